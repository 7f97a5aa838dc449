// Incident radiance that was learned: a tree over space (spatial_tree.h) whose leaves hold mixtures of lobes.
#pragma once

#include "core/objects/memory_budget.h"
#include "lights/guiding/mixture_fit.h"
#include "lights/guiding/spatial_tree.h"

namespace mote::lights {

/// The tree and its leaves.
class GuidingField {
  public:
    /// How fine it may become.
    struct Settings {
        double leaf_samples = 8000.0;  ///< a leaf with more is split
        double bytes = 64e6;           ///< memory of all leaves at most; leaves are split no further
    };
    /// Throws OutOfMemory where settings.bytes are not available.
    GuidingField(const Settings& settings, const core::MemoryBudget& memory);

    /// A batch of samples, in their order; it is sorted by leaves. Throws std::invalid_argument for a weight
    /// that is negative or not finite.
    void add(std::vector<GuidingSample>& samples);
    /// All that was learned so far counts this much.
    void scale(double factor) { tree_.scale(factor); }

    /// The mixture at a point; empty where nothing was learned.
    VmfMixture at(const core::Vec3& position) const;
    const std::vector<MixtureFit>& leaves() const { return tree_.leaves(); }  ///< all of them
    /// Index in leaves().
    std::size_t leaf_of(const core::Vec3& position) const { return tree_.leaf_of(position); }

  private:
    SpatialTree<MixtureFit> tree_;
};

}  // namespace mote::lights
