// The light hierarchy: probabilities that add up to 1, bounds that hold, the same for every scale.
#include "core/scene/light_tree.h"
#include "core/math/random.h"
#include "core/math/warp.h"
#include "core/scene/scene.h"
#include "tests/core/scene/scene_fixture.h"

namespace {

using namespace mote::core;
using namespace mote::tests;

Vec3 in_cube(Rng& rng) { return {rng.next_float(), rng.next_float(), rng.next_float()}; }
Vec3 any_direction(Rng& rng) { return square_to_sphere({rng.next_float(), rng.next_float()}); }

/// Points, spots and small panels in the unit cube, powers 1 : 1e6 apart.
std::vector<LightBounds> mixed_lights(std::size_t n, Rng& rng, float scale = 1.0f) {
    std::vector<LightBounds> lights;
    for (std::size_t i = 0; i < n; ++i) {
        LightBounds light;
        const Vec3 p = in_cube(rng), axis = any_direction(rng), size = 0.05f * in_cube(rng);
        const float kind = rng.next_float();
        light.box = {scale * p, scale * p};
        if (kind < 0.6f) light.normals = DirectionCone::of(axis);
        if (kind < 0.3f) light.box.upper = scale * (p + size);
        if (kind < 0.1f) light.back = 0.5f * glm::dot(glm::abs(axis), light.box.diagonal());
        if (kind >= 0.3f && kind < 0.6f) light.reach = 0.1f + rng.next_float();
        light.intensity = std::pow(10.0, 6.0 * double(rng.next_float()));
        lights.push_back(light);
    }
    return lights;
}

template <typename Where>
double total(const LightTree& tree, const Where& where) {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < tree.size(); ++i) sum += tree.probability(where, i);
    return sum;
}

}  // namespace

TEST_CASE("The probabilities of all lights add up to 1 for any receiver", "[lights][light_tree]") {
    Rng rng(3);
    const std::size_t n = GENERATE(1, 2, 3, 1000);
    const LightTree tree(mixed_lights(n, rng));
    REQUIRE(tree.size() == n);
    for (int i = 0; i < 20; ++i) {
        const LightReceiver in_air{3.0f * in_cube(rng) - 1.0f};
        CHECK(total(tree, in_air) == Approx(1.0).epsilon(1e-9));
        CHECK(total(tree, LightReceiver{in_air.position, any_direction(rng)}) == Approx(1.0).epsilon(1e-9));
        CHECK(total(tree, LightSegment{in_air.position, any_direction(rng), 0.0f, i % 2 ? 1.0f : infinity}) ==
              Approx(1.0).epsilon(1e-9));
    }
}

TEST_CASE("A light tree samples with the probabilities that it states", "[lights][light_tree]") {
    Rng rng(5);
    const LightTree tree(mixed_lights(60, rng));
    const LightReceiver receiver{in_cube(rng), any_direction(rng)};
    const LightSegment segment{in_cube(rng), any_direction(rng), 0.1f, 2.0f};
    constexpr int samples = 200000;
    const auto check = [&](const auto& where) {
        std::vector<int> sampled(tree.size());
        double worst = 0.0;
        for (int i = 0; i < samples; ++i) {
            const auto choice = tree.sample(where, (double(i) + double(rng.next_float())) / samples);
            ++sampled[choice.light];
            worst =
                std::max(worst, std::abs(choice.probability / tree.probability(where, choice.light) - 1.0));
        }
        CHECK(worst < 1e-9);
        // One stratum a sample: each light's count is off by less than the strata at its ends, if it samples
        // as it states.
        for (std::uint32_t i = 0; i < tree.size(); ++i)
            CHECK(std::abs(double(sampled[i]) - samples * tree.probability(where, i)) <= 2.0);
    };
    check(receiver);
    check(segment);
}

TEST_CASE("Lights that shine on a receiver can be sampled there", "[lights][light_tree]") {
    // Probability of a light that illuminates the receiver: its importance, and those of the clusters that
    // hold it, must not be 0 where one of its points emits towards the receiver.
    Rng rng(7);
    const auto lights = mixed_lights(400, rng);
    const LightTree tree(lights);
    int lit = 0;
    for (int i = 0; i < 2000; ++i) {
        const auto chosen = std::uint32_t(rng.next_float() * 400.0f);
        const LightBounds& light = lights[chosen];
        const LightReceiver receiver{2.0f * in_cube(rng) - 0.5f, any_direction(rng)};
        const Vec3 point = light.box.lower + in_cube(rng) * light.box.diagonal();
        const Vec3 wi = glm::normalize(point - receiver.position);
        const bool faces =
            light.normals.angle >= pi ||
            std::acos(std::clamp(-glm::dot(wi, light.normals.axis), -1.0f, 1.0f)) < light.reach;
        if (!faces || !(glm::dot(wi, receiver.normal) > 0.0f)) continue;
        ++lit;
        CHECK(tree.probability(receiver, chosen) > 0.0);
        const LightSegment segment{receiver.position - 0.3f * receiver.normal, receiver.normal, 0.0f, 0.6f};
        CHECK(tree.probability(segment, chosen) > 0.0);
    }
    CHECK(lit > 300);
}

TEST_CASE("A tree does not depend on the scale of the scene", "[lights][light_tree]") {
    const float scale = GENERATE(0x1p-20f, 0x1p-10f, 0x1p20f, 1e-6f, 1e6f);
    int exponent;
    const bool power_of_two = std::frexp(scale, &exponent) == 0.5f;
    Rng rng(9), same(9), at(11);
    const LightTree tree(mixed_lights(300, rng)), scaled(mixed_lights(300, same, scale));
    for (int i = 0; i < 50; ++i) {
        const Vec3 p = in_cube(at), n = any_direction(at);
        const auto light = std::uint32_t(at.next_float() * 300.0f);
        const double a = tree.probability(LightReceiver{p, n}, light);
        const double b = scaled.probability(LightReceiver{scale * p, n}, light);
        // Powers of two: nothing but the exponents differs. Others: rounding of places.
        CHECK(b == Approx(a).epsilon(power_of_two ? 1e-9 : 1e-3));
    }
}

TEST_CASE("Trees deeper than 32 nodes, lights in one place, lights in a row", "[lights][light_tree]") {
    std::vector<LightBounds> powers_of_two, one_place(50), row;
    for (int i = 0; i < 1000; ++i) {  // nearly all that single precision has, squares beyond it
        LightBounds light;
        const Vec3 p(std::exp2(0.245f * float(i) - 120.0f), 0.0f, 0.0f);
        light.box = {p, p}, light.intensity = 1.0;
        powers_of_two.push_back(light);
    }
    for (int i = 0; i < 1000; ++i) {
        LightBounds light;
        const Vec3 p(float(i), 0.0f, 0.0f);
        light.box = {p, p}, light.intensity = 1.0;
        row.push_back(light);
    }
    for (LightBounds& light : one_place) light.box = {Vec3(1), Vec3(1)}, light.intensity = 2.0;
    const LightTree deep(powers_of_two), heap(one_place), straight(row);
    CHECK(deep.depth() > 32);
    CHECK(straight.depth() <= 6);
    const LightReceiver receiver{{0.3f, 0.5f, 0.0f}};
    for (const LightTree* tree : {&deep, &heap, &straight}) CHECK(total(*tree, receiver) == Approx(1.0));
    // Intensity over the square of the distance, where groups are far away: twice as far, a quarter.
    CHECK(heap.probability(receiver, 7) == Approx(1.0 / 50.0));
    // The receiver in the very place of the lights.
    CHECK(total(heap, LightReceiver{Vec3(1)}) == Approx(1.0));
}

TEST_CASE("Light is sampled by the receiver, and from outside the hierarchy by power", "[scene][lights]") {
    const auto scene = load_body(
        "<shape type='sphere'/>"
        "<emitter type='point'><point name='position' x='-4' y='0' z='0'/><rgb name='intensity' "
        "value='1'/></emitter>"
        "<emitter type='point'><point name='position' x='4' y='0' z='0'/><rgb name='intensity' "
        "value='1'/></emitter>"
        "<emitter type='point'><rgb name='intensity' value='0'/></emitter>"
        "<emitter type='constant'><rgb name='radiance' value='1'/></emitter>");
    const auto lights = scene->emitters();
    const LightReceiver near_second{{3, 0, 0}};
    double sum = 0.0;
    for (const auto& light : lights) sum += double(scene->light_probability(near_second, light.get()));
    CHECK(sum == Approx(1.0));
    const float sky = scene->light_probability(near_second, lights[3].get());
    CHECK(sky == scene->light_probability({{-3, 0, 0}}, lights[3].get()));
    CHECK(scene->light_probability(near_second, lights[2].get()) == 0.0f);
    // 15/16 by the hierarchy, 1 / 1 against 1 / 49; the rest alike.
    CHECK(scene->light_probability(near_second, lights[1].get()) ==
          Approx((1.0f - sky) * (0.98f * 15.0f / 16.0f + 0.5f / 16.0f)));
    const LightChoice choice = scene->choose_light(near_second, sky > 0.5f ? 0.25f : 0.75f);
    CHECK(choice.probability == scene->light_probability(near_second, choice.emitter));
    // Behind a receiver's surface: never by the hierarchy.
    CHECK(scene->light_probability({{0, 0, 0}, {1, 0, 0}}, lights[0].get()) ==
          Approx((1.0f - sky) * 0.5f / 16.0f));
    // All black: finite, and some light.
    const auto black =
        load_body("<shape type='sphere'/><emitter type='point'><rgb name='intensity' value='0'/></emitter>");
    CHECK(black->choose_light({}, 0.3f).probability == 1.0f);
    const auto by_power = load_body(
        "<shape type='sphere'/><emitter type='point'><rgb name='intensity' value='3'/></emitter>"
        "<emitter type='point'><rgb name='intensity' value='1'/></emitter>");
    CHECK(by_power->choose_emitter_by_power(0.7f).emitter == by_power->emitters()[0].get());
    CHECK(by_power->choose_emitter_by_power(0.8f).probability == Approx(0.25));
}
