// From a scene's film to an estimator, and from an estimator to passes.
#include "core/render/pass_runner.h"

#include <chrono>
#include <stdexcept>

#include "core/objects/error.h"
#include "core/render/render_driver.h"
#include "core/scene/scene.h"

namespace mote::core {

namespace {

SamplerKind sampler_kind(const std::string& name) {
    if (name == "sobol") return SamplerKind::sobol;
    if (name == "independent") return SamplerKind::independent;
    const std::vector<std::string> known{"independent", "sobol"};
    throw InputError("unknown sampler '" + printable(name) + "'" + suggestion(name, known));
}

std::unique_ptr<PixelFilter> filter_of(const FilmSettings& film) {
    return make_pixel_filter(film.filter, film.filter_radius, film.filter_stddev);
}

std::unique_ptr<Estimator> timed_prepare(const Scene& scene, const Integrator& integrator, std::uint64_t seed,
                                         double& seconds) {
    const FilmSettings& film = scene.film();
    const auto start = std::chrono::steady_clock::now();
    auto estimator = integrator.prepare(scene, {seed, film.width, film.height, sampler_kind(film.sampler)});
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return estimator;
}

}  // namespace

PassRunner::PassRunner(const Scene& scene, const Integrator& integrator, std::uint64_t seed, Film& film)
    : film_(film),
      filter_(filter_of(scene.film())),
      estimator_(timed_prepare(scene, integrator, seed, build_seconds_)),
      image_(film.width(), film.height(), film.layers().size()) {}

bool PassRunner::run_pass(const std::atomic<bool>& cancelled) {
    image_.clear();
    if (!estimator_->pass({film_.pass_count(), *filter_, cancelled}, image_)) {
        if (!cancelled.load(std::memory_order_relaxed))
            throw std::logic_error("a pass ended early without being cancelled");
        return false;
    }
    film_.add_pass(image_);
    return true;
}

}  // namespace mote::core
