#include "integrators/layer_filter/filtered_sum.h"

namespace mote::integrators {

using namespace core;

namespace {

/// The fraction of all light in each layer: for pixels where no path has met any.
std::vector<Vec3d> fractions(const std::vector<LayerOfPasses>& layers) {
    std::vector<Vec3d> light(layers.size(), Vec3d(0.0));
    Vec3d all(0.0);
    for (std::size_t l = 0; l < layers.size(); ++l) {
        for (const Rgb& mean : layers[l].mean) light[l] += Vec3d(mean);
        all += light[l];
    }
    for (Vec3d& of_layer : light)
        for (int c = 0; c < 3; ++c) of_layer[c] = all[c] > 0.0 ? of_layer[c] / all[c] : 0.0;
    return light;
}

}  // namespace

std::vector<std::vector<Rgb>> filtered_sum(screenspace::ViewFilter& filter, std::vector<LayerOfPasses> layers,
                                           screenspace::LayerKind kind, screenspace::FilterQuality quality,
                                           CancelToken cancelled) {
    std::vector<Rgb> sum(layers[0].mean.size(), Rgb(0.0f)), variance = sum;
    for (const LayerOfPasses& layer : layers)
        for (std::size_t p = 0; p < sum.size(); ++p)
            sum[p] += layer.mean[p], variance[p] += layer.variance[p];
    const std::vector<Rgb> shown = filter.filtered({sum, variance, kind, quality}, cancelled).mean;
    const std::vector<Vec3d> usual = fractions(layers);
    std::vector<std::vector<Rgb>> result;
    for (LayerOfPasses& layer : layers) {
        const Rgb of_picture(usual[result.size()]);
        for (std::size_t p = 0; p < sum.size(); ++p)
            for (int c = 0; c < 3; ++c) {
                const float here = sum[p][c] > 0.0f ? layer.mean[p][c] / sum[p][c] : of_picture[c];
                layer.mean[p][c] = shown[p][c] * here;
            }
        result.push_back(std::move(layer.mean));
    }
    return result;
}

}  // namespace mote::integrators
