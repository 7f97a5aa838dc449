// Media of pbrt scenes.
#pragma once

#include "core/formats/pbrt/pbrt_spectra.h"
#include "core/math/transform.h"

#include <pugixml.hpp>

namespace mote::core {

/// The directive MakeNamedMedium; `id`: of the element.
void add_pbrt_medium(pugi::xml_node scene, const std::string& id, const PbrtObject& medium,
                     const Transform& to_world, double exposure, PbrtFiles& files);

/// A medium that does nothing, in the place of one that cannot be read.
void add_pbrt_vacuum(pugi::xml_node scene, const std::string& id);

/// Density of the procedural medium "cloud" at a point of its own space.
double pbrt_cloud_density(const Vec3d& p, double density, double wispiness, double frequency);

}  // namespace mote::core
