// Mitsuba's own formats of shapes: serialized meshes and curves.
#include <zlib.h>

#include "tools/fuzz/seeds.h"

namespace mote::fuzz {

namespace {

constexpr std::uint32_t normals = 1, uvs = 2, colours = 8, floats = 0x1000, doubles = 0x2000;

void put(std::string& bytes, const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// A zlib stream; level 0 leaves the bytes as they are, so that an injury reaches what lies in it.
std::string packed(const std::string& bytes, int level) {
    uLongf size = ::compressBound(uLong(bytes.size()));
    std::string out(size, '\0');
    ::compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                uLong(bytes.size()), level);
    out.resize(size);
    return out;
}

/// Two triangles with whatever the flags say.
std::string serialized_mesh(std::uint16_t version, std::uint32_t flags, int level) {
    constexpr int vertices = 4;
    std::string raw;
    put(raw, flags);
    if (version == 4) raw += std::string("mesh") + '\0';
    put(raw, std::uint64_t(vertices)), put(raw, std::uint64_t(2));
    const int numbers = 3 + (flags & normals ? 3 : 0) + (flags & uvs ? 2 : 0) + (flags & colours ? 3 : 0);
    for (int i = 0; i < vertices * numbers; ++i) {
        const double value = 0.25 * double(i % 5);
        if (flags & doubles)
            put(raw, value);
        else
            put(raw, float(value));
    }
    for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) put(raw, corner);
    std::string mesh;
    put(mesh, std::uint16_t(0x041c)), put(mesh, version);
    return mesh + packed(raw, level);
}

/// Two meshes and the table of where they begin.
Bytes serialized_file(std::uint16_t version, std::uint32_t flags, int level) {
    std::string file = serialized_mesh(version, flags, level);
    const std::size_t second = file.size();
    file += serialized_mesh(version, floats, level);
    for (const std::size_t offset : {std::size_t(0), second}) {
        if (version == 4)
            put(file, std::uint64_t(offset));
        else
            put(file, std::uint32_t(offset));
    }
    put(file, std::uint32_t(2));
    return bytes_of(file);
}

}  // namespace

std::vector<Bytes> serialized_seeds() {
    return {serialized_file(3, floats | normals | uvs | colours, 0), serialized_file(4, doubles | uvs, 0),
            serialized_file(4, floats | normals | colours, 6)};
}

std::vector<Bytes> curve_seeds() {
    return {bytes_of("0 0 0 0.1\n0 1 0 0.1\n0.5 2 0 0.08\n1 2.5 0 0.05\n1 3 1 0\n\n"
                     "2 0 0 0.1\n2 1 0 0.2\n2 2 0 0.1\n2 3 0 0.1\n"),
            bytes_of("-1 0 0 1e-3\r\n-1 1.5e0 0 1e-3\r\n-1 2 +0.5 .001\r\n-1 3 0 1e-3\r\n\r\n\r\n"
                     "1 0 0 0.5\r\n1 0 0 0.5\r\n1 0 0 0.5\r\n1 0 0 0.5")};
}

}  // namespace mote::fuzz
