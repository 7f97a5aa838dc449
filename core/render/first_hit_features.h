// Features of the first hits of a render's eye rays, as layers of its film: positions, normals, depth,
// albedo, and the transmittance of the media before them. Masks stop rays by chance, as they stop eye paths;
// rays pass through thin glass.
//
// The rays are those of the picture itself: every pass samples its position on the film and on the lens from
// the same keys as the eye paths do, so features are filtered as the picture is, blurred as the lens blurs
// it, and their variance belongs to the same samples. This costs one closest hit a pixel and pass and needs
// nothing of the integrator, whose layers keep their bits.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/shape.h"
#include "core/math/random.h"
#include "core/math/ray.h"
#include "core/render/integrator.h"

namespace mote::core {

/// Features of the scene that narrow lobes of a first hit show (mirrored_features.h).
struct MirroredHit {
    Vec3 position{0.0f}, normal{0.0f};
    Rgb albedo{0.0f}, emission{0.0f};
};

struct FirstHit {
    const Scene& scene;
    const Ray& ray;
    const SurfaceHit& hit;
    float stop_chance;  ///< of a mask that stopped the ray there; 1 for all other surfaces
    Rng& rng;           ///< for estimates
    mutable std::optional<MirroredHit> mirrored{};  ///< computed when a feature first needs it

    Vec3 to_viewer() const { return -ray.direction; }
    /// A normal of the hit, turned to the viewer.
    Vec3 facing(const Vec3& normal) const {
        return glm::dot(hit.geometric_normal, ray.direction) > 0.0f ? -normal : normal;
    }
};

struct HitFeature {
    Layer layer;
    /// Value for a ray that hits a surface; the layer is zero for all others. Called from many threads at
    /// once.
    std::function<Rgb(const FirstHit&)> value;
};

/// The first surface that stops a ray; of panes those that can be seen themselves, by chance.
struct FirstStop {
    std::optional<SurfaceHit> hit;
    float chance = 1.0f;  ///< of a mask that stopped it, see FirstHit
};
FirstStop first_stop(const Scene& scene, const Ray& ray, Rng& rng);
/// Albedo of the whole BSDF at the hit, seen along the ray.
Rgb first_hit_albedo(const FirstHit& first);

/// Layer whose mean is the fraction of rays that hit a surface.
inline const std::string coverage_layer = "Coverage";

/// Coverage; means over all rays of N, Ns (geometric and shading normal, turned to the viewer, in the world)
/// and Albedo (of the whole BSDF); means over the rays that hit a surface of P [m] and Depth (along the ray
/// [m], the same in all channels), and in scenes with media of Transmittance (from the camera to the hit, an
/// estimate). The film keeps the variance of all but Coverage, whose variance follows from its mean.
std::vector<HitFeature> first_hit_features(const Scene& scene);

/// Fills the layers of features, one pass at a time.
class FirstHitPass {
  public:
    /// Feature k goes to layer first_layer + k. The scene must outlive this.
    FirstHitPass(const Scene& scene, const RenderOptions& options, std::vector<HitFeature> features,
                 std::size_t first_layer);

    /// Returns false when it was cancelled half-way.
    bool fill(const PassContext& context, PassImage& image);
    std::uint64_t rays() const { return rays_; }  ///< that were traced

  private:
    void fill_pixel(const PassContext& context, PassImage& image, int x, int y) const;

    const Scene& scene_;
    RenderOptions options_;
    std::vector<HitFeature> features_;
    std::size_t first_layer_;
    std::uint64_t rays_ = 0;
};

}  // namespace mote::core
