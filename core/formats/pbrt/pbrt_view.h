// Camera, film, filter, sampler and integrator of a pbrt scene.
#pragma once

#include <pugixml.hpp>

#include "core/formats/pbrt/pbrt_files.h"
#include "core/formats/pbrt/pbrt_parameters.h"
#include "core/math/transform.h"

namespace mote::core {

/// Objects before WorldBegin; pbrt's defaults where nothing is given.
struct PbrtView {
    PbrtView();
    PbrtObject camera, film, filter, sampler, integrator;
    Transform camera_to_world;
    std::string medium;  ///< id of the one around the camera, or ""
};

/// Factor on light from exposure time and sensitivity (pbrt's imaging ratio).
double pbrt_imaging_ratio(const PbrtView& view);

/// Writes integrator and sensor.
void add_pbrt_view(pugi::xml_node scene, const PbrtView& view, PbrtFiles& files);

}  // namespace mote::core
