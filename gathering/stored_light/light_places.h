// Places on surfaces where light arrives that is to be stored: one side of a point each.
//
// Irradiance is stored [W/m^2], the light that a white Lambertian surface would reflect times pi. So every
// place is such a vertex, whatever the surface is made of, and code that sums light at vertices (lights that
// are sampled, virtual point lights, photons) serves places as it serves eye paths.
#pragma once

#include "core/scene/scattering_vertex.h"

namespace mote::gathering {

class LightPlaces {
  public:
    virtual ~LightPlaces() = default;
    virtual std::size_t size() const = 0;
    /// A white vertex (white_vertex()). Safe from many threads.
    virtual core::ScatteringVertex vertex(std::size_t place) const = 0;
};

/// A Lambertian vertex of reflectance 1 at a hit, on the front of its surface or on the back, seen from
/// straight above. Triangles of shapes that are no meshes lie a little below the shapes: their vertices are
/// moved out to the surface.
core::ScatteringVertex white_vertex(const core::SurfaceHit& hit, bool front);

}  // namespace mote::gathering
