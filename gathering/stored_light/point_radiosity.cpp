#include "gathering/stored_light/point_radiosity.h"

#include <algorithm>

#include "gathering/stored_light/micro_receiver.h"

namespace mote::gathering {

using namespace core;

namespace {

/// Normals of places that share what one of them gathers differ by less than about 25 degrees.
constexpr float alike = 0.9f;
/// Receivers between two tests for cancellation: some tenths of a second.
constexpr std::size_t between_looks = 2048;

/// The places of each surfel: front and back, or none.
std::vector<std::array<std::uint32_t, 2>> places_of_surfels(const SurfelSides& sides, std::size_t surfels) {
    std::vector<std::array<std::uint32_t, 2>> places(surfels, {MicroTexel::nothing, MicroTexel::nothing});
    for (std::size_t i = 0; i < sides.size(); ++i) places[sides.surfel(i)][sides.back(i)] = std::uint32_t(i);
    return places;
}

}  // namespace

GatheringPlaces gathering_places(const PointHierarchy& hierarchy, const SurfelSides& sides,
                                 std::uint32_t level) {
    GatheringPlaces result;
    result.by.resize(sides.size());
    const auto of_surfel = places_of_surfels(sides, hierarchy.points());
    const std::uint32_t step = 1u << std::min(level, 24u);
    // Points that follow each other along the hierarchy may be far apart, where its curve jumps.
    const float reach = 2.0f * hierarchy.disc_radius() * std::sqrt(float(step));
    struct Chosen {
        Vec3 normal, position;
        std::uint32_t entry;
    };
    std::vector<Chosen> chosen;  // in the node
    for (std::uint32_t leaf = 0; leaf < hierarchy.points(); ++leaf) {
        if (leaf % step == 0) chosen.clear();
        for (const std::uint32_t place : of_surfel[hierarchy.order()[leaf]]) {
            if (place == MicroTexel::nothing) continue;
            const PointNode& node = hierarchy.nodes()[leaf];
            const Vec3 normal = node.axis * (sides.back(place) ? -1.0f : 1.0f);
            const auto found = std::find_if(chosen.begin(), chosen.end(), [&](const Chosen& c) {
                return glm::dot(c.normal, normal) > alike && glm::distance(c.position, node.center) < reach;
            });
            if (found != chosen.end()) {
                result.by[place] = found->entry;
                continue;
            }
            chosen.push_back({normal, node.center, std::uint32_t(result.gather.size())});
            result.by[place] = chosen.back().entry;
            result.gather.push_back(place);
        }
    }
    return result;
}

std::vector<Rgb> point_radiosity(const PointHierarchy& hierarchy, const MicroBuffers& buffers,
                                 const SurfelSides& sides, std::vector<Rgb> arriving,
                                 const PointRadiositySettings& settings) {
    if (settings.bounces == 0 || sides.size() == 0) return arriving;
    const GatheringPlaces places = gathering_places(hierarchy, sides, settings.level);
    std::vector<MicroReceiver> receivers;
    receivers.reserve(places.gather.size());
    for (const std::uint32_t place : places.gather)
        receivers.push_back(
            micro_receiver(sides.vertex(place), Rng(hash_keys(settings.key, place)).next_float()));
    std::vector<Rgb> light = arriving, gathered(receivers.size());
    for (int bounce = 0; bounce < settings.bounces; ++bounce) {
        const SurfelSides::Radiance sent = sides.reflected(light);
        const NodeRadiance radiance(hierarchy, sent.front, sent.back);
        for (std::size_t begin = 0; begin < receivers.size(); begin += between_looks) {
            settings.cancelled.check();
            const std::size_t count = std::min(between_looks, receivers.size() - begin);
            gather_irradiance(buffers, radiance, std::span(receivers).subspan(begin, count),
                              std::span(gathered).subspan(begin, count));
        }
        for (std::size_t i = 0; i < light.size(); ++i) light[i] = arriving[i] + gathered[places.by[i]];
    }
    return light;
}

}  // namespace mote::gathering
