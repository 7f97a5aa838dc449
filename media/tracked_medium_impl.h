// The loops of tracked_medium.h.
#pragma once

#include "media/tracked_medium.h"
#include "media/volume.h"

namespace mote::media {

template <typename Grid>
class TrackedMedium<Grid>::Voxels {
  public:
    Voxels(const TrackedMedium& medium, const core::Vec3d& origin, const core::Vec3d& direction,
           core::TrackingCounters& counters)
        : scale_(medium.parts_.scale), cursor_(medium.grid_.cursor()), counters_(counters) {
        const MajorantGrid<Value>& cells = medium.grid_.majorants;
        ray_ = {origin, direction, core::Vec3d(cells.lower()),
                glm::max(glm::ivec3(cells.upper() - cells.lower()), glm::ivec3(1))};
    }
    Wide density(double t) const {
        ++counters_.lookups;
        return detail::widen(cursor_.lookup(ray_.origin + t * ray_.direction));
    }
    /// Optical depth between two positions in one voxel.
    Wide depth_within(double from, double to) const {
        return detail::integral_within_voxel(counted(), ray_, from, to) * scale_;
    }
    Wide depth(double t0, double t1) const {
        Wide sum(0.0);
        for_each(t0, t1, [&](double, double, const Wide& depth) {
            sum += depth;
            return true;
        });
        return sum;
    }
    /// Calls visit(from, to, optical depth) -> bool, voxel by voxel.
    template <typename Visit>
    void for_each(double t0, double t1, Visit&& visit) const {
        detail::for_each_voxel(counted(), ray_, t0, t1, [&](double from, double to, const Wide& integral) {
            return visit(from, to, integral * scale_);
        });
    }

  private:
    auto counted() const {
        return [this](const core::Vec3d& p) {
            ++counters_.lookups;
            return detail::widen(cursor_.lookup(p));
        };
    }
    double scale_;
    mutable decltype(std::declval<Grid>().cursor()) cursor_;  ///< may remember where it was
    core::TrackingCounters& counters_;
    detail::VoxelRay ray_;
};

template <typename Grid>
template <typename RateOf, typename AtPiece, typename AtCollision, typename AtVoxels, typename NextGap>
std::optional<double> TrackedMedium<Grid>::track(const core::Ray& ray, core::TrackingCounters& counters,
                                                 RateOf&& rate_of, AtPiece&& at_piece,
                                                 AtCollision&& at_collision, AtVoxels&& at_voxels,
                                                 NextGap&& next_gap) const {
    const core::Vec3d origin = index_origin(ray), direction = index_direction(ray);
    const double scale = parts_.scale;
    auto cursor = grid_.cursor();
    double depth = next_gap();  // majorant optical depth left until the next tentative collision
    std::uint64_t steps = 0;
    std::optional<double> given_up;
    double uneven_from = 0.0, uneven_to = 0.0;  // a piece for regular tracking, outside of the fast loop
    const auto visit = [&](const Range& range, double t0, double t1) __attribute__((always_inline)) {
        const double length = t1 - t0, rate = rate_of(range), rate_per_metre = rate * scale;
        if (rate > regular_from_) [[unlikely]]
            if (far_apart(range)) {
                uneven_from = t0, uneven_to = t1;
                return false;
            }
        if (!(rate_per_metre > 0.0)) {
            at_piece(range, length);
            return true;
        }
        double s = 0.0;  // from the start of the piece, so that short steps are not lost beside a large t
        for (;;) {
            const double remaining = rate_per_metre * (length - s);
            if (!(depth < remaining)) {
                depth -= remaining;
                at_piece(range, length);
                return true;
            }
            s += depth / rate_per_metre;  // -ln(u) / majorant (Woodcock et al. 1965)
            ++steps;
            const double t = t0 + s;
            const Wide density = detail::widen(cursor.lookup(origin + t * direction));
            if (!at_collision(range, rate, t, density)) return false;
            if (steps == parts_.step_limit) {  // here, before what follows is known: the mean stays right
                at_piece(range, s);
                given_up = t;
                return false;
            }
            depth = next_gap();
        }
    };
    const auto voxel_by_voxel = [&]() __attribute__((noinline, cold)) {
        return at_voxels(Voxels(*this, index_origin(ray), index_direction(ray), counters), uneven_from,
                         uneven_to);
    };
    double begin, end;
    for (bool more = clip(ray, begin, end); more;) {
        grid_.majorants.walk(origin, direction, begin, end, visit);
        if (!(uneven_from < uneven_to)) break;
        // The walk continues behind the piece with the same `depth`: the exponential has no memory.
        more = voxel_by_voxel();
        begin = uneven_to, uneven_from = uneven_to;
    }
    counters.lookups += steps, counters.collisions += steps;
    if (given_up) ++counters.fallbacks;
    return given_up;
}

template <typename Grid>
std::optional<float> TrackedMedium<Grid>::sample_collision(const core::Ray& ray, core::PathWeights& weights,
                                                           core::Rgb& emitted, core::Rng& rng,
                                                           core::TrackingCounters& counters) const {
    if (absorbs_alone_) {
        // Russian roulette of paths takes no negative throughput, which marching may estimate.
        weights.throughput *= estimator_ == TransmittanceEstimator::unbiased_ray_marching
                                  ? by_residual_tracking(ray, rng, counters)
                                  : transmittance(ray, rng, counters);
        return std::nullopt;
    }
    std::optional<float> found;
    const int hero = weights.hero;
    const auto at_collision = [&](const Range&, double majorant, double t, Wide density) {
        density = glm::min(density, Wide(majorant));  // interpolation may round above the bound
        const core::Vec3 p = ray.at(float(t));
        if (emissive_) {
            // every tentative collision is a sample of density majorant * exp(...) of the source sigma_a L_e
            const core::Rgb absorbed = core::Rgb(density / majorant) * (core::Rgb(1.0f) - albedo_at(p));
            const core::Rgb emission = absorbed * parts_.emission.at(p);
            if (!core::is_black(emission)) {
                core::Rgb pdfs = weights.unidirectional;
                if (emitter_ && !core::is_black(weights.light))
                    pdfs += weights.light *
                            emitter_->light_over_walk(weights.vertex, p, parts_.scale * core::Rgb(density));
                emitted += weights.throughput * emission / core::average(pdfs);
            }
        }
        // Real with the chance sigma_t / majorant of the hero, else null (Woodcock et al. 1965). Throughput
        // and pdf of a channel c move alike, by the ratio of its chance to the hero's (Miller et al. 2019).
        const double real = detail::channel(density, hero);
        if (sample_event(real / majorant, rng)) {
            if constexpr (chromatic) {
                const core::Rgb ratio(density / real);
                weights.throughput *= ratio;
                weights.unidirectional *= ratio;
            }
            weights.throughput *= albedo_at(p);
            found = std::fmin(float(t), std::fmin(ray.t_max, std::numeric_limits<float>::max()));
            return false;
        }
        if constexpr (chromatic) {
            const core::Rgb ratio((Wide(majorant) - density) / (majorant - real));
            weights.throughput *= ratio;
            weights.unidirectional *= ratio;
        }
        weights.light *= float(majorant / (majorant - real));
        return true;
    };
    const auto at_voxels = [&](const Voxels& voxels, double t0, double t1) {
        return pass_voxels(voxels, t0, t1, ray, weights, emitted, rng, found);
    };
    const auto given_up = track(
        ray, rng, counters, [](const Range& r) { return detail::largest(r.upper); },
        [](const Range&, double) {}, at_collision, at_voxels);
    if (given_up) weights.throughput = core::Rgb(0.0f);
    return found;
}

template <typename Grid>
bool TrackedMedium<Grid>::pass_voxels(const Voxels& voxels, double t0, double t1, const core::Ray& ray,
                                      core::PathWeights& weights, core::Rgb& emitted, core::Rng& rng,
                                      std::optional<float>& found) const {
    const int hero = weights.hero;
    double left = sample_optical_depth(rng);  // of the hero, until its next collision
    // Ratios of densities between the channels, exact where the exponentials of one channel alone overflow.
    const auto apply = [&](const Wide& ratio) {
        if constexpr (chromatic) {
            const core::Rgb bounded(glm::min(ratio, Wide(1e30)));
            weights.throughput *= bounded, weights.unidirectional *= bounded;
        }
    };
    // The walk passes by the chance exp(-tau_h), which light sampling does not need.
    const auto pass = [&](const Wide& depth, double of_hero) {
        apply(detail::exp_minus(depth - Wide(of_hero)));
        weights.light *= float(std::exp(of_hero));
    };
    voxels.for_each(t0, t1, [&](double from, double to, const Wide& depth) {
        const double of_hero = detail::channel(depth, hero);
        if (of_hero <= left) {
            left -= of_hero;
            pass(depth, of_hero);
            return true;
        }
        std::array<double, 4> along;
        for (std::size_t i = 0; i < along.size(); ++i)
            along[i] = detail::channel(voxels.density(from + double(i) / 3.0 * (to - from)), hero);
        const double t = from + detail::inverse_integral(along, left / of_hero) * (to - from);
        Wide before(left);
        if constexpr (chromatic) before = voxels.depth_within(from, t), before[hero] = left;
        Wide density = voxels.density(t);
        if (!(detail::channel(density, hero) > 0.0)) density = depth;  // rounding: as its mean over the voxel
        const double real = detail::channel(density, hero);
        const core::Vec3 p = ray.at(float(t));
        const core::Rgb albedo = albedo_at(p);
        if (const core::Rgb source =
                emissive_ ? (core::Rgb(1.0f) - albedo) * parts_.emission.at(p) : core::Rgb(0.0f);
            !core::is_black(source)) {
            // A real collision is a sample of density sigma_t T of the source sigma_a L_e, the mean over the
            // heroes; against light sampling it is weighted as tentative collisions are, without sigma_t.
            const core::PathWeights here = weights;
            pass(before, left);
            core::Rgb pdfs = weights.unidirectional;
            if (emitter_ && !core::is_black(weights.light))
                pdfs += weights.light *
                        emitter_->light_over_walk(weights.vertex, p, parts_.scale * core::Rgb(density));
            const core::Rgb of_walk = weights.unidirectional,
                            extinction(glm::min(density / real, Wide(1e30)));
            emitted += weights.throughput * extinction * source / core::average(of_walk * extinction) *
                       (core::average(of_walk) / core::average(pdfs));
            weights = here;
        }
        apply(detail::exp_minus(before - Wide(left)) * density / real);
        weights.throughput *= albedo;
        found = std::fmin(float(t), std::fmin(ray.t_max, std::numeric_limits<float>::max()));
        return false;
    });
    return !found;
}

template <typename Grid>
void TrackedMedium<Grid>::connect(const core::Ray& ray, core::PathWeights& weights, core::Rng& rng,
                                  core::TrackingCounters& counters) const {
    if (absorbs_alone_) {
        weights.throughput *= transmittance(ray, rng, counters);
        return;
    }
    // `passed` is both the estimate and the chance that sample_collision() passes the same tentative
    // collisions; roulette divides the estimate alone.
    Wide passed(1.0), estimate(1.0);
    const auto at_collision = [&](const Range&, double majorant, double, const Wide& density) {
        // T = prod (1 - sigma_t(x_i) / majorant), ratio tracking (Novák et al. 2014)
        const Wide factor = Wide(1.0) - glm::min(density, Wide(majorant)) / majorant;
        passed *= factor, estimate *= factor;
        return detail::russian_roulette(estimate, rng);
    };
    const auto at_voxels = [&](const Voxels& voxels, double t0, double t1) {
        const Wide factor = detail::exp_minus(voxels.depth(t0, t1));
        passed *= factor, estimate *= factor;
        return detail::russian_roulette(estimate, rng);
    };
    const auto given_up = track(
        ray, rng, counters, [](const Range& r) { return detail::largest(r.upper); },
        [](const Range&, double) {}, at_collision, at_voxels);
    const core::Rgb rest = rest_by_marching(ray, given_up, counters);
    weights.throughput *= core::Rgb(estimate) * rest;
    weights.unidirectional *= core::Rgb(passed) * rest;
}

template <typename Grid>
core::Rgb TrackedMedium<Grid>::transmittance_by(TransmittanceEstimator estimator, const core::Ray& ray,
                                                core::Rng& rng, core::TrackingCounters& counters) const {
    switch (estimator) {
        case TransmittanceEstimator::ray_marching:
            return by_marching(ray, counters);
        case TransmittanceEstimator::delta_tracking:
            return by_delta_tracking(ray, rng, counters);
        case TransmittanceEstimator::ratio_tracking:
            return by_ratio_tracking(ray, rng, counters);
        case TransmittanceEstimator::residual_ratio_tracking:
            return by_residual_tracking(ray, rng, counters);
        case TransmittanceEstimator::unbiased_ray_marching:
            return by_unbiased_marching(ray, rng, counters);
        case TransmittanceEstimator::automatic:
            break;
    }
    return transmittance_by(estimator_, ray, rng, counters);
}

template <typename Grid>
core::Rgb TrackedMedium<Grid>::by_delta_tracking(const core::Ray& ray, core::Rng& rng,
                                                 core::TrackingCounters& counters) const {
    // One random number decides for all channels: each passes with its own chance.
    Wide passes(1.0);
    const auto at_collision = [&](const Range&, double majorant, double, const Wide& density) {
        const double u = uniform_double(rng) * majorant;  // T = P(no real collision) (Woodcock et al. 1965)
        if constexpr (chromatic) {
            for (int c = 0; c < 3; ++c)
                if (u <= density[c]) passes[c] = 0.0;
        } else {
            if (u <= density) passes = 0.0;
        }
        return detail::largest(passes) > 0.0;
    };
    const auto at_voxels = [&](const Voxels& voxels, double t0, double t1) {
        const double reach = sample_optical_depth(rng);  // T = P(reach > tau)
        const Wide depth = voxels.depth(t0, t1);
        for (int c = 0; c < (chromatic ? 3 : 1); ++c)
            if (reach <= detail::channel(depth, c)) detail::clear_channel(passes, c);
        return detail::largest(passes) > 0.0;
    };
    const auto given_up = track(
        ray, rng, counters, [](const Range& r) { return detail::largest(r.upper); },
        [](const Range&, double) {}, at_collision, at_voxels);
    return core::Rgb(passes) * rest_by_marching(ray, given_up, counters);
}

template <typename Grid>
core::Rgb TrackedMedium<Grid>::by_ratio_tracking(const core::Ray& ray, core::Rng& rng,
                                                 core::TrackingCounters& counters) const {
    Wide estimate(1.0);
    const auto at_collision = [&](const Range&, double majorant, double, const Wide& density) {
        // T = prod (1 - sigma_t(x_i) / majorant), ratio tracking (Novák et al. 2014)
        estimate *= Wide(1.0) - glm::min(density, Wide(majorant)) / majorant;
        return detail::russian_roulette(estimate, rng);
    };
    const auto at_voxels = [&](const Voxels& voxels, double t0, double t1) {
        estimate *= detail::exp_minus(voxels.depth(t0, t1));
        return detail::russian_roulette(estimate, rng);
    };
    const auto given_up = track(
        ray, rng, counters, [](const Range& r) { return detail::largest(r.upper); },
        [](const Range&, double) {}, at_collision, at_voxels);
    return core::Rgb(estimate) * rest_by_marching(ray, given_up, counters);
}

template <typename Grid>
core::Rgb TrackedMedium<Grid>::rest_by_marching(const core::Ray& ray, const std::optional<double>& from,
                                                core::TrackingCounters& counters) const {
    if (!from) return core::Rgb(1.0f);
    core::Ray rest = ray;
    rest.t_min = float(*from);
    return by_marching(rest, counters);
}

template <typename Grid>
core::Rgb TrackedMedium<Grid>::by_marching(const core::Ray& ray, core::TrackingCounters& counters) const {
    // Midpoints of equal parts, one a voxel to begin with, then three times as many (the old ones among them)
    // until the optical depth of the piece moves by less than the tolerance.
    constexpr std::uint64_t max_points = 6561;
    if (parts_.scale == 0.0f) return core::Rgb(1.0f);
    const core::Vec3d origin = index_origin(ray), direction = index_direction(ray);
    const double voxels_per_metre = glm::length(direction);
    auto cursor = grid_.cursor();
    Wide depth(0.0);
    const auto visit = [&](const Range& range, double t0, double t1) {
        const double length = std::min(t1 - t0, 1e30);  // vacuum of infinite length is 0, not NaN
        const Wide lower = detail::widen(range.lower), upper = detail::widen(range.upper);
        if (detail::largest(upper - lower) == 0.0) {
            if (detail::largest(upper) > 0.0) depth += upper * length;
            return std::isfinite(detail::largest(depth));
        }
        if (detail::largest(upper - lower) > regular_from_ && far_apart(range)) {
            depth += Voxels(*this, origin, direction, counters).depth(t0, t1) / double(parts_.scale);
            return true;
        }
        std::uint64_t n = std::uint64_t(std::clamp(std::ceil(length * voxels_per_metre), 1.0, 2187.0));
        const auto at = [&](double x) {
            ++counters.lookups;
            return detail::widen(cursor.lookup(origin + (t0 + x * length) * direction));
        };
        Wide sum(0.0);
        for (std::uint64_t i = 0; i < n; ++i) sum += at((double(i) + 0.5) / double(n));
        for (;;) {
            const Wide coarse = sum / double(n);
            for (std::uint64_t i = 0; i < n; ++i)
                sum += at((double(i) + 1.0 / 6.0) / double(n)) + at((double(i) + 5.0 / 6.0) / double(n));
            n *= 3;
            const Wide fine = sum / double(n);
            const double moved = std::fmax(detail::largest(fine - coarse), detail::largest(coarse - fine));
            if (moved <= parts_.tracking.marching_tolerance * detail::largest(fine) || n >= max_points) break;
        }
        depth += sum * (length / double(n));
        return true;
    };
    if (double t0, t1; clip(ray, t0, t1)) grid_.majorants.walk(origin, direction, t0, t1, visit);
    return detail::exp_minus_rgb(depth * double(parts_.scale));
}

template <typename Grid>
core::Rgb TrackedMedium<Grid>::by_residual_tracking(const core::Ray& ray, core::Rng& rng,
                                                    core::TrackingCounters& counters) const {
    // Residual ratio tracking (Novák et al. 2014): a cell's lower bound is integrated analytically, the rest
    // is tracked. Where a cell is constant, nothing random is left.
    Wide sure_depth(0.0), estimate(1.0);
    const auto rate_of = [](const Range& r) { return detail::largest(r.upper - r.lower); };
    const auto at_piece = [&](const Range& r, double length) {
        const Wide sigma = detail::widen(r.lower) * double(parts_.scale);
        if constexpr (chromatic) {
            for (int c = 0; c < 3; ++c) sure_depth[c] += optical_depth(sigma[c], length);
        } else {
            sure_depth += optical_depth(sigma, length);
        }
    };
    const auto at_collision = [&](const Range& r, double rate, double, const Wide& density) {
        const Wide residual = glm::clamp(density - detail::widen(r.lower), Wide(0.0), Wide(rate));
        // T = exp(-control depth) prod (1 - (sigma_t(x_i) - control) / rate) (Novák et al. 2014)
        estimate *= Wide(1.0) - residual / rate;
        return detail::russian_roulette(estimate, rng);
    };
    const auto at_voxels = [&](const Voxels& voxels, double t0, double t1) {
        sure_depth += voxels.depth(t0, t1);
        return true;
    };
    const auto given_up = track(ray, rng, counters, rate_of, at_piece, at_collision, at_voxels);
    if (detail::largest(estimate) == 0.0) return core::Rgb(0.0f);
    return core::Rgb(estimate) * detail::exp_minus_rgb(sure_depth) *
           rest_by_marching(ray, given_up, counters);
}

template <typename Grid>
core::Vec3d TrackedMedium<Grid>::optical_depth_by_marching(const core::Ray& ray, float step,
                                                           core::TrackingCounters& counters) const {
    const core::Vec3d origin = index_origin(ray), direction = index_direction(ray);
    const double scale = parts_.scale;
    double t0, t1;
    if (majorant_ == 0.0f || !clip(ray, t0, t1)) return core::Vec3d(0.0);
    core::Vec3d beyond(0.0);
    if constexpr (!boxed) {  // beyond the cells it is the same everywhere
        const double whole = t1 - t0;
        if (!(grid_.majorants.has_cells() && grid_.majorants.clip(origin, direction, t0, t1))) t1 = t0;
        const core::Vec3d outside(core::Rgb(grid_.majorants.outside().upper));
        for (int c = 0; c < 3; ++c) beyond[c] = optical_depth(scale * outside[c], whole - (t1 - t0));
    }
    if (!(t0 < t1)) return beyond;
    const auto count = std::uint64_t(std::ceil((t1 - t0) / double(step)));
    const double h = (t1 - t0) / double(count);
    const core::Vec3d start = origin + (t0 + 0.5 * h) * direction, delta = h * direction;
    auto cursor = grid_.cursor();
    Wide sum(0.0);
    for (std::uint64_t i = 0; i < count; ++i) sum += detail::widen(cursor.lookup(start + double(i) * delta));
    counters.lookups += count;
    return beyond + core::Vec3d(sum) * (h * scale);
}

template <typename Grid>
void TrackedMedium<Grid>::optical_depths_by_marching(const core::Ray& ray, float step,
                                                     std::span<core::Vec3d> depths,
                                                     core::TrackingCounters& counters) const {
    std::fill(depths.begin(), depths.end(), core::Vec3d(0.0));
    const double t0 = ray.t_min, part = (double(ray.t_max) - t0) / double(depths.size());
    double enter, leave;
    if (!(part > 0.0) || !clip(ray, enter, leave)) return;
    const auto points = std::uint64_t(std::max(std::ceil(part / double(step)), 1.0));  // of each part
    const double h = part / double(points);
    const core::Vec3d origin = index_origin(ray), direction = index_direction(ray);
    auto cursor = grid_.cursor();
    std::uint64_t i = 0, looked_up = 0;  // the next point, at t0 + (i + 1/2) h
    const std::uint64_t end = points * depths.size();
    const auto add = [&](std::uint64_t at, double t, double weight) {
        ++looked_up;
        depths[at / points] += weight * core::Vec3d(detail::widen(cursor.lookup(origin + t * direction)));
    };
    // A step that the medium's box cuts counts with the part inside.
    const auto add_part = [&](double from, double to) {
        const auto at = std::uint64_t(std::clamp((0.5 * (from + to) - t0) / h, 0.0, double(end - 1)));
        if (from < to) add(at, 0.5 * (from + to), (to - from) / h);
    };
    const double first_whole = std::min(t0 + std::ceil((enter - t0) / h) * h, leave);
    const double last_whole = std::max(t0 + std::floor((leave - t0) / h) * h, first_whole);
    add_part(enter, first_whole);
    grid_.majorants.walk(origin, direction, first_whole, last_whole,
                         [&](const Range& range, double begin, double t1) {
                             if (detail::largest(range.upper) == 0.0) return true;
                             const double first = std::ceil((begin - t0) / h - 0.5);
                             if (first > double(i)) i = std::uint64_t(first);
                             for (double t; i < end && (t = t0 + (double(i) + 0.5) * h) < t1; ++i)
                                 add(i, t, 1.0);
                             return true;
                         });
    add_part(last_whole, leave);
    counters.lookups += looked_up;
    core::Vec3d sum(0.0);
    for (core::Vec3d& depth : depths) depth = sum += depth * (h * double(parts_.scale));
}

template <typename Grid>
core::MediumCoefficients TrackedMedium<Grid>::coefficients(const core::Vec3& p) const {
    core::MediumCoefficients c;
    if constexpr (boxed)
        if (!grid_.box.contains(p)) return c;
    const Value density = grid_.cursor().lookup(grid_.world_to_index.point(core::Vec3d(p)));
    c.sigma_t = parts_.scale * core::Rgb(density);
    c.sigma_s = c.sigma_t * albedo_at(p);
    if (emissive_) c.emission = (c.sigma_t - c.sigma_s) * parts_.emission.at(p);
    return c;
}

template <typename Grid>
core::Bounds3 TrackedMedium<Grid>::bounds() const {
    core::Bounds3 box;
    const auto hold = [&](const core::Vec3d& exact) {  // outwards, so that rounding cannot cut the medium
        const core::Vec3 p(exact);
        for (int axis = 0; axis < 3; ++axis) {
            box.lower[axis] = std::fmin(box.lower[axis], std::nextafter(p[axis], -core::infinity));
            box.upper[axis] = std::fmax(box.upper[axis], std::nextafter(p[axis], core::infinity));
        }
    };
    if constexpr (boxed) {
        hold(grid_.box.lower), hold(grid_.box.upper);
        return box;
    }
    if (detail::largest(grid_.majorants.outside().upper) > 0.0)
        return {core::Vec3(-core::infinity), core::Vec3(core::infinity)};
    if (!grid_.majorants.has_cells()) return box;
    const core::Transform to_world = grid_.world_to_index.inverse();
    for (int corner = 0; corner < 8; ++corner) {
        const Voxel v(corner & 1 ? grid_.majorants.upper().x : grid_.majorants.lower().x,
                      corner & 2 ? grid_.majorants.upper().y : grid_.majorants.lower().y,
                      corner & 4 ? grid_.majorants.upper().z : grid_.majorants.lower().z);
        hold(to_world.point(core::Vec3d(v)));
    }
    return box;
}

template <typename Grid>
core::MediumTraits TrackedMedium<Grid>::traits() const {
    core::MediumTraits t;
    t.emissive = emissive_;
    t.isotropic = parts_.phase->isotropic();
    t.chromatic = chromatic;
    t.scattering = majorant_ > 0.0f && !core::is_black(parts_.albedo->upper_bound());
    t.empty = majorant_ == 0.0f;
    t.description = grid_.description;
    if (t.empty) {
        t.description += ", empty";
        return t;
    }
    if (grid_.majorants.has_cells())
        t.description += fmt::format(", majorants {}x{}x{}", grid_.majorants.resolution().x,
                                     grid_.majorants.resolution().y, grid_.majorants.resolution().z);
    t.estimator = name_of(estimator_);
    t.estimator_reason =
        parts_.tracking.transmittance == TransmittanceEstimator::automatic
            ? std::string(certain_fraction_ == 1.0
                              ? "every cell is constant: in closed form"
                              : "least variance at the time of tracking, which takes over in dense parts")
            : std::string("requested");
    t.voxel_size = voxel_size_;
    return t;
}

template <typename Grid>
float TrackedMedium<Grid>::find_voxel_size() const {
    const core::Vec3d origin = grid_.world_to_index.point(core::Vec3d(0.0));
    double voxels_per_metre = 0.0;  // largest, over the axes
    for (int axis = 0; axis < 3; ++axis) {
        core::Vec3d along(0.0);
        along[axis] = 1.0;
        voxels_per_metre =
            std::fmax(voxels_per_metre, glm::length(grid_.world_to_index.point(along) - origin));
    }
    return float(1.0 / voxels_per_metre);
}

}  // namespace mote::media
