// Mesh files: one reader for each format, all giving the same plain data.
//
// OBJ, PLY and serialized are read by our own code: files of these formats come from anywhere, assimp's PLY
// reader crashes on damaged ones, and its OBJ reader forgets which corners share a vertex, which decides
// where computed normals are smooth. Every other format goes through assimp, in a child process.
#pragma once

#include <string_view>

#include "core/geometry/triangle_mesh.h"
#include "core/objects/error.h"

namespace mote::core {

/// Result of a reader: polygons are triangulated already, nothing is checked yet.
struct MeshFile {
    MeshData data;                  ///< no normals when the file has none
    std::size_t other_dropped = 0;  ///< lines, points and faces with less than three corners
    std::vector<std::string> notes = {};
};

/// Wavefront OBJ from text. Throws InputError with the line at fault.
MeshFile read_obj(std::string text, const std::string& path, bool flip_v);
/// Stanford PLY (ASCII, little- and big-endian binary) from bytes. Throws InputError.
MeshFile read_ply(std::string_view bytes, const std::string& path, bool flip_v);
/// Rows that the header of a PLY file declares, where the file is long enough for them.
struct PlyCounts {
    std::uint64_t vertices = 0, faces = 0;
};
/// By the beginning of the file and its size [B]. Throws InputError.
PlyCounts count_ply(std::string_view head, std::uint64_t size, const std::string& path);
/// The least that a shape of this file takes, with Embree's tree [B]; `format` as in load_mesh_as(). Throws
/// InputError.
double mesh_file_memory(const std::string& format, const std::string& path);
/// Mitsuba's format, version 3 or 4: the mesh of that number, from 0. Throws InputError.
MeshFile read_serialized(std::string_view bytes, const std::string& path, std::int64_t shape_index);
/// Reads any format of assimp's, in a child process with limits on time (60 s) and memory. Throws InputError.
MeshFile read_with_assimp(const std::string& path, bool flip_v);

/// load_mesh() for a format given by name: "obj", "ply", "serialized", or "" for what the file's extension
/// says. `shape_index` chooses among the meshes of a serialized file.
MeshData load_mesh_as(const std::string& format, const std::string& path, bool face_normals, bool flip_v,
                      std::vector<std::string>& notes, std::int64_t shape_index = 0);

}  // namespace mote::core
