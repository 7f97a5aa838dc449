// A hierarchy over lights for drawing from: eight parts a group, and all that is known of them in three cache
// lines, so that a light of a million is seven steps down, each of which looks at eight parts in one vector.
//
// What is known of a part is that of a LightNode, in fewer bits, each rounded outwards: its box in 255ths of
// the group's, the cone of its directions, its share of the group's energy. Groups of at most eight lights
// are the last ones. Parted by LightPartition, the group of most lights first.
#pragma once

#include <mutex>
#include <span>
#include <vector>

#include "lights/selection/light_partition.h"

namespace mote::lights {

inline constexpr int most_parts = 8;  ///< of a group

struct alignas(64) LightTreeNode {
    static constexpr int width = most_parts;

    core::Vec3 lower, step;                      ///< box of the group: lower + [0, 255] step
    float share[width];                          ///< of the group's energy, average(E); 0: no part
    std::uint32_t child[width];                  ///< node, or light where is_light
    std::uint8_t low[3][width], high[3][width];  ///< boxes in steps, by axis
    std::uint8_t axis_u[width], axis_v[width];   ///< octahedral, in units of 1 / 127 from 127
    std::uint8_t half_sine[width];               ///< of half the cone's half angle, in units of 1 / 255
    std::uint8_t least_depth[width];             ///< at most VirtualPointLight::depth of every light
    std::uint8_t g_low[width], g_high[width];    ///< |g| of Henyey-Greenstein's function, in 255ths
    std::uint8_t is_light, has_cosine;           ///< a bit for each part; the latter: C* is at most a cosine
    std::uint8_t any_lobe;                       ///< is a g_high above 0?
    std::uint8_t count;                          ///< of parts

    bool leaf(int i) const { return (is_light >> i & 1) != 0; }
};
static_assert(sizeof(LightTreeNode) == 192);

class LightTree {
  public:
    LightTree() = default;
    /// Lights of energy 0 are left out. Throws core::InputError where memory_bytes() and what building takes
    /// besides may be more than `max_bytes`, and for energies that are negative or not finite.
    explicit LightTree(const LightLeaves& leaves, std::size_t max_bytes = std::size_t(-1));

    bool empty() const { return size_ == 0; }
    std::size_t size() const { return size_; }  ///< lights of energy above 0
    std::uint32_t root_index() const { return root_; }
    const LightTreeNode& root() const { return node(root_); }
    const LightTreeNode& node(std::uint32_t index) const { return nodes_[index]; }
    void prefetch(std::uint32_t index) const {
        const auto* line = reinterpret_cast<const char*>(&nodes_[index]);
        for (std::size_t k = 0; k < sizeof(LightTreeNode); k += 64) __builtin_prefetch(line + k);
    }
    std::size_t memory_bytes() const { return nodes_.size() * sizeof(LightTreeNode); }
    /// At most, and while it is built: a node for five lights and more than four bits of them.
    static constexpr std::size_t bytes_a_light = 36, building_bytes_a_light = sizeof(LightItem);

  private:
    class Builder;

    std::vector<LightTreeNode> nodes_;
    std::uint32_t root_ = 0;
    std::size_t size_ = 0;
};

/// What the parts of a node are, by lane: floats, as drawing wants them. Lanes without a part have share 0.
struct alignas(64) LightParts {
    static constexpr int width = most_parts;

    float lower_x[width], lower_y[width], lower_z[width], upper_x[width], upper_y[width], upper_z[width];
    float axis_x[width], axis_y[width], axis_z[width], cos_angle[width], sin_angle[width];
    float has_cosine[width], share[width], least_depth[width];
    float g_low[width], g_high[width];  ///< set only where there is any lobe
    bool any_lobe;

    explicit LightParts(const LightTreeNode& node);
};

}  // namespace mote::lights
