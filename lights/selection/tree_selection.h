// The common part of selections by the light tree of a pass's VPLs: its construction, and its memory.
#pragma once

#include "lights/selection/hierarchy/build_statistics.h"
#include "lights/selection/hierarchy/vertex_bounds.h"
#include "lights/selection/hierarchy/wide_light_tree.h"
#include "lights/selection/selection.h"

namespace mote::lights {

class TreeSelection : public Selection {
  public:
    std::size_t memory_bytes(std::size_t vpls) const override {
        return vpls * (WideLightTree::bytes_a_light + WideLightTree::building_bytes_a_light);
    }

  protected:
    /// Throws OutOfMemory.
    std::shared_ptr<const WideLightTree> build_tree(const SelectionPass& pass) const {
        check_memory(pass);
        const BuildStatistics timer(pass.statistics, "light_hierarchy");
        auto tree = std::make_shared<const WideLightTree>(VplLeaves(pass.vpls));
        timer.built(tree->memory_bytes());
        return tree;
    }
};

}  // namespace mote::lights
