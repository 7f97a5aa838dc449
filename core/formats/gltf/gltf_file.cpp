// The container: JSON, chunks, data URIs, files beside the scene.
#include "core/formats/gltf/gltf_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/files/whole_file.h"
#include "core/objects/error.h"

namespace mote::core {
namespace {

namespace fs = std::filesystem;

constexpr int max_depth = 64;
constexpr std::uint32_t glb_magic = 0x46546c67, json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;

std::uint32_t word(std::span<const std::byte> bytes, std::size_t at) {
    std::array<std::uint8_t, 4> b{};
    std::memcpy(b.data(), bytes.data() + at, 4);
    return std::uint32_t(b[0]) | std::uint32_t(b[1]) << 8 | std::uint32_t(b[2]) << 16 |
           std::uint32_t(b[3]) << 24;
}

std::vector<std::byte> decode_base64(std::string_view text, const GltfValue& value) {
    static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    while (text.ends_with('=')) text.remove_suffix(1);
    std::array<int, 256> digit_of;
    digit_of.fill(-1);
    for (std::size_t i = 0; i < digits.size(); ++i) digit_of[std::uint8_t(digits[i])] = int(i);
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const int digit = digit_of[std::uint8_t(c)];
        if (digit < 0) value.refuse("is no base64 text");
        bits = bits << 6 | std::uint32_t(digit), count += 6;
        if (count >= 8) count -= 8, bytes.push_back(std::byte(bits >> count & 0xff));
    }
    return bytes;
}

/// The bytes of a data URI, or nothing.
std::optional<std::vector<std::byte>> data_of(const std::string& uri, const GltfValue& value) {
    if (!uri.starts_with("data:")) return std::nullopt;
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || uri.substr(0, comma).find(";base64") == std::string::npos)
        value.refuse("is a data URI without base64 data");
    return decode_base64(std::string_view(uri).substr(comma + 1), value);
}

/// "a%20b.png" is "a b.png".
std::string decode_percent(const std::string& uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool coded = uri[i] == '%' && i + 2 < uri.size() && std::isxdigit(std::uint8_t(uri[i + 1])) &&
                           std::isxdigit(std::uint8_t(uri[i + 2]));
        text += coded ? char(std::stoi(uri.substr(i + 1, 2), nullptr, 16)) : uri[i];
        if (coded) i += 2;
    }
    return text;
}

std::vector<std::byte> read_named(const std::string& path) {
    try {
        return read_whole_file(path);
    } catch (const InputError& error) {
        throw InputError(error.what(), {path, 0});
    }
}

}  // namespace

GltfFile::GltfFile(const std::string& path) : path_(path), files_{path} {
    whole_ = read_named(path);
    if (whole_.size() >= 4 && word(whole_, 0) == glb_magic)
        open_binary();
    else
        parse(whole_);
    const GltfValue asset = root()["asset"];
    if (!asset["version"].text().starts_with("2."))
        asset["version"].refuse("is '" + printable(asset["version"].text()) + "': only glTF 2 is read");
}

GltfFile::~GltfFile() = default;

void GltfFile::parse(std::span<const std::byte> text) {
    const auto* begin = reinterpret_cast<const char*>(text.data());
    const auto depth = [&](int level, nlohmann::json::parse_event_t, nlohmann::json&) {
        if (level > max_depth) throw InputError("lists and objects are nested too deep", {path_, 0});
        return true;
    };
    try {
        json_ = std::make_unique<nlohmann::json>(nlohmann::json::parse(begin, begin + text.size(), depth));
    } catch (const nlohmann::json::exception& error) {
        throw InputError(printable(std::string("no glTF: ") + error.what(), 200), {path_, 0});
    }
    if (!json_->is_object()) throw InputError("no glTF: the document is no object", {path_, 0});
}

/// Chunks of a .glb: the document, then the bytes of the first buffer.
void GltfFile::open_binary() {
    const auto refuse = [&](const char* why) {
        throw InputError(std::string("damaged: ") + why, {path_, 0});
    };
    if (whole_.size() < 20) refuse("the file is shorter than its head");
    if (word(whole_, 4) != 2) refuse("only version 2 is read");
    const std::size_t end = std::min<std::size_t>(whole_.size(), word(whole_, 8));
    for (std::size_t at = 12; at + 8 <= end;) {
        const std::size_t length = word(whole_, at);
        if (length > end - at - 8) refuse("a chunk is longer than the file");
        const auto chunk = std::span(whole_).subspan(at + 8, length);
        if (word(whole_, at + 4) == json_chunk && !json_) parse(chunk);
        if (word(whole_, at + 4) == binary_chunk && binary_chunk_.empty()) binary_chunk_ = chunk;
        at += 8 + (length + 3) / 4 * 4;
    }
    if (!json_) refuse("there is no JSON chunk");
}

std::string GltfFile::beside(const GltfValue& uri) {
    const std::string text = uri.text();
    if (text.find("://") != std::string::npos)
        uri.refuse("is not on this machine: '" + printable(text) + "'");
    const std::string path = (fs::path(path_).parent_path() / fs::path(decode_percent(text))).string();
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored))
        uri.refuse("file '" + printable(decode_percent(text), 300) + "' was not found");
    if (std::find(files_.begin(), files_.end(), path) == files_.end()) files_.push_back(path);
    return path;
}

std::vector<std::byte> GltfFile::read_buffer(const GltfValue& value, bool first) {
    const GltfValue uri = value["uri"];
    if (!uri.present()) {
        if (!first || binary_chunk_.empty()) value.refuse("has no data");
        return {binary_chunk_.begin(), binary_chunk_.end()};
    }
    if (auto data = data_of(uri.text(), uri)) return std::move(*data);
    return read_named(beside(uri));
}

const std::vector<std::byte>& GltfFile::buffer(std::size_t i) {
    const auto it = buffers_.find(i);
    if (it != buffers_.end()) return it->second;
    const GltfValue value = root()["buffers"].at(i);
    std::vector<std::byte> bytes = read_buffer(value, i == 0);
    const std::uint64_t length = value["byteLength"].whole(0);
    if (length > bytes.size())
        value.refuse("has " + std::to_string(bytes.size()) + " bytes instead of " + std::to_string(length));
    bytes.resize(length);  // .glb may be padded
    return buffers_.emplace(i, std::move(bytes)).first->second;
}

std::span<const std::byte> GltfFile::view(std::size_t i) {
    const GltfValue value = root()["bufferViews"].at(i);
    const auto number = value["buffer"].index_below(root()["buffers"].size());
    if (!number) value.refuse("names no buffer");
    const std::vector<std::byte>& bytes = buffer(*number);
    const std::uint64_t offset = value["byteOffset"].whole(0), length = value["byteLength"].whole(0);
    if (offset > bytes.size() || length > bytes.size() - offset) value.refuse("reaches beyond its buffer");
    return std::span(bytes).subspan(offset, length);
}

GltfFile::Image GltfFile::image(std::size_t i) {
    const GltfValue value = root()["images"].at(i);
    if (const auto number = value["bufferView"].index_below(root()["bufferViews"].size()))
        return {"", view(*number)};
    const GltfValue uri = value["uri"];
    if (!uri.present()) value.refuse("has no data");
    const auto it = data_uris_.find(i);
    if (it != data_uris_.end()) return {"", it->second};
    if (auto data = data_of(uri.text(), uri))
        return {"", data_uris_.emplace(i, std::move(*data)).first->second};
    return {beside(uri), {}};
}

}  // namespace mote::core
