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

/// Neighbours farther away than this are asked only where there is none nearer [pixels].
constexpr int near_reach = 2, far_reach = 4;
/// Where no neighbour sees the surface, as of a wire, what others nearby see is taken, with this share of it
/// as its standard deviation: next to much noise it says something, next to little nothing.
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

    /// Eq. (4). Nothing where a sample finds nobody at all.
    std::optional<Estimate> put_together(std::span<const FeatureSample> samples) const {
        Rgb sum(0.0f), squares(0.0f);
        float variance = 0.0f;
        for (const FeatureSample& s : samples) {
            if (!s.hit || is_black(s.reflected)) continue;
            const auto light = s.filterable ? light_of(s) : std::nullopt;
            if (!light) return std::nullopt;
            const Rgb value = s.reflected * light->mean;
            sum += value, squares += value * value;
            variance += average(s.reflected * s.reflected) * light->variance;
        }
        const float n = float(samples.size());
        Estimate r;
        r.mean = sum / n;
        // Samples share their neighbours: their errors add up. Their number is finite: the spread over n.
        r.variance = variance / n + std::fmax(0.0f, average(squares / n - r.mean * r.mean)) / n;
        return r;
    }

    /// V[y] is too noisy itself at one pixel: a black one would be taken to be sure.
    float own_variance() const {
        float sum = average(layer_.variance[pixel_]), count = 1.0f;
        for_each_neighbour(1, [&](std::uint32_t q) {
            if (is_finite(layer_.variance[q])) sum += average(layer_.variance[q]), count += 1.0f;
        });
        return sum / count;
    }

  private:
    template <typename Visit>
    void for_each_neighbour(int reach, const Visit& visit) const {
        for (int y = std::max(0, y_ - reach); y <= std::min(f_.height - 1, y_ + reach); ++y)
            for (int x = std::max(0, x_ - reach); x <= std::min(f_.width - 1, x_ + reach); ++x)
                if (x != x_ || y != y_) visit(std::uint32_t(p_.index(x, y)));
    }

    float weight(const FeatureSample& s, std::uint32_t q) const {
        if (!(p_.weight[q] > 0.0f)) return 0.0f;
        const Vec3 d = f_.position[q] - s.position;
        const float off = std::fmax(std::fabs(glm::dot(d, s.normal)), std::fabs(glm::dot(d, f_.normal[q])));
        const float footprint = std::fmax(f_.frame[q].footprint, f_.frame[pixel_].footprint);
        return same_surface(off, footprint, glm::dot(s.shading_normal, f_.shading_normal[q]));
    }

    /// Of another surface: one over the squared distance, in footprints.
    float nearness(const FeatureSample& s, std::uint32_t q) const {
        if (!(p_.weight[q] > 0.0f)) return 0.0f;
        const Vec3 d = f_.position[q] - s.position;
        return 1.0f / (1.0f + glm::dot(d, d) / std::fmax(sqr(f_.frame[pixel_].footprint), 1e-30f));
    }

    std::optional<Estimate> light_of(const FeatureSample& s) const {
        const auto same = [&](std::uint32_t q) { return weight(s, q); };
        for (const int reach : {near_reach, far_reach})
            if (const auto found = light_within(reach, same)) return found;
        auto strangers = light_within(far_reach, [&](std::uint32_t q) { return nearness(s, q); });
        if (strangers)
            strangers->variance += sqr(strangers_deviation) * average(strangers->mean * strangers->mean);
        return strangers;
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
        result.variance = noise / sum + std::fmax(0.0f, average(squares / sum - result.mean * result.mean));
        return result;
    }

    const FilterFeatures& f_;
    const LayerToFilter& layer_;
    const FilterPlanes& p_;
    const FilteredLayer& filtered_;
    std::uint32_t pixel_;
    int x_, y_;
};

}  // namespace

void put_mixed_together(const FilterFeatures& f, const LayerToFilter& layer, const FilterPlanes& planes,
                        FilteredLayer& result, CancelToken cancelled) {
    const auto per_pixel = std::size_t(f.samples_per_pixel);
    std::vector<Rgb> mean(f.mixed.size());
    std::vector<float> left(f.mixed.size());
    tbb::parallel_for(std::size_t(0), f.mixed.size(), [&](std::size_t k) {
        if (cancelled.requested()) return;
        const std::uint32_t pixel = f.mixed[k];
        mean[k] = result.mean[pixel], left[k] = result.variance[pixel];
        if (!is_finite(layer.mean[pixel]) || !is_finite(layer.variance[pixel])) return;
        const MixedPixel mixed(f, layer, planes, result, pixel);
        const float own = mixed.own_variance();
        const auto r = mixed.put_together({f.samples.data() + k * per_pixel, per_pixel});
        if (!r || !(own > 0.0f) || !is_finite(r->mean)) return;
        const float share = r->variance / (r->variance + own);  // Eq. (5)
        mean[k] = r->mean + share * (layer.mean[pixel] - r->mean);
        left[k] = share * own;
    });
    cancelled.check();
    for (std::size_t k = 0; k < f.mixed.size(); ++k)
        result.mean[f.mixed[k]] = mean[k], result.variance[f.mixed[k]] = left[k];
}

}  // namespace mote::screenspace
