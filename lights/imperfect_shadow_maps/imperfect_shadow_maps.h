// Imperfect shadow maps (Ritschel et al. 2008): the depth around every virtual point light, in many small
// maps that points of the surfaces are splatted into at once.
//
// A map shows the hemisphere above the light's surface on a square, or all directions for a light in a medium
// or on a surface that light passes (ShadowMapView). Each map gets its own range of a random sequence of
// points, so that maps err in different places. A point is a disc of the surface: a texel whose ray meets the
// disc gets the depth of its plane there, and the texel that its middle lies in does in any case. Texels that
// no disc meets are holes: they are filled from coarser levels, where half of what lies below is known
// (pull-push; Marroquim et al. 2007). Gaps through which a texel sees what lies behind most of its neighbours
// are closed with what these see.
//
// A receiver is dark where it lies behind all four texels around it. So a surface casts no shadow on itself,
// however it slants; shadows are smaller by up to a texel, and larger by up to a disc. Nothing is seen that
// is smaller than a texel. Stored is 1 / |d|_1, one over the sum of the components of the vector to the
// surface in the map's frame: what a lookup has at hand without a square root.
#pragma once

#include <span>

#include "core/objects/cancellation.h"
#include "core/objects/memory_budget.h"
#include "lights/imperfect_shadow_maps/surface_samples.h"
#include "lights/shadow_maps/shadow_map_view.h"
#include "lights/virtual_lights/virtual_point_light.h"
#include "lights/virtual_lights/vpl_receivers.h"

namespace mote::lights {

struct ImperfectMapSettings {
    int size = 32;                   ///< texels along an edge of a map
    int points = 8192;               ///< that go into each map
    int all_points = 131072;         ///< of the scene
    float splat = 4.0f;              ///< how often the discs of a map cover a surface
    bool pull_push = true;           ///< fill holes and close gaps
    float bias = 0.5f;               ///< occluders nearer by less than so many texels' width cast no shadow
    core::MemoryBudget memory = {};  ///< of all maps of a pass

    /// Texels of one map, with a border that continues it over its edges.
    std::size_t bytes() const { return std::size_t(size + 2) * std::size_t(size + 2) * sizeof(float); }
};

/// Small maps of many lights.
class ImperfectShadowMaps {
  public:
    /// Maps of all lights of a set, on the threads of TBB; `key` says which points go into which map. The
    /// same for any number of threads. Throws core::Cancelled.
    void build(const SurfaceSamples& points, const VplSet& vpls, const ImperfectMapSettings& settings,
               std::uint64_t key, core::CancelToken cancelled = {});

    std::size_t count() const { return views_.size(); }                           ///< maps
    std::size_t memory_bytes() const { return inverse_.size() * sizeof(float); }  ///< of the maps

    /// 1 for each receiver that the light reaches, else 0.
    void look_up(std::size_t light, const ReceiverLanes& receivers, float* visible) const;
    /// Lookup of one point.
    bool visible(std::size_t light, const core::Vec3& position) const;

  private:
    void store(std::size_t light, std::span<const float> map);

    std::vector<ShadowMapView> views_;
    std::vector<float> inverse_;  ///< 1 / |d|_1 [1/m]; 0 where nothing is known to be in the way
    int size_ = 0;
    float margin_ = 0.0f;
};

/// Fills holes, zeros, of a map of size * size texels in place.
void pull_push(std::span<float> map, int size);
/// Gives a texel that lies behind five of its eight neighbours their mean.
void close_gaps(std::span<float> map, const ShadowMapView& view);

}  // namespace mote::lights
