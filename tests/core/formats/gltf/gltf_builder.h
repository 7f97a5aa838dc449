// glTF files for tests, written piece by piece.
#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/formats/pictures/image_file.h"
#include "core/geometry/triangle_mesh.h"

namespace mote::tests {

class GltfBuilder {
  public:
    using json = nlohmann::json;
    json document = {{"asset", {{"version", "2.0"}}}, {"scenes", {{{"nodes", json::array()}}}}};

    /// All return the number of what they add.
    std::size_t view(const void* data, std::size_t size) {
        bytes_.resize((bytes_.size() + 3) / 4 * 4);
        const std::size_t offset = bytes_.size();
        bytes_.append(static_cast<const char*>(data), size);
        return add("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
    }
    template <typename T>
    std::size_t accessor(const std::vector<T>& values, int component, const std::string& type,
                         std::size_t components) {
        return add("accessors", {{"bufferView", view(values.data(), values.size() * sizeof(T))},
                                 {"componentType", component},
                                 {"type", type},
                                 {"count", values.size() / components}});
    }
    std::size_t floats(const std::vector<float>& values, const std::string& type, std::size_t components) {
        return accessor(values, 5126, type, components);
    }
    /// A primitive of this mesh.
    json primitive(const core::MeshData& mesh) {
        json p = {{"attributes", {{"POSITION", floats(flat(mesh.positions), "VEC3", 3)}}}};
        if (!mesh.normals.empty()) p["attributes"]["NORMAL"] = floats(flat(mesh.normals), "VEC3", 3);
        if (!mesh.uvs.empty()) p["attributes"]["TEXCOORD_0"] = floats(flat(mesh.uvs), "VEC2", 2);
        std::vector<std::uint16_t> corners;
        for (const auto& t : mesh.triangles)
            for (const std::uint32_t corner : t) corners.push_back(std::uint16_t(corner));
        p["indices"] = accessor(corners, 5123, "SCALAR", 1);
        return p;
    }
    std::size_t mesh(const core::MeshData& data, const json& material = {}) {
        json p = primitive(data);
        if (!material.is_null()) p["material"] = add("materials", material);
        return add("meshes", {{"primitives", {p}}});
    }
    /// A picture in the file, 8 bits.
    std::size_t texture(int width, int height, const std::vector<std::uint8_t>& rgb) {
        const auto png = core::encode_png(width, height, rgb, true);
        return add("textures", {{"source", add("images", {{"bufferView", view(png.data(), png.size())},
                                                          {"mimeType", "image/png"}})}});
    }
    std::size_t node(const json& value) {
        const std::size_t number = add("nodes", value);
        document["scenes"][0]["nodes"].push_back(number);
        return number;
    }
    /// Along -z of the node.
    void light(const json& light, json node_value = json::object()) {
        json& lights = document["extensions"]["KHR_lights_punctual"]["lights"];
        lights.push_back(light);
        node_value["extensions"]["KHR_lights_punctual"]["light"] = lights.size() - 1;
        node(node_value);
    }
    void camera(const json& camera, json node_value = json::object()) {
        node_value["camera"] = add("cameras", camera);
        node(node_value);
    }
    std::size_t add(const char* list, const json& value) {
        document[list].push_back(value);
        return document[list].size() - 1;
    }

    /// The buffer as text within the document.
    std::string text() {
        json all = document;
        all["buffers"] = {{{"byteLength", bytes_.size()},
                           {"uri", "data:application/octet-stream;base64," + base64(bytes_)}}};
        return all.dump(1);
    }
    std::string binary() {
        json all = document;
        all["buffers"] = {{{"byteLength", bytes_.size()}}};
        std::string head = all.dump(), data = bytes_;
        head.resize((head.size() + 3) / 4 * 4, ' ');
        data.resize((data.size() + 3) / 4 * 4, '\0');
        return word(0x46546c67) + word(2) + word(28 + head.size() + data.size()) + word(head.size()) +
               word(0x4e4f534a) + head + word(data.size()) + word(0x004e4942) + data;
    }

  private:
    template <typename V>
    static std::vector<float> flat(const std::vector<V>& values) {
        std::vector<float> numbers;
        for (const V& v : values)
            for (int i = 0; i < V::length(); ++i) numbers.push_back(v[i]);
        return numbers;
    }
    static std::string word(std::size_t value) {
        std::string text(4, '\0');
        for (std::size_t i = 0; i < 4; ++i) text[i] = char(value >> (8 * i) & 0xff);
        return text;
    }
    static std::string base64(const std::string& bytes) {
        const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string text;
        for (std::size_t i = 0; i < bytes.size(); i += 3) {
            std::uint32_t bits = 0;
            for (std::size_t k = 0; k < 3; ++k)
                bits = bits << 8 | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0u);
            for (std::size_t k = 0; k < 4; ++k)
                text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
        }
        return text;
    }

    std::string bytes_;
};

/// [-1, 1]^2 facing +z; u to the right, v down.
inline core::MeshData gltf_quad() {
    return {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
            {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
            {{0, 1}, {1, 1}, {1, 0}, {0, 0}},
            {{{0, 1, 2}}, {{0, 2, 3}}},
            {}};
}

}  // namespace mote::tests
