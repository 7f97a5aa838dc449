#include "gathering/stored_light/lit_volume.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/math/random.h"
#include "core/objects/error.h"
#include "core/objects/memory_error.h"

namespace mote::gathering {

using namespace core;

namespace {

/// Places that are looked up for each point that is drawn among them, and how many at least: their cells hold
/// the extinction, too.
constexpr std::uint64_t places_per_point = 4, fewest_cells = 32768, most_cells = std::uint64_t(1) << 24;

MicroBufferSettings over_sphere(MicroBufferSettings settings) {
    settings.map = HemisphereMap::equal_area;
    return settings;
}

MediumSamples samples_of(const LitScene& scene, std::uint32_t points, const MediumStateAt& state_at,
                         std::uint64_t key, CancelToken cancelled) {
    const auto cells = std::clamp(places_per_point * points, fewest_cells, most_cells);
    return sample_media(media_box(scene), std::uint32_t(cells), hash_keys(key, 0x63656c6cull), state_at,
                        cancelled);
}

}  // namespace

void LitVolume::check_memory(std::uint32_t points, std::size_t budget) {
    constexpr std::size_t each = places_per_point * (2 * sizeof(ScatteringPlace) + sizeof(Rgb)) +
                                 PointHierarchy::bytes_per_point + sizeof(MediumState) + sizeof(Fluence) +
                                 VolumeLight::bytes_per_point;
    if (points > budget / each)
        throw InputError(fmt::format("{} points in media take{}; {} fit into the{} allowed", points,
                                     memory_text(double(points) * double(each)), budget / each,
                                     memory_text(double(budget))));
}

LitVolume::LitVolume(const LitScene& scene, const PointHierarchy& surfaces, const MicroBuffers& hemispheres,
                     const MicroBufferSettings& buffers, const LitVolumeSettings& settings,
                     const MediumStateAt& state_at, std::uint64_t key, CancelToken cancelled)
    : LitVolume(samples_of(scene, settings.points, state_at, key, cancelled), surfaces, hemispheres, buffers,
                settings, key) {}

LitVolume::LitVolume(MediumSamples samples, const PointHierarchy& surfaces, const MicroBuffers& hemispheres,
                     const MicroBufferSettings& buffers, const LitVolumeSettings& settings, std::uint64_t key)
    : extinction_(std::move(samples.extinction)),
      points_(draw_volume_points(samples, settings.points, key)),
      hierarchy_(points_),
      sphere_buffers_(surfaces, over_sphere(buffers)),
      hemispheres_(hemispheres, hierarchy_, extinction_, settings.cut),
      spheres_(sphere_buffers_, hierarchy_, extinction_, settings.cut) {}

std::size_t LitVolume::memory_bytes() const {
    return extinction_.memory_bytes() + hierarchy_.tree().memory_bytes() +
           points_.size() * (sizeof(Vec3) + sizeof(Rgb) + sizeof(MediumState) + 2 * sizeof(float) +
                             sizeof(Fluence) + VolumeLight::bytes_per_point);
}

}  // namespace mote::gathering
