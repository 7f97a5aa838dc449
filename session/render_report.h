// Reports of a render: metadata of the picture, and stats.json.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/film/image_channels.h"
#include "core/objects/registry.h"
#include "core/render/render_driver.h"
#include "core/scene/scene.h"

namespace mote::session {

/// Results of a render that has ended.
struct RenderReport {
    const core::Scene& scene;
    const core::Plan& plan;
    const core::RenderResult& result;
    std::string scene_hash;     ///< of everything that determines the bits of the picture
    std::string scene_content;  ///< of the scene alone (session/reference_metadata.h)
    std::uint64_t seed;
    int threads;
    std::vector<std::string> command_line;
    std::vector<std::string> approximations = {};  ///< left out or replaced by leniency
};

/// The command line as a shell would take it.
std::string quoted(const std::vector<std::string>& command_line);
/// Largest resident size of this process so far.
std::size_t peak_memory_bytes();
std::string git_hash();
/// Fraction of the pixels that are finished (RenderResult::finished_pixels); 1 where all are.
double finished_fraction(std::span<const std::uint8_t> finished);

/// Channels that are added to the layers of a film.
struct PictureExtras {
    bool auxiliary = false;     ///< channels at pixel centres, and numbers of objects and materials
    bool in_scattered = false;  ///< feature of light of media (session/in_scattered_feature.h)
};
/// The picture as it is written: layers, variances, metadata, extras. An interrupted one has no in-scattered
/// light; one of a part of the first pass says in A which pixels are finished.
core::ImageChannels make_picture(const RenderReport& report, const core::Registry& registry,
                                 const PictureExtras& extras);

/// Entries "error" and "errorInterval", where an error is known.
void add_error(std::map<std::string, std::string>& metadata, const std::optional<core::PictureError>& error);
/// The ends that "errorInterval" states; nothing without it.
std::optional<core::PictureError> stated_error(const std::map<std::string, std::string>& metadata);

std::map<std::string, std::string> picture_metadata(const RenderReport& report);
std::string statistics_json(const RenderReport& report);

}  // namespace mote::session
