#include "integrators/upbp/effort_choice.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/math/trimmed_sum.h"
#include "integrators/bidirectional/strategies.h"

namespace mote::integrators {

namespace {

/// Moments of one pass of a pixel.
struct Moments {
    double mean = 0.0, variance = 0.0;

    void add(double light, double its_variance) { mean += light, variance += its_variance; }
};

/// Density of the sample's path at these efforts, over that at full ones.
double density_left(const TrialSample& sample, const PerTechnique& efforts) {
    double left = 1.0;
    for (std::size_t t = 0; t < technique_count; ++t) left -= (1.0 - efforts[t]) * sample.share[t];
    return left;
}

/// Samples of one query, or of the connections of one vertex, from sample i on; i is then behind them.
void add_query(const std::vector<TrialSample>& samples, std::size_t& i, const PerTechnique& efforts,
               Moments& moments) {
    const TrialSample& first = samples[i];
    double light = 0.0, squares = 0.0, of_rays = 0.0;
    for (; i < samples.size(); ++i) {
        const TrialSample& s = samples[i];
        if (s.technique != first.technique || s.query != first.query) break;
        const double left = density_left(s, efforts), c = s.light / left;
        const double chance = s.needs_ray ? double(chance_of_ray(float(s.weight / left))) : 1.0;
        light += c, squares += c * c;
        if (chance > 0.0) of_rays += c * c * (1.0 / chance - 1.0);
    }
    const double e = efforts[*first.technique], q = std::sqrt(e);
    const double moment = *first.technique == by_connection
                              ? e * (light * light + of_rays)                   // Eq. (3)
                              : e * (q * light * light + (1.0 - q) * squares);  // Eq. (2)
    moments.add(e * light, moment - e * e * light * light);
}

Moments moments_of(const std::vector<TrialSample>& samples, const PerTechnique& efforts) {
    Moments moments;
    for (std::size_t i = 0; i < samples.size();)
        if (samples[i].technique)
            add_query(samples, i, efforts, moments);
        else
            moments.add(samples[i].light / density_left(samples[i], efforts), 0.0), ++i;
    return moments;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

void set_weights_by_light(Trial& trial) {
    constexpr std::size_t part = 8, parts = 8;
    const std::size_t n = trial.pixels.size() / std::size_t(trial.pairs);
    std::vector<double> light((n + part - 1) / part);  // sums
    for (std::size_t i = 0; i < trial.pixels.size(); ++i)
        for (const auto& samples : trial.pixels[i])
            light[i % n / part] += moments_of(samples, full_efforts).mean;
    for (const TrialSplat& splat : trial.splats)
        light[splat.pixel / part] += splat.sample.light * trial.share_of_splats;
    for (std::size_t p = 0; p < light.size(); ++p)
        light[p] /= 2.0 * trial.pairs * double(std::min(n, (p + 1) * part) - p * part);
    const double least = 0.1 * median(light);
    trial.weights.clear();
    for (std::size_t first = 0; first < light.size(); first += parts) {
        const std::size_t last = std::min(first + parts, light.size());
        const double here =
            median({light.begin() + std::ptrdiff_t(first), light.begin() + std::ptrdiff_t(last)});
        trial.weights.resize(std::min(n, last * part), 1.0 / std::max(here * here + least * least, 1e-30));
    }
}

double variance_at(const Trial& trial, const PerTechnique& efforts, double outliers) {
    std::vector<double> of_pixel(trial.pixels.size());
    tbb::parallel_for(std::size_t(0), of_pixel.size(), [&](std::size_t i) {
        const auto& [first, second] = trial.pixels[i];
        const Moments a = moments_of(first, efforts), b = moments_of(second, efforts);
        const double d = a.mean - b.mean;
        of_pixel[i] = 0.5 * trial.weights[i % trial.weights.size()] * (d * d + a.variance + b.variance);
    });
    double sum = core::sum_without_largest(of_pixel, std::size_t(outliers * double(of_pixel.size())));
    // Each is a path of its own, which seldom meets a pixel: its variance is its square.
    for (const TrialSplat& splat : trial.splats) {
        const double light = splat.sample.light / density_left(splat.sample, efforts);
        sum += 0.5 * trial.share_of_splats * trial.weights[splat.pixel] * light * light;
    }
    return sum / trial.pairs;
}

/// One technique after the other, until none changes.
PerTechnique efficient_efforts(const Trial& trial) {
    constexpr std::array<double, 4> levels{1.0, 1.0 / 4.0, 1.0 / 16.0, 1.0 / 64.0};
    constexpr double outliers = 0.002;  // one bright path in a few thousand decides nothing
    PerTechnique efforts = full_efforts;
    const auto cost = [&](const PerTechnique& e) {
        return variance_at(trial, e, outliers) * (trial.work_of_paths + trial.work.at(e));
    };
    double least = cost(efforts);
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t t = 0; t < technique_count; ++t) {
            if (!trial.work.uses(t)) continue;
            PerTechnique other = efforts;
            for (const double level : levels) {
                if (level == efforts[t]) continue;
                other[t] = level;
                const double its = cost(other);
                if (its < least) least = its, efforts = other, changed = true;
            }
        }
    }
    return efforts;
}

}  // namespace mote::integrators
