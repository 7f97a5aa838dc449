// The light of an atlas where an eye path meets a surface.
#pragma once

#include "core/scene/scattering_vertex.h"
#include "gathering/atlas/surface_locator.h"
#include "gathering/radiance_exchange/radiance_exchange.h"

namespace mote::integrators {

/// Irradiance at a place, as ArrivingLight has it of texels [W/m^2].
struct PlaceIrradiance {
    core::Rgb direct{0.0f};   ///< that bundles carried
    core::Rgb sampled{0.0f};  ///< direct light that was sampled at texels
    core::Rgb indirect{0.0f};
};

class AtlasView {
  public:
    AtlasView(const gathering::SurfaceAtlas& atlas, const gathering::SurfaceLocator& locator,
              const gathering::ArrivingLight& light, const gathering::TexelDirectLight& sampled)
        : atlas_(atlas), locator_(locator), light_(light), sampled_(sampled) {}

    /// On the side of vertex.wo, bilinear between texels; never negative, where a border is extrapolated to.
    /// Nothing where the atlas lacks the surface.
    std::optional<PlaceIrradiance> at(const core::ScatteringVertex& vertex) const {
        using gathering::SurfaceSide;
        const auto place = locator_.find(vertex.hit);
        if (!place) return std::nullopt;
        const bool front = glm::dot(vertex.hit.geometric_normal, vertex.wo) > 0.0f;
        const auto blend =
            atlas_.blend(place->triangle, place->u, place->v, front ? SurfaceSide::front : SurfaceSide::back);
        if (!blend) return std::nullopt;
        PlaceIrradiance sum;
        for (std::size_t i = 0; i < 4; ++i) {
            const std::uint32_t t = blend->texel[i];
            sum.indirect += blend->weight[i] * light_.indirect[t];
            if (!light_.direct.empty()) sum.direct += blend->weight[i] * light_.direct[t];
            if (!sampled_.irradiance.empty()) sum.sampled += blend->weight[i] * sampled_.irradiance[t];
        }
        for (core::Rgb* e : {&sum.direct, &sum.sampled, &sum.indirect}) *e = glm::max(*e, core::Rgb(0.0f));
        return sum;
    }

  private:
    const gathering::SurfaceAtlas& atlas_;
    const gathering::SurfaceLocator& locator_;
    const gathering::ArrivingLight& light_;
    const gathering::TexelDirectLight& sampled_;
};

}  // namespace mote::integrators
