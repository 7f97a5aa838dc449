#include "integrators/upbp/effort_choice.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <numeric>

#include "integrators/bidirectional/strategies.h"

namespace mote::integrators {

namespace {

/// Moments of one pass of a pixel.
struct Moments {
    double mean = 0.0, variance = 0.0;

    void add(double light, double its_variance) { mean += light, variance += its_variance; }
};

/// Density of the sample's path at these efforts, over that at full ones.
double density_left(const TrialSample& sample, const PerMerge& efforts) {
    double left = 1.0;
    for (std::size_t t = 0; t < merge_count; ++t) left -= (1.0 - efforts[t]) * sample.share[t];
    return left;
}

void add_connection(const TrialSample& sample, const PerMerge& efforts, Moments& moments) {
    const double left = density_left(sample, efforts);
    const double chance = sample.needs_ray ? double(chance_of_ray(float(sample.weight / left))) : 1.0;
    const double light = sample.light / left;
    if (chance > 0.0) moments.add(light, light * light * (1.0 / chance - 1.0));
}

Moments moments_of(const std::vector<TrialSample>& samples, const PerMerge& efforts) {
    Moments moments;
    for (std::size_t i = 0; i < samples.size();) {
        const TrialSample& first = samples[i];
        if (!first.merge) {
            add_connection(first, efforts, moments), ++i;
            continue;
        }
        double light = 0.0, squares = 0.0;
        for (; i < samples.size() && samples[i].merge && samples[i].query == first.query; ++i) {
            const double c = samples[i].light / density_left(samples[i], efforts);
            light += c, squares += c * c;
        }
        const double effort = efforts[std::size_t(*first.merge)], q = std::sqrt(effort);
        moments.add(effort * light,
                    effort * (q * light * light + (1.0 - q) * squares - effort * light * light));
    }
    return moments;
}

}  // namespace

double variance_at(const Trial& trial, const PerMerge& efforts) {
    std::vector<double> of_pixel(trial.pixels.size());
    tbb::parallel_for(std::size_t(0), of_pixel.size(), [&](std::size_t i) {
        const auto& [first, second] = trial.pixels[i];
        const Moments a = moments_of(first, efforts), b = moments_of(second, efforts);
        const double d = a.mean - b.mean;
        of_pixel[i] = 0.5 * (d * d + a.variance + b.variance);
    });
    double sum = std::accumulate(of_pixel.begin(), of_pixel.end(), 0.0);
    // Each is a path of its own, which seldom meets a pixel: its variance is its square.
    for (const TrialSample& splat : trial.splats) {
        const double light = splat.light / density_left(splat, efforts);
        sum += 0.5 * trial.share_of_splats * light * light;
    }
    return sum / trial.pairs;
}

/// One technique after the other, until none changes.
PerMerge efficient_efforts(const Trial& trial) {
    constexpr std::array<double, 4> levels{1.0, 1.0 / 4.0, 1.0 / 16.0, 1.0 / 64.0};
    PerMerge efforts = full_efforts;
    const auto cost = [&](const PerMerge& e) {
        return variance_at(trial, e) * (trial.work_of_paths + trial.work_of_merges.at(e));
    };
    double least = cost(efforts);
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t t = 0; t < merge_count; ++t) {
            if (!(trial.work_of_merges.queries[t] > 0.0)) continue;
            PerMerge other = efforts;
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
