#include "screenspace/layer_filter/mixed_pixels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "screenspace/layer_filter/same_surface.h"

namespace mote::screenspace {

using namespace core;

namespace {

/// Mean over neighbours, and its variance: from their noise, and from how far they differ.
struct Estimate {
    Rgb mean{0.0f};
    float variance = 0.0f;
};

/// Neighbours farther away than this are used only where there is none nearer [pixels].
constexpr int near_reach = 2, far_reach = 4;
constexpr int variance_reach = 3;
/// Where no neighbour sees the surface, as of a wire, what others nearby see is taken, with this fraction of
/// it as its standard deviation: next to much noise it says something, next to little nothing.
constexpr float strangers_deviation = 0.5f;

class MixedPixel {
  public:
    MixedPixel(const FilterFeatures& f, const LayerToFilter& layer, const FilterPlanes& p,
               const FilteredLayer& filtered, std::uint32_t pixel)
        : f_(f),
          layer_(layer),
          p_(p),
          filtered_(filtered),
          pixel_(pixel),
          x_(int(pixel % std::uint32_t(f.width))),
          y_(int(pixel / std::uint32_t(f.width))) {}

    /// Eq. (4). Nothing where a sample has no neighbour at all.
    std::optional<Estimate> put_together(std::span<const FeatureSample> samples) const {
        Rgb sum(0.0f), squares(0.0f);
        float variance = 0.0f;
        std::vector<std::pair<const FeatureSample*, Estimate>> known;
        for (const FeatureSample& s : samples) {
            const Rgb m = surface() ? s.reflected : s.scattering;
            if (is_black(m)) continue;
            const Estimate* light = light_of(s, known);
            if (!light) return std::nullopt;
            const Rgb value = m * light->mean;
            sum += value, squares += value * value;
            variance += average(m * m) * light->variance;
        }
        const float n = float(samples.size());
        Estimate r;
        r.mean = sum / n;
        // Samples share their neighbours: their errors add up. Their number is finite: the spread over n.
        r.variance = variance / n + max_of(0.0f, average(squares / n - r.mean * r.mean)) / n;
        return r;
    }

    /// True if hardly any neighbour sees what this pixel sees.
    bool lonely(const FeatureSample& s) const {
        float sum = 0.0f;
        for_each_neighbour(near_reach, [&](std::uint32_t q) {
            if (sum < 1.0f) sum += weight(s, q);
        });
        return sum < 1.0f;
    }

    /// V[y] is too noisy itself at one pixel: a black one would be taken to be sure. An outlier is known to
    /// be unsure, and would stand in the picture as a dot with the variance of its neighbours; what it takes
    /// from the light is a fraction of the weight of the pixel's own mean.
    float own_variance() const {
        float sum = average(layer_.variance[pixel_]), count = 1.0f;
        for_each_neighbour(variance_reach, [&](std::uint32_t q) {
            if (is_finite(layer_.variance[q])) sum += average(layer_.variance[q]), count += 1.0f;
        });
        return max_of(sum / count, average(layer_.variance[pixel_]));
    }

  private:
    template <typename Visit>
    void for_each_neighbour(int reach, const Visit& visit) const {
        for (int y = std::max(0, y_ - reach); y <= std::min(f_.height - 1, y_ + reach); ++y)
            for (int x = std::max(0, x_ - reach); x <= std::min(f_.width - 1, x_ + reach); ++x)
                if (x != x_ || y != y_) visit(std::uint32_t(p_.index(x, y)));
    }

    bool surface() const { return layer_.kind == LayerKind::surface; }

    /// Weight of a neighbour that sees the surface of the sample alone, or its depth of a medium.
    float weight(const FeatureSample& s, std::uint32_t q) const {
        if (!(p_.weight[q] > 0.0f) || f_.kind[q] == PixelKind::mixed) return 0.0f;
        const Vec3 d = f_.position[q] - s.position;
        const float off = max_of(std::fabs(glm::dot(d, s.normal)), std::fabs(glm::dot(d, f_.normal[q])));
        if (!surface()) return same_depth(s, q, off);
        const float footprint = max_of(f_.frame[q].footprint, f_.frame[pixel_].footprint);
        return same_surface(off, footprint, glm::dot(s.shading_normal, f_.shading_normal[q]));
    }

    float same_depth(const FeatureSample& s, std::uint32_t q, float off_plane) const {
        const float own = s.hit ? s.distance : FilterFeatures::far, other = f_.distance[q];
        const float along = std::fabs(other - own);
        const float step = along < 0.5f * FilterFeatures::far ? min_of(off_plane, along) : along;
        const float near = min_of(own, other);
        const float passes = own <= other ? s.transmittance : f_.transmittance[q];
        const float between = between_depths(step, near, passes, std::log(max_of(passes, 1e-30f)));
        return tukey(sqr(between / depth_tolerance));
    }

    /// Weight of another surface: one over the squared distance, in footprints.
    float nearness(const FeatureSample& s, std::uint32_t q) const {
        if (f_.kind[q] == PixelKind::none || !is_finite(filtered_.mean[q])) return 0.0f;
        const Vec3 d = f_.position[q] - s.position;
        return 1.0f / (1.0f + glm::dot(d, d) / max_of(sqr(f_.frame[pixel_].footprint), 1e-30f));
    }

    /// The ratio of two means over all that is near, mixed pixels too, whose noise is independent.
    std::optional<Estimate> light_of_strangers(const FeatureSample& s) const {
        Rgb light(0.0f), reflected(0.0f);
        float noise = 0.0f;
        for_each_neighbour(far_reach, [&](std::uint32_t q) {
            const float w = nearness(s, q);
            light += w * filtered_.mean[q], reflected += w * f_.reflected[q],
                noise += w * w * filtered_.variance[q];
        });
        const float scale = average(reflected);
        if (!(scale > 0.0f)) return std::nullopt;
        Estimate result;
        for (int c = 0; c < 3; ++c) result.mean[c] = reflected[c] > 0.0f ? light[c] / reflected[c] : 0.0f;
        result.variance = noise / sqr(scale) + sqr(strangers_deviation) * average(result.mean * result.mean);
        return result;
    }

    /// Samples of one surface share what one of them has found.
    const Estimate* light_of(const FeatureSample& s,
                             std::vector<std::pair<const FeatureSample*, Estimate>>& known) const {
        const float footprint = f_.frame[pixel_].footprint;
        for (const auto& [o, light] : known) {
            if (o->hit != s.hit) continue;
            const float off = std::fabs(glm::dot(o->position - s.position, s.normal));
            if (same_surface(off, footprint, glm::dot(o->shading_normal, s.shading_normal)) > 0.5f)
                return &light;
        }
        const auto found = s.filterable || !surface() ? look_for_light(s) : std::nullopt;
        return found ? &known.emplace_back(&s, *found).second : nullptr;
    }

    std::optional<Estimate> look_for_light(const FeatureSample& s) const {
        const auto same = [&](std::uint32_t q) { return weight(s, q); };
        for (const int reach : {near_reach, far_reach})
            if (const auto found = light_within(reach, same)) return found;
        return surface() ? light_of_strangers(s) : std::nullopt;
    }

    template <typename Weight>
    std::optional<Estimate> light_within(int reach, const Weight& weight_of) const {
        float sum = 0.0f, noise = 0.0f;
        Rgb light(0.0f), squares(0.0f);
        for_each_neighbour(reach, [&](std::uint32_t q) {
            const float w = weight_of(q);
            if (!(w > 0.0f)) return;
            const Rgb m = modulation(f_, layer_.kind, q), e = filtered_.mean[q] / m;
            sum += w, light += w * e, squares += w * e * e;
            noise += w * filtered_.variance[q] / average(m * m);
        });
        if (!(sum > 0.0f)) return std::nullopt;
        Estimate result;
        result.mean = light / sum;
        result.variance = noise / sum + max_of(0.0f, average(squares / sum - result.mean * result.mean));
        return result;
    }

    const FilterFeatures& f_;
    const LayerToFilter& layer_;
    const FilterPlanes& p_;
    const FilteredLayer& filtered_;
    std::uint32_t pixel_;
    int x_, y_;
};

FeatureSample mean_sample(const FilterFeatures& f, std::uint32_t pixel) {
    FeatureSample s;
    s.hit = true, s.distance = f.distance[pixel], s.transmittance = f.transmittance[pixel];
    s.position = f.position[pixel], s.normal = f.normal[pixel], s.shading_normal = f.shading_normal[pixel];
    s.reflected = f.reflected[pixel];
    return s;
}

}  // namespace

void put_mixed_together(const FilterFeatures& f, const LayerToFilter& layer, const FilterPlanes& planes,
                        FilteredLayer& result, CancelToken cancelled) {
    const auto per_pixel = std::size_t(f.samples_per_pixel);
    FilteredLayer changed = result;
    const auto change = [&](const MixedPixel& mixed, std::uint32_t pixel,
                            std::span<const FeatureSample> samples) {
        const float own = mixed.own_variance();
        const auto r = mixed.put_together(samples);
        if (!r || !(own > 0.0f) || !is_finite(r->mean)) return;
        const float weight_of_own = r->variance / (r->variance + own);  // Eq. (5)
        changed.mean[pixel] = r->mean + weight_of_own * (layer.mean[pixel] - r->mean);
        changed.variance[pixel] = weight_of_own * own;
    };
    tbb::parallel_for(std::size_t(0), f.mixed.size(), [&](std::size_t k) {
        const std::uint32_t pixel = f.mixed[k];
        if (cancelled.requested() || !is_finite(layer.mean[pixel]) || !is_finite(layer.variance[pixel]))
            return;
        const MixedPixel mixed(f, layer, planes, result, pixel);
        // Where media hide what is behind them, several surfaces are no matter.
        if (layer.kind == LayerKind::volume && !mixed.lonely(mean_sample(f, pixel))) return;
        change(mixed, pixel, {f.samples.data() + k * per_pixel, per_pixel});
    });
    tbb::parallel_for(std::uint32_t(0), std::uint32_t(f.pixels()), [&](std::uint32_t pixel) {
        if (cancelled.requested() || layer.kind == LayerKind::volume || !(planes.weight[pixel] > 0.0f))
            return;
        const MixedPixel lonely(f, layer, planes, result, pixel);
        const FeatureSample sample = mean_sample(f, pixel);
        if (lonely.lonely(sample)) change(lonely, pixel, {&sample, 1});
    });
    cancelled.check();
    result = std::move(changed);
}

}  // namespace mote::screenspace
