// Memory that meshes of files will take, before they are read.
#include <algorithm>
#include <fstream>

#include "core/files/whole_file.h"
#include "core/formats/meshes/mesh_file.h"

namespace mote::core {

namespace {

constexpr std::size_t longest_header = 1 << 16;  // of PLY files
// Measured with meshes of 0.5 and 2 million triangles: 182 bytes for a triangle and half a vertex while the
// scene is made.
constexpr double per_vertex = 24.0, per_triangle = 160.0;

}  // namespace

double mesh_file_memory(const std::string& format, const std::string& path) {
    const std::uint64_t size = size_of_file(path);
    if (format != "ply") return 2.0 * double(size);  // the file, and as much of triangles at least
    std::string head(std::min<std::uint64_t>(size, longest_header), '\0');
    std::ifstream(path, std::ios::binary).read(head.data(), std::streamsize(head.size()));
    const PlyCounts counts = count_ply(head, size, path);
    return per_vertex * double(counts.vertices) + per_triangle * double(counts.faces);
}

}  // namespace mote::core
