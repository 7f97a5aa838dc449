// Strict reading of .vol files.
#include "media/vol_file.h"

#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/objects/error.h"

namespace mote::media {

namespace {

struct Header {
    char magic[3];
    std::uint8_t version;
    std::int32_t type, nx, ny, nz, channels;
    float bounds[6];
};
static_assert(sizeof(Header) == 48);

[[noreturn]] void refuse(const std::string& path, const std::string& message) {
    throw core::InputError(message, {path, 0});
}

const char* type_name(std::int32_t type) {
    switch (type) {
        case 1:
            return "float32";
        case 2:
            return "float16";
        case 3:
            return "uint8";
        case 4:
            return "quantised directions";
        default:
            return "unknown";
    }
}

void check_header(const Header& h, const std::string& path) {
    if (std::memcmp(h.magic, "VOL", 3) != 0) refuse(path, "not a .vol file (it does not start with 'VOL')");
    if (h.version != 3) refuse(path, fmt::format(".vol version {}, only 3 is known", int(h.version)));
    if (h.type != 1)
        refuse(path, fmt::format("voxels of type {} ({}), only float32 is read", h.type, type_name(h.type)));
    if (h.channels != 1 && h.channels != 3)
        refuse(path, fmt::format("{} channels, only 1 and 3 are read", h.channels));
    for (const std::int32_t n : {h.nx, h.ny, h.nz})
        if (n < 1 || n > (1 << 16))
            refuse(path, fmt::format("a grid of {} x {} x {} voxels", h.nx, h.ny, h.nz));
    for (const float b : h.bounds)
        if (!std::isfinite(b)) refuse(path, "its bounding box is not finite");
}

void check_values(VolFile& file, const std::string& path, bool clamp_negative) {
    const auto voxel_name = [&](std::size_t i) {
        const std::size_t v = i / std::size_t(file.channels), nx = std::size_t(file.resolution.x),
                          ny = std::size_t(file.resolution.y);
        return fmt::format("voxel ({}, {}, {})", v % nx, v / nx % ny, v / nx / ny);
    };
    for (std::size_t i = 0; i < file.values.size(); ++i) {
        float& v = file.values[i];
        if (v >= 0.0f && std::isfinite(v)) continue;
        if (!std::isfinite(v)) refuse(path, fmt::format("{} is {}", voxel_name(i), v));
        if (!clamp_negative)
            refuse(path, fmt::format("{} is negative ({}); set clamp_negative to use 0", voxel_name(i), v));
        file.lowest = std::fmin(file.lowest, v);
        v = 0.0f;
        ++file.clamped;
    }
}

}  // namespace

VolFile read_vol_file(const std::string& path, bool clamp_negative, const core::MemoryBudget& memory) {
    std::error_code error;
    const auto size = std::filesystem::file_size(path, error);
    std::ifstream in(path, std::ios::binary);
    if (error || !in) refuse(path, "cannot be read");
    Header h{};
    if (size < sizeof h || !in.read(reinterpret_cast<char*>(&h), sizeof h))
        refuse(path, fmt::format("{} bytes are too few for a .vol file", size));
    check_header(h, path);
    const std::uint64_t count =
        std::uint64_t(h.nx) * std::uint64_t(h.ny) * std::uint64_t(h.nz) * std::uint64_t(h.channels);
    const std::uint64_t expected = sizeof h + count * sizeof(float);
    if (size != expected)
        refuse(path, fmt::format("{} x {} x {} x {} voxels need {} bytes, the file has {}", h.nx, h.ny, h.nz,
                                 h.channels, expected, size));
    VolFile file;
    file.resolution = {h.nx, h.ny, h.nz};
    file.channels = h.channels;
    file.bounds.lower = {h.bounds[0], h.bounds[1], h.bounds[2]};
    file.bounds.upper = {h.bounds[3], h.bounds[4], h.bounds[5]};
    memory.require(double(count) * sizeof(float),
                   fmt::format("{} x {} x {} voxels of '{}'", h.nx, h.ny, h.nz, core::printable(path, 300)));
    file.values.resize(count);
    if (!in.read(reinterpret_cast<char*>(file.values.data()), std::streamsize(count * sizeof(float))))
        refuse(path, "ends before its last voxel");
    check_values(file, path, clamp_negative);
    return file;
}

void write_vol_file(const std::string& path, const VolFile& file) {
    const core::Vec3 lo = file.bounds.lower, hi = file.bounds.upper;
    const Header h{{'V', 'O', 'L'},
                   3,
                   1,
                   file.resolution.x,
                   file.resolution.y,
                   file.resolution.z,
                   file.channels,
                   {lo.x, lo.y, lo.z, hi.x, hi.y, hi.z}};
    std::ofstream out(path, std::ios::binary);
    out.write(reinterpret_cast<const char*>(&h), sizeof h);
    out.write(reinterpret_cast<const char*>(file.values.data()),
              std::streamsize(file.values.size() * sizeof(float)));
    if (!out.flush()) refuse(path, "cannot be written");
}

}  // namespace mote::media
