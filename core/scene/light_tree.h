// A hierarchy over lights, eight children a node, from which one is sampled for a receiver in proportion to
// what it may contribute (Estevez and Kulla 2018; without their splitting: one light a sample).
//
// Going down, each child's probability is its importance over that of all eight. The probability of a light
// is the product of the probabilities on its way; where no child matters all are alike, so that the
// probabilities of all lights add up to 1 for every receiver.
#pragma once

#include <span>
#include <vector>

#include "core/scene/light_importance.h"

namespace mote::core {

class LightTree {
  public:
    LightTree() = default;
    /// At most 2^28 lights, of intensity above 0.
    explicit LightTree(std::span<const LightBounds> lights);

    bool empty() const { return leaves_.empty(); }       ///< no light
    std::size_t size() const { return leaves_.size(); }  ///< lights
    int depth() const { return depth_; }                 ///< nodes on the longest way down

    /// A light sampled.
    struct Choice {
        std::uint32_t light;  ///< index into the list that the tree was made of
        double probability;   ///< of this sample
    };
    /// Precondition: !empty(). `where` is a LightReceiver or a LightSegment; u in [0, 1).
    template <typename Where>
    Choice sample(const Where& where, double u) const;
    /// Probability of sample() choosing this light.
    template <typename Where>
    double probability(const Where& where, std::uint32_t light) const;

  private:
    static constexpr std::uint32_t none = 0xffffffffu;
    /// A child of a node.
    struct Place {
        std::uint32_t node = none, slot = 0;
    };
    struct Node {
        LightClusters clusters;
        Place parent;
        std::uint32_t children = 0;
        LightClusters::Each<std::uint32_t> child{};  ///< a node, or a light where is_light
        LightClusters::Each<bool> is_light{};
    };
    template <typename Where>
    static LightImportances importances(const Node& node, const Where& where);

    std::vector<Node> nodes_;
    std::vector<Place> leaves_;  ///< by light
    int depth_ = 0;
};

}  // namespace mote::core
