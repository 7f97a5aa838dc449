// The light tree of sampling: eight children a node, whose bounds are three cache lines, so that a VPL of a
// million is seven steps down, each of which evaluates eight children in one vector.
//
// A child's bounds are those of a LightNode, in fewer bits, each rounded outwards: its box in 255ths of
// the node's, the cone of its directions, its fraction of the node's energy. Nodes of at most eight VPLs
// are the last ones. Split by LightPartition, the largest cluster first.
#pragma once

#include <mutex>
#include <span>
#include <vector>

#include "lights/selection/hierarchy/light_partition.h"

namespace mote::lights {

inline constexpr int max_children = 8;  ///< of a node

struct alignas(64) WideLightNode {
    static constexpr int width = max_children;

    core::Vec3 lower, step;                      ///< box of the node: lower + [0, 255] step
    float energy_fraction[width];                ///< fraction of the node's energy, average(E); 0: no child
    std::uint32_t child[width];                  ///< node, or light where is_light
    std::uint8_t low[3][width], high[3][width];  ///< boxes in steps, by axis
    std::uint8_t axis_u[width], axis_v[width];   ///< octahedral, in units of 1 / 127 from 127
    std::uint8_t half_sine[width];               ///< of half the cone's half angle, in units of 1 / 255
    std::uint8_t min_depth[width];               ///< at most VirtualPointLight::depth of every light
    std::uint8_t g_low[width], g_high[width];    ///< |g| of Henyey-Greenstein's function, in 255ths
    std::uint8_t is_light, has_cosine;           ///< a bit for each child; the latter: C* is at most a cosine
    std::uint8_t any_lobe;                       ///< 1 if a g_high is above 0
    std::uint8_t count;                          ///< of children

    bool leaf(int i) const { return (is_light >> i & 1) != 0; }
};
static_assert(sizeof(WideLightNode) == 192);

class WideLightTree {
  public:
    WideLightTree() = default;
    /// Lights of energy 0 are left out. Throws core::InputError where memory_bytes() and what building takes
    /// besides may be more than `max_bytes`, and for energies that are negative or not finite.
    explicit WideLightTree(const LightLeaves& leaves, std::size_t max_bytes = std::size_t(-1));

    bool empty() const { return size_ == 0; }
    std::size_t size() const { return size_; }  ///< lights of energy above 0
    std::uint32_t root_index() const { return root_; }
    const WideLightNode& root() const { return node(root_); }
    const WideLightNode& node(std::uint32_t index) const { return nodes_[index]; }
    void prefetch(std::uint32_t index) const {
        const auto* line = reinterpret_cast<const char*>(&nodes_[index]);
        for (std::size_t k = 0; k < sizeof(WideLightNode); k += 64) __builtin_prefetch(line + k);
    }
    std::size_t memory_bytes() const { return nodes_.size() * sizeof(WideLightNode); }
    /// At most, and while it is built: a node for five lights and more than four bits of them.
    static constexpr std::size_t bytes_a_light = 36, building_bytes_a_light = sizeof(LightItem);

  private:
    class Builder;

    std::vector<WideLightNode> nodes_;
    std::uint32_t root_ = 0;
    std::size_t size_ = 0;
};

/// The children of a node as floats, by lane. Lanes without a child have energy_fraction 0.
struct alignas(64) LightChildren {
    static constexpr int width = max_children;

    float lower_x[width], lower_y[width], lower_z[width], upper_x[width], upper_y[width], upper_z[width];
    float axis_x[width], axis_y[width], axis_z[width], cos_angle[width], sin_angle[width];
    float has_cosine[width], energy_fraction[width], min_depth[width];
    float g_low[width], g_high[width];  ///< set only where there is any lobe
    bool any_lobe;

    explicit LightChildren(const WideLightNode& node);
};

}  // namespace mote::lights
