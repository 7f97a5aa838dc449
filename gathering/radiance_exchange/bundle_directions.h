// The directions of global ray-bundles: points of the Halton sequence on half of the sphere.
//
// A bundle serves its direction and the opposite one, so half of the sphere holds every line once. Each of
// the two is uniform over the whole sphere, and over the hemisphere above any surface one of them has the
// density 1 / (2 pi) (Hermes 2010, Eq. 3; Tokuyoshi 2012, Sec. 4).
#pragma once

#include <cstdint>

#include "core/math/random.h"

namespace mote::gathering {

/// Density of a bundle's direction, or its opposite, above a surface [1/sr].
inline constexpr float pdf_bundle_solid_angle = core::inv_two_pi;

/// The digits of `index` in this base, mirrored at the point: in [0, 1).
inline double radical_inverse(std::uint32_t base, std::uint64_t index) {
    double result = 0.0, digit = 1.0 / base;
    for (; index > 0; index /= base, digit /= base) result += double(index % base) * digit;
    return result;
}

/// Directions in batches. Batches that follow each other are independent: they belong to different sequences,
/// each moved by a random shift of its own (Cranley and Patterson 1976), which makes every direction uniform.
/// A batch goes on where the batch before it in its sequence ended, so all together cover the sphere evenly.
class BundleDirections {
  public:
    static constexpr std::uint32_t sequences = 2;

    BundleDirections(std::uint64_t key, std::uint32_t batch)
        : key_(core::hash_keys(key, 0x62756e64ull)), batch_(batch) {}

    core::Vec3 direction(std::uint32_t i) const {
        const std::uint32_t number = i / batch_;
        core::Rng rng(core::hash_keys(key_, number % sequences));
        const core::Vec2 shift = rng.next_vec2();
        const std::uint64_t point = std::uint64_t(number / sequences) * batch_ + i % batch_;
        const auto shifted = [](double x, float s) {
            return float(x + double(s) - std::floor(x + double(s)));
        };
        const float z = shifted(radical_inverse(2, point), shift.x);  // uniform over the upper half
        const float phi = 2.0f * core::pi * shifted(radical_inverse(3, point), shift.y);
        const float r = core::safe_sqrt(1.0f - z * z);
        return glm::normalize(core::Vec3(r * std::cos(phi), r * std::sin(phi), z));
    }
    /// Where the grid of rays of direction i begins, as a share of its spacing.
    core::Vec2 offset(std::uint32_t i) const {
        core::Rng rng(core::hash_keys(key_, i, 0x67726964ull));
        return rng.next_vec2();
    }

  private:
    std::uint64_t key_;
    std::uint32_t batch_;
};

}  // namespace mote::gathering
