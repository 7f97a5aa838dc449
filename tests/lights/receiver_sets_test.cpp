// Receivers that share shadow rays, and the quick loop over lobes.
#include "lights/selection/lightcuts/receiver_sets.h"

#include "lights/virtual_lights/lobe_contributions.h"
#include "media/phase_functions.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using lights::ReceiverLanes, lights::ReceiverSets;

namespace {

/// Eight receivers on a floor, six on a wall beside it, one in the air, one idle.
ReceiverLanes corner() {
    ReceiverLanes x;
    for (int i = 0; i < ReceiverLanes::width; ++i) {
        const bool floor = i < 8, air = i == 14;
        const Vec3 n = air ? Vec3(0.0f) : floor ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
        const Vec3 p = floor ? Vec3(0.1f * float(i % 4), 0.0f, 0.1f * float(i / 4))
                             : Vec3(0.0f, 0.1f * float(i % 4), 0.1f * float(i / 4 - 2));
        x.x[i] = p.x, x.y[i] = p.y, x.z[i] = p.z;
        x.geometric_x[i] = n.x, x.geometric_y[i] = n.y, x.geometric_z[i] = n.z;
        x.in_medium[i] = air ? 1.0f : 0.0f, x.max_vpl_depth[i] = i == 15 ? 0 : 100;
    }
    return x;
}

}  // namespace

TEST_CASE("Receivers that share a ray lie on one face, as near as they say", "[light_selection]") {
    const ReceiverLanes x = corner();
    const ReceiverSets sets(x);
    CHECK(sets.stages() == 13);  // 15 sets in the beginning, three in the end
    for (const float diameter : {0.0f, 0.11f, 0.15f, 0.25f, 100.0f}) {
        const auto& of = sets.within(diameter);
        for (int i = 0; i < 16; ++i)
            for (int j = 0; j < 16; ++j) {
                if (of[std::size_t(i)] != of[std::size_t(j)] || i == j) continue;
                REQUIRE((i != 15 && j != 15));
                CHECK(i / 8 == j / 8);
                CHECK((i == 14) == (j == 14));
                CHECK(glm::length(x.position(i) - x.position(j)) <= diameter * 1.0001f);
            }
        CHECK(of[15] == ReceiverSets::none);
    }
    // Nothing is shared where nothing may be, and everything on a face where everything may.
    for (int i = 0; i < 15; ++i) CHECK(sets.within(0.0f)[std::size_t(i)] == i);
    for (int i = 0; i < 8; ++i) CHECK(sets.within(100.0f)[std::size_t(i)] == sets.within(100.0f)[0]);
    CHECK(ReceiverSets(ReceiverLanes{}).within(1.0f)[3] == ReceiverSets::none);
}

TEST_CASE("The loop over lobes sends what f* says", "[light_selection]") {
    Rng rng(5);
    const media::HenyeyGreensteinPhase forward{0.7f}, backward{-0.3f};
    const media::IsotropicPhase isotropic;
    const auto direction = [&] {
        const float z = 2.0f * rng.next_float() - 1.0f, phi = 2.0f * pi * rng.next_float(),
                    r = std::sqrt(std::max(1.0f - z * z, 0.0f));
        return Vec3(r * std::cos(phi), r * std::sin(phi), z);
    };
    std::array<ScatteringVertex, 16> vertices;
    lights::ReceiverTile tile;
    for (int i = 0; i < 16; ++i) {
        ScatteringVertex& v = vertices[std::size_t(i)];
        v.position = direction(), v.wo = direction();
        v.phase = i % 3 == 0   ? static_cast<const PhaseFunction*>(&isotropic)
                  : i % 3 == 1 ? &forward
                               : &backward;
        tile.set(i, v, Rgb(0.3f, 0.2f, 0.1f), {}, Rng(1), i == 4 ? 1 : 100);
    }
    const lights::ReceiverLobes lobes(tile);
    CHECK(lobes.known);
    lights::VplSet set;
    for (const PhaseFunction* phase :
         {static_cast<const PhaseFunction*>(&isotropic), static_cast<const PhaseFunction*>(&forward),
          static_cast<const PhaseFunction*>(&backward)})
        for (int k = 0; k < 20; ++k) {
            ScatteringVertex v;
            v.position = 2.0f * direction(), v.wo = direction(), v.phase = phase;
            lights::append_vpl(set, v, Rgb(1.0f, 2.0f, 3.0f), 2, 0);
        }
    for (std::size_t j = 0; j < set.lights.size(); ++j) {
        ShadowPacket packet, packet_again;
        lights::LaneLight quick, slow;
        const lights::BoundedGeometry bound{j % 2 ? 0.2f : infinity};
        CHECK(lights::lobe_contributions(set, {j, 1.5f}, tile, lobes, bound, packet, quick));
        CHECK(lights::contributions_of(set, {j, 1.5f}, tile, bound, packet_again, slow));
        for (int i = 0; i < 16; ++i) {
            CHECK(quick.r[i] == Approx(slow.r[i]).epsilon(1e-4));
            CHECK(quick.b[i] == Approx(slow.b[i]).epsilon(1e-4));
            CHECK((packet.t_max[i] > 0.0f) == (i != 4));
        }
    }
}
