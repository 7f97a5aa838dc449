#include "session/host/host_scene.h"

#include "core/materials/bsdfs.h"
#include "core/materials/textures.h"
#include "lights/emitters/emitters.h"
#include "media/homogeneous_medium.h"
#include "media/phase_functions.h"

namespace mote::session {

using core::Rgb, core::Vec3;

namespace {

bool is_unit(const Vec3& v) { return std::fabs(glm::dot(v, v) - 1.0f) < 1e-3f; }
bool all_within(const Rgb& v, float low, float high) {
    return v.x >= low && v.y >= low && v.z >= low && v.x <= high && v.y <= high && v.z <= high;
}

std::shared_ptr<core::Medium> fog_of(const HostSceneData& data) {
    const float most = std::numeric_limits<float>::max();
    if (!all_within(data.scattering, 0.0f, most) || !all_within(data.absorption, 0.0f, most))
        throw core::InputError("scattering and absorption of fog are finite and not below 0");
    if (core::is_black(data.scattering + data.absorption)) return nullptr;
    std::shared_ptr<core::PhaseFunction> phase = std::make_shared<media::IsotropicPhase>();
    if (data.anisotropy != 0.0f) phase = std::make_shared<media::HenyeyGreensteinPhase>(data.anisotropy);
    return std::make_shared<media::HomogeneousMedium>(data.scattering + data.absorption, data.scattering,
                                                      Rgb(0.0f), std::move(phase));
}

/// Between t_min and t_max, in lengths of the direction.
HostSegment segment(const Vec3& origin, const Vec3& direction, float t_min, float t_max) {
    const float length = glm::length(direction);
    return {origin + t_min * direction, direction / length, (t_max - t_min) * length};
}

/// All active lanes of the packets in one call of the host.
void find_occluded(const HostSceneData& data, std::span<core::ShadowPacket> packets) {
    std::vector<HostSegment> segments;
    const auto for_each_active = [&](const auto& visit) {
        for (core::ShadowPacket& packet : packets)
            for (int lane = 0; lane < core::ShadowPacket::width; ++lane)
                if (!(packet.t_max[lane] < packet.t_min[lane])) visit(packet, lane);
    };
    for_each_active([&](core::ShadowPacket& p, int lane) {
        segments.push_back(segment(p.origin(lane), p.direction(lane), p.t_min[lane], p.t_max[lane]));
    });
    if (segments.empty()) return;
    std::vector<std::uint8_t> hidden(segments.size());
    data.find_occluded(segments, hidden);
    std::size_t next = 0;
    for_each_active([&](core::ShadowPacket& packet, int lane) {
        if (hidden[next++]) packet.t_max[lane] = -core::infinity;
    });
}

}  // namespace

HostScene::HostScene(HostSceneData data)
    : data_(std::move(data)), offset_(1e-6f * data_.bounds.radius()), fog_(fog_of(data_)) {
    if (!data_.first_hit) throw core::InputError("a scene needs a function for the first hit");
    for (const Rgb& reflectance : data_.reflectance) {
        if (!all_within(reflectance, 0.0f, 1.0f)) throw core::InputError("a reflectance is between 0 and 1");
        surfaces_.push_back(std::make_unique<core::ForeignSurface>(
            core::make_diffuse(core::make_constant_texture(reflectance))));
    }
    core::SceneCallbacks calls;
    calls.first_hit = [this](const core::Ray& ray) { return hit(ray); };
    if (data_.find_occluded)
        calls.find_occluded = [this](std::span<core::ShadowPacket> packets) {
            find_occluded(data_, packets);
        };
    calls.medium = fog_, calls.bounds = data_.bounds;
    for (const HostLamp& lamp : data_.lamps) {
        if (!std::isfinite(glm::dot(lamp.position, lamp.position)))
            throw core::InputError("the position of a lamp is not finite");
        calls.emitters.push_back(lights::make_point_light(lamp.position, lamp.intensity));
    }
    scene_.emplace(std::move(calls));
}

float HostScene::extinction() const { return core::average(data_.scattering + data_.absorption); }

const core::ForeignSurface& HostScene::surface(std::uint32_t material) const {
    if (material >= surfaces_.size())
        throw core::InputError("there is no material " + std::to_string(material) + ": there are " +
                               std::to_string(surfaces_.size()));
    return *surfaces_[material];
}

std::optional<core::SurfaceHit> HostScene::hit(const core::Ray& ray) const {
    const HostSegment way = segment(ray.origin, ray.direction, ray.t_min, ray.t_max);
    const std::optional<HostHit> found = data_.first_hit(way);
    if (!found || !(found->distance > 0.0f && found->distance < way.length)) return {};
    if (!is_unit(found->normal)) throw core::InputError("the normal of a hit is not unit");
    const Vec3 normal = glm::dot(found->normal, ray.direction) < 0.0f ? found->normal : -found->normal;
    return surface(found->material).hit(ray, ray.t_min + found->distance, normal, offset_);
}

core::ScatteringVertex HostScene::vertex(const HostReceiver& receiver) const {
    if (!is_unit(receiver.normal) || !std::isfinite(glm::dot(receiver.position, receiver.position)))
        throw core::InputError("a receiver has a finite position and a unit normal");
    const core::Ray ray{receiver.position + receiver.normal, -receiver.normal};
    core::WalkEvent arrived;
    arrived.kind = core::WalkEvent::Kind::surface;
    arrived.hit = surface(receiver.material).hit(ray, 1.0f, receiver.normal, offset_);
    arrived.hit.position = receiver.position;  // without the rounding of a ray
    return core::make_vertex(arrived, ray);
}

}  // namespace mote::session
