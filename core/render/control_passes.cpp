#include "core/render/control_passes.h"

#include <algorithm>

#include "core/film/film_memory.h"
#include "core/math/random.h"
#include "core/metrics/control_error.h"
#include "core/render/counted_work.h"
#include "core/render/pass_runner.h"
#include "core/scene/scene.h"

namespace mote::core {

namespace {

constexpr int block_width = control_block_width, block_height = control_block_height;
constexpr std::uint64_t control_stream = 0x636f6e74726f6cull;
/// Counted work of control passes over that of the image's. For the same counted work a path took 2.3 times
/// as long as light that is gathered on surfaces, and 9 times in smoke; 15 % of the time is the most that an
/// error may take.
double work_fraction(const Scene& scene) { return scene.has_media() ? 1.0 / 64.0 : 1.0 / 20.0; }
constexpr std::uint32_t min_passes = 2;  ///< one of each half

double work_of(const Film& film) {
    double work = 0.0;
    for (std::size_t part = 0; part < film.parts(); ++part) work += film.work(part);
    return work;
}

}  // namespace

ControlPasses::ControlPasses(const Scene& scene, const Integrator& unbiased, std::uint64_t seed,
                             CancelToken cancelled, const MemoryBudget& memory)
    : filter_(film_filter(scene)), work_fraction_(work_fraction(scene)) {
    const std::uint64_t own_seed = hash_keys(seed, control_stream);
    RenderOptions options = render_options(scene, own_seed, cancelled);
    if (options.sampler == SamplerKind::sobol) options.sampler = SamplerKind::sobol_halves;
    sample_pixels(options.width, options.height, own_seed);
    options.width = columns_, options.height = rows_, options.memory = memory;
    const std::vector<Layer> layers = unbiased.layers(scene);
    FilmMemory(columns_, rows_, layers, false, {}, true).require(memory);
    estimator_ = unbiased.prepare(scene, options);
    film_.emplace(columns_, rows_, layers, false, true);
    image_.emplace(columns_, rows_, layers.size());
}

void ControlPasses::sample_pixels(int width, int height, std::uint64_t seed) {
    columns_ = (width + block_width - 1) / block_width, rows_ = (height + block_height - 1) / block_height;
    for (int row = 0; row < rows_; ++row)
        for (int column = 0; column < columns_; ++column) {
            const int x0 = column * block_width, y0 = row * block_height;
            const int across = std::min(block_width, width - x0), down = std::min(block_height, height - y0);
            Rng rng(hash_keys(seed, blocks_.size()));
            const int x = x0 + std::min(int(rng.next_float() * float(across)), across - 1);
            const int y = y0 + std::min(int(rng.next_float() * float(down)), down - 1);
            blocks_.push_back({std::size_t(y) * std::size_t(width) + std::size_t(x), double(across * down)});
            corners_.emplace_back(float(x), float(y));
        }
}

double ControlPasses::work_done() const {
    Statistics statistics;
    estimator_->add_statistics(statistics);
    return counted_work(statistics);
}

void ControlPasses::follow(const Film& film, const std::atomic<bool>& cancelled) {
    const double wanted = work_fraction_ * work_of(film);
    while (film_->pass_count() < Film::max_passes) {
        const double n = film_->pass_count(), done = work_done();
        if (n >= min_passes && !(done > 0.0 && done * (1.0 + 1.0 / n) <= wanted)) return;
        image_->clear();
        const PassContext context{film_->next_pass(0), *filter_, cancelled, 0,
                                  PixelPositions(corners_, columns_)};
        try {
            if (!estimator_->pass(context, *image_)) return;
        } catch (const Cancelled&) {
            return;
        }
        film_->add_pass(*image_);
    }
}

std::optional<PictureError> ControlPasses::error(const Film& film) const {
    if (film_->pass_count() < min_passes || blocks_.size() < min_control_samples) return std::nullopt;
    const std::vector<Rgb> a = film_->half_beauty(0).passes, b = film_->half_beauty(1).passes;
    ControlSamples samples{columns_, rows_, {}};
    for (std::size_t k = 0; k < blocks_.size(); ++k)
        samples.blocks.push_back({blocks_[k].pixel, blocks_[k].pixels, a[k], b[k]});
    const std::vector<Rgb> image = film.beauty();
    return control_error(image, control_weights(image, film.shown_weights(), samples, film.width()), samples);
}

void ControlPasses::add_statistics(Statistics& statistics) const {
    Statistics own;
    estimator_->add_statistics(own);
    for (const auto& [name, count] : own.rays) statistics.rays[name] += count;
    for (const auto& [name, count] : own.lookups) statistics.lookups[name] += count;
    statistics.values["control_passes"] = film_->pass_count();
    statistics.non_finite_samples += film_->non_finite();
}

}  // namespace mote::core
