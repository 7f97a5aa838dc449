#include "screenspace/layer_filter/filter_features.h"

#include <stdexcept>

#include "screenspace/layer_filter/same_surface.h"

namespace mote::screenspace {

using namespace core;

Vec3 unit_or_zero(const Vec3& v) {
    const float length = glm::length(v);
    return length > 0.0f ? v / length : Vec3(0.0f);
}

namespace {

/// True if all samples lie on one smooth surface.
bool one_surface(const FilterFeatures& f, std::size_t pixel, std::span<const FeatureSample> samples) {
    const float tolerance = surface_tolerance * f.frame[pixel].footprint;
    for (const FeatureSample& s : samples)
        if (!(std::abs(glm::dot(s.position - f.position[pixel], f.normal[pixel])) <= tolerance) ||
            glm::dot(s.shading_normal, f.shading_normal[pixel]) < 1.0f - normal_tolerance)
            return false;
    return true;
}

}  // namespace

FilterFeatures::FilterFeatures(int w, int h, int spp) : width(w), height(h), samples_per_pixel(spp) {
    if (w < 1 || h < 1 || spp < 1) throw std::invalid_argument("features of an empty picture");
    kind.resize(pixels(), PixelKind::none);
    position.resize(pixels()), normal.resize(pixels()), shading_normal.resize(pixels());
    distance.resize(pixels(), far), transmittance.resize(pixels(), 1.0f);
    frame.resize(pixels()), reflected.resize(pixels()), scattering.resize(pixels());
}

MeanSurface mean_surface(std::span<const FeatureSample> samples) {
    MeanSurface mean;
    float hits = 0.0f;
    for (const FeatureSample& s : samples)
        if (s.hit)
            hits += 1.0f, mean.position += s.position, mean.normal += s.normal, mean.distance += s.distance;
    if (hits == 0.0f) return mean;
    mean.position /= hits, mean.distance /= hits, mean.normal = unit_or_zero(mean.normal), mean.hit = true;
    return mean;
}

bool FilterFeatures::set_pixel(std::size_t pixel, std::span<const FeatureSample> all, const PixelFrame& at) {
    const MeanSurface mean = mean_surface(all);
    const float per_sample = 1.0f / float(all.size());
    Vec3 shading(0.0f);
    Rgb reflects(0.0f), scatters(0.0f);
    float passes = 0.0f;
    bool complete = true, filterable = false;
    for (const FeatureSample& s : all) {
        shading += s.shading_normal, reflects += s.reflected, scatters += s.scattering;
        passes += s.transmittance;
        complete = complete && s.hit && s.filterable;
        filterable = filterable || (s.hit && s.filterable);
    }
    position[pixel] = mean.position, normal[pixel] = mean.normal, shading_normal[pixel] = unit_or_zero(shading);
    distance[pixel] = mean.hit ? mean.distance : far, transmittance[pixel] = passes * per_sample;
    reflected[pixel] = reflects * per_sample, scattering[pixel] = scatters * per_sample, frame[pixel] = at;
    kind[pixel] = !filterable                                  ? PixelKind::none
                  : complete && one_surface(*this, pixel, all) ? PixelKind::single
                                                               : PixelKind::mixed;
    // Media are seen before whatever there is, so a partly empty pixel keeps its samples for them too.
    return kind[pixel] == PixelKind::mixed;
}

}  // namespace mote::screenspace
