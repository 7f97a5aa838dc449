// Which virtual point lights each part of the surfaces can see: lists that let a tile of receivers look at
// few lights (`light_lists` of `mote_vpl`).
//
// Surfaces are parted into items: cells of a grid over the scene, and in each the six directions that a
// normal may lie nearest to. A light's view is a small picture of items, found by rays. The pictures of many
// lights are the tiles of one, and one hierarchical item buffer counts them all: the bins of an item are the
// lights that see it (screenspace/visibility). A light that is not on a list may still shine there, where a
// texel has missed it, so such lights are taken by chance and count more: lists make noise, and no bias.
#pragma once

#include <span>
#include <vector>

#include "core/geometry/ray_counters.h"
#include "core/math/bounds.h"
#include "core/objects/cancellation.h"
#include "core/scene/ray_queries.h"
#include "lights/virtual_lights/virtual_point_light.h"
#include "screenspace/visibility/id_picture.h"

namespace mote::integrators {

struct LightListSettings {
    int size = 0;   ///< texels along an edge of a light's picture; 0: no lists
    int cells = 8;  ///< along the longest edge of the scene
    int rest = 8;   ///< of the lights that are not on a list one in so many is taken
};

/// The number of an item by its place. Outside of the bounds the nearest cell is meant.
class SurfaceItems {
  public:
    SurfaceItems(const core::Bounds3& bounds, int cells);
    std::size_t count() const {
        return 6 * std::size_t(cells_.x) * std::size_t(cells_.y) * std::size_t(cells_.z);
    }
    std::size_t item(const core::Vec3& position, const core::Vec3& normal) const;

  private:
    core::Vec3 lower_, per_metre_;
    glm::ivec3 cells_;
};

class VplLightLists {
  public:
    /// Asks every light of `vpls` for its picture, on the threads of TBB. Throws core::Cancelled.
    VplLightLists(const core::RayQueries& scene, const SurfaceItems& items, const lights::VplSet& vpls,
                  const LightListSettings& settings, core::CancelToken cancelled);

    std::size_t words() const { return words_; }
    /// Sets the bits of the lights that see an item in `list`, which has words() numbers.
    void add(std::size_t item, std::span<std::uint64_t> list) const;
    const core::RayCounters& rays() const { return rays_; }

  private:
    struct View {
        std::size_t light;
        std::uint32_t side;
    };
    void look(const core::RayQueries& scene, const SurfaceItems& items, const lights::VplSet& vpls,
              const LightListSettings& settings, std::span<const View> views, core::CancelToken cancelled);
    void enter(const screenspace::IdPicture& picture, std::span<const View> views, int t);

    std::size_t words_;
    std::vector<std::uint32_t> row_;    ///< of each item, or no_item
    std::vector<std::uint64_t> lists_;  ///< words_ a row
    core::RayCounters rays_;
};

}  // namespace mote::integrators
