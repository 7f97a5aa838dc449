#include "integrators/layers/layers_estimator.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/film/film.h"
#include "core/math/random.h"
#include "core/objects/error.h"
#include "core/scene/scene.h"
#include "integrators/layers/pass_schedule.h"

namespace mote::integrators {

using namespace core;

namespace {

constexpr std::uint64_t control_key = 0x636f6e74726f6cull;

std::uint64_t seed_of_part(std::uint64_t seed, std::size_t part) {
    return part == 0 ? seed : hash_keys(seed, 0x6c61796572ull, part);
}

/// The share of the variance that the filter leaves of a layer whose pixels err independently, about: what it
/// was measured to leave lies between 0.006 and 0.2 (docs/methods/layers.md), and the best schedule goes with
/// its root.
constexpr double left_by_filter = 1.0 / 50.0;

std::string shares_wanted(std::size_t parts) {
    return fmt::format(
        "mote_layers gives its {0} methods passes by the noise that it has seen, so it is not known "
        "beforehand which method has which pass: integrator.shares with {0} numbers, passes of each in a "
        "round, makes "
        "it known ('parts' of --stats of a short render say how many each wants)",
        parts);
}

/// Control passes of a part: its method at the control pixels, by other random numbers.
class ControlOfPart {
  public:
    /// `options`: of the part.
    ControlOfPart(const Scene& scene, RenderOptions options, const LayerMethod& method)
        : scene_(scene), options_(std::move(options)), method_(method), image_(1, 1, 1) {
        options_.seed = hash_keys(options_.seed, control_key);
    }
    /// As Estimator::control_pass().
    bool pass(const PixelColumns& pixels, const PassContext& context, PassImage& light) {
        if (!estimator_) prepare(pixels);
        image_.clear();
        if (!estimator_->pass({context.index, context.filter, context.cancelled}, image_)) return false;
        for (const std::size_t layer : method_.kept)
            for (std::size_t i = 0; i < light.layer(0).size(); ++i)
                light.layer(0)[i] += image_.layer(layer)[i];
        return true;
    }
    void add_statistics(Statistics& statistics) const {
        if (estimator_) estimator_->add_statistics(statistics);
    }

  private:
    void prepare(const PixelColumns& pixels) {
        options_.columns = pixels;
        options_.width = pixels.columns(), options_.height = pixels.rows();
        image_ = PassImage(options_.width, options_.height, method_.layers.size());
        estimator_ = method_.integrator->prepare(scene_, options_);
    }
    const Scene& scene_;
    RenderOptions options_;
    LayerMethod method_;
    PassImage image_;  ///< with all its layers
    std::unique_ptr<Estimator> estimator_;
};

class LayersEstimator final : public Estimator {
  public:
    LayersEstimator(const Scene& scene, const RenderOptions& options, const LayerChoice& choice,
                    LayerFilter filter, const std::vector<std::uint32_t>& shares)
        : filter_(std::move(filter)) {
        for (std::size_t part = 0; part < shares.size(); ++part)
            round_.insert(round_.end(), shares[part], part);

        for (std::size_t i = 0; i < choice.methods.size(); ++i) {
            const LayerMethod& method = choice.methods[i];
            RenderOptions own = options;
            own.seed = seed_of_part(options.seed, i), own.cells = method.cells;
            parts_.push_back(
                {method.integrator->prepare(scene, own),
                 method.kept,
                 PassImage(options.width, options.height, method.layers.size()),
                 std::ranges::any_of(choice.layers,
                                     [&](const Layer& layer) { return layer.part == i && layer.fine; }),
                 {}});
            if (method.integrator->renders_columns()) parts_.back().control.emplace(scene, own, method);
            const auto layers =
                std::count_if(filter_.layers().begin(), filter_.layers().end(),
                              [&](const auto& f) { return choice.layers[f.layer].part == i; });
            left_.push_back(
                std::size_t(layers) == method.kept.size() && filter_.has_variance() ? left_by_filter : 1.0);
        }
    }

    std::size_t next_part(const Film& film) const override {
        if (round_.empty()) return integrators::next_part(film, left_);
        return part_of_pass(film.first_pass() + film.pass_count());
    }

    std::size_t part_of_pass(std::uint32_t number) const override {
        if (parts_.size() == 1) return 0;
        if (round_.empty()) throw InputError(shares_wanted(parts_.size()));
        return round_[number % round_.size()];
    }

    bool pass(const PassContext& context, PassImage& image) override {
        Part& part = parts_.at(context.part);
        part.image.clear();
        if (part.fine && !part.image.has_places()) part.image.keep_places();
        if (!part.estimator->pass({context.index, context.filter, context.cancelled}, part.image))
            return false;
        for (std::size_t i = 0; i < part.kept.size(); ++i) image.swap_layer(i, part.image, part.kept[i]);
        if (part.fine) image.swap_places(part.image);
        return true;
    }

    bool has_control_passes(std::size_t part) const override { return parts_.at(part).control.has_value(); }
    bool control_pass(const PixelColumns& pixels, const PassContext& context, PassImage& light) override {
        return parts_.at(context.part).control.value().pass(pixels, context, light);
    }

    void finish(Film& film, CancelToken cancelled) override { filter_.apply(film, cancelled); }
    bool finish_preview(Film& film, CancelToken cancelled) override {
        return filter_.apply_for_preview(film, cancelled);
    }
    std::optional<double> seconds_to_finish(const Film& film) const override {
        return filter_.seconds_to_apply(film);
    }
    double seconds_once() const override { return filter_.feature_seconds(); }
    void shorten_finish(const Film& film) override { filter_.keep_features(film); }

    bool changes_noise(const Film& film) const override {
        return filter_.has_variance() || filter_.has_halves(film);
    }

    void add_statistics(Statistics& statistics) const override {
        for (const Part& part : parts_) {
            part.estimator->add_statistics(statistics);
            if (part.control) part.control->add_statistics(statistics);
        }
        filter_.add_statistics(statistics);
    }

  private:
    struct Part {
        std::unique_ptr<Estimator> estimator;
        std::vector<std::size_t> kept;  ///< of its layers
        PassImage image;                ///< with all its layers
        bool fine;                      ///< films may keep some of them at twice the resolution
        std::optional<ControlOfPart> control;
    };
    std::vector<Part> parts_;
    std::vector<double> left_;        ///< of the variance of each part, after filtering
    std::vector<std::size_t> round_;  ///< the part of each pass of a round; empty: next_part() of the film
    LayerFilter filter_;
};

}  // namespace

std::unique_ptr<Estimator> make_layers_estimator(const Scene& scene, const RenderOptions& options,
                                                 const LayerChoice& choice, LayerFilter filter,
                                                 const std::vector<std::uint32_t>& shares) {
    return std::make_unique<LayersEstimator>(scene, options, choice, std::move(filter), shares);
}

}  // namespace mote::integrators
