// Bundles from the eye: parallel rays from the points that the eye sees, along one direction or against it,
// whichever leaves the surface, and what light the points that they find send back (Tokuyoshi & Ogaki 2012,
// Secs. 3 and 4).
//
// At a point y that a ray from x finds, the light of one light is connected (paths of one bounce, Eq. 3), and
// a few virtual point lights are joined (two bounces and more, Eq. 7). From some of them the path continues,
// to a next point that is lit alike. Weights are those of path_weights.h.
#pragma once

#include <array>
#include <optional>

#include "core/scene/lit_scene.h"
#include "gathering/eye_bundles/bundle_directions.h"
#include "gathering/eye_bundles/imperfect_links.h"
#include "gathering/eye_bundles/path_weights.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::gathering {

/// Technique of the paths that both can make.
enum class Techniques : std::uint8_t { combined, vpls, bundles };

/// A point that the eye sees.
struct BundleReceiver {
    const core::ScatteringVertex* vertex = nullptr;  ///< null: an idle lane
    core::Rgb throughput{0.0f};
    std::int32_t max_vpl_depth = 0;  ///< of the VPLs that it may gather; a bundle's point counts as one
    core::Sampler* sampler = nullptr;
    bool first = true;  ///< seen by the eye; false: a point further on, which has lines alone
};

/// Settings and lights of a pass, shared by all receivers.
struct BundlePass {
    const core::LitScene& scene;
    const lights::VplSet& vpls;
    std::span<const float> rivals;  ///< of the VPLs, where techniques are combined
    TechniqueSamples samples;
    Techniques techniques = Techniques::combined;
    std::size_t stride = 1;  ///< every so many VPLs are joined to a point, from a random one on
    std::optional<float> bound =
        {};  ///< of paths of two bounces and more, as in the paper; nothing: weighted
    const core::Emitter* sky = nullptr;  ///< whose direct light the bundles find; null: none
    bool own_rays = true;  ///< of glossy receivers: one more direction each, sampled by the BSDF
    /// Bounces of paths that take the pass's own lines in random order, each at most once (the paper's
    /// Sec. 7); 0: virtual point lights are joined instead.
    int bounces = 0;
    const ImperfectLinks* links = nullptr;  ///< of lines with kept bundles
};

using ReceiverArray = std::array<BundleReceiver, lights::ReceiverLanes::width>;

/// Sixteen receivers, one direction after the other.
class EyeBundles {
  public:
    EyeBundles(const BundlePass& pass, lights::GatherScratch& scratch, core::WalkContext& walk)
        : pass_(pass), scratch_(scratch), walk_(walk) {
        shadow_.clear();
    }

    /// Adds the light that line `index` of the pass finds, divided by M p_r: indirect light to `indirect`,
    /// that of the sky to `direct`. Samples from the receivers' samplers and from the walk's generator.
    void add(const ReceiverArray& receivers, std::span<const BundleDirection> lines, std::size_t index,
             lights::TileLight& indirect, lights::TileLight& direct);
    /// Adds the light that the glossy receivers' own rays find, weighted against lines.
    void add_own_rays(const ReceiverArray& receivers, std::span<const BundleDirection> lines,
                      lights::TileLight& indirect, lights::TileLight& direct);

  private:
    static constexpr int width = lights::ReceiverLanes::width;

    /// A point y that a ray found.
    struct Found {
        core::ScatteringVertex vertex;
        core::Rgb throughput{0.0f};  ///< f_x cos_x / (M p_r), and what came before
        FewerFound fewer;            ///< b_k
        std::int32_t max_vpl_depth = 0;
        core::Sampler* sampler = nullptr;
    };

    bool has_own_ray(const core::ScatteringVertex& x) const {
        return pass_.own_rays && !x.diffuse_reflectance().has_value();
    }
    void light_found_points(std::span<const BundleDirection> lines, std::size_t index,
                            lights::TileLight& indirect);
    void trace(const BundleReceiver& x, const core::Vec3& w, float pdf_lines, const RayBundle* kept, Found& y,
               core::Rgb& direct);
    core::WalkEvent first_surface(const core::ScatteringVertex& x, const core::Ray& ray,
                                  const RayBundle* kept, core::Rgb& throughput);
    void continue_paths(std::span<const BundleDirection> lines, std::size_t first,
                        lights::TileLight& indirect);
    void light_points(lights::TileLight& indirect);
    bool continue_paths();
    bool continue_path(Found& y);
    void connect_lights(lights::TileLight& indirect);
    void join_lights(lights::TileLight& indirect);
    float weight_of_connection(const Found& y, const core::LightChoice& choice,
                               const core::DirectSample& light) const;

    const BundlePass& pass_;
    lights::GatherScratch& scratch_;
    core::WalkContext& walk_;
    core::ShadowPacket shadow_;
    std::array<Found, lights::ReceiverLanes::width> found_;
    lights::ReceiverTile tile_;
};

}  // namespace mote::gathering
