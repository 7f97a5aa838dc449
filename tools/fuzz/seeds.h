// Small sound files of every format.
#pragma once

#include "core/film/film.h"
#include "core/scene/scene.h"
#include "tools/fuzz/formats.h"

namespace mote::fuzz {

Bytes bytes_of(const std::string& text);
Bytes bytes_of_file(const std::string& path);

std::vector<Bytes> scene_seeds();
std::vector<Bytes> obj_seeds();
std::vector<Bytes> ply_seeds();
std::vector<Bytes> vol_seeds();
std::vector<Bytes> methods_seeds();
std::vector<Bytes> record_seeds();
std::vector<Bytes> checkpoint_seeds();
/// Passes [first, end) of a render as `mote render --pass-range` writes them.
Bytes partial_film(std::uint32_t first, std::uint32_t end);
std::vector<Bytes> partial_film_seeds();
/// `world_to_camera`: 16 numbers.
std::vector<Bytes> exr_seeds(const std::string& world_to_camera);
/// Pictures of colours and grey, plain and packed (picture_seeds.cpp).
std::vector<Bytes> png_seeds();
std::vector<Bytes> jpeg_seeds();
std::vector<Bytes> hdr_seeds();
std::vector<Bytes> pnm_seeds();
std::vector<Bytes> bmp_seeds();
std::vector<Bytes> targa_seeds();
/// A cube as assimp writes it: format "stlb", extension ".stl".
std::vector<Bytes> exported_cubes(const std::vector<std::string>& formats);
std::vector<Bytes> off_seeds();
std::vector<Bytes> stl_seeds();
std::vector<Bytes> gltf_seeds();
/// A scene with cameras, lights, pictures and materials, as text and as .glb.
std::vector<Bytes> gltf_scene_seeds();
std::vector<Bytes> glb_scene_seeds();
/// A scene of every kind of directive, with its mesh in the text.
std::vector<Bytes> pbrt_scene_seeds();
std::vector<Bytes> pfm_seeds();
/// Two meshes a file.
std::vector<Bytes> serialized_seeds();
/// Control points, as `bsplinecurve` and `linearcurve` read them.
std::vector<Bytes> curve_seeds();

/// Film that the checkpoints among the seeds belong to.
core::Film small_film(core::PassSplit split = core::PassSplit::whole);
inline const char* const checkpoint_hash = "0123456789abcdef";
/// A neighbour that partial films are merged with: the passes after them.
inline const char* const next_film = "next.film";

/// Makes the two checksums of a checkpoint or a partial film, and those of the chunks of a PNG, fit again.
void forge_checkpoint(Bytes& bytes);
void forge_png(Bytes& bytes);

}  // namespace mote::fuzz
