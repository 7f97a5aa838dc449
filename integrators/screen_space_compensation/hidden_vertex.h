// The points where a pixel's ray meets its hidden surfaces, as vertices of paths.
#pragma once

#include <optional>
#include <vector>

#include "core/scene/scattering_vertex.h"
#include "core/scene/scene.h"
#include "screenspace/g_buffer/g_buffer.h"

namespace mote::integrators {

/// A point on a side of a surface, and the media there.
struct HiddenVertex {
    core::ScatteringVertex vertex;
    core::MediumState state;
};

/// Surfaces and media along the ray of one pixel, kept while its sides follow each other.
class PixelRay {
  public:
    PixelRay(const core::Scene& scene, int layers, core::WalkContext& walk)
        : scene_(scene), layers_(layers), walk_(walk) {}

    void aim(std::uint32_t pixel, int columns) {
        if (pixel == pixel_) return;
        pixel_ = pixel;
        const core::Vec2 film(float(pixel % std::uint32_t(columns)) + 0.5f,
                              float(pixel / std::uint32_t(columns)) + 0.5f);
        ray_ = scene_.camera().sample_ray(film, core::Vec2(0.5f));
        screenspace::peel(scene_, ray_, layers_, hits_);
        walk_.rays.closest += std::uint64_t(layers_);
        if (!scene_.has_media()) return;
        state_ = scene_.eye_medium_state(ray_);
        scene_.boundaries_along(ray_, walk_.boundary_hits);
        ++walk_.rays.boundary;
    }
    /// Side 2 k is behind layer k, and 2 k - 1 before it. Nothing where rounding lost it.
    std::optional<HiddenVertex> vertex(std::uint32_t side) const {
        const std::size_t layer = (side + 1) / 2;
        const bool behind = side % 2 == 0;
        if (hits_.size() <= layer) return std::nullopt;
        HiddenVertex result;
        core::ScatteringVertex& v = result.vertex;
        v.hit = hits_[layer], v.position = v.hit.position, v.bsdf = v.hit.shape->bsdf.get();
        v.wo = behind ? ray_.direction : -ray_.direction;
        if (!scene_.has_media()) return result;
        result.state = state_;
        const auto cross = [&](const core::SurfaceHit& hit) {
            result.state.cross(*hit.shape, hit.geometric_normal, ray_.direction);
        };
        std::size_t b = 0;
        for (std::size_t k = 0; k <= layer; ++k) {
            for (; b < walk_.boundary_hits.size() && walk_.boundary_hits[b].t < hits_[k].t; ++b)
                cross(walk_.boundary_hits[b]);
            if (k < layer || behind) cross(hits_[k]);
        }
        return result;
    }

  private:
    const core::Scene& scene_;
    int layers_;
    core::WalkContext& walk_;
    std::uint32_t pixel_ = ~std::uint32_t(0);
    core::Ray ray_;
    core::MediumState state_;  ///< where the ray begins
    std::vector<core::SurfaceHit> hits_;
};

}  // namespace mote::integrators
