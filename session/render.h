// A render as a function call: threads, a limit in time, cancellation, checkpoints, and the finished picture.
//
// The passes run in a thread of their own, and the observer is called in the caller's: its functions need no
// locks, and a host whose calls belong to one thread (Python, a user interface) is called in it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/film/image_channels.h"
#include "core/render/motion_features.h"
#include "core/render/render_driver.h"
#include "session/loaded_scene.h"

namespace mote::session {

/// Receives what a render reports, twenty times a second at most. An exception from any function ends the
/// render, whose picture is not finished, and leaves render().
class RenderObserver {
  public:
    virtual ~RenderObserver() = default;
    virtual void progress(const core::RenderProgress&) {}  ///< after passes, the last one among them
    virtual bool cancelled() { return false; }             ///< true: stop, and keep what there is
    virtual bool wants_previews() const { return false; }  ///< true: preview() is called
    /// The picture so far, its beauty alone, from the first pass on, now and then.
    virtual void preview(const core::ImageChannels&) {}
    /// True: preview() receives every layer and variance, as a file has them, and "passes" (0: a part of the
    /// first ones is missing), "noise" and, where it is known, "error" with "errorInterval" as metadata.
    virtual bool wants_layers() const { return false; }
    virtual double preview_every_seconds() const { return 1.0; }  ///< shortest time between two previews
    virtual double preview_share() const { return 0.05; }         ///< of the time, that previews take at most
    /// True: the first preview comes at once, before any filter.
    virtual bool first_preview_is_raw() const { return false; }
    /// True: none of a picture some of whose layers have no pass yet.
    virtual bool previews_are_whole() const { return false; }
    /// Called in the thread of the passes: false spares the work of a preview, and of the noise of one in
    /// progress().
    virtual bool preview_is_seen() const { return true; }
    virtual void warning(const std::string&) {}  ///< at once: a checkpoint that could not be written
    /// Called in the thread of the passes, before the first one: from now on an end loses something.
    virtual void building_is_over() {}
};

/// Passes that were rendered elsewhere, from the first on, added up.
struct EarlierPasses {
    std::shared_ptr<const core::Film> film;  ///< their sums
    core::Statistics statistics;             ///< of all of them together
    std::string scene_hash;                  ///< of their render
};

/// The frame before in a sequence: where its camera and shapes were.
struct FrameBefore {
    std::shared_ptr<const core::PreviousFrame> frame;  ///< its camera and shapes
    std::vector<std::string> settings;                 ///< frame_before_settings() of its scene
};

/// When a render ends, and what it makes.
struct RenderSettings {
    std::uint64_t seed = 0;  ///< with scene and passes it determines every bit
    /// Seconds count from `seconds_before` before the call on, until `seconds_after` after it. No rule: the
    /// film's sample_count of passes.
    core::StopRule stop;
    double seconds_before = 0.0;  ///< [s], such as those of loading
    double seconds_after = 0.0;   ///< that the caller will take, such as to write the picture, about [s]
    /// A further rule, evaluated where the noise rule is, in the thread of the passes; may be empty.
    std::function<bool(const core::Film&)> enough;
    std::optional<core::PassRange>
        range;  ///< these passes alone, whatever `stop` says: leaves Rendered::film
    std::optional<EarlierPasses> begin_with;  ///< added before the first pass of this render
    int threads = 0;                          ///< 0: one for every core
    std::string checkpoint;                   ///< file; "": none. Removed when the render is complete
    double checkpoint_every = 60.0;           ///< [s]
    bool keep_checkpoint = false;             ///< also of a complete render, to continue with more passes
    bool resume = false;     ///< continue from the checkpoint, which must be of this very render
    bool auxiliary = false;  ///< also what is seen: positions, normals, depth, albedo, with variances
    std::optional<FrameBefore> frame_before;  ///< with `auxiliary`: for motion vectors
    bool finish = true;                       ///< false: without the integrator's filter, for a quick look
    std::string denoise;                      ///< "oidn" or "bmfr": adds the layer `denoised`
    std::string oidn_package;                 ///< folder of Python's package pyoidn, as OidnLibrary takes it
    std::vector<std::string> command_line;    ///< for the metadata
    core::MemoryBudget memory;                ///< of the film, the picture, and what the integrator builds
};

/// Result of a render: the picture, its statistics and warnings.
struct Rendered {
    /// As `mote render` writes it, to the bit. Interrupted in its first pass: A says which pixels are
    /// finished. Interrupted before the first pixel, or of a range: without channels.
    core::ImageChannels image;
    std::optional<core::Film> film;  ///< the passes of a range
    std::string statistics;          ///< JSON (docs/guide.md)
    core::Statistics counts;         ///< numbers in it
    std::vector<std::string> warnings;
    std::uint32_t passes = 0;
    double noise = core::infinity;            ///< Film::noise(); infinity: not known
    std::optional<core::PictureError> error;  ///< Film::error(); nothing where it is not known
    bool interrupted = false;
    std::vector<std::uint8_t> finished_pixels;  ///< of a part of the first pass; else empty
    std::vector<std::string> missing_layers;    ///< those without a pass
    std::optional<std::uint32_t> finished_for;  ///< core::RenderResult::finished_for
    std::string checkpoint_problem;             ///< why the last checkpoint could not be written
};

/// Renders until a stop rule holds or the observer cancels, which takes effect within two seconds. Throws
/// InputError where the scene has no integrator, StopRule::error is set and the error is not known, the
/// checkpoint or the earlier passes are of another render, something else stands where the checkpoint is to
/// be written, or `denoise` is unknown, and core::OutOfMemory. Several may run at once.
Rendered render(const LoadedScene& scene, const RenderSettings& settings, RenderObserver& observer);
Rendered render(const LoadedScene& scene, const RenderSettings& settings);

/// core::content_hash() of everything that determines the bits of a picture with these settings.
std::string render_hash(const LoadedScene& scene, const RenderSettings& settings);

}  // namespace mote::session
