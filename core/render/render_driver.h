// The render driver: passes, stopping, progress, Ctrl-C, checkpoints and resume, written once for all
// integrators.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/image/film.h"
#include "core/render/integrator.h"

namespace mote::core {

struct StopRule {
    std::optional<std::uint32_t> passes;  ///< this many in all
    std::optional<double> seconds;        ///< wall time of this run's passes
    std::optional<double> noise;          ///< Film::relative_noise()
};

struct RenderProgress {
    std::uint32_t passes;
    std::optional<std::uint32_t> passes_wanted;
    double seconds, seconds_left;  ///< seconds_left < 0: unknown
    double noise;
};

struct RenderRequest {
    std::uint64_t seed = 0;
    StopRule stop;
    std::string checkpoint_path;  ///< "" for none
    double checkpoint_every_seconds = 60.0;
    bool resume = false;
    std::string content_hash;  ///< of the scene, its files and the options that change the picture
    bool all_squares = false;
    std::function<void(const RenderProgress&)> progress;  ///< called after every pass; may be empty
    const std::atomic<bool>* interrupted = nullptr;       ///< set by Ctrl-C
};

struct RenderResult {
    Film film;
    Statistics statistics;
    bool interrupted = false;
    std::uint32_t resumed_at = 0;  ///< pass index the checkpoint held
};

/// Renders until a stop rule holds. Throws InputError when a checkpoint does not belong to this render.
RenderResult render(const Scene& scene, const Integrator& integrator, const RenderRequest& request);

/// The filter of a film as a distribution of offsets. Throws InputError for an unknown name.
std::unique_ptr<PixelFilter> make_pixel_filter(const std::string& name, float radius, float stddev);

/// FNV-1a 64 over the contents of files and strings: changes when any input of a render changes.
std::string content_hash(const Scene& scene, const std::vector<std::string>& settings);

}  // namespace mote::core
