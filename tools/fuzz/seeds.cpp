// Sound files, small enough that an injury is likely to hit something that matters.
#include "tools/fuzz/seeds.h"

#include <assimp/cexport.h>
#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>

#include "core/formats/pictures/image_file.h"
#include "media/vol_file.h"
#include "tools/fuzz/scratch_file.h"
#include "trade/record.h"

namespace mote::fuzz {

namespace {

using core::Rgb;

const char* const cube_obj = R"(# a cube
o cube
v -1 -1 -1
v 1 -1 -1
v 1 1 -1
v -1 1 -1
v -1 -1 1
v 1 -1 1
v 1 1 1
v -1 1 1
vt 0 0
vt 1 0
vt 1 1
vn 0 0 -1
g sides
s 1
f 1/1/1 4/2/1 3/3/1 2/1/1
f 5//1 6//1 7//1 8//1
usemtl red
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f -8 -4 -1 -5
l 1 2
)";

core::ImageChannels gradient(int width, int height) {
    core::ImageChannels image;
    image.width = width, image.height = height;
    std::vector<Rgb> pixels;
    for (int i = 0; i < width * height; ++i) pixels.emplace_back(float(i) / 32.0f, 0.5f, float(i % width));
    image.add_rgb("", pixels);
    image.add_rgb("direct", pixels);
    return image;
}

// CRC-32 as PNG defines it (ISO/IEC 15948, annex D).
std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
    std::uint32_t c = ~0u;
    for (const std::uint8_t byte : bytes) {
        c ^= byte;
        for (int bit = 0; bit < 8; ++bit) c = (c & 1) ? (c >> 1) ^ 0xedb88320u : c >> 1;
    }
    return ~c;
}

void put(std::string& text, const auto& value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

std::string binary_ply() {
    std::string text =
        "ply\nformat binary_little_endian 1.0\ncomment a triangle\nelement vertex 3\nproperty float x\n"
        "property float y\nproperty float z\nproperty uchar red\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n";
    for (int i = 0; i < 3; ++i) {
        for (int axis = 0; axis < 3; ++axis) put(text, float(i == axis));
        text += 'x';
    }
    text += '\3';
    for (int i = 0; i < 3; ++i) put(text, i);
    return text;
}

}  // namespace

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

Bytes bytes_of_file(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return Bytes(std::istreambuf_iterator<char>(file), {});
}

std::vector<Bytes> obj_seeds() { return {bytes_of(cube_obj)}; }

std::vector<Bytes> ply_seeds() {
    return {
        bytes_of(binary_ply()),
        bytes_of(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
            "property double z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float u\n"
            "property float v\nelement face 2\nproperty list uchar uint vertex_index\nend_header\n"
            "0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n1 1 0 0 0 1 1 1\n0 1 0 0 0 1 0 1\n4 0 1 2 3\n3 0 1 2\n")};
}

std::vector<Bytes> off_seeds() {
    return {bytes_of("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n")};
}

std::vector<Bytes> stl_seeds() {
    std::string text = "solid one\nfacet normal 0 0 1\nouter loop\n";
    for (const char* place : {"0 0 0", "1 0 0", "0 1 0"}) text += std::string("vertex ") + place + "\n";
    text += "endloop\nendfacet\nendsolid one\n";
    std::string binary(80, ' ');
    put(binary, std::uint32_t(2));
    for (int triangle = 0; triangle < 2; ++triangle) {
        for (int i = 0; i < 12; ++i) put(binary, float((i * 7 + triangle) % 5));
        put(binary, std::uint16_t(0));
    }
    return {bytes_of(text), bytes_of(binary)};
}

std::vector<Bytes> gltf_seeds() {
    // Three corners as floats and three indices of two bytes, in base64.
    return {bytes_of(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
 "nodes": [{"mesh": 0, "translation": [1, 2, 3]}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}],
 "buffers": [{"uri": "data:application/octet-stream;base64,AAABAAIAAAAAAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPwAAAAA=", "byteLength": 44}],
 "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 6, "target": 34963},
                 {"buffer": 0, "byteOffset": 8, "byteLength": 36, "target": 34962}],
 "accessors": [{"bufferView": 0, "byteOffset": 0, "componentType": 5123, "count": 3, "type": "SCALAR", "max": [2], "min": [0]},
               {"bufferView": 1, "byteOffset": 0, "componentType": 5126, "count": 3, "type": "VEC3", "max": [1, 1, 0], "min": [0, 0, 0]}]})")};
}

std::vector<Bytes> pfm_seeds() {
    std::string colour = "PF\n4 3\n-1.0\n", grey = "Pf\n4 3\n-2.5\n";
    for (int i = 0; i < 36; ++i) put(colour, 0.1f * float(i));
    for (int i = 0; i < 12; ++i) put(grey, 0.1f * float(i));
    return {bytes_of(colour), bytes_of(grey)};
}

std::vector<Bytes> vol_seeds() {
    const ScratchFile file(".vol");
    std::vector<Bytes> seeds;
    for (const int channels : {1, 3}) {
        media::VolFile grid;
        grid.resolution = {3, 4, 5}, grid.channels = channels;
        grid.bounds = {core::Vec3(-1.0f), core::Vec3(1.0f)};
        grid.values.assign(std::size_t(60 * channels), 0.25f);
        media::write_vol_file(file.path(), grid);
        seeds.push_back(file.bytes());
    }
    return seeds;
}

std::vector<Bytes> methods_seeds() {
    return {bytes_of(R"({"time": 60, "passes": 128, "seeds": 3, "methods": [
 {"name": "path tracing", "integrator": "path"},
 {"name": "deep", "integrator": "path", "settings": {"max_depth": 12, "hide_emitters": false}},
 {"name": "Täuschung", "integrator": "volpath", "settings": {"max_depth": -1, "rr_depth": 5, "clamp": 0.5,
  "tint": [1, 0.5, 2.5e-1], "mode": "word"}}]})")};
}

std::vector<Bytes> record_seeds() {
    std::vector<trade::Record> records(2);
    records[0].method = "a, \"b\"", records[0].integrator = "path", records[0].settings = "x=1 y=2",
    records[0].passes = 4;
    records[1].method = "c", records[1].integrator = "volpath", records[1].passes = 2,
    records[1].error = 0.25, records[1].final = true;
    for (trade::Record& r : records) r.wall = 1.5;
    return {bytes_of(trade::to_csv(records))};
}

void forge_png(Bytes& bytes) {
    const auto big_endian = [&](std::size_t at) {
        return std::size_t(bytes[at]) << 24 | std::size_t(bytes[at + 1]) << 16 |
               std::size_t(bytes[at + 2]) << 8 | bytes[at + 3];
    };
    for (std::size_t at = 8; at + 12 <= bytes.size();) {
        const std::size_t length = big_endian(at);
        if (length > bytes.size() - at - 12) return;
        const std::uint32_t sum = crc32(std::span(bytes).subspan(at + 4, length + 4));
        for (int i = 0; i < 4; ++i)
            bytes[at + 8 + length + std::size_t(i)] = std::uint8_t(sum >> (24 - 8 * i));
        at += length + 12;
    }
}

std::vector<Bytes> exr_seeds(const std::string& world_to_camera) {
    const ScratchFile file(".exr");
    std::vector<Bytes> seeds;
    for (const bool half : {false, true}) {
        core::ImageChannels image = gradient(4, 3);
        image.add("Depth.Z", std::vector<float>(12, 2.0f));
        // A reference must say how noisy it is; little enough for the smallest error that is requested.
        image.add_rgb("Variance", std::vector<Rgb>(12, Rgb(1e-6f)));
        image.metadata = {{"bound", "12.5"},
                          {"integrator", "path"},
                          {"passes", "16"},
                          {"relativeError", "0.0001"},
                          {"meanError", "0.0001"},
                          {"seed", "1"},
                          {"sceneContent", "0123456789abcdef"},
                          {"worldToCamera", world_to_camera}};
        core::write_exr(file.path(), image, half);
        seeds.push_back(file.bytes());
    }
    return seeds;
}

std::vector<Bytes> exported_cubes(const std::vector<std::string>& formats) {
    Assimp::Importer importer;
    const aiScene* cube = importer.ReadFileFromMemory(cube_obj, std::strlen(cube_obj), 0, "obj");
    std::vector<Bytes> seeds;
    for (const std::string& format : formats) {
        Assimp::Exporter exporter;
        const aiExportDataBlob* blob = cube ? exporter.ExportToBlob(cube, format) : nullptr;
        if (!blob) continue;
        const auto* data = static_cast<const std::uint8_t*>(blob->data);
        seeds.emplace_back(data, data + blob->size);
    }
    return seeds;
}

}  // namespace mote::fuzz
