// The eye paths of sixteen pixels, advanced together to their connectable vertices, where virtual point
// lights are gathered and bundles of rays start.
#pragma once

#include <limits>
#include <optional>

#include "core/render/cpu_clock.h"
#include "integrators/eye_path/eye_path.h"
#include "integrators/vpl_ray_bundles/vpl_bundle_pass.h"

namespace mote::integrators {

/// Where the time of a pass goes, in seconds of its threads.
struct VplBundleTime {
    double eye = 0.0, vpls = 0.0, bundles = 0.0;
};

class VplBundleTile {
  public:
    static constexpr int side = 4, width = side * side;
    static_assert(width == lights::ReceiverTile::width);

    VplBundleTile(const core::Scene& scene, const VplBundleSettings& settings, const VplBundlePass& pass,
                  lights::GatherScratch& scratch, core::WalkContext& walk)
        : scene_(scene),
          settings_(settings),
          pass_(pass),
          scratch_(scratch),
          walk_(walk),
          bundles_(pass.bundles, scratch, walk) {}

    /// The first of a pixel's `paths` eye paths.
    void start(int lane, const EyeRay& eye, int paths);
    /// One of the others: its direct light and what it sees of lights.
    void add_direct(int lane, const EyeRay& eye);
    void stop(int lane);
    /// Follows the eye paths; `share` of the VPLs, and all directions, count for them.
    void run(const lights::VplRange& share, std::span<const gathering::BundleDirection> directions);
    TransportSum sum(int lane) const;
    const VplBundleTime& time() const { return time_; }

  private:
    struct Lane {
        std::optional<EyePath<false>> path;
        core::Rng rng;          ///< of the path, while other lanes advance
        TransportSum found;     ///< by eye paths, all of them together
        TransportSum gathered;  ///< from virtual point lights and along bundles, for the first
        float paths = 1.0f;
        bool alive = false;
    };

    bool advance(int lane);
    bool advance(EyePath<false>& path, TransportSum& sum);
    void add_receiver(int lane, const EyePath<false>& path);
    void gather(const lights::VplRange& share, std::span<const gathering::BundleDirection> directions);

    const core::Scene& scene_;
    const VplBundleSettings& settings_;
    const VplBundlePass& pass_;
    lights::GatherScratch& scratch_;
    core::WalkContext& walk_;
    gathering::EyeBundles bundles_;
    std::array<Lane, width> lanes_;
    lights::ReceiverTile tile_;
    gathering::ReceiverArray receivers_;
    VplBundleTime time_;
};

}  // namespace mote::integrators
