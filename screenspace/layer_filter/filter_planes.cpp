#include "screenspace/layer_filter/filter_planes.h"

#include <cmath>
#include <stdexcept>

namespace mote::screenspace {

using namespace core;

namespace {

/// A channel of the modulation below this fraction of the largest is nothing: what is left of it would be
/// noise divided by nearly zero.
constexpr float min_fraction = 1e-4f;

const Rgb& raw_modulation(const FilterFeatures& f, LayerKind kind, std::size_t pixel) {
    return kind == LayerKind::surface ? f.reflected[pixel] : f.scattering[pixel];
}

float lit_channels(const Rgb& m) {
    const float least = min_fraction * max_component(m);
    return float((m.x > least) + 2 * (m.y > least) + 4 * (m.z > least));
}

bool takes_part(const FilterFeatures& f, const LayerToFilter& layer, std::size_t i) {
    const Rgb& m = raw_modulation(f, layer.kind, i);
    if (!is_finite(layer.mean[i]) || !is_finite(layer.variance[i]) || !is_finite(m)) return false;
    if (!(max_component(m) > 1e-20f)) return false;
    return layer.kind == LayerKind::volume || f.kind[i] == PixelKind::single;
}

void check_sizes(const FilterFeatures& f, const LayerToFilter& layer) {
    const std::size_t n = f.pixels();
    const bool fits = layer.mean.size() == n && layer.variance.size() == n && f.kind.size() == n &&
                      f.position.size() == n && f.normal.size() == n && f.shading_normal.size() == n &&
                      f.distance.size() == n && f.transmittance.size() == n && f.frame.size() == n &&
                      f.reflected.size() == n && f.scattering.size() == n &&
                      f.samples.size() == f.mixed.size() * std::size_t(f.samples_per_pixel);
    if (!fits) throw std::invalid_argument("a layer and the features of its filter differ in size");
}

}  // namespace

Rgb modulation(const FilterFeatures& f, LayerKind kind, std::size_t pixel) {
    const Rgb m = raw_modulation(f, kind, pixel);
    const float least = min_fraction * max_component(m);
    return {m.x > least ? m.x : 1.0f, m.y > least ? m.y : 1.0f, m.z > least ? m.z : 1.0f};
}

FilterPlanes::FilterPlanes(const FilterFeatures& f, const LayerToFilter& layer)
    : width(f.width), height(f.height), kind(layer.kind), frame(&f.frame) {
    check_sizes(f, layer);
    const std::size_t n = f.pixels();
    for (auto* plane : {&px, &py, &pz, &nx, &ny, &nz, &sx, &sy, &sz, &footprint, &distance, &transmittance,
                        &log_transmittance, &weight, &channels})
        plane->resize(n, 0.0f);
    for (std::size_t i = 0; i < n; ++i) {
        px[i] = f.position[i].x, py[i] = f.position[i].y, pz[i] = f.position[i].z;
        nx[i] = f.normal[i].x, ny[i] = f.normal[i].y, nz[i] = f.normal[i].z;
        sx[i] = f.shading_normal[i].x, sy[i] = f.shading_normal[i].y, sz[i] = f.shading_normal[i].z;
        footprint[i] = f.frame[i].footprint, distance[i] = f.distance[i];
        transmittance[i] = f.transmittance[i];
        log_transmittance[i] = std::log(std::fmax(f.transmittance[i], 1e-30f));
        channels[i] = lit_channels(raw_modulation(f, kind, i));
        if (takes_part(f, layer, i))
            weight[i] =
                kind == LayerKind::volume ? average(f.scattering[i]) : std::fmax(f.transmittance[i], 1e-20f);
    }
}

}  // namespace mote::screenspace
