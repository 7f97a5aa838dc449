// Shared by BSDFs that hold others.
#pragma once

#include <vector>

#include "core/materials/bsdfs.h"

namespace mote::core {

/// Settings of BSDFs that hold others.
struct NestedBsdfs {
    std::vector<Nested<const Bsdf>> nested;  ///< whatever their names, in the order of the file
    /// All of them. Throws InputError (file, line) unless there are `count`.
    std::vector<BsdfPtr> exactly(std::size_t count, const Properties& properties) const;
};

/// Light that passes a BSDF straight on: all through `null`, a part through panes, nothing through others.
inline StraightPassage straight_passage_of(const Bsdf& bsdf, const BsdfPoint& p, const Vec3& wo) {
    return bsdf.traits().passes_straight() ? bsdf.straight_passage(p, wo) : StraightPassage{};
}

/// Two passages of which one is met with probability `probability_of_b`, the other otherwise.
StraightPassage mixed_passage(const StraightPassage& a, const StraightPassage& b, float probability_of_b);

/// A path that was let pass.
std::optional<BsdfSample> straight_sample(const StraightPassage& passage, const Vec3& wo);

/// A number in [0, size) as one in [0, 1).
inline float stretched(float u, float size) { return std::fmin(u / size, one_minus_epsilon); }

}  // namespace mote::core
