// The points at which the pixels of a tile gather light, in clusters: the gather tree of multidimensional
// lightcuts (Walter et al. 2006).
//
// The n-th point of every lane makes a tile of receivers. Tiles of surfaces and of media are two binary trees
// over the order in which the points came, along eye rays; each lane of a node has bounds of its own points
// and a representative, sampled in proportion to its weight. With one point a pixel there
// is one node, and multidimensional lightcuts are lightcuts.
#pragma once

#include <array>
#include <deque>
#include <vector>

#include "lights/selection/hierarchy/receiver_bounds.h"
#include "lights/selection/lightcuts/receiver_sets.h"
#include "lights/selection/selection.h"
#include "lights/virtual_lights/lobe_contributions.h"

namespace mote::lights {

struct GatherNode {
    ReceiverTile representative;  ///< weighted for all points of its lane
    ReceiverBounds bounds;
    std::uint32_t left = 0, right = 0;  ///< groups; both 0: one tile of points
    float diagonal2 = 0.0f;             ///< ReceiverBounds::diagonal2()
    ReceiverLobes lobes{};              ///< of the representatives
    ReceiverSets sets{};                ///< of the representatives

    bool single() const { return right == 0; }
};

class GatherPoints {
  public:
    void clear() { nodes_.clear(), vertices_.clear(), leaves_ = {}, roots_ = {}; }
    /// A tile of points of one kind, idle lanes allowed. Copies the vertices that it refers to.
    void add(const ReceiverTile& tile, ReceiverKind kind);
    /// Builds the trees, after the last add(). `rng` samples representatives.
    void build(core::Rng& rng);

    bool empty() const { return nodes_.empty(); }
    std::size_t tiles(ReceiverKind kind) const { return leaves_[std::size_t(kind)].size(); }
    static constexpr std::uint32_t none = 0xffffffffu;
    /// After build(): the node of all points of a kind, or none.
    std::uint32_t root(ReceiverKind kind) const { return roots_[std::size_t(kind)]; }
    GatherNode& node(std::uint32_t index) { return nodes_[index]; }

  private:
    std::uint32_t build(const std::vector<std::uint32_t>& leaves, std::size_t first, std::size_t last,
                        core::Rng& rng);
    std::uint32_t join(std::uint32_t left, std::uint32_t right, core::Rng& rng);

    std::deque<GatherNode> nodes_;  ///< addresses stay
    std::deque<core::ScatteringVertex> vertices_;
    std::array<std::vector<std::uint32_t>, 2> leaves_;
    std::array<std::uint32_t, 2> roots_{none, none};
};

}  // namespace mote::lights
