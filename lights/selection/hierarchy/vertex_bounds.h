// Upper bounds of f* of a vertex over cones of directions, and VPLs as leaves of light trees.
#pragma once

#include "core/math/direction_cone.h"
#include "lights/selection/hierarchy/light_node.h"
#include "lights/virtual_lights/virtual_point_light.h"

namespace mote::lights {

/// At least vertex.eval() of any wi of the cone, whatever the mode [1/sr]; infinity where no bound is known.
core::Rgb eval_bound(const core::ScatteringVertex& vertex, const core::DirectionCone& wi);

/// Virtual point lights as the leaves of a hierarchy. Keeps a reference.
class VplLeaves final : public LightLeaves {
  public:
    explicit VplLeaves(const VplSet& vpls) : vpls_(vpls) {}
    std::size_t size() const override { return vpls_.lights.size(); }
    LightNode leaf(std::uint32_t light) const override;

  private:
    const VplSet& vpls_;
};

}  // namespace mote::lights
