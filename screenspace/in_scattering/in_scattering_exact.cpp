// In-scattering without steps: along the part of a ray whose triangle with the light lies in one homogeneous
// medium, the integral is taken exactly (analytic_light.h).
//
// Where no surface reaches into the triangle either (unoccluded_space.h), all of it is lit and no shadow ray
// is traced. Else shadow rays from the places where marching would have its steps say which steps are lit,
// and each run of lit ones is integrated as one. The first and the last thousandth of the part, whose ends
// touch surfaces and the borders of media, are left out of the triangle; each has a shadow ray of its own.
#include <algorithm>

#include "screenspace/in_scattering/in_scattering.h"

namespace mote::screenspace {

using namespace core;

namespace {
constexpr double end_fraction = 1e-3;  ///< of the angle that the part subtends at the light
}  // namespace

const AnalyticMedium* InScattering::analytic_medium(const Medium* medium) const {
    for (const AnalyticMedium& m : analytic_media_)
        if (m.medium == medium) return &m;
    return nullptr;
}

/// The triangle between the light and a part of the ray.
template <bool surfaces>
bool InScattering::is_free(const Ray& ray, double t0, double t1) const {
    const Vec3d light(position_), direction(ray.direction), from = Vec3d(ray.origin) + t0 * direction;
    const double far = 4.0 * double(scene_.bounds().radius());
    const UnoccludedSpace& space = *accelerations_.space;
    if (t1 - t0 < far) {
        const UnoccludedSpace::Triangle triangle = {light, from, Vec3d(ray.origin) + t1 * direction};
        return surfaces ? space.free_of_surfaces(triangle) : space.free_of_boundaries(triangle);
    }
    return surfaces ? space.free_of_surfaces(light, from, direction)
                    : space.free_of_boundaries(light, from, direction);
}

/// Traces shadow rays from the steps to the light; sets scratch.lit.
void InScattering::trace_steps(const Ray& ray, const StepRule& rule, MarchScratch& scratch) const {
    constexpr int width = ShadowPacket::width;
    place_steps(rule, scratch.distances);
    const std::size_t steps = scratch.distances.size();
    scratch.lit.resize(steps);
    scratch.packets.resize((steps + width - 1) / width);
    for (std::size_t i = 0; i < scratch.packets.size() * width; ++i) {
        ShadowPacket& p = scratch.packets[i / width];
        const std::size_t lane = i % width;
        if (lane == 0) p.clear();
        const Vec3 x = ray.at(scratch.distances[std::min(i, steps - 1)]), to_light = position_ - x;
        const float distance = glm::length(to_light);
        p.set(lane, x, to_light / distance, i < steps ? distance : -1.0f);
    }
    scene_.find_occluded(scratch.packets);
    for (std::size_t i = 0; i < steps; ++i)
        scratch.lit[i] = !scratch.packets[i / width].occluded(int(i % width));
    scratch.walk.rays.occlusion += steps, scratch.steps += steps;
}

/// Light scattered in a short piece that the test of the triangle leaves out, by one shadow ray from its
/// middle.
Rgb InScattering::end_piece(const Ray& ray, double t0, double t1, const MediumSegment& at,
                            const AnalyticMedium& medium, MarchScratch& scratch) const {
    if (!(t0 < t1)) return Rgb(0.0f);
    const PassingRay passing(ray, position_);
    const auto middle = float(passing.at_angle(0.5 * (passing.angle(t0) + passing.angle(t1))));
    const Rgb scattered = scattered_at(ray, middle, at, scratch);
    if (is_black(scattered)) return scattered;
    const bool one_medium = scratch.shadow.size() == 1 && scratch.shadow[0].medium == medium.medium;
    if (one_medium) return analytic_light_->in_scattered(ray, t0, t1, medium);
    return medium.transmittance(double(middle) - t0) * scattered * float(t1 - t0);
}

std::optional<Rgb> InScattering::integrate(const Ray& ray, double t0, double t1, const MediumSegment& at,
                                           MarchScratch& scratch) const {
    const AnalyticMedium* medium = analytic_medium(at.medium);
    if (!accelerations_.space || !analytic_light_ || !medium || t0 < double(at.t0) || t1 > double(at.t1))
        return std::nullopt;
    const StepRule all(MarchRule::equiangular, ray, position_, t0, t1);
    const double from = t0 > double(ray.t_min) ? all.at(end_fraction) : t0;
    const double to = std::isfinite(t1) ? all.at(1.0 - end_fraction) : t1;
    if (!(t0 <= from && from < to && to <= t1) || !is_free<false>(ray, from, to)) return std::nullopt;

    Rgb sum(0.0f);
    const auto add = [&](double begin, double end) {
        sum += medium->transmittance(begin - t0) * analytic_light_->in_scattered(ray, begin, end, *medium);
    };
    if (is_free<true>(ray, from, to)) {
        ++scratch.unoccluded;
        add(from, to);
    } else {
        if (accelerations_.map || (!std::isfinite(to) && settings_.rule == MarchRule::uniform))
            return std::nullopt;
        const StepRule rule(settings_.rule, ray, position_, from, to);
        trace_steps(ray, rule, scratch);
        const int n = settings_.steps;
        for (int i = 0, end = 0; i < n; i = end + 1) {
            for (end = i; end < n && scratch.lit[std::size_t(end)];) ++end;
            if (end > i) add(rule.at(double(i) / n), rule.at(double(end) / n));
        }
    }
    sum += end_piece(ray, t0, from, at, *medium, scratch);
    if (to < t1) sum += medium->transmittance(to - t0) * end_piece(ray, to, t1, at, *medium, scratch);
    return sum;
}

}  // namespace mote::screenspace
