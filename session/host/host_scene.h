// Another renderer's scene for the C interface and Python: diffuse materials, point lights and fog as data,
// rays by the host's functions.
#pragma once

#include "core/scene/callback_scene.h"
#include "core/scene/scattering_vertex.h"

namespace mote::session {

/// Segment of a ray, as the host traces it.
struct HostSegment {
    core::Vec3 origin{0.0f}, direction{0.0f};  ///< [m]; unit
    float length = 0.0f;                       ///< [m], infinity for a ray
};

/// First surface on a segment.
struct HostHit {
    float distance = 0.0f;       ///< from the origin, above 0 [m]
    core::Vec3 normal{0.0f};     ///< geometric, unit, on either side
    std::uint32_t material = 0;  ///< index into HostSceneData::reflectance
};

/// A light that shines to all sides.
struct HostLamp {
    core::Vec3d position{0.0};  ///< [m]
    core::Rgb intensity{0.0f};  ///< [W/sr]
};

/// A place on a surface, seen from the side of its normal.
struct HostReceiver {
    core::Vec3 position{0.0f}, normal{0.0f};  ///< [m]; unit
    std::uint32_t material = 0;               ///< index into HostSceneData::reflectance
};

struct HostSceneData {
    std::vector<core::Rgb> reflectance;  ///< of diffuse materials, both sides alike, in [0, 1]
    std::vector<HostLamp> lamps;
    core::Rgb scattering{0.0f}, absorption{0.0f};  ///< of fog that fills all space [1/m]
    float anisotropy = 0.0f;                       ///< mean cosine of scattering in fog, in (-1, 1)
    core::Bounds3 bounds;                          ///< holds all surfaces and lamps [m]
    /// Closest surface on a segment, its ends left out; from many threads at once.
    std::function<std::optional<HostHit>(const HostSegment&)> first_hit;
    /// Optional, for shadow rays in place of first_hit: sets hidden[i], which is 0, to 1 where a surface is
    /// on segment i. From many threads at once.
    std::function<void(std::span<const HostSegment>, std::span<std::uint8_t> hidden)> find_occluded;
};

/// The scene that algorithms query.
class HostScene {
  public:
    /// Throws InputError for data that cannot be, naming it.
    explicit HostScene(HostSceneData data);
    HostScene(const HostScene&) = delete;
    HostScene& operator=(const HostScene&) = delete;

    const core::CallbackScene& scene() const { return *scene_; }
    bool has_fog() const { return fog_ != nullptr; }
    float extinction() const;  ///< mean over channels [1/m]
    /// The vertex where an eye path along the normal ends. Throws InputError for a receiver that cannot be.
    core::ScatteringVertex vertex(const HostReceiver& receiver) const;

  private:
    std::optional<core::SurfaceHit> hit(const core::Ray& ray) const;
    const core::ForeignSurface& surface(std::uint32_t material) const;

    HostSceneData data_;
    float offset_;  // of rays that leave a surface [m]
    std::shared_ptr<core::Medium> fog_;
    std::vector<std::unique_ptr<core::ForeignSurface>> surfaces_;
    std::optional<core::CallbackScene> scene_;
};

}  // namespace mote::session
