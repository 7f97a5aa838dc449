// A render as a function call: threads, a limit in time, the wish to stop, checkpoints, and the finished
// picture.
//
// The passes run in a thread of their own, and what the caller wants to hear is told in the caller's:
// callbacks need no locks, and a host whose calls belong to one thread (Python, a user interface) is called
// in it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/film/image_channels.h"
#include "core/render/render_driver.h"
#include "session/loaded_scene.h"

namespace mote::session {

/// How long a render takes, what it writes, and whom it tells.
struct RenderSettings {
    std::uint64_t seed = 0;  ///< with scene and passes it determines every bit
    /// Seconds count from the call on: the scene is loaded already. No rule: the film's sample_count of
    /// passes.
    core::StopRule stop;
    int threads = 0;                 ///< 0: one for every core
    std::string checkpoint;          ///< file; "": none. Removed when the render is complete
    double checkpoint_every = 60.0;  ///< [s]
    bool resume = false;             ///< continue from the checkpoint, which must be of this very render
    bool auxiliary = false;          ///< also what is seen: positions, normals, depth, albedo, with variances
    std::string denoise;             ///< "oidn" or "bmfr": adds the layer `denoised`
    std::vector<std::string> command_line;  ///< for the metadata

    // Called in the thread of the caller, twenty times a second at most; each may be empty.
    std::function<void(const core::RenderProgress&)> progress;  ///< after passes, the last one among them
    std::function<bool()> cancelled;                            ///< true: stop, and keep what there is
    /// The picture so far, from the first pass on: the beauty alone. Now and then, so that it takes a
    /// twentieth of the time at most.
    std::function<void(const core::ImageChannels&)> preview;
};

/// What a render leaves: the picture, and what is said about it.
struct Rendered {
    /// As `mote render` writes it, to the bit. Interrupted in its first pass: A says which pixels are
    /// finished. Interrupted before the first pixel: without channels.
    core::ImageChannels image;
    std::string statistics;  ///< JSON (docs/guide.md)
    std::vector<std::string> warnings;
    std::uint32_t passes = 0;
    double noise = 0.0;  ///< Film::noise(); infinity: not known
    bool interrupted = false;
};

/// Renders until a stop rule holds or `cancelled` says so, which takes effect within two seconds. What a
/// callback throws ends the render, and leaves this function. Throws InputError where the scene has no
/// integrator, the checkpoint is of another render or `denoise` is unknown, and core::OutOfMemory. Several
/// may run at once.
Rendered render(const LoadedScene& scene, const RenderSettings& settings);

}  // namespace mote::session
