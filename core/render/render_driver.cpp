// The loop over passes.
#include "core/render/render_driver.h"

#include <chrono>
#include <stdexcept>

#include "core/objects/error.h"
#include "core/render/checkpoint.h"
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
    }

    void run() {
        refresh_noise();
        while (!must_stop(stop_, state_)) {
            if (interrupted() || !runner_.run_pass(cancelled_flag())) break;
            after_pass();
        }
        state_.seconds = seconds_since(start_);
        // A render that was complete before the key was pressed is not an interrupted one.
        result_.interrupted = interrupted() && !must_stop(stop_, state_);
        if (result_.interrupted || request_.checkpoint_at_end) write_checkpoint_now();
        result_.statistics.seconds["render"] = state_.seconds;
        result_.statistics.values["noise"] = result_.film.relative_noise();
    }

  private:
    const std::atomic<bool>& cancelled_flag() const {
        return request_.interrupted ? *request_.interrupted : never_;
    }
    bool interrupted() const { return cancelled_flag().load(std::memory_order_relaxed); }

    void after_pass() {
        ++state_.passes_of_this_run;
        state_.passes = result_.film.pass_count();
        state_.seconds = seconds_since(start_);
        // The rule must not depend on the clock, so it looks at every pass; for the eye twice a second will
        // do.
        if (stop_.noise || seconds_since(noise_time_) > 0.5 || state_.passes <= 2) refresh_noise();
        if (request_.progress)
            request_.progress({state_.passes, state_.passes_of_this_run, stop_.passes, state_.seconds,
                               seconds_left(stop_, state_), state_.noise});
        if (seconds_since(checkpoint_time_) >= request_.checkpoint_every_seconds) write_checkpoint_now();
    }
    void refresh_noise() {
        state_.noise = request_.noise ? request_.noise(result_.film) : result_.film.relative_noise();
        noise_time_ = Clock::now();
    }
    void write_checkpoint_now() {
        if (request_.checkpoint_path.empty() || result_.film.pass_count() == 0) return;
        const Clock::time_point begin = Clock::now();
        write_checkpoint(request_.checkpoint_path, {request_.content_hash, request_.seed}, result_.film);
        checkpoint_time_ = Clock::now();
        result_.statistics.seconds["checkpoints"] += seconds_since(begin);
    }

    const RenderRequest& request_;
    const StopRule& stop_;
    PassRunner& runner_;
    RenderResult& result_;
    const std::atomic<bool> never_{false};
    RenderState state_;
    const Clock::time_point start_ = Clock::now();
    Clock::time_point noise_time_ = start_, checkpoint_time_ = start_;
};

void resume(const RenderRequest& request, RenderResult& result) {
    if (request.checkpoint_path.empty()) throw std::logic_error("resuming needs the path of a checkpoint");
    if (read_checkpoint(request.checkpoint_path, {request.content_hash, request.seed}, result.film))
        result.resumed_at = result.film.pass_count();
    else
        result.statistics.warnings.push_back("no checkpoint '" + printable(request.checkpoint_path) +
                                             "': rendering from the start");
}

}  // namespace

RenderResult render(const Scene& scene, const Integrator& integrator, const RenderRequest& request) {
    const FilmSettings& settings = scene.film();
    StopRule stop = request.stop;
    if (!stop.passes && !stop.seconds && !stop.noise) stop.passes = std::uint32_t(settings.sample_count);
    RenderResult result{Film(settings.width, settings.height,
                             film_layers(scene, integrator, request.features), request.all_squares),
                        {},
                        false,
                        0};
    if (request.resume) resume(request, result);  // before the work of prepare(): it may be refused

    PassRunner runner(scene, integrator, request.seed, result.film, request.features);
    result.statistics.seconds["build"] = runner.build_seconds();

    PassLoop(request, stop, runner, result).run();

    if (!result.interrupted && result.film.pass_count() > 0) {
        const Clock::time_point finish_start = Clock::now();
        runner.estimator().finish(result.film);
        result.statistics.seconds["finish"] = seconds_since(finish_start);
    }
    runner.add_statistics(result.statistics);
    result.statistics.non_finite_samples += result.film.non_finite();
    return result;
}

}  // namespace mote::core
