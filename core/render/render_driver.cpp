// The loop over passes.
#include "core/render/render_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/film/film_memory.h"
#include "core/objects/error.h"
#include "core/objects/memory_error.h"
#include "core/render/checkpoint.h"
#include "core/render/deadline.h"
#include "core/render/pass_runner.h"
#include "core/render/stop_clock.h"
#include "core/scene/scene.h"

namespace mote::core {

namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// One render: what the loop keeps from pass to pass.
class PassLoop {
  public:
    PassLoop(const RenderRequest& request, const StopRule& stop, PassRunner& runner, RenderResult& result)
        : request_(request), stop_(stop), runner_(runner), result_(result) {
        state_.passes = result.film.pass_count();
        state_.seconds_beside = request.seconds_before + runner.build_seconds() + request.seconds_after;
    }

    void run() {
        with_memory_for("the passes", [&] { run_passes(); });
        finish_run();
    }
    /// Estimator::finish() of the picture.
    void finish_picture(const std::string& type) {
        if (result_.film.pass_count() == 0 || !result_.finished_pixels.empty() || request_.range) return;
        if (!request_.finish) return;
        if (request_.abandoned && request_.abandoned->load()) return;
        const Clock::time_point begin = Clock::now();
        try {
            if (!result_.interrupted && preview_is_whole_ && preview_passes_ == state_.passes)
                result_.film.exchange_replaced(std::move(preview_means_));  // a preview was the last step
            else if (!result_.interrupted)
                with_memory_for("what '" + type + "' does after its passes",
                                [&] { runner_.estimator().finish(result_.film, cancelled_flag()); });
        } catch (const Cancelled&) {
            result_.interrupted = true;
            write_checkpoint_now();
        }
        if (result_.interrupted) finish_in_a_hurry();
        result_.statistics.seconds["finish"] = seconds_since(begin);
    }
    void state_noise() {
        const Film::GainAndNoise found = result_.film.gain_and_noise();
        result_.statistics.values["noise"] = known(found.noise);
        if (found.noise == 0.0 && found_no_light())
            result_.statistics.warnings.emplace_back(
                "no pass found any light but that of lights in view: how noisy the picture is, is not known");
        result_.statistics.values["varianceGain"] = found.gain;
        if (!request_.range) result_.error = stated(result_.film);
    }

  private:
    /// The noise, or infinity where the passes do not show it.
    double known(double noise) const {
        const bool shown =
            request_.noise_is_known && !has_few_samples() && (noise > 0.0 || !found_no_light());
        return shown ? noise : infinity;
    }
    /// The error, or nothing where the passes do not show it.
    std::optional<PictureError> stated(const Film& film) const {
        if (request_.split == PassSplit::whole || !std::isfinite(known(1.0)) || found_no_light())
            return std::nullopt;
        return film.error(runner_.controls().pixels(film));
    }
    /// The variance of 64 normal samples has a relative standard error of sqrt(2 / 63), a sixth; that of
    /// fewer, or of light that few paths meet, may say nothing.
    bool has_few_samples() const {
        constexpr double min_samples = 64.0;
        const Film& film = result_.film;
        std::uint32_t passes = film.pass_count();
        for (const Layer& layer : film.layers())
            if (!layer.auxiliary) passes = std::min(passes, film.pass_count(layer.part));
        return double(passes) * double(film.width()) * double(film.height()) < min_samples;
    }
    /// Passes that have found no light yet, but that of lights in view, agree with each other and say
    /// nothing.
    bool found_no_light() const {
        const Film& film = result_.film;
        for (std::size_t i = 0; i < film.layers().size(); ++i) {
            const Layer& layer = film.layers()[i];
            if (layer.auxiliary || layer.transport == TransportSet(Transport::emission)) continue;
            const std::vector<Rgb> mean = film.mean(i);
            if (std::ranges::any_of(mean, [](const Rgb& c) { return c != Rgb(0.0f); })) return false;
        }
        return true;
    }
    /// After an interruption: reuses the last preview's result of every step that would take too long.
    void finish_in_a_hurry() {
        try {
            const Deadline deadline(max_finish_seconds);
            return runner_.estimator().finish(result_.film, deadline.is_over());
        } catch (const Cancelled&) {
        } catch (const std::bad_alloc&) {
        } catch (const std::system_error&) {  // no thread for the deadline
        }
        const bool any = std::any_of(preview_means_.begin(), preview_means_.end(),
                                     [](const auto& means) { return !means.mean.empty(); });
        result_.finished_for = any ? preview_passes_ : 0;
        result_.film.exchange_replaced(std::move(preview_means_));
    }
    void write_checkpoint_now() {
        if (request_.checkpoint_path.empty() || result_.film.pass_count() == 0) return;
        if (!result_.finished_pixels.empty()) return;  // to continue is to begin anew
        const Clock::time_point begin = Clock::now();
        checkpoint_time_ = begin;
        try {
            write_checkpoint(request_.checkpoint_path, {request_.content_hash, request_.seed}, result_.film,
                             request_.memory, runner_.controls());
            result_.checkpoint_problem.clear();
        } catch (const InputError& error) {  // a full disk may have room again in a minute
            result_.checkpoint_problem = std::string("no checkpoint: ") + error.what();
        } catch (const std::bad_alloc&) {
            result_.checkpoint_problem =
                "no checkpoint '" + printable(request_.checkpoint_path) + "': no memory for it";
        }
        if (!result_.checkpoint_problem.empty() && request_.checkpoint_failed)
            request_.checkpoint_failed(result_.checkpoint_problem);
        checkpoint_time_ = Clock::now();
        result_.statistics.seconds["checkpoints"] += seconds_since(begin);
    }

    void run_passes() {
        if (!rule_looks() || noise_rule_looks()) refresh_noise();
        while (!is_done()) {
            if (interrupted()) break;
            if (!runner_.run_pass(cancelled_flag())) {
                if (request_.keep_part_of_first_pass) result_.finished_pixels = runner_.add_part();
                break;
            }
            after_pass();
        }
    }
    void finish_run() {
        state_.seconds = seconds_since(start_);
        // A render that was complete before the key was pressed is not an interrupted one.
        const bool in_time = !request_.time_is_over || !request_.time_is_over->load();
        result_.interrupted = interrupted() && in_time && !is_done();
        if (result_.interrupted || request_.checkpoint_at_end) write_checkpoint_now();
        result_.statistics.seconds["render"] = state_.seconds;
        if (!in_time && !request_.range) warn_of_missing_layers();
        if (!result_.checkpoint_problem.empty())
            result_.statistics.warnings.push_back(result_.checkpoint_problem);
    }

    /// The time can be over when only some of the parts have passes.
    void warn_of_missing_layers() {
        const std::vector<std::string> names = result_.film.layers_without_passes();
        if (names.empty() || result_.film.pass_count() == 0) return;
        result_.statistics.warnings.push_back(fmt::format(
            "the time was over before every layer had a pass: the picture lacks {}", fmt::join(names, ", ")));
    }

    const std::atomic<bool>& cancelled_flag() const {
        return request_.interrupted ? *request_.interrupted : never_;
    }
    bool interrupted() const { return cancelled_flag().load(std::memory_order_relaxed); }

    bool is_done() const {
        if (request_.range) return state_.passes >= request_.range->end - request_.range->first;
        if (!result_.film.has_passes(1)) return false;
        return must_stop(stop_, state_) || (request_.enough && state_.passes >= noise_rule_from &&
                                            noise_is_due(state_.passes) && request_.enough(result_.film));
    }
    void after_pass() {
        ++state_.passes_of_this_run;
        state_.passes = result_.film.pass_count();
        // Post-processes may do more after more passes than a preview has shown.
        if (finished_before_)
            state_.seconds_to_finish =
                runner_.estimator().seconds_to_finish(result_.film).value_or(state_.seconds_to_finish);
        state_.seconds = seconds_since(start_);
        // The rule must not depend on the clock; for the eye twice a second will do, and a twentieth of the
        // time.
        const bool for_the_eye = seconds_since(noise_time_) > std::max(0.5, 20.0 * noise_seconds_);
        if (rule_looks() ? noise_rule_looks() : for_the_eye || state_.passes == 2) refresh_noise();
        if (request_.progress)
            request_.progress({state_.passes, state_.passes_of_this_run, stop_.passes, state_.seconds,
                               seconds_left(stop_, state_), known(state_.noise), state_.error});
        if (seconds_since(checkpoint_time_) >= request_.checkpoint_every_seconds) write_checkpoint_now();
        show_preview();
        state_.seconds = seconds_since(start_);
        keep_to_the_time();
    }
    /// More passes are worth more than time that is left since what is done after them would not fit.
    void keep_to_the_time() {
        StopRule time;
        time.seconds = stop_.seconds;
        if (!finished_before_ || !must_stop(time, state_)) return;
        Estimator& estimator = runner_.estimator();
        estimator.shorten_finish(result_.film);
        state_.seconds_to_finish =
            estimator.seconds_to_finish(result_.film).value_or(state_.seconds_to_finish);
    }
    /// True for a rule of noise or error, which must not depend on the clock.
    bool rule_looks() const { return stop_.noise || stop_.error; }
    bool noise_rule_looks() const {
        return stop_.error || changes_noise() ? filtered_noise_is_due(state_.passes)
                                              : noise_is_due(state_.passes);
    }
    /// The film is afterwards as it was: which part is next must not depend on previews.
    void show_preview() {
        const bool watched = !request_.preview_is_seen || request_.preview_is_seen();
        // The noise in reports of progress is that of the picture that a preview would show.
        const bool for_the_noise = request_.progress && watched && !rule_looks() && changes_noise();
        const bool seen = request_.preview && watched;
        if ((!seen && !for_the_noise) || is_done()) return;
        // After this time the passes are shown though some part of the picture is still black: as they are,
        // since to finish them would put off the others.
        constexpr double patience = 2.5;
        const bool whole = result_.film.has_passes(1);
        const bool too_early = request_.previews_are_whole || seconds_since(start_) < patience;
        if (!whole && (!seen || too_early)) return;
        if (previews_ > 0 && !is_due_again(seen)) return;
        const Clock::time_point begin = Clock::now();
        const double once = runner_.estimator().seconds_once();
        if (seen && (!whole || (previews_ == 0 && request_.first_preview_is_raw)))
            request_.preview(result_.film, stated(result_.film));
        else
            finish_for_preview(seen);
        const double seconds = seconds_since(begin);
        ++previews_, preview_time_ = Clock::now();
        state_.seconds_of_previews += seconds;
        preview_seconds_ = seconds - (runner_.estimator().seconds_once() - once);
        result_.statistics.seconds["previews"] = state_.seconds_of_previews;
    }
    /// After as long as the render had taken, while previews take up to four times their share of the time;
    /// later by their share. None shortly before the end.
    bool is_due_again(bool seen) const {
        const double before = std::chrono::duration<double>(preview_time_ - start_).count(),
                     of_share = preview_seconds_ / request_.preview_share,
                     wait = std::max(seen ? request_.preview_every_seconds : 1.0,
                                     std::min(of_share, std::max(0.25 * of_share, before))),
                     left = seconds_left(stop_, state_);
        return seconds_since(preview_time_) >= wait && (left < 0.0 || left >= 0.25 * wait);
    }
    void finish_for_preview(bool seen) {
        try {
            finish_for_now(true, [&](const std::optional<PictureError>& error) {
                if (seen) request_.preview(result_.film, error);
            });
        } catch (const Cancelled&) {
        }
    }
    /// Shows the finished picture's error to `look`, while the film holds the picture; the film is afterwards
    /// as it was. Throws Cancelled.
    template <typename Look>
    void finish_for_now(bool preview, const Look& look) {
        const Clock::time_point begin = Clock::now();
        try {
            Estimator& estimator = runner_.estimator();
            if (preview)
                preview_is_whole_ = estimator.finish_preview(result_.film, cancelled_flag());
            else
                estimator.finish(result_.film, cancelled_flag()), preview_is_whole_ = true;
        } catch (const Cancelled&) {
            result_.film.exchange_replaced();
            throw;
        }
        // The first call also builds what all later ones use: about half of it.
        const double half_if_first = std::exchange(finished_before_, true) ? 1.0 : 0.5;
        state_.seconds_to_finish = runner_.estimator()
                                       .seconds_to_finish(result_.film)
                                       .value_or(half_if_first * seconds_since(begin));
        const std::optional<PictureError> error = stated(result_.film);
        if (error && !preview && stop_.error) runner_.choose_controls();
        look(error);
        const double finished = changes_noise() ? result_.film.noise() : 0.0;
        if (request_.split != PassSplit::whole) finished_error_ = error.value_or(PictureError());
        if (!stop_.error) state_.error = finished_error_;  // a rule must not depend on previews
        preview_means_ = result_.film.exchange_replaced(), preview_passes_ = state_.passes;
        if (!changes_noise()) return;
        finished_noise_ = finished, left_of_noise_ = finished / result_.film.noise();
    }
    void refresh_noise() {
        const Clock::time_point begin = Clock::now();
        if (stop_.error || (stop_.noise && changes_noise()))  // rules must not depend on earlier previews
            state_.noise = finished_noise_now(), state_.error = finished_error_;
        else if (!changes_noise())
            state_.noise = result_.film.noise();
        else if (std::isfinite(left_of_noise_))
            state_.noise = left_of_noise_ * result_.film.noise();
        noise_seconds_ = seconds_since(begin), noise_time_ = Clock::now();
    }
    double finished_noise_now() {
        if (!result_.film.has_passes(2) || state_.passes < noise_rule_from) return infinity;
        try {
            finish_for_now(false, [](const std::optional<PictureError>&) {});
        } catch (const Cancelled&) {
            return infinity;  // the render ends here
        }
        return changes_noise() ? finished_noise_ : result_.film.noise();
    }
    bool changes_noise() const { return runner_.estimator().changes_noise(result_.film); }

    const RenderRequest& request_;
    const StopRule& stop_;
    PassRunner& runner_;
    RenderResult& result_;
    const std::atomic<bool> never_{false};
    RenderState state_{.noise = infinity};
    int previews_ = 0;
    double preview_seconds_ = 0.0;  ///< that the last one took, without what the next finds already
    Film::Replacements preview_means_;
    std::uint32_t preview_passes_ = 0;
    /// Noise of the picture when it was finished last, and relative to the noise of its passes.
    double finished_noise_ = infinity, left_of_noise_ = infinity;
    PictureError finished_error_;    ///< of the picture when it was finished last
    bool finished_before_ = false;   ///< for a preview or the noise
    bool preview_is_whole_ = false;  ///< the last one is what Estimator::finish() makes
    Clock::time_point preview_time_ = Clock::now();
    double noise_seconds_ = 0.0;  ///< cost of the last evaluation of the noise
    const Clock::time_point start_ = Clock::now();
    Clock::time_point noise_time_ = start_, checkpoint_time_ = start_;
};

void resume(const RenderRequest& request, RenderResult& result, ControlPasses& controls) {
    if (request.checkpoint_path.empty()) throw std::logic_error("resuming needs the path of a checkpoint");
    if (read_checkpoint(request.checkpoint_path, {request.content_hash, request.seed}, result.film, controls))
        result.resumed_at = result.film.pass_count();
    else
        result.statistics.warnings.push_back("no checkpoint '" + printable(request.checkpoint_path) +
                                             "': rendering from the start");
}

/// Films of other layers or sizes are those of another render, whatever their files say.
void begin_with(const Film& before, Film& film) {
    try {
        film.add(before);
    } catch (const std::invalid_argument&) {
        throw InputError(
            "the passes that this render begins with are of another one: other pixels or other layers");
    }
}

/// Lets an empty film begin with the range; one that was resumed must do so already.
void begin_range(const PassRange& range, const Estimator& estimator, Film& film) {
    std::vector<std::uint32_t> first(film.parts(), 0);
    if (film.parts() == 1)
        first[0] = range.first;
    else
        for (std::uint32_t pass = 0; pass < range.first; ++pass) ++first.at(estimator.part_of_pass(pass));
    for (std::size_t part = 0; part < film.parts(); ++part) {
        if (film.pass_count() == 0)
            film.begin_at(part, first[part]);
        else if (film.first_pass(part) != first[part])
            throw InputError("cannot resume: this checkpoint holds passes from " +
                             std::to_string(film.first_pass()) + " on, not from " +
                             std::to_string(range.first));
    }
    estimator.part_of_pass(range.first);  // also of the first pass it must be known
}

StopRule stop_rule(const RenderRequest& request, const FilmSettings& settings) {
    StopRule stop = request.stop;
    if (stop.error && request.split == PassSplit::whole)
        throw InputError("the error of this image is not known, and a limit on it would not end the render");
    if (!stop.passes && !stop.seconds && !stop.noise && !stop.error && !request.enough)
        stop.passes = std::uint32_t(settings.sample_count);
    if (request.range) stop = {request.range->end - request.range->first, {}, {}, {}};
    return stop;
}

}  // namespace

RenderResult render(const Scene& scene, const Integrator& integrator, const RenderRequest& request) {
    const FilmSettings& settings = scene.film();
    if (!request.checkpoint_path.empty() && !request.resume)
        require_own_checkpoint(request.checkpoint_path, request.content_hash);
    const StopRule stop = stop_rule(request, settings);
    const std::vector<Layer> layers = film_layers(scene, integrator, request.features);
    const FilmMemory needed(settings.width, settings.height, layers, request.all_squares, stop.passes,
                            request.split);
    const bool has_controls = stop.error && request.split == PassSplit::halves;
    const double of_controls =
        has_controls ? ControlPasses::memory(settings.width, settings.height, layers) : 0.0;
    // A checkpoint is read beside it.
    needed.require(request.memory, of_controls + (request.resume ? needed.sums() : 0.0));
    RenderResult result = with_memory_for(needed.purpose() + memory_text(needed.peak()), [&] {
        return RenderResult{
            Film(settings.width, settings.height, layers, request.all_squares, request.split), {}, false, 0};
    });
    ControlPasses controls;
    if (has_controls) controls = ControlPasses(result.film);
    if (request.begin_with) begin_with(*request.begin_with, result.film);
    if (request.resume) resume(request, result, controls);  // before the work of prepare(): it may be refused
    if (!request.range && result.film.first_pass() > 0)
        throw InputError("cannot resume: this checkpoint holds passes from " +
                         std::to_string(result.film.first_pass()) + " on, those before are missing");

    const CancelToken token = request.interrupted ? CancelToken(*request.interrupted) : CancelToken();
    std::optional<PassRunner> runner;
    try {
        with_memory_for("what '" + integrator.type() + "' builds before its passes", [&] {
            runner.emplace(scene, integrator, request.seed, result.film, request.features, token,
                           request.memory.without(needed.peak() - needed.begin() + of_controls),
                           std::move(controls));
        });
    } catch (const Cancelled&) {
        result.interrupted = true;
        return result;
    }
    result.statistics.seconds["build"] = runner->build_seconds();
    if (request.range) begin_range(*request.range, runner->estimator(), result.film);
    if (request.building_is_over) request.building_is_over();

    PassLoop loop(request, stop, *runner, result);
    loop.run();
    if (request.passes_are_over) request.passes_are_over();

    loop.finish_picture(integrator.type());
    loop.state_noise();
    runner->add_statistics(result.statistics);
    result.statistics.non_finite_samples += result.film.non_finite() + runner->controls().non_finite();
    return result;
}

}  // namespace mote::core
