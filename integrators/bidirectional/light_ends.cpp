#include "integrators/bidirectional/light_ends.h"

#include "core/geometry/shape.h"

namespace mote::integrators {

using namespace core;

LightEnds::LightEnds(const LitScene& scene) : scene_(scene) {
    std::vector<float> powers;
    double total = 0.0;
    for (const auto& emitter : scene.emitters()) {
        const bool medium = emitter->traits().kind == EmitterKind::medium;
        const float power = medium ? 0.0f : average(emitter->power());
        index_.emplace(emitter.get(), powers.size());
        powers.push_back(power), total += double(power);
    }
    for (float& p : powers) p = total > 0.0 ? float(double(p) / total) : 0.0f;
    by_power_ = Distribution1D(powers);
}

LightChoice LightEnds::choose(float u, float* remapped) const {
    if (by_power_.empty()) return {nullptr, 0.0f};
    const auto sampled = by_power_.sample_discrete(u);
    *remapped = sampled.remapped;
    return {scene_.emitters()[sampled.index].get(), sampled.probability};
}

float LightEnds::probability(const Emitter* emitter) const {
    const auto it = index_.find(emitter);
    return it == index_.end() ? 0.0f : by_power_.probability(it->second);
}

LightEnds::Start LightEnds::start(const LightPoint& point) const {
    const double chance = double(probability(point.emitter));
    const EmissionDensity d = point.emitter->pdf_emission(point.position, point.normal, -point.wi);
    if (point.infinite()) return {chance * double(d.pdf_solid_angle), double(d.pdf_area)};
    return {chance * double(d.pdf_area), double(d.pdf_solid_angle)};
}

double LightEnds::sampled(const LightReceiver& receiver, const LightPoint& point,
                          double distance_squared) const {
    const EmitterTraits traits = point.emitter->traits();
    if (!traits.direct) return 0.0;
    const double chance = double(scene_.light_probability(receiver, point.emitter));
    if (!traits.can_be_hit()) return chance;
    SurfaceHit hit;
    hit.position = point.position, hit.geometric_normal = point.normal;
    const float pdf =
        point.emitter->pdf_direct(receiver.position, point.wi, point.infinite() ? nullptr : &hit);
    return chance * double(pdf) * point.area_measure(distance_squared);
}

}  // namespace mote::integrators
