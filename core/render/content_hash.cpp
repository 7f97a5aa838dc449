// The hash that ties a checkpoint to the inputs of its render.
#include <cstdio>
#include <cstring>
#include <fstream>

#include "core/files/checksum.h"
#include "core/objects/error.h"
#include "core/render/render_driver.h"
#include "core/scene/scene.h"

namespace mote::core {

namespace {

std::uint64_t hash_text(const std::string& text, std::uint64_t h) {
    return checksum(std::as_bytes(std::span(text.data(), text.size())), h);
}

// Names are left out: a scene may move to another folder.
std::uint64_t hash_file(const std::string& path, std::uint64_t h) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw InputError(std::string("cannot be read: ") + std::strerror(errno), {path, 0});
    std::vector<char> buffer(std::size_t(1) << 20);
    do {
        file.read(buffer.data(), std::streamsize(buffer.size()));
        if (file.bad()) throw InputError("cannot be read", {path, 0});
        h = checksum(std::as_bytes(std::span(buffer.data(), std::size_t(file.gcount()))), h);
    } while (file);
    return h;
}

}  // namespace

std::string content_hash(std::span<const std::string> files, const std::vector<std::string>& settings) {
    std::uint64_t h = checksum_start;
    for (const std::string& path : files) h = hash_file(path, h);
    for (const std::string& setting : settings) h = hash_text(setting, h);
    char digits[17];
    std::snprintf(digits, sizeof(digits), "%016llx", static_cast<unsigned long long>(h));
    return digits;
}

std::string content_hash(const Scene& scene, const std::vector<std::string>& settings) {
    return content_hash(scene.parts().input_files, settings);
}

}  // namespace mote::core
