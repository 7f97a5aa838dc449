// Scattering along a ray through a grid, all of it in one walk (Medium::scatter_along): ratio tracking
// carries the transmittance, and candidates lie in strata of the majorant's optical depth, as many as are
// needed where the medium is thin.
#pragma once

#include "core/scene/scattering_points.h"
#include "media/stratified_events.h"
#include "media/tracked_medium.h"

namespace mote::media {

namespace detail {
/// Strata are no longer than this optical depth: what lies behind a few of them is hardly seen.
inline constexpr double longest_stratum = 0.5;
}  // namespace detail

template <typename Grid>
double TrackedMedium<Grid>::stratum_along(const core::Ray& ray, int samples) const {
    double depth = 0.0, t0, t1;
    if (!clip(ray, t0, t1)) return detail::longest_stratum;
    const auto add = [&](const Range& range, double from, double to) {
        const double rate = detail::largest(range.upper);
        if (rate > 0.0 && !(rate > regular_from_ && far_apart(range)))
            depth += rate * double(parts_.scale) * (to - from);
        return depth < double(samples) * detail::longest_stratum;
    };
    grid_.majorants.walk(index_origin(ray), index_direction(ray), t0, t1, add);
    return depth > 0.0 ? std::fmin(depth / double(samples), detail::longest_stratum)
                       : detail::longest_stratum;
}

template <typename Grid>
void TrackedMedium<Grid>::scatter_along(const core::Ray& ray, core::PathWeights& weights, core::Rgb& emitted,
                                        core::ScatteringPoints& points, core::Rng& rng,
                                        core::TrackingCounters& counters) const {
    if (majorant_ == 0.0f) return;
    if (absorbs_alone_ || (points.count() == 0 && !emissive_)) {
        weights.throughput *= transmittance(ray, rng, counters);
        return;
    }
    const core::Rgb start = weights.throughput / core::average(weights.unidirectional);
    Wide passed(1.0);  // the transmittance so far
    detail::StratifiedEvents events(stratum_along(ray, points.candidates()), rng);
    const auto at_event = [&](const Range&, double majorant, double t, Wide density) {
        const Wide probability = glm::min(density, Wide(majorant)) / majorant;
        if (!events.at_sample()) {
            passed *= Wide(1.0) - probability;  // ratio tracking (Novák et al. 2014)
            return detail::russian_roulette(passed, rng);
        }
        if (!(detail::largest(probability) > 0.0)) return true;
        const core::Vec3 p = ray.at(float(t));
        const core::Rgb collides = start * core::Rgb(passed * probability * events.stratum()),
                        albedo = albedo_at(p);
        points.add(p, collides * albedo);
        if (emissive_) emitted += collides * (core::Rgb(1.0f) - albedo) * parts_.emission.at(p);
        return true;
    };
    // Where cells are tracked voxel by voxel, at most one collision, by chance, is a candidate.
    const auto at_voxels = [&](const Voxels& voxels, double t0, double t1) {
        core::PathWeights path;
        path.throughput = start * core::Rgb(passed);
        path.hero = std::min(int(rng.next_float() * 3.0f), 2);  // of this candidate alone
        std::optional<float> found;
        if (!pass_voxels(voxels, t0, t1, ray, path, emitted, rng, found))
            points.add(ray.at(*found), path.throughput / core::average(path.unidirectional));
        passed *= detail::exp_minus(voxels.depth(t0, t1));
        return detail::russian_roulette(passed, rng);
    };
    const auto given_up = track(
        ray, counters, [](const Range& r) { return detail::largest(r.upper); }, [](const Range&, double) {},
        at_event, at_voxels, [&] { return events.next(); });
    weights.throughput *= core::Rgb(passed) * rest_by_marching(ray, given_up, counters);
}

}  // namespace mote::media
