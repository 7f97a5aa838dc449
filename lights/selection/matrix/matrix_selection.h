// Matrix row-column sampling (Hasan et al. 2007) with slices (Ou and Pellacini 2011) as a selection.
#pragma once

#include "lights/selection/matrix/matrix_clusters.h"
#include "lights/selection/selection.h"

namespace mote::core {
class Registry;
}

namespace mote::lights {

class MatrixSelection final : public Selection {
  public:
    explicit MatrixSelection(const MatrixSettings& settings) : settings_(settings) {}
    std::unique_ptr<VplSelector> prepare(const SelectionPass& pass) const override;
    std::size_t receiver_paths() const override;
    std::size_t memory_bytes(std::size_t vpls) const override { return settings_.bytes(vpls); }
    void plan(core::Plan& plan, const SelectionSize& size) const override;

  private:
    MatrixSettings settings_;
};

void register_matrix_selection(core::Registry& registry);

}  // namespace mote::lights
