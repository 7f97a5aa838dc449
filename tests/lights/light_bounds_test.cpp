// Bounds of light clusters: they hold for every kind of light and of receiver, and each of their factors
// matters.
#include <functional>

#include "lights/selection/hierarchy/cluster_bounds.h"
#include "lights/selection/lightcuts/gather_points.h"
#include "tests/lights/random_lights.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;
using lights::LightCluster, lights::LightNode;

namespace {

/// How often more arrives than the bound says, of how many pairs of a node and a receiver that any light
/// arrives at, and how often the bound is less than twice what arrives (of glossy
/// lights, whose lobe is known by its peak alone, a hundred times).
struct Tally {
    std::size_t pairs = 0, broken = 0, tight = 0;
};

using Change = std::function<void(LightNode&)>;

void compare(bool glossy, const lights::VplSet& set, const lights::LightHierarchy& tree,
             const LightCluster& c, const lights::ReceiverTile& tile, const lights::ReceiverBounds& bounds,
             float bound, const Change& change, Tally& tally) {
    std::array<double, 16> sum{};
    for (const std::uint32_t light : tree.lights(c)) {
        const auto one = sent(set, light, tile, bound);
        for (std::size_t i = 0; i < 16; ++i) sum[i] += one[i];
    }
    LightNode node = tree.node(c);
    if (change) change(node);
    const core::Lanes most = lights::upper_bound(node, bounds, bound);
    const core::Lanes expected = lights::importance(node, bounds, bound);
    for (std::size_t i = 0; i < 16; ++i) {
        if (!(sum[i] > 1e-30)) continue;
        ++tally.pairs;
        tally.broken += !(double(most.value[i]) >= sum[i]) || !(expected.value[i] > 0.0f);
        tally.tight += double(most.value[i]) < (glossy ? 100.0 : 2.0) * sum[i];
    }
    if (c.single()) return;
    compare(glossy, set, tree, tree.left(c), tile, bounds, bound, change, tally);
    compare(glossy, set, tree, tree.right(c), tile, bounds, bound, change, tally);
}

Tally tally(Lights kind, std::size_t pairs, std::uint64_t seed, const Change& change = {}) {
    const Materials& materials = all_materials();
    Rng rng(seed);
    Tally tally;
    while (tally.pairs < pairs) {
        const auto set = random_lights(rng, materials, kind, 1 + rng.next_u32() % 8,
                                       random_size(rng, -3, 0.5f), random_size(rng, -3, 0.5f));
        const lights::VplLeaves leaves(set);
        const lights::LightHierarchy tree(leaves);
        const RandomReceivers receivers(rng, materials, set.lights[0].position);
        const lights::ReceiverBounds bounds(receivers.tile);
        const float bound = rng.next_u32() % 2 ? infinity : random_size(rng, -1, 2);
        const bool glossy = kind == Lights::glossy;
        compare(glossy, set, tree, tree.root(), receivers.tile, bounds, bound, change, tally);
    }
    return tally;
}

}  // namespace

TEST_CASE("What groups of lights send is at most what the bound says", "[light_selection][bounds]") {
    for (const Lights kind : {Lights::plain, Lights::glossy, Lights::isotropic, Lights::lobes, Lights::all}) {
        const Tally result = tally(kind, 200000, 1 + std::uint64_t(kind));
        INFO("kind " << int(kind) << ": " << result.broken << " of " << result.pairs << ", " << result.tight
                     << " near them");
        CHECK(result.pairs >= 200000);
        CHECK(result.broken == 0);
        CHECK(double(result.tight) >
              (kind == Lights::glossy || kind == Lights::all ? 0.03 : 0.2) * double(result.pairs));
    }
}

TEST_CASE("Every part of a bound is needed", "[light_selection][bounds]") {
    const auto broken = [](Lights kind, const Change& change) { return tally(kind, 4000, 7, change).broken; };
    CHECK(broken(Lights::plain, {}) == 0);
    CHECK(broken(Lights::plain, [](LightNode& n) { n.energy *= 0.95f; }) > 0);
    CHECK(broken(Lights::plain, [](LightNode& n) { n.upper -= 0.3f * (n.upper - n.lower); }) > 0);
    CHECK(broken(Lights::plain, [](LightNode& n) { n.cos_angle = std::cos(0.7f * n.cone().angle); }) > 0);
    CHECK(broken(Lights::plain, [](LightNode& n) { ++n.min_depth; }) > 0);
    CHECK(broken(Lights::glossy, [](LightNode& n) { n.peak *= 0.01f; }) > 0);
    CHECK(broken(Lights::glossy, [](LightNode& n) { n.set_grazing(1e-4f * n.peak); }) > 0);
    CHECK(broken(Lights::lobes, [](LightNode& n) { n.cos_angle = std::cos(0.5f * n.cone().angle); }) > 0);
    CHECK(broken(Lights::lobes, [](LightNode& n) { n.g_high = n.g_low = 0; }) > 0);
    CHECK(broken(Lights::all, [](LightNode& n) {
              if (n.kind == lights::LightKind::mixed) n.kind = lights::LightKind::surface, n.peak = 1.0f;
          }) > 0);
}

TEST_CASE("Lobes over cones of directions are at most their bounds", "[light_selection][bounds]") {
    const Materials& materials = all_materials();
    Rng rng(5);
    std::size_t pairs = 0, tight = 0;
    for (int k = 0; k < 100000; ++k) {
        const ScatteringVertex v = rng.next_u32() % 4
                                       ? materials.surface(rng, Vec3(0.0f), random_direction(rng))
                                       : materials.volume(rng, Vec3(0.0f), random_direction(rng));
        const DirectionCone cone{random_direction(rng), random_size(rng, -3, 0.5f)};
        const Rgb bound = lights::eval_bound(v, cone);
        for (int i = 0; i < 10; ++i) {
            // Within the cone, and on its border as often.
            const float angle = cone.angle * (i % 2 ? 1.0f : rng.next_float());
            if (angle > pi) continue;
            const float phi = 2.0f * pi * rng.next_float();
            const Vec3 wi = Frame(cone.axis).to_world(
                {std::sin(angle) * std::cos(phi), std::sin(angle) * std::sin(phi), std::cos(angle)});
            const Rgb value = v.eval(wi, TransportMode::radiance);
            if (is_black(value)) continue;
            ++pairs, tight += bound.y < 2.0f * value.y;
            for (int c = 0; c < 3; ++c)
                if (!(value[c] <= bound[c])) FAIL_CHECK(value[c] << " above " << bound[c]);
        }
    }
    CHECK(pairs > 300000);
    CHECK(tight > pairs / 5);
}

TEST_CASE("Groups of receivers are bounded as their points are", "[light_selection][bounds]") {
    const Materials& materials = all_materials();
    Rng rng(9);
    std::size_t pairs = 0, broken = 0, too_few = 0;
    while (pairs < 200000) {
        const auto set = random_lights(rng, materials, Lights(rng.next_u32() % 5), 1 + rng.next_u32() % 4,
                                       random_size(rng, -3, 0.5f), random_size(rng, -2, 0.5f));
        const lights::VplLeaves leaves(set);
        const lights::LightHierarchy tree(leaves);
        lights::GatherPoints points;
        std::vector<std::unique_ptr<RandomReceivers>> receivers;
        std::array<double, 16> sum{};
        const float bound = rng.next_u32() % 2 ? infinity : random_size(rng, -1, 2);
        for (std::size_t n = 1 + rng.next_u32() % 4; n > 0; --n) {
            receivers.push_back(std::make_unique<RandomReceivers>(rng, materials, set.lights[0].position));
            points.add(receivers.back()->tile, lights::ReceiverKind::medium);
            for (std::size_t j = 0; j < set.lights.size(); ++j) {
                const auto one = sent(set, j, receivers.back()->tile, bound);
                for (std::size_t i = 0; i < 16; ++i) sum[i] += one[i];
            }
        }
        points.build(rng);
        const auto& node = points.node(points.root(lights::ReceiverKind::medium));
        const auto most = lights::upper_bound(tree.node(tree.root()), node.bounds, bound);
        for (std::size_t i = 0; i < 16; ++i) {
            if (!(sum[i] > 1e-30)) continue;
            ++pairs, broken += !(double(most.value[i]) >= sum[i]);
            too_few += !(double(most.value[i]) * 0.02 >= sum[i]);
        }
    }
    CHECK(broken == 0);
    CHECK(too_few > 0);
}
