// The files of `mote render`: their names, and what is written into them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/subcommands.h"
#include "session/output_files.h"
#include "session/render.h"

namespace mote::apps {

/// --pass-range. Throws UsageError for a malformed one, and beside a stopping rule.
std::optional<core::PassRange> pass_range(const RenderArguments& arguments);

/// `picture` is a partial film where a range of passes is rendered; it has no preview then.
struct RenderFiles {
    std::string picture, preview, checkpoint;
    bool named_picture = false, named_preview = false;  ///< by the user
};
/// Throws UsageError for an output of another kind.
RenderFiles render_files(const RenderArguments& arguments, const std::optional<core::PassRange>& range);
/// Throws InputError for outputs that are inputs, each other, files of others, or cannot be written.
void check_files(const RenderFiles& files, const RenderArguments& arguments,
                 std::span<const std::string> inputs);

/// Writes picture and preview; returns the exposure of the preview. Adds to `warnings`.
std::string write_pictures(const RenderFiles& files, const Rendered& rendered,
                           const RenderArguments& arguments, bool half, std::vector<std::string>& warnings);
/// Writes the passes of a range as a partial film.
void write_range(const std::string& path, Rendered&& rendered, const RenderArguments& arguments,
                 const core::PassRange& range, const LoadedScene& scene);
/// Writes the statistics, with the seconds that writing the picture took.
void write_statistics(const std::string& path, const Rendered& rendered, double write_seconds);

}  // namespace mote::apps
