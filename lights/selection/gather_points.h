// The points at which the pixels of a tile gather light, in groups: the other tree of multidimensional
// lightcuts (Walter et al. 2006).
//
// The n-th point of every lane makes a tile of receivers. Tiles of surfaces and of media are two binary trees
// over the order in which the points came, along eye rays; each lane of a group knows what its own points are
// at most, and has one of them stand for all, drawn in proportion to its weight. With one point a pixel there
// is one group, and multidimensional lightcuts are lightcuts.
#pragma once

#include <array>
#include <deque>
#include <vector>

#include "lights/selection/lobe_contributions.h"
#include "lights/selection/receiver_bounds.h"
#include "lights/selection/receiver_sets.h"

namespace mote::lights {

/// What is gathered apart.
enum class GatherKind : std::uint8_t { surface, medium };

struct GatherGroup {
    ReceiverTile representative;  ///< weighed so that it stands for all points of its lane
    ReceiverBounds bounds;
    std::uint32_t left = 0, right = 0;  ///< groups; both 0: one tile of points
    float diagonal2 = 0.0f;             ///< ReceiverBounds::diagonal2()
    ReceiverLobes lobes{};              ///< of the representatives
    ReceiverSets sets{};                ///< of the representatives

    bool single() const { return right == 0; }
};

class GatherPoints {
  public:
    void clear() { groups_.clear(), vertices_.clear(), leaves_ = {}, roots_ = {}; }
    /// A tile of points of one kind, idle lanes allowed. Copies the vertices that it refers to.
    void add(const ReceiverTile& tile, GatherKind kind);
    /// Makes the trees, after the last add(). `rng` draws who stands for a group.
    void build(core::Rng& rng);

    bool empty() const { return groups_.empty(); }
    std::size_t tiles(GatherKind kind) const { return leaves_[std::size_t(kind)].size(); }
    static constexpr std::uint32_t none = 0xffffffffu;
    /// After build(): the group of all points of a kind, or none.
    std::uint32_t root(GatherKind kind) const { return roots_[std::size_t(kind)]; }
    GatherGroup& group(std::uint32_t index) { return groups_[index]; }

  private:
    std::uint32_t build(const std::vector<std::uint32_t>& leaves, std::size_t first, std::size_t last,
                        core::Rng& rng);
    std::uint32_t join(std::uint32_t left, std::uint32_t right, core::Rng& rng);

    std::deque<GatherGroup> groups_;  ///< whose places stay
    std::deque<core::ScatteringVertex> vertices_;
    std::array<std::vector<std::uint32_t>, 2> leaves_;
    std::array<std::uint32_t, 2> roots_{none, none};
};

}  // namespace mote::lights
