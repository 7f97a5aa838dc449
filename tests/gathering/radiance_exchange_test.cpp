// The exchange of radiance: symmetric, unbiased for each direction, and in a closed furnace the sum of all
// its reflections.
#include "tests/gathering/furnace_scenes.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;
using namespace mote::tests;

namespace {

const std::string room = R"(<scene version="3.0.0">
    <shape type="cube"><boolean name="flip_normals" value="true"/><bsdf type="diffuse"/></shape>
    <shape type="sphere"><float name="radius" value="0.4"/><bsdf type="diffuse"/></shape>
    <shape type="rectangle"><transform name="to_world"><scale value="0.3"/><translate x="0.5" z="0.6"/></transform>
        <bsdf type="twosided"><bsdf type="diffuse"/></bsdf></shape>
    <emitter type="point"/><sensor type="perspective"/></scene>)";

Rgb4Vector random_light(std::size_t n, std::uint64_t key) {
    Rgb4Vector light(n);
    Rng rng(key);
    for (Rgb4& l : light) l = {rng.next_float(), rng.next_float(), rng.next_float(), 0.0f};
    return light;
}

double dot(const Rgb4Vector& a, const Rgb4Vector& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += double(a[i].r) * double(b[i].r) + double(a[i].g) * double(b[i].g) +
               double(a[i].b) * double(b[i].b);
    return sum;
}

Rgb4Vector received(const SurfaceAtlas& atlas, const RayBundle& bundle, const Rgb4Vector& sent) {
    Rgb4Vector result(atlas.size());
    exchange_radiance(atlas, bundle, {sent.data(), nullptr, nullptr}, {result.data(), nullptr});
    return result;
}

}  // namespace

// Symmetry of the exchange: with T the exchange along one direction, as power a link, <x, T y> = <T x, y> for
// any radiances x and y; and all power that is sent is received.
TEST_CASE("the exchange is symmetric, direction by direction", "[exchange]") {
    const ExchangeStage stage(room, {.texels_per_metre = 6.0f});
    const Rgb4Vector x = random_light(stage.atlas.size(), 1), y = random_light(stage.atlas.size(), 2);
    const Rgb4Vector one(stage.atlas.size(), Rgb4{1, 1, 1, 0});
    for (std::uint32_t i = 0; i < 12; ++i) {
        const BundleSample sample = bundle_sample(3, i);
        const BundleGrid grid = bundle_grid(sample.direction, stage.surfaces.bounds, 0.1f, sample.offset);
        const RayBundle bundle = stage.tracer.trace(grid);
        const Rgb4Vector tx = received(stage.atlas, bundle, x), ty = received(stage.atlas, bundle, y);
        CHECK(dot(x, ty) == Approx(dot(tx, y)).epsilon(1e-6));
        const auto uses_back = [&](std::uint32_t triangle) {
            return stage.atlas.texel(triangle, 0.3f, 0.3f, SurfaceSide::back) != SurfaceAtlas::none;
        };
        double sent = 0.0;  // link by link, in another loop
        for_each_link(bundle, uses_back, [&](std::size_t, const BundleHit& near, const BundleHit& far) {
            const auto light = [&](const BundleHit& hit, bool towards) {
                const SurfaceSide side =
                    hit.from_behind() == towards ? SurfaceSide::front : SurfaceSide::back;
                const Rgb4& l = x[stage.atlas.texel(hit.index(), hit.u(), hit.v(), side)];
                return double(l.r) + double(l.g) + double(l.b);
            };
            sent += light(near, true) + light(far, false);
        });
        CHECK(dot(tx, one) == Approx(sent).epsilon(1e-6));
        CHECK(sent > 0.0);
        // Planted: one texel that receives a tenth too much.
        Rgb4Vector wrong = ty;
        const auto most = std::max_element(ty.begin(), ty.end(), [](auto& a, auto& b) { return a.r < b.r; });
        wrong[std::size_t(most - ty.begin())].r *= 1.1f;
        CHECK_FALSE(dot(x, wrong) == Approx(dot(tx, y)).epsilon(1e-6));
    }
}

// In a closed room of radiance 1, a texel receives 2 pi cos from one direction in the mean over the grid's
// offsets: Eq. (1) of link_exchange.h.
TEST_CASE("one direction is unbiased over the offsets of its grid", "[exchange][statistics]") {
    const ExchangeStage stage(furnace(1.0, 1.0), {.texels_per_metre = 1.6f});
    const Vec3 d = glm::normalize(Vec3(0.3f, -0.8f, 0.5f));
    std::vector<Trials> trials(stage.atlas.size());
    const float spacing = 0.4f;
    Rng rng(5);
    const Rgb4Vector one(stage.atlas.size(), Rgb4{1, 1, 1, 0});
    for (int i = 0; i < 400; ++i) {
        const RayBundle bundle =
            stage.tracer.trace(bundle_grid(d, stage.surfaces.bounds, spacing, rng.next_vec2()));
        const Rgb4Vector r = received(stage.atlas, bundle, one);
        for (std::size_t t = 0; t < r.size(); ++t)
            trials[t].add(double(2.0f * pi * sqr(spacing) / stage.atlas.texels()[t].area * r[t].r));
    }
    double planted = 0.0;
    for (std::size_t t = 0; t < trials.size(); ++t) {
        const double expected = double(2.0f * pi * std::fabs(glm::dot(stage.atlas.texels()[t].normal, d)));
        CHECK(trials[t].is(expected));
        planted = std::max(planted, trials[t].z(1.1 * expected));
    }
    CHECK(planted > trials[0].critical());
}

// Emission 1 and albedo rho everywhere: light of k reflections has the radiance rho^k. Bundles find it as
// the k-fold product of an operator whose mean over the room is 1, up to how many rays there are.
TEST_CASE("closed furnace, one bounce at a time: the geometric series", "[exchange][furnace]") {
    for (const double rho : {0.5, 0.95}) {
        const ExchangeStage stage(furnace(rho, 1.0), {.texels_per_metre = 1.5f});
        ExchangeSettings settings;
        settings.transfer = LightTransfer::one_bounce, settings.batch = 8;
        settings.bounces = rho < 0.9 ? 8 : 160, settings.directions = 16 * std::uint32_t(settings.bounces);
        settings.rays_per_texel = 4.0f;
        Trials direct, indirect, all;
        for (std::uint64_t key = 0; key < 12; ++key) {
            const ArrivingLight light = stage.solve(settings, key);
            direct.add(stage.mean(light.direct)), indirect.add(stage.mean(light.indirect));
            all.add(1.0 + rho * (stage.mean(light.direct) + stage.mean(light.indirect)) / double(pi));
        }
        const double series = rho * (1.0 - std::pow(rho, settings.bounces - 1)) / (1.0 - rho);
        // The room keeps its power from bounce to bounce: what is left is rounding, here 1e-5.
        CHECK(std::fabs(direct.mean() - double(pi)) < direct.critical() * direct.error() + 1e-5);
        CHECK(std::fabs(indirect.mean() / double(pi) - series) <
              indirect.critical() * indirect.error() + 1e-5 * series);
        const double left_out = std::pow(rho, settings.bounces + 1) / (1.0 - rho);
        CHECK(std::fabs(all.mean() - (1.0 / (1.0 - rho) - left_out)) <
              all.critical() * all.error() + 1e-5 * series);
        // A bounce counted twice is found.
        CHECK_FALSE(indirect.is(double(pi) * (series + std::pow(rho, 2))));
    }
}

// Interleaved, batch b holds light of b reflections or less (Eq. 2 of radiance_exchange.h): the mean over
// batches is known exactly, and no path counts twice.
TEST_CASE("closed furnace, interleaved: each reflection once", "[exchange][furnace]") {
    for (const double rho : {0.5, 0.95}) {
        const ExchangeStage stage(furnace(rho, 1.0), {.texels_per_metre = 1.5f});
        ExchangeSettings settings;
        settings.warm_up = 0, settings.batch = 8, settings.directions = 8 * 40,
        settings.rays_per_texel = 4.0f;
        Trials indirect;
        for (std::uint64_t key = 0; key < 16; ++key)
            indirect.add(stage.mean(stage.solve(settings, key).indirect));
        double expected = 0.0;
        for (int b = 0; b < 40; ++b)
            for (int k = 1; k <= b; ++k) expected += double(pi) * std::pow(rho, k) / 40.0;
        CHECK(indirect.is(expected));
        // Sum by the text of Hermes: E (e^rho - 1) / rho, less its direct part.
        const double printed = double(pi) * ((std::exp(rho) - 1.0) / rho - 1.0);
        CHECK_FALSE(indirect.is(printed));
        // A batch that is missing from the mean.
        CHECK_FALSE(indirect.is(expected * 41.0 / 40.0));
    }
}

// With the balance of power after the first batches nothing is missing: E / (1 - rho) up to noise, on walls
// and on a sphere, whose shading normals are not those of its triangles.
TEST_CASE("closed furnace, interleaved and balanced, is E / (1 - rho) up to albedo 0.95",
          "[exchange][furnace]") {
    for (const std::string shape : {"cube", "sphere"})
        for (const double rho : {0.2, 0.8, 0.95}) {
            INFO(shape << ", albedo " << rho);
            const ExchangeStage stage(furnace(rho, 0.7, shape), {.texels_per_metre = 4.0f});
            ExchangeSettings settings;
            settings.directions = 16 * 16, settings.rays_per_texel = 2.0f;
            Trials radiance;
            for (std::uint64_t key = 0; key < 16; ++key) {
                const ArrivingLight light = stage.solve(settings, key);
                radiance.add(0.7 +
                             rho * (stage.mean(light.direct) + stage.mean(light.indirect)) / double(pi));
            }
            const double exact = 0.7 / (1.0 - rho);
            // 1e-3: shading normals of the sphere's triangles, by 1 / 12 of the square of the angle between.
            CHECK(std::fabs(radiance.mean() - exact) < radiance.critical() * radiance.error() + 1e-3 * exact);
            CHECK(radiance.z(1.1 * exact) > radiance.critical());
        }
}

// Two opposite faces of a unit cube: F = 0.1998249. One emits, the others are black.
TEST_CASE("the light of one face on the opposite one is the form factor's", "[exchange][analytic]") {
    const std::string face = R"(<scene version="3.0.0">
        <shape type="rectangle"><bsdf type="diffuse"><rgb name="reflectance" value="0.6"/></bsdf></shape>
        <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="180"/><translate z="2"/></transform>
            <emitter type="area"><rgb name="radiance" value="3"/></emitter></shape><sensor type="perspective"/></scene>)";
    const ExchangeStage stage(face, {.texels_per_metre = 4.0f});
    ExchangeSettings settings;
    settings.directions = 64;
    Trials mean;
    for (std::uint64_t key = 0; key < 40; ++key) {
        const ArrivingLight light = stage.solve(settings, key);
        double sum = 0.0, area = 0.0, back = 0.0;
        for (std::size_t t = 0; t < stage.atlas.size(); ++t)
            if (const AtlasTexel& texel = stage.atlas.texels()[t]; texel.position.z < 1.0f)
                sum += double(light.direct[t].x * texel.area), area += double(texel.area),
                    back += double(light.indirect[t].x);
        mean.add(sum / area / (3.0 * double(pi)));
        CHECK(back == 0.0);  // the other face is black
    }
    CHECK(mean.is(0.1998249));
    CHECK(mean.error() < 0.002);
    CHECK_FALSE(mean.is(0.1998249 * 1.06));
}

TEST_CASE("the sky of an open floor is what enters bundles from outside", "[exchange][analytic]") {
    const std::string floor = R"(<scene version="3.0.0"><shape type="rectangle"><bsdf type="diffuse"/></shape>
        <emitter type="constant"><rgb name="radiance" value="2, 1, 0.5"/></emitter><sensor type="perspective"/></scene>)";
    const ExchangeStage stage(floor, {.texels_per_metre = 3.0f});
    ExchangeSettings settings;
    settings.directions = 64;
    Trials red;
    for (std::uint64_t key = 0; key < 20; ++key) red.add(stage.mean(stage.solve(settings, key).direct));
    CHECK(red.is(2.0 * double(pi)));
    CHECK(red.error() < 0.02);
}

// A ray from below meets the floor and the lower side of the body at one distance: in the wrong order the sky
// below would light the gap between them, and that the floor before it.
TEST_CASE("no sky comes between an open floor and a body that stands on it", "[exchange][ray_bundles]") {
    const ExchangeStage stage(R"(<scene version="3.0.0">
        <shape type="rectangle"><transform name="to_world"><scale value="2"/></transform>
            <bsdf type="twosided"><bsdf type="diffuse"/></bsdf></shape>
        <shape type="cube"><transform name="to_world"><scale value="0.5"/><translate z="0.5"/></transform>
            <bsdf type="diffuse"/></shape>
        <emitter type="constant"/><sensor type="perspective"/></scene>)",
                              {.texels_per_metre = 8.0f});
    ExchangeSettings settings;
    settings.directions = 128;
    const ArrivingLight light = stage.solve(settings, 1);
    double hidden = 0.0, open = 0.0;
    for (std::size_t t = 0; t < stage.atlas.size(); ++t) {
        const AtlasTexel& texel = stage.atlas.texels()[t];
        const double arrives = double(light.direct[t].x + light.indirect[t].x) * double(texel.area);
        const Vec3& p = texel.position;
        const bool below = std::fabs(p.z) < 1e-4f && std::max(std::fabs(p.x), std::fabs(p.y)) < 0.4f;
        // Upper side of the floor alone: the lower one is in the open.
        const bool in_gap = below && (texel.normal.z > 0.0f || texel.side == SurfaceSide::front);
        (in_gap ? hidden : open) += arrives;
    }
    CHECK(open > 100.0);
    CHECK(hidden < 1e-6 * open);
}

/// Power that the texels of a diffuse ball of radius 1 at the origin receive from a light [W].
double power_on_ball(const std::string& light) {
    const ExchangeStage stage(
        R"(<scene version="3.0.0"><shape type="sphere"><bsdf type="diffuse"/></shape>)" + light +
            R"(<sensor type="perspective"/></scene>)",
        {.texels_per_metre = 12.0f});
    const TexelDirectLight sampled = texel_direct_light(*stage.scene, stage.atlas, stage.materials, 2, 1, {});
    double power = 0.0;
    for (std::size_t t = 0; t < stage.atlas.size(); ++t)
        power += double(sampled.irradiance[t].x * stage.atlas.texels()[t].area);
    return power;
}

// A ball of radius r at distance d from a lamp of intensity I takes up 2 pi I (1 - sqrt(1 - (r/d)^2)), from a
// small face of area A and radiance L that faces it pi L A (r/d)^2. Its texels lie on triangles inside of
// it, and must not be in its shadow, nor in that of the lamp. 2 %: cosines in the middle of texels, and 0.6 %
// of the ball's area that its triangles lack.
TEST_CASE("light of a lamp on the texels of a ball is what its solid angle takes up",
          "[exchange][lamps][analytic]") {
    const double power = power_on_ball(
        R"(<emitter type="point"><point name="position" x="0" y="0" z="3"/><rgb name="intensity" value="5"/></emitter>)");
    const double exact = 2.0 * double(pi) * 5.0 * (1.0 - std::sqrt(1.0 - 1.0 / 9.0));
    CHECK(power == Approx(exact).epsilon(0.02));
    CHECK_FALSE(1.05 * power == Approx(exact).epsilon(0.02));
    const double of_face =
        power_on_ball(R"(<shape type="rectangle"><transform name="to_world"><scale value="0.05"/>
        <rotate x="1" angle="180"/><translate z="3"/></transform>
        <emitter type="area"><rgb name="radiance" value="500"/></emitter></shape>)");
    CHECK(of_face == Approx(double(pi) * 500.0 * 0.01 / 9.0).epsilon(0.02));
}

TEST_CASE("batches continue in their own sequence, and have another one than their neighbours",
          "[exchange]") {
    const BatchDirections all(1, 8), other(2, 8);
    for (std::uint32_t i = 0; i < 8; ++i) {
        CHECK(all.at(16 + i).direction == bundle_sample(hash_keys(1ull, 0u), 8 + i).direction);
        CHECK(all.at(8 + i).direction == bundle_sample(hash_keys(1ull, 1u), i).direction);
        CHECK(all.at(i).direction != all.at(8 + i).direction);
        CHECK(all.at(i).direction != other.at(i).direction);
    }
}

TEST_CASE("nothing there: no surface, no texel, no light", "[exchange][degenerate]") {
    const ExchangeStage black(R"(<scene version="3.0.0"><shape type="rectangle"><bsdf type="diffuse">
        <rgb name="reflectance" value="0"/></bsdf></shape><emitter type="constant"/><sensor type="perspective"/></scene>)",
                              {});
    CHECK(black.atlas.size() == 0);
    CHECK(black.solve({.directions = 16}, 1).direct.empty());
    const ExchangeStage dark(R"(<scene version="3.0.0"><shape type="sphere"><bsdf type="diffuse"/></shape>
        <emitter type="point"/><sensor type="perspective"/></scene>)",
                             {.texel_budget = 500});
    const ArrivingLight light = dark.solve({.directions = 32}, 1);
    CHECK(dark.mean(light.direct) == 0.0);
    CHECK(dark.mean(light.indirect) == 0.0);
}
