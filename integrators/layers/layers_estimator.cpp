#include "integrators/layers/layers_estimator.h"

#include "core/image/film.h"
#include "core/math/random.h"
#include "core/scene/scene.h"
#include "integrators/layers/pass_schedule.h"

namespace mote::integrators {

using namespace core;

namespace {

std::uint64_t seed_of_part(std::uint64_t seed, std::size_t part) {
    return part == 0 ? seed : hash_keys(seed, 0x6c61796572ull, part);
}

class LayersEstimator final : public Estimator {
  public:
    LayersEstimator(const Scene& scene, const RenderOptions& options,
                    const std::vector<LayerMethod>& methods) {
        for (std::size_t i = 0; i < methods.size(); ++i) {
            RenderOptions own = options;
            own.seed = seed_of_part(options.seed, i), own.cells = methods[i].cells;
            const Integrator& integrator = *methods[i].integrator;
            parts_.push_back({integrator.prepare(scene, own), kept_layers(scene, methods[i]),
                              PassImage(options.width, options.height, integrator.layers(scene).size())});
            left_.push_back(1.0);
        }
    }

    std::size_t next_part(const Film& film) const override { return integrators::next_part(film, left_); }

    bool pass(const PassContext& context, PassImage& image) override {
        Part& part = parts_.at(context.part);
        part.image.clear();
        if (!part.estimator->pass({context.index, context.filter, context.cancelled}, part.image))
            return false;
        for (std::size_t i = 0; i < part.kept.size(); ++i) image.swap_layer(i, part.image, part.kept[i]);
        return true;
    }

    void add_statistics(Statistics& statistics) const override {
        for (const Part& part : parts_) part.estimator->add_statistics(statistics);
    }

  private:
    struct Part {
        std::unique_ptr<Estimator> estimator;
        std::vector<std::size_t> kept;  ///< of its layers
        PassImage image;                ///< with all its layers
    };
    std::vector<Part> parts_;
    std::vector<double> left_;  ///< of the variance of each part, after filtering
};

}  // namespace

std::unique_ptr<Estimator> make_layers_estimator(const Scene& scene, const RenderOptions& options,
                                                 const std::vector<LayerMethod>& methods) {
    return std::make_unique<LayersEstimator>(scene, options, methods);
}

}  // namespace mote::integrators
