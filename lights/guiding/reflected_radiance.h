// Radiance that vertices reflect towards where a path came from, learned over space: what a path may expect
// behind a vertex.
//
// It weights the places where a path may scatter (choose_scattering.h) and ends paths that expect little
// (Vorba & Křivánek 2016). The best probability of a choice goes with the root of the second moment of what
// is found behind it, the noise of paths included (Xu et al. 2024), not with its mean. Directions are left
// out: a leaf holds means over those from which paths came.
#pragma once

#include "lights/guiding/spatial_tree.h"

namespace mote::lights {

/// Found by a path behind a vertex, over its weight when it arrived there.
struct ReflectedSample {
    core::Vec3 position;  ///< of the vertex [m]
    float radiance;       ///< finite, not negative
    float indirect;       ///< without next-event estimation at the vertex
};

/// Radiance that is expected behind a vertex.
struct ExpectedRadiance {
    float root_square = 1.0f;  ///< root of the second moment
    float mean = 1.0f;         ///< first moment
    float indirect = 1.0f;     ///< mean, without next-event estimation at the vertex
    bool known = false;        ///< false: nothing was learned
};

/// Moments of the samples of a leaf.
class ReflectedMoments {
  public:
    using Sample = ReflectedSample;  ///< as SpatialTree needs it
    /// By each half of a leaf (SpatialTree). Little: they differ where a shaft of light has its border.
    static constexpr double inherited = 0.125;

    explicit ReflectedMoments(const core::Vec3&) {}      ///< of no samples, whatever the pivot
    void add(std::span<const ReflectedSample> samples);  ///< a batch
    /// All that was learned so far counts this much.
    void scale(double factor);
    ReflectedMoments moved_to(const core::Vec3&) const { return *this; }  ///< the same everywhere in a leaf

    double samples() const { return samples_; }  ///< those without light too
    /// By all samples so far.
    const ExpectedRadiance& expected() const { return expected_; }

  private:
    double samples_ = 0.0, sum_ = 0.0, squares_ = 0.0, indirect_ = 0.0;
    ExpectedRadiance expected_;  ///< of these sums
};

/// The tree and its leaves.
class ReflectedField {
  public:
    /// Throws OutOfMemory where `bytes` are not available.
    ReflectedField(double leaf_samples, double bytes, const core::MemoryBudget& memory)
        : tree_(leaf_samples, bytes, memory, "the reflected radiance of guided paths") {}

    /// A batch of samples, in their order; it is sorted by leaves. Throws std::invalid_argument for what is
    /// no radiance.
    void add(std::vector<ReflectedSample>& samples);
    /// All that was learned so far counts this much.
    void scale(double factor) { tree_.scale(factor); }
    /// At a vertex.
    ExpectedRadiance at(const core::Vec3& position) const {
        return tree_.leaves().empty() ? ExpectedRadiance{}
                                      : tree_.leaves()[tree_.leaf_of(position)].expected();
    }
    const std::vector<ReflectedMoments>& leaves() const { return tree_.leaves(); }  ///< all of them

  private:
    SpatialTree<ReflectedMoments> tree_;
};

}  // namespace mote::lights
