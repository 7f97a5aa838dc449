// Which method fills which cells of the transport.
//
// The cells are those of transport_layers.h: emission, direct, indirect, and in media single_scattering and
// multiple_scattering. Every cell is filled by one method at most, which estimates all of it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/objects/error.h"
#include "core/render/integrator.h"
#include "core/scene/requirements.h"
#include "integrators/eye_path/eye_path_limits.h"

namespace mote::integrators {

struct LayerMethod {
    std::shared_ptr<const core::Integrator> integrator;
    std::vector<std::string> cells;  ///< that it fills; empty: all that it can
    std::string reason = "asked for";
    core::SourceLocation where = {};
};

/// The names of the cells of a scene, in the order of Transport.
std::vector<std::string> transport_cells(bool media);

/// What fills light that has scattered at least twice, or once after a surface: paths, unbiased, or virtual
/// point lights, which leave less noise and miss what their bound takes.
enum class FarLight : std::uint8_t { paths, lights };

/// For each cell the method that does it best in this scene, with reasons.
std::vector<LayerMethod> choose_layer_methods(const core::Scene& scene,
                                              const core::Requirements& requirements,
                                              const EyePathLimits& limits, FarLight far_light);

/// The same methods, each with the cells that it fills in this scene. Throws InputError, with its place, for
/// a cell that no scene has or that the method cannot fill, and where two methods fill one cell.
std::vector<LayerMethod> with_cells(const core::Scene& scene, std::vector<LayerMethod> methods);

/// The cells of the scene that none of them fills.
std::vector<std::string> unfilled_cells(bool media, const std::vector<LayerMethod>& methods);

/// The layers of a method that belong to its cells: their index among all layers of the method. Layers that
/// are no part of the beauty are left out.
std::vector<std::size_t> kept_layers(const core::Scene& scene, const LayerMethod& method);

}  // namespace mote::integrators
