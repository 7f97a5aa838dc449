// The sides of surfels that reflect light to others: where light is stored.
#pragma once

#include "gathering/atlas/surface_place.h"
#include "gathering/stored_light/light_places.h"
#include "gathering/surface_points/surfels.h"

namespace mote::gathering {

class SurfelSides final : public LightPlaces {
  public:
    /// Keeps references to all three. Looks reflectances up once; a side whose surface reflects nothing is
    /// left out.
    SurfelSides(const SurfaceTriangles& surfaces, ShapeSpan shapes, const Surfels& surfels);

    std::size_t size() const override { return places_.size(); }
    core::ScatteringVertex vertex(std::size_t place) const override;
    /// Reflectance of a Lambertian surface; that of every other one is for light from straight above, which
    /// is sent everywhere alike (Engelhardt 2013, Sec. 8.4.1: points send light diffusely). Mirrors and clear
    /// glass are black.
    const core::Rgb& reflectance(std::size_t place) const { return places_[place].reflectance; }
    std::uint32_t surfel(std::size_t place) const { return places_[place].surfel; }
    bool back(std::size_t place) const { return places_[place].back; }

    /// Radiance that the surfels send: reflectance / pi times the irradiance of their places, black
    /// elsewhere.
    struct Radiance {
        std::vector<core::Rgb> front, back;  ///< by surfel; back is empty where no back reflects
    };
    Radiance reflected(std::span<const core::Rgb> irradiance) const;

    std::size_t memory_bytes() const { return places_.capacity() * sizeof(Place); }

  private:
    struct Place {
        std::uint32_t surfel;
        bool back;
        core::Rgb reflectance;
    };
    core::SurfaceHit hit(std::uint32_t surfel) const;

    const SurfaceTriangles& surfaces_;
    ShapeSpan shapes_;
    const Surfels& surfels_;
    std::vector<Place> places_;
    bool any_back_ = false;
};

}  // namespace mote::gathering
