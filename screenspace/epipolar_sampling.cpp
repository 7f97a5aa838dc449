#include "screenspace/epipolar_sampling.h"

#include <algorithm>
#include <cmath>

namespace mote::screenspace {

using namespace core;

namespace {

float brightness(const Rgb& c) { return max_component(glm::abs(c)); }

/// Does the light or the transmittance of two rays differ by more than the tolerance? Light counts relative
/// to that of either and to `mean`, whichever is more.
bool differ(const LineSample& a, const LineSample& b, float tolerance, float mean) {
    const float weight = 0.5f * (a.weight + b.weight);
    const float local =
        0.5f * (a.weight * brightness(a.light.radiance) + b.weight * brightness(b.light.radiance));
    return weight * brightness(a.light.radiance - b.light.radiance) > tolerance * std::max(mean, local) ||
           brightness(a.light.transmittance - b.light.transmittance) > tolerance;
}

/// What interpolation would say of the ray of `middle`.
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
    place(settings);
    for (LineSample& s : samples_) s = march(s.texel, task);
}

LineSample SampledLine::march(std::int32_t texel, InScatteringTask& task) {
    const Vec2d p = film(texel);
    const RayEnd end = task.end_of(p);
    LineSample sample{texel, end.weight, task.march(p, end)};
    sample.light.radiance /= end.weight;
    ++marched_, texels_[std::size_t(texel)].marched = true;
    return sample;
}

Vec2d SampledLine::film(double texel) const {
    return texels_.size() < 2 ? line_.end : line_.at(texel / double(texels_.size() - 1));
}

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

void SampledLine::place(const LineSampling& settings) {
    const auto lit = [](const LineTexel& t) { return t.run >= 0; };
    const auto first = std::find_if(texels_.begin(), texels_.end(), lit) - texels_.begin();
    const auto last = std::find_if(texels_.rbegin(), texels_.rend(), lit) - texels_.rbegin();
    const auto n = std::ptrdiff_t(texels_.size());
    if (first == n) return;
    const auto end = n - 1 - last;
    const double spacing = std::max(1.0, double(end - first) / std::max(1, settings.initial - 1));
    double next = double(first) + settings.shift * spacing;
    for (auto i = first; i <= end; ++i) {
        const LineTexel& t = texels_[std::size_t(i)];
        const bool spread = double(i) >= next;
        if (spread) next += spacing;
        if (t.run < 0) continue;
        const bool starts = i == first || texels_[std::size_t(i - 1)].run != t.run;
        const bool ends = i == end || texels_[std::size_t(i + 1)].run != t.run;
        if (!(starts || ends || spread)) continue;
        if (samples_.size() >= std::size_t(std::max(1, settings.cap))) return;
        samples_.push_back({std::int32_t(i), 0.0f, {}});
    }
}

void SampledLine::refine(const LineSampling& settings, float mean, std::size_t from, std::size_t to,
                         InScatteringTask& task, std::vector<LineSample>& added) {
    // Intervals still to look at, nearest to the line's start on top; their ends are samples by value.
    std::vector<std::pair<LineSample, LineSample>> open{{samples_[from], samples_[to]}};
    while (!open.empty()) {
        const auto [a, b] = open.back();
        open.pop_back();
        if (b.texel - a.texel < 2 || marched_ >= std::size_t(settings.cap)) continue;
        if (!differ(a, b, settings.tolerance, mean)) continue;
        const LineSample middle = march((a.texel + b.texel) / 2, task);
        added.push_back(middle);
        if (differ(middle, half_way(a, b, middle), 0.5f * settings.tolerance, mean))
            open.push_back({middle, b}), open.push_back({a, middle});
    }
}

void SampledLine::finish(const LineSampling& settings, float mean, InScatteringTask& task) {
    if (settings.tolerance > 0.0f) {
        std::vector<LineSample> added;
        for (std::size_t i = 0; i + 1 < samples_.size(); ++i)
            if (texels_[std::size_t(samples_[i].texel)].run ==
                texels_[std::size_t(samples_[i + 1].texel)].run)
                refine(settings, mean, i, i + 1, task, added);
        samples_.insert(samples_.end(), added.begin(), added.end());
        std::sort(samples_.begin(), samples_.end(), [](auto& a, auto& b) { return a.texel < b.texel; });
    }
    interpolate();
    samples_.clear();
    samples_.shrink_to_fit();
}

void SampledLine::interpolate() {
    const auto at = [&](std::int32_t i) -> LineTexel& { return texels_[std::size_t(i)]; };
    for (std::size_t i = 0; i < samples_.size(); ++i) {
        const LineSample& a = samples_[i];
        at(a.texel).light = a.light.radiance, at(a.texel).known = true;
        if (i + 1 == samples_.size() || at(samples_[i + 1].texel).run != at(a.texel).run) continue;
        const LineSample& b = samples_[i + 1];
        for (std::int32_t k = a.texel + 1; k < b.texel; ++k) {
            const float f = float(k - a.texel) / float(b.texel - a.texel);
            at(k).light = (1.0f - f) * a.light.radiance + f * b.light.radiance, at(k).known = true;
        }
    }
}

std::size_t SampledLine::memory_bytes() const {
    return texels_.capacity() * sizeof(LineTexel) + samples_.capacity() * sizeof(LineSample);
}

}  // namespace mote::screenspace
