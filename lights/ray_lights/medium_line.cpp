#include "lights/ray_lights/medium_line.h"

#include <algorithm>
#include <cmath>

namespace mote::lights {

using namespace core;

namespace {

constexpr float deepest = 40.0f;    ///< optical depth at which a line ends
constexpr float even_depth = 0.3f;  ///< optical depth over which a homogeneous line is one cell
constexpr std::uint32_t fog_cells =
    6;  ///< of lines in homogeneous media that are deeper, or scatter unevenly
constexpr float voxels_per_cell = 2.0f;  ///< at least
constexpr int lookups = 2;               ///< at the density of a cell
constexpr float defensive_fraction =
    0.1f;  ///< of the mean of all cells that each has, whatever was seen in it

Rgb exp_minus(const Rgb& depth) { return {std::exp(-depth.x), std::exp(-depth.y), std::exp(-depth.z)}; }

/// Mean of a transmittance that falls from one value to another over an optical depth.
Rgb mean_between(const Rgb& before, const Rgb& after, const Rgb& depth) {
    Rgb mean;
    for (int i = 0; i < 3; ++i)
        mean[i] = depth[i] > 1e-3f ? (before[i] - after[i]) / depth[i] : 0.5f * (before[i] + after[i]);
    return mean;
}

std::optional<MediumLine> homogeneous_line(MediumLine line, const MediumCoefficients& c) {
    line.sigma_t = c.sigma_t, line.sigma_s = c.sigma_s, line.homogeneous = true;
    float thinnest = infinity;
    for (int i = 0; i < 3; ++i)
        if (c.sigma_s[i] > 0.0f) thinnest = std::fmin(thinnest, c.sigma_t[i]);
    line.length = std::fmin(line.length, deepest / thinnest);
    if (!(line.length > 0.0f)) return std::nullopt;
    line.cells = line.isotropic && max_component(c.sigma_t) * line.length < even_depth ? 1 : fog_cells;
    // The mean of sigma_s T over a cell: what is in its middle says little where cells are deep.
    const float cell = line.length / float(line.cells);
    Rgb before(1.0f);
    for (std::uint32_t i = 0; i < line.cells; ++i) {
        const Rgb after = exp_minus(c.sigma_t * (float(i + 1) * cell));
        line.weights[i] = average(c.sigma_s * mean_between(before, after, c.sigma_t * cell));
        before = after;
    }
    return line;
}

/// Samples the coefficients of a cell: the mean of sigma_s.
Rgb sample_cell(MediumLine& line, double t0, double t1, Rng& rng, TrackingCounters& counters) {
    Rgb mean(0.0f);
    for (int i = 0; i < lookups; ++i) {
        const double t = t0 + (t1 - t0) * (double(i) + double(rng.next_float())) / double(lookups);
        const MediumCoefficients c = line.medium->coefficients(Vec3(line.at(t)));
        mean += c.sigma_s / float(lookups);
        line.sigma_t += c.sigma_t / float(lookups * int(line.cells));
        line.sigma_s += c.sigma_s / float(lookups * int(line.cells));
    }
    counters.lookups += lookups;
    return mean;
}

std::optional<MediumLine> varying_line(MediumLine line, float voxel, Rng& rng, TrackingCounters& counters) {
    if (!std::isfinite(line.length)) return std::nullopt;
    line.cells = count_cells(line.length, voxel);
    line.transmittance[0] = Rgb(1.0f);
    float sum = 0.0f, rest = 0.0f;
    for (std::uint32_t i = 0; i < line.cells; ++i) {
        const float t0 = line.length * float(i) / float(line.cells),
                    t1 = line.length * float(i + 1) / float(line.cells);
        const Rgb before = line.transmittance[i];
        Rgb after(0.0f);
        if (!is_black(before))
            after = before * line.medium->transmittance({line.origin, line.direction, t0, t1}, rng, counters);
        line.transmittance[i + 1] = after;
        // A point in a cell counts with the transmittance to the cell's beginning: where that is black, the
        // weight is 0.
        const float there = std::fabs(average(before));  // estimates may be negative
        line.weights[i] = there > 0.0f
                              ? std::fabs(average(0.5f * (before + after) *
                                                  sample_cell(line, double(t0), double(t1), rng, counters)))
                              : 0.0f;
        sum += line.weights[i], rest += there;
    }
    // Between the samples there may be more scattering.
    const float floor = sum > 0.0f ? defensive_fraction * sum / rest : 1.0f / line.length;
    for (std::uint32_t i = 0; i < line.cells; ++i)
        line.weights[i] += floor * std::fabs(average(line.transmittance[i]));
    return line;
}

}  // namespace

std::uint32_t count_cells(float length, float voxel) {
    return std::uint32_t(std::clamp(std::ceil(length / (voxels_per_cell * voxel)), 1.0f, float(max_cells)));
}

std::size_t MediumLine::cell_of(double t) const {
    return std::min(std::size_t(std::max(t / double(length) * double(cells), 0.0)), std::size_t(cells) - 1);
}

Rgb MediumLine::scattering(double t, Rng& rng, TrackingCounters& counters) const {
    if (homogeneous) return sigma_s * exp_minus(sigma_t * float(t));
    const std::size_t cell = cell_of(t);
    const Rgb before = transmittance[cell];
    const float begin = length * float(cell) / float(cells);
    ++counters.lookups;
    const Rgb scattered = before * medium->coefficients(Vec3(at(t))).sigma_s;
    if (is_black(scattered) || !(begin < float(t))) return scattered;
    return scattered * medium->transmittance({origin, direction, begin, float(t)}, rng, counters);
}

Rgb MediumLine::phase(const Vec3& to) const {
    return isotropic ? Rgb(inv_four_pi) : medium->phase().eval(-direction, to);
}

ScatteringMedia::ScatteringMedia(std::span<const std::shared_ptr<Medium>> media) {
    for (const auto& medium : media) {
        const MediumTraits traits = medium->traits();
        if (!traits.scattering) continue;
        MediumKind kind{medium.get(), traits.homogeneous, traits.isotropic,
                        {},           traits.voxel_size,  medium->bounds()};
        if (kind.homogeneous) kind.coefficients = medium->coefficients(Vec3(0.0f));
        kinds_.push_back(kind);
    }
}

std::optional<MediumLine> make_medium_line(const Ray& ray, float t0, float t1, const MediumKind& kind,
                                           Rng& rng, TrackingCounters& counters) {
    if (!kind.homogeneous) {
        Ray part = ray;
        part.t_min = t0, part.t_max = t1;
        const auto inside = intersect(kind.bounds, part);
        if (!inside) return std::nullopt;
        t0 = inside->t0, t1 = inside->t1;  // outside of its bounds a medium is vacuum
    }
    MediumLine line;
    line.origin = ray.at(t0), line.direction = ray.direction, line.length = t1 - t0;
    line.medium = kind.medium, line.isotropic = kind.isotropic;
    if (!(line.length > 0.0f)) return std::nullopt;
    return kind.homogeneous ? homogeneous_line(line, kind.coefficients)
                            : varying_line(line, kind.voxel_size, rng, counters);
}

}  // namespace mote::lights
