// Which virtual point lights `mote_vpl` looks at: a nested <selection> of a scene file.
#pragma once

#include "core/objects/error.h"
#include "core/objects/registry.h"
#include "lights/selection/lightcut.h"
#include "lights/selection/matrix_selection.h"
#include "lights/selection/spatial_reuse.h"

namespace mote::integrators {

/// Where candidates of resampling come from, how many a tile looks at, and whose choices become candidates.
struct ResamplingSettings {
    enum class Proposal : std::uint8_t { light_tree, cut, groups, power };
    /// A table of the power of lights is needed.
    bool by_power() const { return proposal == Proposal::power || proposal == Proposal::groups; }

    /// By the tree over all lights: candidates of all points of a pixel at once, which learn.
    bool by_tree() const { return proposal == Proposal::cut || proposal == Proposal::light_tree; }

    std::uint32_t candidates = 256;
    Proposal proposal = Proposal::cut;
    lights::SpatialReuse reuse = lights::SpatialReuse::none;
};

struct SelectionSettings {
    enum class Kind : std::uint8_t {
        all,
        lightcuts,
        multidimensional,
        stochastic,
        light_tree,
        matrix,
        resampling
    };

    Kind kind = Kind::all;
    lights::LightcutSettings cut;
    lights::MatrixSettings matrix;
    std::uint32_t shared_passes = 1;  ///< that have the same rows and clusters of a matrix
    std::uint32_t samples = 64;       ///< drawn for a tile of receivers; resampled for each
    bool learning = true;             ///< drawn lights: shares by what tiles before found out
    ResamplingSettings resampling;
    std::size_t max_bytes = std::size_t(4) << 30;  ///< of the hierarchy while it is built
    core::SourceLocation where;

    bool selects() const { return kind != Kind::all; }
    bool by_hierarchy() const { return selects() && !by_matrix(); }
    bool by_matrix() const { return kind == Kind::matrix; }
    /// A sum of groups, which looks at what arrives; else lights are drawn without bias.
    bool cuts() const { return kind == Kind::lightcuts || kind == Kind::multidimensional; }
    bool resamples() const { return kind == Kind::resampling; }
    /// A few lights for each tile, the same for all of its receivers.
    bool draws() const { return kind == Kind::stochastic || kind == Kind::light_tree; }
    /// Candidates are drawn by power, from all or from groups; else by the tree.
    bool by_power() const { return resamples() && resampling.by_power(); }
    /// All points of a pixel are gathered at once.
    bool collects() const { return kind == Kind::multidimensional || resamples(); }
    /// Visibility is traced, whatever else there is.
    bool traces() const { return cuts() || resamples(); }
};

class Selection : public core::Object {
  public:
    explicit Selection(const SelectionSettings& settings) : settings_(settings) {}
    const SelectionSettings& settings() const { return settings_; }

  private:
    SelectionSettings settings_;
};

/// all, lightcuts, multidimensional_lightcuts, stochastic_lightcuts, light_tree, matrix, resampling.
void register_selection(core::Registry& registry);

}  // namespace mote::integrators
