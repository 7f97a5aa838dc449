// The render driver: passes, stopping, progress, Ctrl-C, checkpoints and resume, written once for all
// integrators.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/film/film.h"
#include "core/render/first_hit_features.h"
#include "core/render/integrator.h"

namespace mote::core {

/// The first rule that holds ends the render. Without any rule, the film's sample_count is the number of
/// passes.
struct StopRule {
    std::optional<std::uint32_t> passes;  ///< this many in all, those of a checkpoint included
    /// Wall time from RenderRequest::seconds_before on, finishing included once a preview has shown how long
    /// that takes: ends as near to it as whole passes allow, after one at least.
    std::optional<double> seconds;
    std::optional<double> noise;  ///< Film::noise() of the finished picture, tested from 8 passes on
    /// Upper end for rules of Film::error() of the finished picture (PictureError::rule_high), tested from 8
    /// passes on. From the first test on there are control passes (core/film/control_passes.h), where the
    /// method has them and the film keeps halves.
    std::optional<double> error = {};
};

/// Passes first .. end - 1 of a picture, counted over all parts: one share of a render on several machines.
struct PassRange {
    std::uint32_t first = 0, end = 0;  ///< index of the first, and behind the last
};

/// Called after every pass.
struct RenderProgress {
    std::uint32_t passes, passes_of_this_run;    ///< the first holds those of a checkpoint too
    std::optional<std::uint32_t> passes_wanted;  ///< where a number was given
    double seconds, seconds_left;                ///< seconds_left < 0: unknown
    /// Film::noise() of the finished picture; infinity: not known yet. Refreshed twice a second at most; what
    /// Estimator::finish() takes from it is that of the last preview.
    double noise;
    PictureError error =
        {};  ///< of the finished picture, when it was made last: by StopRule::error or a preview
};

/// Seeds, stop rules and limits of a render, and the functions that receive reports.
struct RenderRequest {
    std::uint64_t seed = 0;  ///< of all random numbers
    StopRule stop;           ///< when it ends
    /// These passes alone, whatever `stop` says. Estimator::finish() needs the others too.
    std::optional<PassRange> range;
    const Film* begin_with = nullptr;        ///< passes that were rendered elsewhere, from the first on
    std::string checkpoint_path;             ///< "" for none
    double checkpoint_every_seconds = 60.0;  ///< wall time between checkpoints
    bool checkpoint_at_end = true;     ///< also after the last pass; an interrupted render always writes one
    bool resume = false;               ///< continue from checkpoint_path; from the start where there is none
    std::string content_hash;          ///< of the scene, its files and the options that change the picture
    bool all_squares = false;          ///< the film keeps variances of all layers
    std::vector<HitFeature> features;  ///< become layers of the film, behind those of the integrator
    MemoryBudget memory;               ///< of the film, and of what the integrator builds
    bool noise_is_known = true;        ///< false: none is stated (Plan::noise_unknown)
    PassSplit split = PassSplit::whole;       ///< the film keeps parts of the passes, and an error is stated
    std::function<bool(const Film&)> enough;  ///< a rule of the caller's, tested with the noise rule
    std::function<void(const RenderProgress&)> progress;  ///< called after every pass; may be empty
    /// Shown the picture so far, as Estimator::finish() leaves it, as soon as every part has a pass, after
    /// some seconds those that have one (unless `previews_are_whole`), and then now and then; and its error,
    /// or nothing where that is not known. May be empty.
    std::function<void(const Film&, const std::optional<PictureError>&)> preview;
    double preview_every_seconds = 1.0;  ///< shortest time between two of them
    double preview_share = 0.05;         ///< of the time that they take at most
    /// False: neither a preview nor its noise in `progress` would have a use now; empty: always true.
    std::function<bool()> preview_is_seen;
    bool first_preview_is_raw = false;  ///< at once, without Estimator::finish()
    bool previews_are_whole = false;    ///< none of a picture some of whose parts have no pass
    bool finish = true;                 ///< false: the picture is left as the passes made it
    std::function<void(const std::string&)> checkpoint_failed;  ///< called at once; retried later
    std::function<void()> building_is_over;           ///< called before the first pass; may be empty
    std::function<void()> passes_are_over;            ///< called before Estimator::finish; may be empty
    const std::atomic<bool>* interrupted = nullptr;   ///< set by Ctrl-C, and when the time is over
    const std::atomic<bool>* time_is_over = nullptr;  ///< set before `interrupted`: it was not Ctrl-C
    /// Set before `interrupted`: the picture is discarded, so it is not finished.
    const std::atomic<bool>* abandoned = nullptr;
    /// Wall time that the command took before: what stop.seconds is for begins there.
    double seconds_before = 0.0;
    /// Wall time that it will take afterwards, such as to write the picture, about [s].
    double seconds_after = 0.0;
    /// Where no pass becomes complete: the pixels of the first that did (RenderResult::finished_pixels).
    bool keep_part_of_first_pass = false;
};

/// The picture and what it took.
struct RenderResult {
    Film film;                     ///< sums over passes
    Statistics statistics;         ///< counts and times
    bool interrupted = false;      ///< before a stop rule held
    std::uint32_t resumed_at = 0;  ///< pass index the checkpoint held
    /// Interrupted, and there was no time for Estimator::finish(): what it changes is as the last preview had
    /// it, of so many passes; of 0, as the passes left it.
    std::optional<std::uint32_t> finished_for = {};
    /// Not empty: the film holds a part of one pass, the pixels with a 1, and zeros elsewhere.
    std::vector<std::uint8_t> finished_pixels = {};
    /// Film::error() of the finished picture; nothing where it is not known.
    std::optional<PictureError> error = {};
    std::string checkpoint_problem = "";  ///< why the last checkpoint could not be written
};

/// Estimator::finish() of an interrupted render may take so long [s]: half of what stopping may take.
inline constexpr double max_finish_seconds = 1.0;

/// Renders until a stop rule holds. When interrupted, the running pass is dropped and everything before it
/// kept. Throws InputError when StopRule::error is set without RenderRequest::split, when a range of passes
/// is requested and the integrator cannot determine which those are, when a checkpoint does not belong to
/// this render or is damaged, and when something else stands where it is to be written; OutOfMemory when the
/// film does not fit into the budget. One that cannot be written is a warning and another try later: the one
/// before it stays intact.
RenderResult render(const Scene& scene, const Integrator& integrator, const RenderRequest& request);

/// The filter of a film as a distribution of offsets. Throws InputError for an unknown name.
std::unique_ptr<PixelFilter> make_pixel_filter(const std::string& name, float radius, float stddev);

/// Checksum over the contents of every file that the scene was read from, and over `settings`: changes when
/// any input of a render changes, but not when its files move. 16 hexadecimal digits. Throws InputError for a
/// file that cannot be read.
std::string content_hash(const Scene& scene, const std::vector<std::string>& settings);
/// content_hash() of files by their names.
std::string content_hash(std::span<const std::string> files, const std::vector<std::string>& settings);

}  // namespace mote::core
