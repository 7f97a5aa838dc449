#include "integrators/upbp/effort_choice.h"

#include <tbb/parallel_for.h>

#include "integrators/bidirectional/strategies.h"

namespace mote::integrators {

namespace {

/// Moments of one pass of a pixel.
struct Moments {
    double mean = 0.0, variance = 0.0;

    /// Light that is there with this probability.
    void add(double light, double probability) {
        mean += probability * light;
        variance += probability * (1.0 - probability) * light * light;
    }
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
    if (chance > 0.0) moments.add(sample.light / (left * chance), chance);
}

Moments moments_of(const std::vector<TrialSample>& samples, const PerMerge& efforts) {
    Moments moments;
    for (std::size_t i = 0; i < samples.size();) {
        const TrialSample& first = samples[i];
        if (!first.merge) {
            add_connection(first, efforts, moments), ++i;
            continue;
        }
        double light = 0.0;
        for (; i < samples.size() && samples[i].merge && samples[i].query == first.query; ++i)
            light += samples[i].light / density_left(samples[i], efforts);
        moments.add(light, efforts[std::size_t(*first.merge)]);
    }
    return moments;
}

double work_at(const Trial& trial, const PerMerge& efforts) {
    double work = trial.work_of_paths;
    for (std::size_t t = 0; t < merge_count; ++t) work += efforts[t] * trial.work_of_merges[t];
    return work;
}

}  // namespace

double variance_at(const Trial& trial, const PerMerge& efforts) {
    std::vector<double> of_row(trial.rows.size());
    tbb::parallel_for(std::size_t(0), trial.rows.size(), [&](std::size_t row) {
        for (const TrialPixel& pixel : trial.rows[row]) {
            const Moments a = moments_of(pixel[0], efforts), b = moments_of(pixel[1], efforts);
            const double d = a.mean - b.mean;
            of_row[row] += 0.5 * (d * d + a.variance + b.variance);
        }
    });
    double sum = 0.0;
    for (const double variance : of_row) sum += variance;
    // Each is a path of its own, which seldom meets a pixel: its variance is its square.
    for (const TrialSample& splat : trial.splats) {
        const double light = splat.light / density_left(splat, efforts);
        sum += 0.5 * trial.share_of_splats * light * light;
    }
    return sum;
}

/// One technique after the other, until none changes.
PerMerge efficient_efforts(const Trial& trial) {
    constexpr std::array<double, 5> levels{1.0, 1.0 / 4.0, 1.0 / 16.0, 1.0 / 64.0, 1.0 / 256.0};
    PerMerge efforts = full_efforts;
    const auto cost = [&](const PerMerge& e) { return variance_at(trial, e) * work_at(trial, e); };
    double least = cost(efforts);
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t t = 0; t < merge_count; ++t)
            for (const double level : levels) {
                if (!(trial.work_of_merges[t] > 0.0)) continue;
                PerMerge other = efforts;
                other[t] = level;
                const double its = cost(other);
                if (its < least) least = its, efforts = other, changed = true;
            }
    }
    return efforts;
}

}  // namespace mote::integrators
