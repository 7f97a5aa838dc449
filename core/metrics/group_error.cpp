#include "core/metrics/group_error.h"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <stdexcept>

namespace mote::core {

namespace {

using Picture = std::vector<Rgb>;
/// Digits enough, in a third of the time.
using InDoubles = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

constexpr double upper = 0.975;      ///< probability below the upper end of an interval of 95 %
constexpr double max_freedom = 1e6;  ///< of variables that are normal, and of noise that pixels do not share

double passes_of(std::span<const PassGroup> groups) {
    double passes = 0.0;
    for (const PassGroup& group : groups) passes += group.passes;
    return passes;
}

/// X
Picture mean_of(std::span<const PassGroup> groups) {
    Picture result(groups[0].mean.size());
    const double passes = passes_of(groups);
    for (std::size_t p = 0; p < result.size(); ++p) {
        glm::dvec3 sum(0.0);
        for (const PassGroup& group : groups) sum += group.passes * glm::dvec3(group.mean[p]);
        result[p] = Rgb(sum / passes);
    }
    return result;
}

double product(const RelativeWeights& w, std::span<const Rgb> a, std::span<const Rgb> b) {
    double sum = 0.0;
    for (std::size_t p = 0; p < a.size(); ++p) sum += w.weight[p] * mean_product(a[p], b[p]);
    return w.norm > 0.0 ? sum / w.norm : 0.0;
}

/// Y_g - X
std::vector<Picture> deviations(std::span<const PassGroup> groups) {
    const Picture mean = mean_of(groups);
    std::vector<Picture> result;
    for (const PassGroup& group : groups) {
        result.push_back(group.mean);
        for (std::size_t p = 0; p < mean.size(); ++p) result.back()[p] -= mean[p];
    }
    return result;
}

using Gram = std::vector<std::vector<double>>;

/// <Y_a - X, Y_b - X>; `d`: the deviations.
Gram products(std::span<const Picture> d, const RelativeWeights& weights) {
    Gram gram(d.size(), std::vector<double>(d.size()));
    for (std::size_t a = 0; a < d.size(); ++a)
        for (std::size_t b = 0; b <= a; ++b) gram[a][b] = gram[b][a] = product(weights, d[a], d[b]);
    return gram;
}

/// tr S^2, Eq. (3)
double trace_of_square(std::span<const PassGroup> groups, const Gram& gram) {
    const std::size_t n = groups.size();
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

/// Eq. (4), without what one half of the light that is missing makes of it by chance.
double variance_of_cross_term(std::span<const PassGroup> groups, std::span<const Picture> d,
                              std::span<const PictureHalf> missing, const RelativeWeights& weights) {
    double sum = 0.0;
    for (std::size_t g = 0; g < groups.size(); ++g)
        sum += groups[g].passes * product(weights, d[g], missing[0].passes) *
               product(weights, d[g], missing[1].passes);
    return std::max(0.0, 4.0 * sum / (passes_of(groups) * (double(groups.size()) - 1.0)));
}

/// |m|^2 and its variance, Eq. (5), relative to the light.
SquaredError missing_light(std::span<const PictureHalf> missing, const RelativeWeights& weights) {
    const PictureHalf &a = missing[0], &b = missing[1];
    SquaredError result{.rest = product(weights, a.passes, b.passes), .norm = 1.0};
    for (std::size_t p = 0; p < weights.weight.size(); ++p) {
        const double w = weights.weight[p] / weights.norm, va = mean_of_channels(a.variance[p]),
                     vb = mean_of_channels(b.variance[p]);
        result.variance +=
            w * w *
            (mean_square(glm::dvec3(b.passes[p])) * va + mean_square(glm::dvec3(a.passes[p])) * vb - va * vb);
    }
    result.variance = std::max(0.0, result.variance);
    return result;
}

/// Quantiles of a variable at the middles of equal shares.
constexpr std::size_t shares = 200;
template <typename Distribution>
std::vector<double> quantiles(const Distribution& distribution, double scale) {
    std::vector<double> result;
    for (std::size_t i = 0; i < shares; ++i)
        result.push_back(scale * boost::math::quantile(distribution, (double(i) + 0.5) / double(shares)));
    return result;
}

std::vector<double> quantiles(const SharedNoise& noise) {
    return quantiles(
        boost::math::fisher_f_distribution<double, InDoubles>(noise.freedom, noise.freedom_of_mean),
        noise.squared);
}

/// A variable of mean 0, one of whose variances has few degrees of freedom, has Student's t, with as many as
/// their sum has (Satterthwaite 1946).
std::vector<double> quantiles(double known, double estimated, double freedom) {
    const double variance = known + estimated, share = variance > 0.0 ? estimated / variance : 0.0;
    const double of_sum = std::min(freedom / (share * share), max_freedom);
    return quantiles(boost::math::students_t_distribution<double, InDoubles>(of_sum), std::sqrt(variance));
}

/// Ends of the middle 95 % of x + y.
std::array<double, 2> middle_of_sums(const std::vector<double>& x, const std::vector<double>& y) {
    std::vector<double> sums;
    sums.reserve(x.size() * y.size());
    for (const double a : x)
        for (const double b : y) sums.push_back(a + b);
    const auto at = [&](double share) {
        const auto place = sums.begin() + std::ptrdiff_t(share * double(sums.size()));
        std::nth_element(sums.begin(), place, sums.end());
        return *place;
    };
    return {at(1.0 - upper), at(upper)};
}

void check(std::span<const PassGroup> groups, std::size_t pixels) {
    bool fits = groups.size() >= min_pass_groups;
    for (const PassGroup& group : groups) fits = fits && group.mean.size() == pixels && group.passes > 0.0;
    if (!fits) throw std::invalid_argument("groups of passes do not fit a picture");
}

/// Median over the groups, pixel by pixel.
std::vector<double> medians(const std::vector<std::vector<double>>& groups) {
    std::vector<double> result(groups[0].size()), here(groups.size());
    for (std::size_t p = 0; p < result.size(); ++p) {
        for (std::size_t g = 0; g < groups.size(); ++g) here[g] = groups[g][p];
        std::sort(here.begin(), here.end());
        result[p] = 0.5 * (here[(here.size() - 1) / 2] + here[here.size() / 2]);
    }
    return result;
}

SharedNoise noise_of(std::span<const PassGroup> groups, std::span<const Picture> d,
                     const RelativeWeights& weights) {
    const Gram gram = products(d, weights);
    const double rest = double(groups.size()) - 1.0;
    double sum = 0.0;
    for (std::size_t g = 0; g < groups.size(); ++g) sum += groups[g].passes * gram[g][g];
    const double trace = sum / rest, square = trace_of_square(groups, gram);
    SharedNoise result;
    result.squared = trace / passes_of(groups);
    result.freedom = square > 0.0 ? std::clamp(trace * trace / square, 1.0, max_freedom) : max_freedom;
    result.freedom_of_mean = result.freedom * rest;
    return result;
}

}  // namespace

SharedNoise shared_noise(std::span<const PassGroup> groups, const RelativeWeights& weights) {
    check(groups, weights.weight.size());
    return noise_of(groups, deviations(groups), weights);
}

RelativeWeights weights_of_groups(std::span<const PassGroup> groups, std::span<const Rgb> missing, int width,
                                  int height) {
    const std::size_t pixels = groups.empty() ? 0 : groups[0].mean.size();
    check(groups, pixels);
    if (!missing.empty() && missing.size() != pixels)
        throw std::invalid_argument("light that is missing does not fit a picture");
    std::vector<std::vector<double>> own, around;
    for (const PassGroup& group : groups) {
        Picture light = group.mean;
        for (std::size_t p = 0; p < missing.size(); ++p) light[p] += missing[p];
        around.push_back(light_squares(light, {}, width, height));
        std::vector<double>& squares = own.emplace_back();
        for (const Rgb& c : light) squares.push_back(mean_square(c));
    }
    const std::vector<double> light = medians(own);
    RelativeWeights result{weights_of_squares(medians(around))};
    for (std::size_t p = 0; p < pixels; ++p) result.norm += result.weight[p] * light[p];
    return result;
}

PictureError group_error(std::span<const PassGroup> groups, std::span<const PictureHalf> missing,
                         const RelativeWeights& weights) {
    check(groups, weights.weight.size());
    if (!(weights.norm > 0.0)) return {};
    const std::vector<Picture> d = deviations(groups);
    const SharedNoise noise = noise_of(groups, d, weights);
    if (!(noise.squared > 0.0) || !std::isfinite(noise.squared)) return {};
    double rest = 0.0, known = 0.0, cross = 0.0;
    if (!missing.empty()) {
        const SquaredError light = missing_light(missing, weights);
        rest = light.rest, known = light.variance;
        cross = variance_of_cross_term(groups, d, missing, weights);
        if (!std::isfinite(rest + known + cross)) return {};
    }
    const auto [low, high] =
        middle_of_sums(quantiles(noise), quantiles(known, cross, double(groups.size()) - 1.0));
    PictureError result;
    result.error = std::sqrt(noise.squared + std::max(rest, 0.0));
    result.low = std::sqrt(std::max(0.0, rest + low));
    result.high = std::sqrt(std::max(rest + high, noise.squared));
    result.rule_high = std::sqrt(std::max(rest, 0.0) + std::max(high, noise.squared));
    return result;
}

}  // namespace mote::core
