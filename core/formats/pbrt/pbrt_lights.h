// Lights of pbrt scenes as emitters.
#pragma once

#include "core/formats/pbrt/pbrt_textures.h"

namespace mote::core {

/// The directive LightSource. `exposure`: factor on what it emits; `medium`: around it, "" for none.
void add_pbrt_light(pugi::xml_node scene, const PbrtObject& light, const Transform& to_world, double exposure,
                    const std::string& medium, PbrtFiles& files);

/// The directive AreaLightSource, for a shape of that area [m^2] in the world.
void add_pbrt_area_light(pugi::xml_node shape, const PbrtObject& light, double area, double exposure,
                         PbrtTextures& textures, PbrtFiles& files);
/// False for null.
bool pbrt_is_two_sided(const PbrtObject* light);

/// An infinite light with a picture in the equal-area octahedral mapping (Clarberg 2008), resampled to a
/// latitude-longitude picture in the world.
void add_pbrt_environment(pugi::xml_node scene, const PbrtObject& light, const Transform& to_world,
                          double exposure, PbrtFiles& files);

}  // namespace mote::core
