#include "media/medium_emitter.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "core/math/random.h"
#include "core/math/warp.h"

namespace mote::media {

using namespace core;

namespace {

constexpr int cells_along = 32;           ///< the longest side of the box
constexpr int points_along = 4;           ///< of each side of a cell, to find its emission
constexpr float even_probability = 0.1f;  ///< of the choices: what the points of a cell missed is still found

float max_extinction(const Rgb& sigma_t) { return max_component(sigma_t); }

}  // namespace

MediumEmitter::MediumEmitter(const Medium& source, const Bounds3& box, bool direct)
    : medium_(source), box_(box), direct_(direct) {
    // A flat box has no volume to sample points from.
    const Vec3 pad(1e-6f * std::max(box.radius(), 1e-20f));
    box_.lower -= pad, box_.upper += pad;
    make_cells();
}

void MediumEmitter::make_cells() {
    const Vec3 size = box_.diagonal();
    if (!medium_.traits().homogeneous)
        for (int axis = 0; axis < 3; ++axis)
            cells_[axis] =
                std::clamp(int(std::ceil(cells_along * size[axis] / max_component(size))), 1, cells_along);
    const auto count = std::size_t(cells_.x) * std::size_t(cells_.y) * std::size_t(cells_.z);
    std::vector<Rgb> emission(count);
    tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) { emission[i] = cell_emission(cell_of(i)); });
    double sum = 0.0;
    glm::dvec3 total(0.0);
    for (const Rgb& e : emission) sum += double(average(e)), total += glm::dvec3(e);
    const double cell_volume = double(size.x) * double(size.y) * double(size.z) / double(count);
    power_ = Rgb(total * cell_volume * 4.0 * double(pi));
    if (!(sum > 0.0)) sum = 1.0;  // black as far as the points saw: even choices
    std::vector<float> weights(count);
    for (std::size_t i = 0; i < count; ++i)
        weights[i] = (1.0f - even_probability) * float(double(average(emission[i])) / sum) +
                     even_probability / float(count);
    choice_ = Distribution1D(weights);
}

glm::ivec3 MediumEmitter::cell_of(std::size_t index) const {
    const int i = int(index);
    return {i % cells_.x, (i / cells_.x) % cells_.y, i / (cells_.x * cells_.y)};
}

/// Mean of a cell's emission over a lattice of points [W/(m^3 sr)].
Rgb MediumEmitter::cell_emission(const glm::ivec3& cell) const {
    const Vec3 size = box_.diagonal() / Vec3(cells_);
    Rgb sum(0.0f);
    for (int i = 0; i < points_along * points_along * points_along; ++i) {
        const Vec3 within(float(i % points_along), float(i / points_along % points_along),
                          float(i / (points_along * points_along)));
        const Vec3 p = box_.lower + size * (Vec3(cell) + (within + 0.5f) / float(points_along));
        sum += medium_.coefficients(p).emission;
    }
    return sum / float(points_along * points_along * points_along);
}

MediumEmitter::Point MediumEmitter::sample_point(const Vec2& u) const {
    // Two numbers choose a cell and three coordinates: a generator keyed by them makes the rest.
    Rng rng(hash_keys(std::bit_cast<std::uint32_t>(u.x), std::bit_cast<std::uint32_t>(u.y), 0x656d6974u));
    const auto chosen = choice_.sample_discrete(u.x);
    const Vec3 size = box_.diagonal() / Vec3(cells_);
    const Vec3 within(rng.next_float(), rng.next_float(), rng.next_float());
    return {box_.lower + size * (Vec3(cell_of(chosen.index)) + within),
            chosen.probability / (size.x * size.y * size.z)};
}

float MediumEmitter::pdf_volume(const Vec3& p) const {
    if (!box_.contains(p)) return 0.0f;
    const Vec3 size = box_.diagonal() / Vec3(cells_);
    const glm::ivec3 cell = glm::clamp(glm::ivec3((p - box_.lower) / size), glm::ivec3(0), cells_ - 1);
    const std::size_t index =
        std::size_t(cell.x) +
        std::size_t(cells_.x) * (std::size_t(cell.y) + std::size_t(cells_.y) * std::size_t(cell.z));
    return choice_.probability(index) / (size.x * size.y * size.z);
}

std::optional<DirectSample> MediumEmitter::sample_direct(const Vec3& p, const Vec2& u) const {
    if (!direct_) return std::nullopt;
    const Point y = sample_point(u);
    const MediumCoefficients there = medium_.coefficients(y.position);
    const Vec3 d = y.position - p;
    const float squared = glm::dot(d, d);
    if (is_black(there.emission) || !(squared > 1e-30f) || !std::isfinite(squared)) return std::nullopt;
    DirectSample sample{};
    sample.distance = std::sqrt(squared), sample.wi = d / sample.distance;
    sample.pdf_solid_angle = y.pdf_volume * squared;
    sample.weight = there.emission / sample.pdf_solid_angle;
    sample.line_density = max_extinction(there.sigma_t);
    sample.inside = &medium_;
    return sample;
}

float MediumEmitter::light_over_walk(const Vec3& from, const Vec3& y, const Rgb& sigma_t) const {
    const Vec3 d = y - from;
    return probability_ * pdf_volume(y) * glm::dot(d, d) / max_extinction(sigma_t);
}

std::optional<EmissionSample> MediumEmitter::sample_emission(const Vec2& u_position,
                                                             const Vec2& u_direction) const {
    const Point y = sample_point(u_position);
    const Rgb emission = medium_.coefficients(y.position).emission;
    if (is_black(emission)) return std::nullopt;
    EmissionSample sample{};
    sample.origin = y.position, sample.direction = square_to_sphere(u_direction);
    sample.normal = Vec3(0.0f);
    sample.pdf_area = y.pdf_volume, sample.pdf_solid_angle = inv_four_pi;
    sample.weight = emission / (y.pdf_volume * inv_four_pi);
    sample.inside = &medium_;
    return sample;
}

}  // namespace mote::media
