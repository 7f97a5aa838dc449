// Methods that fill the cells of the transport (core/film/transport.h): one a cell at most, which estimates
// all of it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/objects/error.h"
#include "core/render/integrator.h"
#include "core/scene/requirements.h"
#include "integrators/eye_path/eye_path_limits.h"

namespace mote::integrators {

/// A part of the picture.
struct LayerMethod {
    std::shared_ptr<const core::Integrator> integrator;
    core::TransportSet cells;  ///< that it fills; empty: all that it can
    std::string reason = "requested";
    core::SourceLocation where = {};
    std::vector<core::Layer> layers = {};  ///< of the method, all of them; from fill_layers()
    std::vector<std::size_t> kept = {};    ///< indices of those that hold its cells
};

/// Methods of a scene and the film that they fill: method i is part i of the picture.
struct LayerChoice {
    std::vector<LayerMethod> methods;
    std::vector<core::Layer> layers;  ///< of the film: the kept ones of each method, in their order

    /// Cells of the scene that no method fills.
    core::TransportSet unfilled(bool media) const;
};

/// Method of light that scatters at least twice: paths, unbiased, or virtual point lights, which leave less
/// noise and miss what their bound takes.
enum class FarLight : std::uint8_t { paths, lights };

/// For each cell the method that does it best in this scene, with reasons.
std::vector<LayerMethod> choose_layer_methods(const core::Scene& scene,
                                              const core::Requirements& requirements,
                                              const EyePathLimits& limits, FarLight far_light);

/// Lets films keep the light that surfaces scatter at twice the resolution (Layer::fine), where pixels of its
/// method are independent of each other.
void keep_fine_light(LayerChoice& choice);

/// Finds the cells and layers that each method fills in this scene. Throws InputError, with its place, for a
/// cell that the method cannot fill, and where two methods fill one cell.
LayerChoice fill_layers(const core::Scene& scene, std::vector<LayerMethod> methods);

}  // namespace mote::integrators
