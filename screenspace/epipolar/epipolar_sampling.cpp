#include "screenspace/epipolar/epipolar_sampling.h"

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
    find_spread(settings);
}

bool SampledLine::lit(double texel) const {
    if (!(texel >= 0.0 && texel <= double(texels_.size() - 1))) return false;
    const auto run = texels_[std::size_t(std::floor(texel))].run;
    return run >= 0 && run == texels_[std::size_t(std::ceil(texel))].run;
}

bool SampledLine::ends_run(std::ptrdiff_t texel) const {
    const auto run = [&](std::ptrdiff_t i) {
        return i < 0 || i >= std::ptrdiff_t(texels_.size()) ? -1 : texels_[std::size_t(i)].run;
    };
    return run(texel) >= 0 && (run(texel - 1) != run(texel) || run(texel + 1) != run(texel));
}

void SampledLine::add(double texel, const RayEnd& end, const MarchedRay& light) {
    LineSample sample{float(texel), end.weight, light};
    sample.light.radiance /= end.weight;
    samples_.push_back(sample);
    ++marched_, at(sample.texel).marched = true;
}

void SampledLine::march(const LineSampling& settings, InScatteringTask& task) {
    const std::size_t added = samples_.size();
    place(settings);
    for (std::size_t i = added; i < samples_.size(); ++i) samples_[i] = march_texel(samples_[i].texel, task);
    sort_samples();
}

LineSample SampledLine::march_texel(float texel, InScatteringTask& task) {
    const Vec2d p = film(double(texel));
    const RayEnd end = task.end_of(p);
    LineSample sample{texel, end.weight, task.march(p, end)};
    sample.light.radiance /= end.weight;
    ++marched_, at(texel).marched = true;
    return sample;
}

void SampledLine::sort_samples() {
    std::sort(samples_.begin(), samples_.end(), [](auto& a, auto& b) { return a.texel < b.texel; });
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

/// The few samples that would do without occluders (Engelhardt 2013, Sec. 9.2.1).
void SampledLine::find_spread(const LineSampling& settings) {
    const auto lit = [](const LineTexel& t) { return t.run >= 0; };
    const auto first = std::find_if(texels_.begin(), texels_.end(), lit) - texels_.begin();
    const auto last = std::find_if(texels_.rbegin(), texels_.rend(), lit) - texels_.rbegin();
    const auto n = std::ptrdiff_t(texels_.size());
    if (first == n) return;
    const double length = double(n - 1 - last - first);
    spread_.spacing = std::max(1.0, length / std::max(1, settings.initial - 1));
    spread_.first = double(first) + settings.shift * spread_.spacing;
    spread_.count = int(std::floor(length / spread_.spacing - settings.shift)) + 1;
}

void SampledLine::place(const LineSampling& settings) {
    std::vector<bool> wanted(std::size_t(spread_.count), true);
    for (const LineSample& s : samples_) wanted[std::size_t(spread_.nearest(double(s.texel)))] = false;
    const auto n = std::ptrdiff_t(texels_.size());
    int next = 0;
    for (std::ptrdiff_t i = 0; i < n; ++i) {
        bool spread = false;
        for (; next < spread_.count && spread_.place(next) <= double(i); ++next)
            spread |= wanted[std::size_t(next)];
        // One directly before and one directly after every discontinuity: Sec. 9.2.2.
        if (texels_[std::size_t(i)].run < 0 || !(spread || ends_run(i))) continue;
        if (samples_.size() >= std::size_t(std::max(1, settings.cap))) return;
        samples_.push_back({float(i), 0.0f, {}});
    }
}

void SampledLine::refine(const LineSampling& settings, float mean, std::size_t from, std::size_t to,
                         InScatteringTask& task, std::vector<LineSample>& added) {
    // Intervals still to look at, nearest to the line's start on top; their ends are samples by value.
    std::vector<std::pair<LineSample, LineSample>> open{{samples_[from], samples_[to]}};
    while (!open.empty()) {
        const auto [a, b] = open.back();
        open.pop_back();
        if (b.texel - a.texel < 2.0f || marched_ >= std::size_t(settings.cap)) continue;
        if (!differ(a, b, settings.tolerance, mean)) continue;
        const LineSample middle = march_texel(std::floor(0.5f * (a.texel + b.texel)), task);
        added.push_back(middle);
        if (differ(middle, half_way(a, b, middle), 0.5f * settings.tolerance, mean))
            open.push_back({middle, b}), open.push_back({a, middle});
    }
}

void SampledLine::finish(const LineSampling& settings, float mean, InScatteringTask& task) {
    if (settings.tolerance > 0.0f) {
        std::vector<LineSample> added;
        for (std::size_t i = 0; i + 1 < samples_.size(); ++i)
            if (at(samples_[i].texel).run == at(samples_[i + 1].texel).run)
                refine(settings, mean, i, i + 1, task, added);
        samples_.insert(samples_.end(), added.begin(), added.end());
        sort_samples();
    }
    interpolate();
    samples_.clear();
    samples_.shrink_to_fit();
}

void SampledLine::interpolate() {
    for (std::size_t i = 0; i < samples_.size(); ++i) {
        const LineSample& a = samples_[i];
        LineTexel& own = at(a.texel);
        if (!own.known || a.texel == std::floor(a.texel)) own.light = a.light.radiance, own.known = true;
        if (i + 1 == samples_.size() || at(samples_[i + 1].texel).run != own.run) continue;
        const LineSample& b = samples_[i + 1];
        for (float k = std::ceil(a.texel); k < b.texel; ++k) {
            const float f = (k - a.texel) / (b.texel - a.texel);
            at(k).light = (1.0f - f) * a.light.radiance + f * b.light.radiance, at(k).known = true;
        }
    }
}

std::size_t SampledLine::memory_bytes() const {
    return texels_.capacity() * sizeof(LineTexel) + samples_.capacity() * sizeof(LineSample);
}

}  // namespace mote::screenspace
