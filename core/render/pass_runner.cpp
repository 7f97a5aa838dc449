// From a scene's film to an estimator, and from an estimator to passes.
#include "core/render/pass_runner.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "core/objects/cancellation.h"
#include "core/objects/error.h"
#include "core/render/counted_work.h"
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

std::unique_ptr<Estimator> timed_prepare(const Scene& scene, const Integrator& integrator,
                                         const RenderOptions& options, double& seconds) {
    const auto start = std::chrono::steady_clock::now();
    auto estimator = integrator.prepare(scene, options);
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return estimator;
}

}  // namespace

std::unique_ptr<PixelFilter> film_filter(const Scene& scene) {
    const FilmSettings& film = scene.film();
    return make_pixel_filter(film.filter, film.filter_radius, film.filter_stddev);
}

PassSplit pass_split(const Scene& scene, const Integrator& integrator) {
    if (!scene.film().interval) return PassSplit::whole;
    return integrator.plan(scene, find_requirements(scene)).split();
}

RenderOptions render_options(const Scene& scene, std::uint64_t seed, PassSplit split, CancelToken cancelled) {
    const FilmSettings& film = scene.film();
    SamplerKind sampler = sampler_kind(film.sampler);
    if (sampler == SamplerKind::sobol && split == PassSplit::halves) sampler = SamplerKind::sobol_halves;
    if (sampler == SamplerKind::sobol && split == PassSplit::groups) sampler = SamplerKind::sobol_groups;
    RenderOptions options{seed, film.width, film.height, sampler, cancelled};
    options.estimates_missing = split == PassSplit::groups;
    return options;
}

std::vector<Layer> film_layers(const Scene& scene, const Integrator& integrator,
                               std::span<const HitFeature> features) {
    std::vector<Layer> layers = integrator.layers(scene);
    for (const HitFeature& feature : features) layers.push_back(feature.layer);
    return layers;
}

PassRunner::PassRunner(const Scene& scene, const Integrator& integrator, std::uint64_t seed, Film& film,
                       std::vector<HitFeature> features, CancelToken cancelled, const MemoryBudget& memory,
                       ControlPasses controls)
    : film_(film), controls_(std::move(controls)), seed_(seed), filter_(film_filter(scene)) {
    RenderOptions options = render_options(scene, seed, film.kept().split, cancelled);
    options.memory = memory;
    estimator_ = timed_prepare(scene, integrator, options, build_seconds_);
    for (std::size_t part = 0; part < film.parts(); ++part)
        images_.emplace_back(film.width(), film.height(), film.layers_of(part).size());
    if (features.size() > images_.front().layers())
        throw std::invalid_argument("the film has no layers for the features");
    const std::size_t first_layer = images_.front().layers() - features.size();
    if (!features.empty())
        features_.emplace(scene, render_options(scene, seed, film.kept().split), std::move(features),
                          first_layer);
}

bool PassRunner::run_pass(const std::atomic<bool>& cancelled) {
    part_ = estimator_->next_part(film_);
    PassImage& image = images_.at(part_);
    image.clear();
    const PassContext context{film_.next_pass(part_), *filter_, cancelled, part_};
    const double work = counted_work();
    const auto has_ended = [&](bool filled) {
        if (!filled && !cancelled.load(std::memory_order_relaxed))
            throw std::logic_error("a pass ended early without being cancelled");
        return filled;
    };
    const bool has_control = !controls_.empty() && estimator_->has_control_passes(part_);
    if (!has_ended(fill(context, image))) return false;
    const double done = counted_work() - work;  // of the picture: what depends on it is as without control
    if (has_control && !has_ended(fill_control(context))) return false;
    if (has_control) controls_.add_pass(control_, part_);
    film_.add_pass(image, part_, done);
    return true;
}

bool PassRunner::fill(const PassContext& context, PassImage& image) {
    try {
        if (!estimator_->pass(context, image)) return false;
        return !features_ || part_ > 0 || features_->fill(context, image);
    } catch (const Cancelled&) {
        return false;
    }
}

void PassRunner::choose_controls() {
    if (!controls_.can_choose()) return;
    for (std::size_t part = 0; part < film_.parts(); ++part)
        if (estimator_->has_control_passes(part)) return controls_.choose(film_, seed_);
}

bool PassRunner::fill_control(PassContext context) {
    const PixelColumns& pixels = controls_.columns();
    if (control_.width() != pixels.columns()) control_ = PassImage(pixels.columns(), pixels.rows(), 1);
    context.index = controls_.next_pass(part_);
    control_.clear();
    try {
        return estimator_->control_pass(pixels, context, control_);
    } catch (const Cancelled&) {
        return false;
    }
}

double PassRunner::counted_work() const {
    Statistics statistics;
    estimator_->add_statistics(statistics);
    return core::counted_work(statistics);
}

std::vector<std::uint8_t> PassRunner::add_part() {
    PassImage& image = images_[part_];
    const std::vector<std::uint8_t> finished(image.finished().begin(), image.finished().end());
    const auto done = std::size_t(std::count(finished.begin(), finished.end(), std::uint8_t(1)));
    if (features_ || images_.size() > 1 || done == 0 || film_.pass_count() > 0) return {};
    for (std::size_t layer = 0; layer < image.layers();
         ++layer)  // what an unfinished pixel has is no estimate
        for (std::size_t pixel = 0; pixel < finished.size(); ++pixel)
            if (!finished[pixel]) image.layer(layer)[pixel] = Rgb(0.0f);
    film_.add_pass(image);
    return finished;
}

void PassRunner::add_statistics(Statistics& statistics) const {
    estimator_->add_statistics(statistics);
    if (features_) statistics.rays["closest"] += features_->rays();
}

}  // namespace mote::core
