// Requirements of a scene on an integrator: found once after loading, shown to the user, used to choose what
// runs.
#pragma once

#include <string>
#include <vector>

#include "core/film/transport.h"
#include "core/math/bounds.h"

namespace mote::core {

class Scene;

struct Requirements {
    std::size_t shapes = 0, triangles = 0, analytic_shapes = 0;
    std::size_t bsdfs_diffuse = 0, bsdfs_glossy = 0, bsdfs_delta = 0, bsdfs_null = 0;
    bool textures = false;
    std::size_t lights_point = 0, lights_area = 0, lights_infinite = 0;  ///< point includes spot
    std::size_t lights_media = 0;  ///< media whose emission is sampled from
    std::size_t media = 0, media_homogeneous = 0, media_heterogeneous = 0;
    bool media_emissive = false, media_anisotropic = false, media_chromatic = false, media_scattering = false;
    bool camera_in_medium = false;
    Bounds3 bounds, media_bounds;
    std::vector<std::string> media_descriptions;
    std::vector<std::string> media_estimators,
        media_estimator_reasons;  ///< of the transmittance, one a medium

    TransportSet cells = TransportSet::all();  ///< wanted from an integrator

    bool any_glossy() const { return bsdfs_glossy > 0; }
    bool any_delta() const { return bsdfs_delta > 0; }
    bool any_media() const { return media > 0; }
};

Requirements find_requirements(const Scene& scene);

}  // namespace mote::core
