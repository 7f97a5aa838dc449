#include "integrators/layers/pass_schedule.h"

#include <algorithm>
#include <cmath>

#include "core/metrics/relative_error.h"

namespace mote::integrators {

using namespace core;

namespace {

constexpr int block = 8;  ///< pixels along the edge of what "around them" means here
/// A part whose few passes found no variance gets another pass now and then.
constexpr std::uint32_t fewest_share = 64;

/// 1 / |mean|^2 of every block of the picture, row by row; black blocks count as a hundredth of its mean.
std::vector<double> block_weights(const Film& film, int columns, int rows) {
    const std::vector<Rgb> picture = film.beauty();
    std::vector<double> sums(std::size_t(columns * rows), 0.0), counts(sums.size(), 0.0);
    double total = 0.0;
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) {
            const auto b = std::size_t(y / block * columns + x / block);
            const double v =
                mean_of_channels(picture[std::size_t(y) * std::size_t(film.width()) + std::size_t(x)]);
            sums[b] += v, counts[b] += 1.0, total += v;
        }
    const double least = sqr(0.01 * total / double(film.pixels())) + 1e-60;
    for (std::size_t b = 0; b < sums.size(); ++b) sums[b] = 1.0 / (sqr(sums[b] / counts[b]) + least);
    return sums;
}

/// The weighted variance of the mean of each part.
std::vector<double> part_errors(const Film& film) {
    const int columns = (film.width() + block - 1) / block, rows = (film.height() + block - 1) / block;
    const std::vector<double> weights = block_weights(film, columns, rows);
    std::vector<double> errors(film.parts(), 0.0);
    for (std::size_t part = 0; part < film.parts(); ++part) {
        const std::vector<Rgb> variance = film.part_variance_of_mean(part);
        for (int y = 0; y < film.height(); ++y)
            for (int x = 0; x < film.width(); ++x)
                errors[part] +=
                    weights[std::size_t(y / block * columns + x / block)] *
                    mean_of_channels(variance[std::size_t(y) * std::size_t(film.width()) + std::size_t(x)]);
    }
    return errors;
}

}  // namespace

std::size_t next_part(const Film& film, std::span<const double> left) {
    if (film.parts() == 1) return 0;
    // Variances are compared from two passes a part on, or two of each half.
    const std::uint32_t pilot_passes = film.kept().split == PassSplit::halves ? 4 : 2;
    for (std::uint32_t n = 1; n <= pilot_passes; ++n)
        for (std::size_t part = 0; part < film.parts(); ++part)
            if (film.pass_count(part) < n) return part;
    for (std::size_t part = 0; part < film.parts(); ++part)
        if (film.pass_count(part) < film.pass_count() / fewest_share) return part;

    const std::vector<double> errors = part_errors(film);
    std::size_t best = 0;
    double most = -1.0;
    for (std::size_t part = 0; part < film.parts(); ++part) {
        const double n = film.pass_count(part), work = std::max(film.work(part), 1.0) / n;
        const double gain = left[part] * errors[part] / ((n + 1.0) * work);
        if (std::isfinite(gain) && gain > most) most = gain, best = part;
    }
    return best;
}

}  // namespace mote::integrators
