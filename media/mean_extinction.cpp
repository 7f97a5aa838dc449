#include "media/mean_extinction.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace mote::media {

using namespace core;

namespace {

/// A pyramid takes 8/7 of its finest level.
std::size_t cells_within(std::size_t bytes, int channels) {
    return std::max<std::size_t>(1, bytes / (sizeof(float) * std::size_t(channels)) * 7 / 8);
}

glm::ivec3 cells_of(const Vec3& extent, float edge) {
    return glm::max(glm::ivec3(glm::ceil(extent / edge - 1e-4f)), glm::ivec3(1));
}

double count_of(const glm::ivec3& size) { return double(size.x) * double(size.y) * double(size.z); }

}  // namespace

MeanExtinction::MeanExtinction(const Medium& source, const Bounds3& box, std::size_t max_bytes)
    : medium_(source), box_(box) {
    const MediumTraits traits = source.traits();
    homogeneous_ = traits.homogeneous || !std::isfinite(traits.voxel_size) || box.empty();
    channels_ = traits.chromatic ? 3 : 1;
    if (homogeneous_) {
        if (!box.empty()) constant_ = source.coefficients(box.center()).sigma_t;
        return;
    }
    const Vec3 extent = glm::max(box.diagonal(), Vec3(traits.voxel_size));
    cell_size_ = traits.voxel_size;
    const double allowed = double(cells_within(max_bytes, channels_));
    while (count_of(cells_of(extent, cell_size_)) > allowed) cell_size_ *= 1.1f;
    levels_.push_back({cells_of(extent, cell_size_), cell_size_, {}});
    fill_finest(levels_.back());
    while (glm::any(glm::greaterThan(levels_.back().size, glm::ivec3(1))))
        levels_.push_back(coarser(levels_.back()));
    const Level& top = levels_.back();
    total_ = value(top, glm::ivec3(0)) * (top.cell * top.cell * top.cell);
}

void MeanExtinction::fill_finest(Level& level) const {
    level.values.resize(std::size_t(count_of(level.size)) * std::size_t(channels_));
    // About one sample a voxel, two along the edge of a cell at least.
    const int along = std::max(2, int(std::ceil(level.cell / medium_.traits().voxel_size)));
    const double per_cell = 1.0 / double(along * along * along);
    tbb::parallel_for(0, level.size.z, [&](int z) {
        for (int y = 0; y < level.size.y; ++y)
            for (int x = 0; x < level.size.x; ++x) {
                Vec3d sum(0.0);
                for (int s = 0; s < along * along * along; ++s) {
                    const Vec3 within =
                        (Vec3(float(s % along), float(s / along % along), float(s / (along * along))) +
                         0.5f) /
                        float(along);
                    const Vec3 p = box_.lower + level.cell * (Vec3(float(x), float(y), float(z)) + within);
                    if (box_.contains(p))
                        sum += Vec3d(medium_.coefficients(p).sigma_t);  // cells may stick out
                }
                const std::size_t i = (std::size_t(z) * std::size_t(level.size.y) + std::size_t(y)) *
                                          std::size_t(level.size.x) +
                                      std::size_t(x);
                for (int c = 0; c < channels_; ++c)
                    level.values[i * std::size_t(channels_) + std::size_t(c)] = float(sum[c] * per_cell);
            }
    });
}

Rgb MeanExtinction::value(const Level& level, const glm::ivec3& cell) const {
    if (glm::any(glm::lessThan(cell, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(cell, level.size)))
        return Rgb(0.0f);
    const std::size_t i =
        ((std::size_t(cell.z) * std::size_t(level.size.y) + std::size_t(cell.y)) * std::size_t(level.size.x) +
         std::size_t(cell.x)) *
        std::size_t(channels_);
    return channels_ == 1 ? Rgb(level.values[i])
                          : Rgb(level.values[i], level.values[i + 1], level.values[i + 2]);
}

MeanExtinction::Level MeanExtinction::coarser(const Level& fine) const {
    Level level{(fine.size + 1) / 2, 2.0f * fine.cell, {}};
    level.values.resize(std::size_t(count_of(level.size)) * std::size_t(channels_));
    std::size_t i = 0;
    for (int z = 0; z < level.size.z; ++z)
        for (int y = 0; y < level.size.y; ++y)
            for (int x = 0; x < level.size.x; ++x) {
                Rgb sum(0.0f);
                for (int corner = 0; corner < 8; ++corner)
                    // Eighths of each, since eight of the largest values have no sum.
                    sum += 0.125f * value(fine, 2 * glm::ivec3(x, y, z) +
                                                    glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2));
                for (int c = 0; c < channels_; ++c) level.values[i++] = sum[c];
            }
    return level;
}

Rgb MeanExtinction::interpolate(const Level& level, const Vec3& p) const {
    const Vec3 q = glm::clamp((p - box_.lower) / level.cell - 0.5f, Vec3(-2.0f), Vec3(level.size) + 1.0f);
    const Vec3 base = glm::floor(q), f = q - base;
    const glm::ivec3 cell(base);
    Rgb sum(0.0f);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
        const float weight =
            (step.x ? f.x : 1.0f - f.x) * (step.y ? f.y : 1.0f - f.y) * (step.z ? f.z : 1.0f - f.z);
        if (weight > 0.0f) sum += weight * value(level, cell + step);
    }
    return sum;
}

Rgb MeanExtinction::mean(const Vec3& p, float radius) const {
    if (homogeneous_) return constant_;
    const float ball = 4.0f / 3.0f * pi * radius * radius * radius;
    return ball > 0.0f ? glm::min(unbounded_mean(p, radius), total_ / ball) : unbounded_mean(p, radius);
}

Rgb MeanExtinction::unbounded_mean(const Vec3& p, float radius) const {
    const float variance = sqr(radius) / 5.0f;
    const auto variance_of = [](const Level& level) { return sqr(level.cell) / 4.0f; };
    if (!(variance > variance_of(levels_.front()))) {
        const float w = std::max(variance, 0.0f) / variance_of(levels_.front());
        const Rgb coarse = w > 0.0f ? interpolate(levels_.front(), p) : Rgb(0.0f);
        const Rgb here = box_.contains(p) ? medium_.coefficients(p).sigma_t : Rgb(0.0f);
        return (1.0f - w) * here + w * coarse;
    }
    // The radius may exceed the box: from the coarsest level on, what it holds is spread over a growing ball.
    if (!(variance < variance_of(levels_.back()))) {
        const float growth = std::sqrt(variance_of(levels_.back()) / variance);
        const Vec3 nearer = box_.center() + (p - box_.center()) * growth;
        return interpolate(levels_.back(), nearer) * (growth * growth * growth);
    }
    std::size_t l = 0;
    while (variance >= variance_of(levels_[l + 1])) ++l;
    const float v0 = variance_of(levels_[l]), v1 = variance_of(levels_[l + 1]);
    const float w = (variance - v0) / (v1 - v0);
    return (1.0f - w) * interpolate(levels_[l], p) + w * interpolate(levels_[l + 1], p);
}

std::size_t MeanExtinction::memory_bytes() const {
    std::size_t bytes = 0;
    for (const Level& level : levels_) bytes += level.values.size() * sizeof(float);
    return bytes;
}

}  // namespace mote::media
