#include "core/metrics/group_error.h"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <stdexcept>

namespace mote::core {

namespace {

using Picture = std::vector<Rgb>;

constexpr double normal_quantile = 1.96;  ///< of 95 %
constexpr double upper = 0.975;           ///< probability below the upper end of an interval of 95 %

double passes_of(std::span<const PassGroup> groups) {
    double passes = 0.0;
    for (const PassGroup& group : groups) passes += group.passes;
    return passes;
}

/// Mean over all passes but those of group `without`.
Picture mean_without(std::span<const PassGroup> groups, std::size_t without) {
    Picture result(groups[0].mean.size());
    double passes = 0.0;
    for (std::size_t g = 0; g < groups.size(); ++g) passes += g == without ? 0.0 : groups[g].passes;
    for (std::size_t p = 0; p < result.size(); ++p) {
        glm::dvec3 sum(0.0);
        for (std::size_t g = 0; g < groups.size(); ++g)
            if (g != without) sum += groups[g].passes * glm::dvec3(groups[g].mean[p]);
        result[p] = Rgb(sum / passes);
    }
    return result;
}

/// Weights of a picture to which `missing` is added. `scale`: of its variance.
RelativeWeights weights_of(Picture picture, std::span<const Rgb> missing, std::span<const Rgb> variance,
                           double scale, int width, int height) {
    for (std::size_t p = 0; p < missing.size(); ++p) picture[p] += missing[p];
    Picture scaled(variance.begin(), variance.end());
    for (Rgb& v : scaled) v *= float(scale);
    return relative_weights(picture, scaled, width, height);
}

double product(const RelativeWeights& w, std::span<const Rgb> a, std::span<const Rgb> b) {
    double sum = 0.0;
    for (std::size_t p = 0; p < a.size(); ++p)
        sum += w.weight[p] * glm::dot(glm::dvec3(a[p]), glm::dvec3(b[p])) / 3.0;
    return w.noise_norm > 0.0 ? sum / w.noise_norm : 0.0;
}

/// Y_g - X
std::vector<Picture> deviations(std::span<const PassGroup> groups) {
    const Picture mean = mean_without(groups, groups.size());
    std::vector<Picture> result;
    for (const PassGroup& group : groups) {
        result.push_back(group.mean);
        for (std::size_t p = 0; p < mean.size(); ++p) result.back()[p] -= mean[p];
    }
    return result;
}

/// tr S^2, Eq. (3)
double trace_of_square(std::span<const PassGroup> groups, const RelativeWeights& weights) {
    const std::vector<Picture> d = deviations(groups);
    const std::size_t n = groups.size();
    std::vector<std::vector<double>> gram(n, std::vector<double>(n));
    for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b <= a; ++b) gram[a][b] = gram[b][a] = product(weights, d[a], d[b]);
    double sum = 0.0, count = 0.0;
    const auto add_pairs_with = [&](std::size_t a, std::size_t b) {
        for (std::size_t c = 0; c < n; ++c)
            for (std::size_t e = c + 1; e < n; ++e) {
                if (c == a || c == b || e == a || e == b) continue;
                const double x = gram[a][c] - gram[a][e] - gram[b][c] + gram[b][e];
                sum += x * x /
                       ((1.0 / groups[a].passes + 1.0 / groups[b].passes) *
                        (1.0 / groups[c].passes + 1.0 / groups[e].passes));
                count += 1.0;
            }
    };
    for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = a + 1; b < n; ++b) add_pairs_with(a, b);
    return sum / count;
}

/// A, Eq. (2): each group weighted by the picture of the others. Y_g - X = (1 - n_g / N) (Y_g - X without g).
double noise_of(std::span<const PassGroup> groups, std::span<const Rgb> missing,
                std::span<const Rgb> variance, int width, int height) {
    const double passes = passes_of(groups);
    double sum = 0.0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const double n = groups[g].passes, rest = 1.0 - n / passes;
        const Picture others = mean_without(groups, g);
        const RelativeWeights weights = weights_of(others, missing, variance, 1.0 / rest, width, height);
        Picture difference = groups[g].mean;
        for (std::size_t p = 0; p < difference.size(); ++p) difference[p] -= others[p];
        sum += n * rest * rest * product(weights, difference, difference);
    }
    return sum / (passes * (double(groups.size()) - 1.0));
}

/// Eq. (4), without what one half of the light that is missing makes of it by chance.
double variance_of_cross_term(std::span<const PassGroup> groups, std::span<const PictureHalf> missing,
                              const RelativeWeights& weights) {
    const std::vector<Picture> d = deviations(groups);
    double sum = 0.0;
    for (std::size_t g = 0; g < groups.size(); ++g)
        sum += groups[g].passes * product(weights, d[g], missing[0].passes) *
               product(weights, d[g], missing[1].passes);
    return std::max(0.0, 4.0 * sum / (passes_of(groups) * (double(groups.size()) - 1.0)));
}

/// Mean of both halves, and its variance.
std::array<Picture, 2> mean_of(std::span<const PictureHalf> halves) {
    std::array<Picture, 2> result;
    if (halves.empty()) return result;
    for (std::size_t p = 0; p < halves[0].passes.size(); ++p) {
        result[0].push_back(0.5f * (halves[0].passes[p] + halves[1].passes[p]));
        result[1].push_back(0.25f * (halves[0].variance[p] + halves[1].variance[p]));
    }
    return result;
}

/// |m|^2 and its variance, Eq. (5), relative to the light.
SquaredError missing_light(std::span<const PictureHalf> missing, const RelativeWeights& weights) {
    const PictureHalf &a = missing[0], &b = missing[1];
    SquaredError result{.rest = product(weights, a.passes, b.passes), .norm = 1.0};
    for (std::size_t p = 0; p < weights.weight.size(); ++p) {
        const double w = weights.weight[p] / weights.noise_norm, va = mean_of_channels(a.variance[p]),
                     vb = mean_of_channels(b.variance[p]);
        result.variance +=
            w * w *
            (mean_square(glm::dvec3(b.passes[p])) * va + mean_square(glm::dvec3(a.passes[p])) * vb - va * vb);
    }
    result.variance = std::max(0.0, result.variance);
    return result;
}

/// Of the interval of a sum, one of whose variances has few degrees of freedom: by Student's t, with as many
/// as the sum has (Satterthwaite 1946).
double half_width(double known, double estimated, double freedom) {
    const double variance = known + estimated;
    if (!(estimated > 0.0) || !std::isfinite(variance)) return normal_quantile * std::sqrt(variance);
    const double share = estimated / variance;
    const boost::math::students_t ratio(freedom / (share * share));
    return boost::math::quantile(ratio, upper) * std::sqrt(variance);
}

void check(std::span<const PassGroup> groups, std::size_t pixels) {
    bool fits = groups.size() >= min_pass_groups;
    for (const PassGroup& group : groups) fits = fits && group.mean.size() == pixels && group.passes > 0.0;
    if (!fits) throw std::invalid_argument("groups of passes do not fit a picture");
}

}  // namespace

SharedNoise shared_noise(std::span<const PassGroup> groups, std::span<const Rgb> missing,
                         std::span<const Rgb> variance, int width, int height) {
    check(groups, variance.size());
    SharedNoise result;
    result.squared = noise_of(groups, missing, variance, width, height);
    if (!(result.squared > 0.0) || !std::isfinite(result.squared)) return result;
    const RelativeWeights weights =
        weights_of(mean_without(groups, groups.size()), missing, variance, 1.0, width, height);
    const double trace = result.squared * passes_of(groups), square = trace_of_square(groups, weights);
    constexpr double most = 1e6;  // pixels that differ alone: F is 1
    result.freedom = square > 0.0 ? std::clamp(trace * trace / square, 1.0, most) : most;
    const boost::math::fisher_f ratio(result.freedom, result.freedom * (double(groups.size()) - 1.0));
    result.low = result.squared * boost::math::quantile(ratio, 1.0 - upper);
    result.high = result.squared * boost::math::quantile(ratio, upper);
    return result;
}

PictureError group_error(std::span<const PassGroup> groups, std::span<const PictureHalf> missing,
                         std::span<const Rgb> variance, int width, int height) {
    const std::array<Picture, 2> light = mean_of(missing);
    const SharedNoise noise = shared_noise(groups, light[0], variance, width, height);
    Picture picture = mean_without(groups, groups.size()), spread(variance.begin(), variance.end());
    for (std::size_t p = 0; p < light[0].size(); ++p) picture[p] += light[0][p], spread[p] += light[1][p];
    const RelativeWeights weights = relative_weights(picture, spread, width, height);
    if (!(weights.noise_norm > 0.0) || !(noise.squared > 0.0)) return {};
    double rest = 0.0, within = 0.0;
    if (!missing.empty()) {
        const SquaredError light_missing = missing_light(missing, weights);
        const double cross = variance_of_cross_term(groups, missing, weights);
        rest = light_missing.rest;
        within = half_width(light_missing.variance, cross, double(groups.size()) - 1.0);
    }
    const double squared = noise.squared + rest, above = std::hypot(noise.high - noise.squared, within),
                 below = std::hypot(noise.squared - noise.low, within);
    PictureError result;
    if (!std::isfinite(above)) return result;
    result.error = std::sqrt(std::max(squared, noise.squared));
    result.low = std::sqrt(std::max(0.0, squared - below));
    result.high = std::sqrt(std::max(squared + above, noise.squared));
    result.rule_high = std::sqrt(std::max(squared, noise.squared) + above);
    return result;
}

}  // namespace mote::core
