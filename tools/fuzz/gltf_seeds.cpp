// glTF scenes that use much of what is read: one document, with its bytes as text or as a chunk.
#include "core/formats/pictures/image_file.h"
#include "tools/fuzz/seeds.h"

namespace mote::fuzz {

namespace {

const char* const head = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2,3,5,6,7]}],
"extensionsUsed":["KHR_lights_punctual","KHR_materials_transmission","KHR_texture_transform"],
"nodes":[{"name":"Floor","mesh":0,"scale":[2,-2,2]},{"camera":0,"translation":[0,1,6],"rotation":[0,0,0,1]},
{"camera":1,"name":"Top","matrix":[1,0,0,0,0,0,-1,0,0,1,0,0,0,5,0,1]},{"children":[4],"translation":[1,0,0]},
{"mesh":1},{"mesh":1,"scale":[0.5,0.5,0.5]},{"extensions":{"KHR_lights_punctual":{"light":0}},"translation":[0,2,2]},
{"extensions":{"KHR_lights_punctual":{"light":1}}}],
"cameras":[{"type":"perspective","perspective":{"yfov":0.6,"aspectRatio":1.5,"znear":0.1,"zfar":50}},
{"type":"orthographic","orthographic":{"xmag":2,"ymag":1,"znear":0.1,"zfar":50}}],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":500,"color":[1,0.5,0.2],
"spot":{"innerConeAngle":0.2,"outerConeAngle":0.6}},{"type":"directional","intensity":3}]}},
"materials":[{"name":"Wood","doubleSided":true,"alphaMode":"MASK","alphaCutoff":0.3,"pbrMetallicRoughness":
{"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":{"offset":[0.1,0],"rotation":0.3,"scale":[2,2]}}},
"metallicRoughnessTexture":{"index":1},"metallicFactor":0.5,"baseColorFactor":[0.9,0.8,0.7,1]},
"normalTexture":{"index":1,"scale":0.8}},
{"emissiveFactor":[1,1,0.5],"emissiveTexture":{"index":0},"extensions":{"KHR_materials_transmission":
{"transmissionFactor":0.5},"KHR_materials_volume":{"thicknessFactor":1,"attenuationDistance":2,"attenuationColor":[0.5,1,1]}}}],
"samplers":[{"wrapS":33071,"wrapT":33071,"magFilter":9728}],
"textures":[{"source":0,"sampler":0},{"source":1}],
"images":[{"bufferView":5,"mimeType":"image/png"},{"uri":"picture.png"}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3,"material":0}]},
{"primitives":[{"attributes":{"POSITION":0,"COLOR_0":4},"mode":5,"material":1}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
{"bufferView":1,"componentType":5120,"normalized":true,"count":4,"type":"VEC3"},
{"bufferView":2,"componentType":5126,"count":4,"type":"VEC2"},
{"bufferView":3,"componentType":5123,"count":6,"type":"SCALAR"},
{"bufferView":4,"componentType":5121,"normalized":true,"count":4,"type":"VEC4",
"sparse":{"count":1,"indices":{"bufferView":3,"componentType":5123},"values":{"bufferView":4}}}],
"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":16,"byteStride":4},
{"buffer":0,"byteOffset":64,"byteLength":32},{"buffer":0,"byteOffset":96,"byteLength":12},
{"buffer":0,"byteOffset":108,"byteLength":16},{"buffer":0,"byteOffset":124,"byteLength":)";

void append(std::string& bytes, const void* data, std::size_t size) {
    bytes.append(static_cast<const char*>(data), size);
}

std::string picture() {
    const std::uint8_t pixels[12] = {255, 0, 0, 0, 255, 0, 0, 0, 255, 128, 128, 255};
    const std::vector<std::byte> png = core::encode_png(2, 2, pixels, true);
    return {reinterpret_cast<const char*>(png.data()), png.size()};
}

std::string buffer(const std::string& png) {
    const float positions[12] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0.5f},
                uvs[8] = {0, 1, 1, 1, 1, 0, 0, 0};
    const std::int8_t normals[16] = {0, 0, 127, 0, 0, 10, 126, 0, 0, 0, 127, 0, 9, 0, 126, 0};
    const std::uint16_t corners[6] = {0, 1, 2, 0, 2, 3};
    const std::uint8_t colours[16] = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 9, 99, 199, 255};
    std::string bytes;
    append(bytes, positions, 48), append(bytes, normals, 16), append(bytes, uvs, 32);
    append(bytes, corners, 12), append(bytes, colours, 16);
    return bytes + png;
}

std::string base64(const std::string& bytes) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = i; k < i + 3; ++k)
            bits = bits << 8 | (k < bytes.size() ? std::uint8_t(bytes[k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
    }
    return text;
}

std::string document(const std::string& png, const std::string& buffer_text) {
    std::string text = head;
    text.append(std::to_string(png.size())).append(R"(}],"buffers":[{"byteLength":)");
    text.append(std::to_string(124 + png.size())).append(buffer_text).append("}]}");
    return text;
}

void append_word(std::string& bytes, std::size_t value) {
    const auto bits = std::uint32_t(value);
    append(bytes, &bits, 4);
}

/// Appends a chunk of a .glb, filled up to a multiple of four bytes.
void append_chunk(std::string& file, std::uint32_t type, std::string bytes, char filler) {
    while (bytes.size() % 4 != 0) bytes.push_back(filler);
    append_word(file, bytes.size()), append_word(file, type);
    file.append(bytes);
}

}  // namespace

std::vector<Bytes> gltf_scene_seeds() {
    const std::string png = picture();
    return {bytes_of(document(png, R"(,"uri":"data:;base64,)" + base64(buffer(png)) + "\""))};
}

std::vector<Bytes> glb_scene_seeds() {
    const std::string png = picture();
    std::string chunks, file;
    append_chunk(chunks, 0x4e4f534a, document(png, ""), ' ');
    append_chunk(chunks, 0x004e4942, buffer(png), '\0');
    append_word(file, 0x46546c67), append_word(file, 2), append_word(file, 12 + chunks.size());
    return {bytes_of(file.append(chunks))};
}

}  // namespace mote::fuzz
