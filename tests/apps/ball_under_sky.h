// A scene that every command takes, and little else.
#pragma once

#include <string>

namespace mote::tests {

/// A diffuse ball under an even sky, by paths.
inline std::string ball_under_sky(int width, int height) {
    return R"(<scene version="3.0.0"><integrator type="path"/>
            <sensor type="perspective"><film type="hdrfilm"><integer name="width" value=")" +
           std::to_string(width) + R"("/><integer name="height" value=")" + std::to_string(height) +
           R"("/></film><transform name="to_world">
            <lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>
            <shape type="sphere"><bsdf type="diffuse"/></shape><emitter type="constant"/></scene>)";
}

}  // namespace mote::tests
