// Bounds of a light or a cluster of lights for a light hierarchy: position, directions of emission, how
// strongly (Estevez and Kulla 2018).
#pragma once

#include "core/math/bounds.h"
#include "core/math/direction_cone.h"

namespace mote::core {

struct LightBounds {
    Bounds3 box;                                   ///< holds the light [m]
    DirectionCone normals = DirectionCone::all();  ///< of the light's surface, or the axis of a spot
    float reach = 0.5f * pi;  ///< light leaves within this angle of a normal; at most a right angle
    /// Where all normals are one, and reach is a right angle: how far behind the box's centre, against the
    /// normal, the light's points lie at most [m]. Else infinite: nothing is known.
    float back = infinity;
    double intensity = 0.0;  ///< along a normal, the mean of the channels; of a cluster the sum [W/sr]
};

/// Holds both.
LightBounds united(const LightBounds& a, const LightBounds& b);

/// Receiver of light.
struct LightReceiver {
    Vec3 position{0, 0, 0};  ///< [m]
    Vec3 normal{0, 0, 0};    ///< unit, on the side from which light counts; zero: it counts from all sides
};

/// A part of a ray, along which light is scattered.
struct LightSegment {
    Vec3 origin, direction;  ///< unit direction
    float t0, t1;            ///< t1 may be infinite
};

}  // namespace mote::core
