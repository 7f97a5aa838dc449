#include "screenspace/epipolar/epipolar_sampling.h"

#include <algorithm>
#include <cmath>

namespace mote::screenspace {

using namespace core;

namespace {

float brightness(const Rgb& c) { return max_component(glm::abs(c)); }

/// True if the light or the transmittance of two rays differs by more than the tolerance. Light counts
/// relative to that of either and to `mean`, whichever is more.
bool differ(const LineSample& a, const LineSample& b, float tolerance, float mean) {
    const float weight = 0.5f * (a.weight + b.weight);
    const float local =
        0.5f * (a.weight * brightness(a.light.radiance) + b.weight * brightness(b.light.radiance));
    return weight * brightness(a.light.radiance - b.light.radiance) > tolerance * std::max(mean, local) ||
           brightness(a.light.transmittance - b.light.transmittance) > tolerance;
}

/// Sample that interpolation between a and b gives instead of `middle`.
LineSample half_way(const LineSample& a, const LineSample& b, const LineSample& middle) {
    return {middle.texel,
            middle.weight,
            {0.5f * (a.light.radiance + b.light.radiance),
             0.5f * (a.light.transmittance + b.light.transmittance)}};
}

}  // namespace

SampledLine::SampledLine(const EpipolarLine& line, const LineSampling& settings, InScatteringTask& task)
    : line_(line), texels_(std::size_t(std::ceil(settings.texels * line.length())) + 1) {
    find_runs(settings.depth_tolerance, task);
    march(settings, task);
}

/// True for the first texel of a run and for the last: they are marched, spread sample or not.
bool SampledLine::ends_run(std::size_t texel) const {
    const std::int32_t run = texels_[texel].run;
    const bool first = texel == 0 || texels_[texel - 1].run != run;
    const bool last = texel + 1 == texels_.size() || texels_[texel + 1].run != run;
    return run >= 0 && (first || last);
}

LineSample SampledLine::march_texel(std::size_t texel, InScatteringTask& task) {
    const Vec2d p = film(double(texel));
    const RayEnd end = task.end_of(p);
    LineSample sample{texel, end.weight, task.march(p, end)};
    sample.light.radiance /= end.weight;
    ++marched_, texels_[texel].marched = true;
    return sample;
}

Vec2d SampledLine::film(double texel) const {
    return texels_.size() < 2 ? line_.end : line_.at(texel / double(texels_.size() - 1));
}

/// Where neighbours along the line differ in depth (Engelhardt 2013, Sec. 9.2.2).
void SampledLine::find_runs(float tolerance, InScatteringTask& task) {
    RayEnd previous;
    std::int32_t run = -1;
    for (std::size_t i = 0; i < texels_.size(); ++i) {
        const RayEnd end = task.end_of(film(double(i)));
        LineTexel& texel = texels_[i];
        texel.distance = end.distance, texel.surface = end.surface;
        if (!end.dark()) {
            const bool same = continues(previous, end.distance, end.surface, tolerance,
                                        [&] { return task.ray(film(double(i))); }) ||
                              continues(end, previous.distance, previous.surface, tolerance,
                                        [&] { return task.ray(film(double(i) - 1.0)); });
            texel.run = same ? run : ++run;
        }
        previous = end;
    }
}

/// Flag of each texel: true for the few samples that would do without occluders (Engelhardt 2013,
/// Sec. 9.2.1).
std::vector<bool> SampledLine::spread(const LineSampling& settings) const {
    std::vector<bool> wanted(texels_.size(), false);
    const auto lit = [](const LineTexel& t) { return t.run >= 0; };
    const auto first = std::find_if(texels_.begin(), texels_.end(), lit) - texels_.begin();
    const auto last = std::find_if(texels_.rbegin(), texels_.rend(), lit) - texels_.rbegin();
    const auto n = std::ptrdiff_t(texels_.size());
    if (first == n) return wanted;
    const double length = double(n - 1 - last - first);
    const double spacing = std::max(1.0, length / std::max(1, settings.initial - 1));
    const double begin = double(first) + settings.shift * spacing;
    const int count = int(std::floor(length / spacing - settings.shift)) + 1;
    for (int i = 0; i < count; ++i)
        if (const double at = std::ceil(begin + i * spacing); at < double(n)) wanted[std::size_t(at)] = true;
    return wanted;
}

void SampledLine::march(const LineSampling& settings, InScatteringTask& task) {
    const std::vector<bool> wanted = spread(settings);
    for (std::size_t i = 0; i < texels_.size(); ++i) {
        // One directly before and one directly after every discontinuity: Sec. 9.2.2.
        if (texels_[i].run < 0 || !(wanted[i] || ends_run(i))) continue;
        if (samples_.size() >= std::size_t(std::max(1, settings.cap))) return;
        samples_.push_back(march_texel(i, task));
    }
}

void SampledLine::refine(const LineSampling& settings, float mean, std::size_t from, std::size_t to,
                         InScatteringTask& task, std::vector<LineSample>& added) {
    // Intervals still to refine, nearest to the line's start on top; their ends are samples by value.
    std::vector<std::pair<LineSample, LineSample>> open{{samples_[from], samples_[to]}};
    while (!open.empty()) {
        const auto [a, b] = open.back();
        open.pop_back();
        if (b.texel - a.texel < 2 || marched_ >= std::size_t(settings.cap)) continue;
        if (!differ(a, b, settings.tolerance, mean)) continue;
        const LineSample middle = march_texel((a.texel + b.texel) / 2, task);
        added.push_back(middle);
        if (differ(middle, half_way(a, b, middle), 0.5f * settings.tolerance, mean))
            open.push_back({middle, b}), open.push_back({a, middle});
    }
}

void SampledLine::finish(const LineSampling& settings, float mean, InScatteringTask& task) {
    if (settings.tolerance > 0.0f) {
        std::vector<LineSample> added;
        for (std::size_t i = 0; i + 1 < samples_.size(); ++i)
            if (texels_[samples_[i].texel].run == texels_[samples_[i + 1].texel].run)
                refine(settings, mean, i, i + 1, task, added);
        samples_.insert(samples_.end(), added.begin(), added.end());
        std::sort(samples_.begin(), samples_.end(), [](auto& a, auto& b) { return a.texel < b.texel; });
    }
    interpolate();
    samples_.clear();
    samples_.shrink_to_fit();
}

void SampledLine::interpolate() {
    for (std::size_t i = 0; i < samples_.size(); ++i) {
        const LineSample& a = samples_[i];
        LineTexel& own = texels_[a.texel];
        own.light = a.light.radiance, own.known = true;
        if (i + 1 == samples_.size() || texels_[samples_[i + 1].texel].run != own.run) continue;
        const LineSample& b = samples_[i + 1];
        for (std::size_t k = a.texel + 1; k < b.texel; ++k) {
            const float f = float(k - a.texel) / float(b.texel - a.texel);
            texels_[k].light = (1.0f - f) * a.light.radiance + f * b.light.radiance, texels_[k].known = true;
        }
    }
}

std::size_t SampledLine::memory_bytes() const {
    return texels_.capacity() * sizeof(LineTexel) + samples_.capacity() * sizeof(LineSample);
}

}  // namespace mote::screenspace
