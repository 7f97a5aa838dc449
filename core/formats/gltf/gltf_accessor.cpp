// Component types and layouts of glTF 2.0, Sec. 3.6.2.
#include "core/formats/gltf/gltf_accessor.h"

#include <cmath>
#include <cstring>

#include "core/objects/error.h"

namespace mote::core {
namespace {

enum Component : int {
    int8 = 5120,
    uint8 = 5121,
    int16 = 5122,
    uint16 = 5123,
    uint32 = 5125,
    float32 = 5126
};

constexpr std::size_t max_elements = std::size_t(1) << 28;
constexpr std::size_t max_zeros = std::size_t(1) << 24;  // of accessors that have no bytes

std::size_t bytes_of(int type, const GltfValue& value) {
    switch (type) {
        case int8:
        case uint8:
            return 1;
        case int16:
        case uint16:
            return 2;
        case uint32:
        case float32:
            return 4;
        default:
            value["componentType"].refuse("is no type of component");
    }
}

int components_of(const GltfValue& value) {
    const std::string type = value["type"].text();
    if (type == "SCALAR") return 1;
    if (type.size() == 4 && type.starts_with("VEC") && type[3] >= '2' && type[3] <= '4') return type[3] - '0';
    value["type"].refuse("is '" + printable(type, 20) + "': only SCALAR, VEC2, VEC3 and VEC4 are read");
}

template <typename T>
T load(const std::byte* from) {
    T value;
    std::memcpy(&value, from, sizeof(T));
    return value;
}

}  // namespace

GltfAccessor::GltfAccessor(GltfFile& file, std::size_t index)
    : value_(file.root()["accessors"].at(index)),
      count_(value_["count"].whole(0)),
      type_(int(std::min<std::uint64_t>(value_["componentType"].whole(0), 1u << 20))),
      components_(components_of(value_)),
      normalized_(value_["normalized"].flag(false)) {
    if (count_ > max_elements) value_["count"].refuse("is larger than 2^28");
    dense_.type = type_;
    if (value_["bufferView"].present())
        dense_ = numbers(file, value_, count_, type_, components_, true);
    else if (count_ > max_zeros)
        value_["count"].refuse("is larger than 2^24, without data");
    if (value_["sparse"].present()) read_sparse(file, value_["sparse"]);
}

GltfAccessor::Numbers GltfAccessor::numbers(GltfFile& file, const GltfValue& value, std::size_t count,
                                            int type, int components, bool strided) const {
    const GltfValue views = file.root()["bufferViews"];
    const auto view = value["bufferView"].index_below(views.size());
    if (!view) value.refuse("names no bufferView");
    const std::size_t element = bytes_of(type, value) * std::size_t(components);
    const std::uint64_t stride = strided ? views.at(*view)["byteStride"].whole(element) : element;
    if (stride < element || stride > 4096) views.at(*view)["byteStride"].refuse("does not fit the elements");
    const std::span<const std::byte> bytes = file.view(*view);
    const std::uint64_t offset = value["byteOffset"].whole(0);
    const std::uint64_t length = count > 0 ? (count - 1) * stride + element : 0;
    if (offset > bytes.size() || length > bytes.size() - offset)
        value.refuse("has " + std::to_string(count) + " elements that reach beyond their bufferView");
    return {bytes.subspan(offset, length), stride, type};
}

void GltfAccessor::read_sparse(GltfFile& file, const GltfValue& sparse) {
    const std::uint64_t count = sparse["count"].whole(0);
    if (count > count_) sparse["count"].refuse("is larger than that of the accessor");
    const GltfValue places = sparse["indices"];
    const int type = int(std::min<std::uint64_t>(places["componentType"].whole(0), 1u << 20));
    const Numbers indices = numbers(file, places, count, type, 1, false);
    sparse_ = numbers(file, sparse["values"], count, type_, components_, false);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::byte* from = indices.bytes.data() + i * indices.stride;
        const std::uint32_t at = type == uint8    ? load<std::uint8_t>(from)
                                 : type == uint16 ? load<std::uint16_t>(from)
                                 : type == uint32 ? load<std::uint32_t>(from)
                                                  : UINT32_MAX;
        if (at >= count_) places.refuse("names an element that is not there");
        replaced_[at] = i;
    }
}

float GltfAccessor::value(std::size_t i, int c) const {
    const Numbers* from = &dense_;
    if (!replaced_.empty())
        if (const auto it = replaced_.find(std::uint32_t(i)); it != replaced_.end())
            from = &sparse_, i = it->second;
    if (from->bytes.empty()) return 0.0f;
    const std::size_t size = from->type == int8 || from->type == uint8       ? 1
                             : from->type == uint32 || from->type == float32 ? 4
                                                                             : 2;
    const std::byte* at = from->bytes.data() + i * from->stride + std::size_t(c) * size;
    const auto whole_number = [&](float raw, float largest) {
        return normalized_ ? std::fmax(raw / largest, -1.0f) : raw;
    };
    switch (from->type) {
        case int8:
            return whole_number(load<std::int8_t>(at), 127.0f);
        case uint8:
            return whole_number(load<std::uint8_t>(at), 255.0f);
        case int16:
            return whole_number(load<std::int16_t>(at), 32767.0f);
        case uint16:
            return whole_number(load<std::uint16_t>(at), 65535.0f);
        case uint32:
            return float(load<std::uint32_t>(at));
        default:
            return load<float>(at);
    }
}

std::uint32_t GltfAccessor::whole(std::size_t i) const {
    if (dense_.bytes.empty() || !replaced_.empty()) value_.refuse("holds no plain indices");
    const std::byte* at = dense_.bytes.data() + i * dense_.stride;
    switch (type_) {
        case uint8:
            return load<std::uint8_t>(at);
        case uint16:
            return load<std::uint16_t>(at);
        case uint32:
            return load<std::uint32_t>(at);
        default:
            value_["componentType"].refuse("is no type of an index");
    }
}

}  // namespace mote::core
