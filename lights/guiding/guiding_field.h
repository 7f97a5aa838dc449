// Incident radiance that was learned: a binary tree over space, whose leaves hold mixtures of lobes.
//
// A leaf is split where it has received more than so many samples: at their mean, along the axis in which
// they vary most. Its halves inherit what it learned, each half of it (Müller et al. 2017; Ruppert et al.
// 2020). The result depends on the samples and their order alone, not on threads.
#pragma once

#include <cstddef>
#include <vector>

#include "core/objects/memory_budget.h"
#include "lights/guiding/mixture_fit.h"

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
    void scale(double factor);

    /// The mixture at a point; empty where nothing was learned.
    VmfMixture at(const core::Vec3& position) const;
    const std::vector<MixtureFit>& leaves() const { return leaves_; }  ///< all of them
    std::size_t leaf_of(const core::Vec3& position) const;             ///< index in leaves()

  private:
    struct Node {
        float plane = 0.0f;      ///< what lies below goes to the first child
        std::int32_t axis = -1;  ///< -1: a leaf
        std::uint32_t next = 0;  ///< the first child, the second behind it; of a leaf: its index
    };
    /// Samples of a batch, by their indices, and the leaf in which they lie.
    struct Share {
        std::uint32_t leaf;
        std::size_t begin, end;
    };
    void distribute(std::uint32_t node, std::vector<GuidingSample>& samples, std::size_t begin,
                    std::size_t end, std::vector<Share>& shares);
    void split(std::uint32_t node, std::span<GuidingSample> samples);

    double leaf_samples_;
    std::size_t max_leaves_;
    std::vector<Node> nodes_;
    std::vector<MixtureFit> leaves_;
};

}  // namespace mote::lights
