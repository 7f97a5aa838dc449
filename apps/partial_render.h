// Text of a partial film about the render that it is a part of (`mote render --pass-range`, `mote merge`).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/subcommands.h"
#include "core/film/film.h"
#include "session/add_statistics.h"

namespace mote::apps {

/// Passes that were rendered elsewhere, added up, and what they have in common.
struct MergedFilm {
    std::shared_ptr<core::Film> film;
    RenderArguments render;            ///< as they were rendered: scene, definitions, layers, seed
    std::string integrator;            ///< its type
    std::string content_hash;          ///< of the scene's files and of what changes the picture
    core::Statistics statistics;       ///< of all
    std::uint32_t first = 0, end = 0;  ///< passes, counted over all parts
};

/// Writes the passes as a partial film. Throws InputError when that fails.
void write_partial(const std::string& path, const MergedFilm& partial);

/// Reads partial films and adds them up in the order of their passes. Throws InputError that names the file
/// when one cannot be read, when two are of different renders (and in what), and where passes are missing or
/// there twice.
MergedFilm merge_partials(const std::vector<std::string>& paths);

/// Properties that partial films of a render must have in common, and the number of passes of the scene, as
/// JSON.
std::string identity_json(const RenderArguments& render, const LoadedScene& scene,
                          const std::string& content_hash);

}  // namespace mote::apps
