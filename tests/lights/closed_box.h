// Scene text that the tests of virtual point lights share.
#pragma once

#include <string>

namespace mote::tests {

/// A closed box [-1,1]^3 of albedo `albedo`, open to no side, with a point light inside and maybe fog.
inline std::string closed_box(const std::string& bsdf, const std::string& medium) {
    return R"(<scene version="3.0.0"><shape type="cube"><boolean name="flip_normals" value="true"/>)" + bsdf +
           R"(</shape><emitter type="point"><point name="position" x="0.1" y="0.3" z="-0.2"/>
        <rgb name="intensity" value="2, 1, 0.5"/></emitter>)" +
           medium + R"(<sensor type="perspective"/></scene>)";
}
inline const std::string diffuse = R"(<bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf>)";
inline const std::string glossy = R"(<bsdf type="roughconductor"><float name="alpha" value="0.4"/></bsdf>)";
inline const std::string fog = R"(<shape type="sphere"><float name="radius" value="0.8"/><bsdf type="null"/>
    <medium type="homogeneous" name="interior"><rgb name="sigma_t" value="2"/><rgb name="albedo" value="0.7"/></medium></shape>)";

}  // namespace mote::tests
