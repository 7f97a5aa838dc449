// Random virtual point lights and receivers of every kind, without a scene: for tests of what is known of
// groups of them.
#pragma once

#include <deque>
#include <memory>

#include "core/materials/bsdfs.h"
#include "core/math/random.h"
#include "lights/selection/hierarchy/light_hierarchy.h"
#include "lights/selection/hierarchy/receiver_bounds.h"
#include "lights/selection/hierarchy/vertex_bounds.h"
#include "lights/virtual_lights/vpl_gather.h"
#include "media/phase_functions.h"

namespace mote::tests {

inline core::Vec3 random_direction(core::Rng& rng) {
    const core::Vec2 u = rng.next_vec2();
    const float z = 2.0f * u.x - 1.0f, r = core::safe_sqrt(1.0f - z * z), phi = 2.0f * core::pi * u.y;
    return {r * std::cos(phi), r * std::sin(phi), z};
}
/// Within about `spread` of an axis.
inline core::Vec3 random_direction(core::Rng& rng, const core::Vec3& axis, float spread) {
    return glm::normalize(axis + spread * random_direction(rng));
}
/// Between 10^a and 10^b, evenly in its logarithm.
inline float random_size(core::Rng& rng, float a, float b) {
    return std::pow(10.0f, a + (b - a) * rng.next_float());
}

/// BSDFs whose lobes are bounded, and phase functions.
struct Materials {
    std::vector<std::shared_ptr<core::Bsdf>> bsdfs;
    std::vector<std::unique_ptr<media::HenyeyGreensteinPhase>> phases;
    media::IsotropicPhase isotropic;

    Materials() {
        using namespace core;
        PlasticParameters diamond;
        diamond.int_ior = 2.4f;
        const ConductorParameters copper{{Rgb(0.2f, 0.9f, 1.1f), Rgb(3.9f, 2.4f, 2.2f)}};
        for (const auto kind : {MicrofacetKind::ggx, MicrofacetKind::beckmann})
            for (const float alpha : {0.02f, 0.1f, 0.4f, 1.0f}) {
                bsdfs.push_back(make_rough_plastic({}, Microfacet(kind, alpha)));
                bsdfs.push_back(make_rough_conductor(copper, Microfacet(kind, alpha, 0.5f * alpha + 0.1f)));
                bsdfs.push_back(make_twosided(make_rough_plastic(diamond, Microfacet(kind, alpha))));
            }
        for (const float g : {0.3f, -0.4f, 0.8f, 0.95f})
            phases.push_back(std::make_unique<media::HenyeyGreensteinPhase>(g));
    }
    core::ScatteringVertex surface(core::Rng& rng, const core::Vec3& position,
                                   const core::Vec3& normal) const {
        core::ScatteringVertex v;
        v.position = position, v.bsdf = bsdfs[rng.next_u32() % bsdfs.size()].get();
        v.hit.position = position, v.hit.geometric_normal = normal, v.hit.t = 1.0f;
        v.hit.shading = core::Frame(random_direction(rng, normal, 0.1f));
        do v.wo = random_direction(rng);
        while (glm::dot(v.wo, normal) < 0.05f || glm::dot(v.wo, v.hit.shading.n) < 0.05f);
        return v;
    }
    core::ScatteringVertex volume(core::Rng& rng, const core::Vec3& position, const core::Vec3& wo) const {
        core::ScatteringVertex v;
        v.position = position, v.wo = wo;
        v.phase = phases[rng.next_u32() % phases.size()].get();
        return v;
    }
};

/// Made once: rough plastics tabulate their transmittance.
inline const Materials& all_materials() {
    static const Materials materials;
    return materials;
}

enum class Lights { plain, glossy, isotropic, lobes, all };

/// A group of lights in a box, whose normals or lobes lie in a cone.
inline lights::VplSet random_lights(core::Rng& rng, const Materials& materials, Lights kind,
                                    std::size_t count, float size, float spread) {
    using namespace core;
    lights::VplSet set;
    const Vec3 axis = random_direction(rng), middle = random_direction(rng);
    const Vec3 box = size * Vec3(rng.next_float(), rng.next_float(), rng.next_float());
    for (std::size_t j = 0; j < count; ++j) {
        const auto own = kind == Lights::all ? Lights(rng.next_u32() % 4) : kind;
        lights::VirtualPointLight vpl;
        vpl.position = middle + box * (Vec3(rng.next_float(), rng.next_float(), rng.next_float()) - 0.5f);
        vpl.intensity = random_size(rng, -2, 2) * Rgb(rng.next_float(), rng.next_float(), rng.next_float());
        vpl.depth = 1 + rng.next_u32() % 3;
        const Vec3 direction = random_direction(rng, axis, spread);
        if (own == Lights::plain || own == Lights::glossy) {
            vpl.normal = direction;
            vpl.shading_normal = random_direction(rng, direction, 0.1f);
        }
        if (own == Lights::glossy || own == Lights::lobes) {
            vpl.detail = std::uint32_t(set.details.size());
            set.details.push_back({own == Lights::glossy ? materials.surface(rng, vpl.position, direction)
                                                         : materials.volume(rng, vpl.position, direction)});
        }
        set.lights.push_back(vpl);
    }
    return set;
}

/// Sixteen receivers of all kinds, around the middle of things and around the first light.
struct RandomReceivers {
    std::array<core::ScatteringVertex, 16> vertices;
    lights::ReceiverTile tile;
    std::shared_ptr<core::Bsdf> diffuse = core::make_diffuse();

    RandomReceivers(core::Rng& rng, const Materials& materials, const core::Vec3& light, bool glossy = true) {
        using namespace core;
        for (std::size_t i = 0; i < 16; ++i) {
            Vec3 p = random_size(rng, -1, 1.5f) * random_direction(rng);
            if (rng.next_float() < 0.4f) p = light + random_size(rng, -3, 0) * random_direction(rng);
            ScatteringVertex& v = vertices[i];
            const std::uint32_t kind = rng.next_u32() % (glossy ? 4 : 2);
            if (kind == 0 || kind == 2) v = materials.surface(rng, p, random_direction(rng));
            if (kind == 1 || kind == 3) v = materials.volume(rng, p, random_direction(rng));
            if (kind == 0) v.bsdf = diffuse.get();
            if (kind == 1) v.phase = &materials.isotropic;
            const Rgb throughput(rng.next_float(), rng.next_float(), rng.next_float());
            tile.set(int(i), v, throughput, MediumState{}, Rng(i), 1 + std::int32_t(rng.next_u32() % 3));
        }
    }
};

/// Unoccluded contribution of one light to the receivers, mean of the channels.
inline std::array<double, 16> sent(const lights::VplSet& set, std::size_t light,
                                   const lights::ReceiverLanes& receivers, float bound) {
    static thread_local core::ShadowPacket packet;
    static thread_local lights::LaneLight out;
    std::array<double, 16> sum{};
    if (!lights::contributions_of(set, {light}, receivers, lights::BoundedGeometry{bound}, packet, out))
        return sum;
    for (std::size_t i = 0; i < 16; ++i)
        sum[i] = (double(out.r[i]) + double(out.g[i]) + double(out.b[i])) / 3.0;
    return sum;
}

}  // namespace mote::tests
