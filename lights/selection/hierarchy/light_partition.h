// Sorts VPLs into the order of a light tree, and splits clusters of them.
//
// Splits follow the surface area orientation heuristic of Estevez and Kulla 2018 with the size of a cluster
// that Walter et al. 2005 give (their Eq. 2), over sixteen bins along the longest side of positions and of
// directions. Plain and glossy surfaces and media are split before anything else. Equal lights
// are halved, so 2^20 of them in one place are 20 levels deep.
#pragma once

#include <array>
#include <vector>

#include "lights/selection/hierarchy/light_node.h"

namespace mote::lights {

/// Features of a light that splits depend on.
struct LightItem {
    core::Vec3 position;
    std::uint32_t light;
    float weight;  ///< average(E)
    std::array<std::int8_t, 3>
        direction{};  ///< of the cone's axis, in units of 1 / 127; zero where it has none
    LightKind kind;
};
static_assert(sizeof(LightItem) == 24);

class LightPartition {
  public:
    /// Lights of energy 0 are left out. Throws core::InputError for energies that are negative or not finite.
    explicit LightPartition(const LightLeaves& leaves);

    std::uint32_t size() const { return std::uint32_t(items_.size()); }
    const LightItem& item(std::uint32_t index) const { return items_[index]; }

    /// Puts the lights of [first, first + count) in an order where those of the left child come first.
    /// Returns how many they are: not 0 and not all. Where `unit` is less than count, it is a multiple of it,
    /// unless lights of different kinds are split. Disjoint ranges may be split by different threads.
    std::uint32_t split(std::uint32_t first, std::uint32_t count, std::uint32_t unit = 1);

  private:
    std::vector<LightItem> items_;
    double c2_ = 0.0;  ///< c^2 of Walter et al. 2005, Eq. 2
};

}  // namespace mote::lights
