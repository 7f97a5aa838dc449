#include "screenspace/epipolar/epipolar_picture.h"

#include <algorithm>
#include <cmath>

namespace mote::screenspace {

using namespace core;

EpipolarPicture::EpipolarPicture(EpipolarLines lines, const LineSampling& settings,
                                 const InScatteringSource& source, const Loop& loop)
    : lines_(std::move(lines)), settings_(settings) {
    std::vector<std::optional<SampledLine>> found(lines_.lines().size());
    loop(int(found.size()), [&](int i) {
        const auto task = source.start();
        found[std::size_t(i)].emplace(lines_.lines()[std::size_t(i)], settings_, *task);
    });
    sampled_.reserve(found.size());
    for (auto& line : found) {
        if (line) sampled_.push_back(std::move(*line));
    }
    if (sampled_.size() < found.size()) {  // the loop was cancelled
        sampled_.clear();
        return;
    }
    double sum = 0.0, weights = 0.0;
    for (const SampledLine& line : sampled_)
        for (const LineSample& s : line.samples()) {
            // Lines are close to each other near the light: a sample represents an area that grows with the
            // distance.
            const double weight = lines_.light_inside() ? double(s.texel) : 1.0;
            sum += weight * double(s.weight * max_component(s.light.radiance)), weights += weight;
        }
    const float mean = weights > 0.0 ? float(sum / weights) : 0.0f;
    loop(int(sampled_.size()), [&](int i) {
        const auto task = source.start();
        sampled_[std::size_t(i)].finish(settings_, mean, *task);
    });
}

/// The line's light at a position along it, where the end of the ray there continues `end`.
std::optional<Rgb> EpipolarPicture::texel_light(const SampledLine& line, double texel, const RayEnd& end,
                                                InScatteringTask& task) const {
    const auto& texels = line.texels();
    const double last = double(texels.size() - 1);
    if (texel < 0.0 || texel > last) return std::nullopt;
    const auto usable = [&](std::size_t i) {
        return texels[i].known &&
               continues(end, texels[i].distance, texels[i].surface, settings_.depth_tolerance,
                         [&] { return task.ray(line.film(double(i))); });
    };
    const auto i = std::size_t(texel), j = std::min(i + 1, texels.size() - 1);
    const auto f = float(texel - double(i));
    const bool left = usable(i), right = usable(j);
    if (left && right) return (1.0f - f) * texels[i].light + f * texels[j].light;
    if (left) return texels[i].light;
    if (right) return texels[j].light;
    return std::nullopt;
}

EpipolarPicture::Tap EpipolarPicture::tap(std::size_t line, const Vec2d& film, double spacing,
                                          const RayEnd& end, InScatteringTask& task) const {
    const SampledLine& sampled = sampled_[line];
    const double fraction = sampled.line().project(film);
    const double texel = fraction * double(sampled.texels().size() - 1);
    Tap result;
    result.distance = glm::length(film - sampled.line().at(fraction));
    if (const auto light = texel_light(sampled, texel, end, task)) {
        result.light = *light, result.weight = 1.0f;
        return result;
    }
    const double step =
        spacing * double(sampled.texels().size() - 1) / std::max(1e-9, sampled.line().length());
    for (const double k : {-1.0, 1.0, -2.0, 2.0})
        if (const auto light = texel_light(sampled, texel + k * step, end, task)) {
            const auto weight = float(std::exp(-0.5 * k * k));  // w_G of Engelhardt 2013, Sec. 9.2.3
            result.light += weight * *light, result.weight += weight;
        }
    if (result.weight > 0.0f) result.light /= result.weight;
    result.weight = std::min(result.weight, 1.0f);
    return result;
}

std::optional<Rgb> EpipolarPicture::light_at(const Vec2d& film, const RayEnd& end,
                                             InScatteringTask& task) const {
    if (end.dark()) return Rgb(0.0f);
    if (sampled_.empty()) return std::nullopt;
    const auto [before, after] = lines_.around(film);
    const auto foot = [&](std::size_t i) { return sampled_[i].line().at(sampled_[i].line().project(film)); };
    const double spacing = std::max(1.0, glm::length(foot(after) - foot(before)));
    Tap left = tap(before, film, spacing, end, task), right = tap(after, film, spacing, end, task);
    // Sec. 9.2.3: a line without valid taps is replaced by the next one outwards.
    const auto outwards = [&](std::size_t from, int step, Tap& side) {
        const auto i = lines_.next(from, step);
        if (side.weight > 0.0f || !i) return;
        const Tap outer = tap(*i, film, spacing, end, task);
        if (outer.weight > 0.0f) side = outer;
    };
    outwards(before, -1, left), outwards(after, 1, right);
    const double total = left.distance + right.distance;
    const double fraction = total > 0.0 ? right.distance / total : 0.5;
    const double a = double(left.weight) * fraction, b = double(right.weight) * (1.0 - fraction);
    if (!(a + b > 0.1)) return std::nullopt;
    return end.weight * Rgb((a * Vec3d(left.light) + b * Vec3d(right.light)) / (a + b));
}

PictureCounts EpipolarPicture::counts() const {
    PictureCounts counts;
    for (const SampledLine& line : sampled_) {
        ++counts.lines, counts.texels += line.texels().size(), counts.marched += line.marched();
        counts.bytes += line.memory_bytes() + sizeof(SampledLine);
    }
    return counts;
}

std::vector<Vec2d> EpipolarPicture::marched_at() const {
    std::vector<Vec2d> places;
    for (const SampledLine& line : sampled_)
        for (std::size_t i = 0; i < line.texels().size(); ++i)
            if (line.texels()[i].marched) places.push_back(line.film(double(i)));
    return places;
}

}  // namespace mote::screenspace
