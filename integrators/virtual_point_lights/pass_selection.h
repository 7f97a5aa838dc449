// What a pass of `mote_vpl` prepares to select its virtual point lights by: a hierarchy, a tree, a table of
// powers, or the clusters of a matrix.
#pragma once

#include <functional>

#include "integrators/virtual_point_lights/selected_by.h"
#include "integrators/virtual_point_lights/vpl_matrix.h"
#include "lights/selection/vertex_bounds.h"

namespace mote::integrators {

class PassSelection {
  public:
    PassSelection(const core::Scene& scene, const SelectionSettings& settings,
                  const core::RenderOptions& options, float bound);

    /// What a matrix asks of the passes: the lights of another one, and the receivers that eye paths of these
    /// pixels find while all lights are looked at.
    struct Passes {
        std::function<lights::VplSet(const core::PassContext&)> trace;
        std::function<std::vector<lights::MatrixReceiver>(const core::PassContext&, const lights::VplSet&,
                                                          std::span<const glm::ivec2>)>
            find_receivers;
    };
    /// For the gathers of a pass that has these lights, which are kept by reference. Throws core::InputError
    /// where memory does not suffice, before it is asked for.
    void prepare(const lights::VplSet& vpls, const core::PassContext& context, const Passes& passes,
                 SharedCounters& counters);
    /// Nothing before prepare(), and for receivers of a matrix.
    SelectedBy by() const;
    void add_statistics(core::Statistics& statistics) const;

  private:
    void make_hierarchy(const lights::VplSet& vpls);
    void make_matrix(const lights::VplSet& vpls, const core::PassContext& context, const Passes& passes,
                     SharedCounters& counters);
    void make_rows(const lights::VplSet& vpls, const core::PassContext& first, const Passes& passes,
                   SharedCounters& counters);

    SelectionSettings settings_;
    core::RenderOptions options_;
    float bound_;
    std::optional<lights::VplLeaves> leaves_;
    // Of this pass; none: all lights are looked at.
    std::optional<lights::LightHierarchy> hierarchy_;  ///< for cuts
    std::optional<lights::LightTree> tree_;            ///< to draw from
    std::optional<lights::PowerCandidates> power_;     ///< to draw candidates from
    std::optional<VplMatrix> matrix_;                  ///< nothing: not by a matrix
    bool selects_by_matrix_ = false;
    double seconds_ = 0.0;  ///< of all but the matrix
    std::size_t bytes_ = 0;
};

}  // namespace mote::integrators
