// Particle tracing and gathering, each against something that does not share its code.
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <cstring>

#include "core/math/warp.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "lights/virtual_lights/vpl_gather.h"
#include "tests/lights/closed_box.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;

namespace {

lights::LightPathSettings paths(std::uint32_t n, int rr_depth = 5) {
    lights::LightPathSettings s;
    s.paths = n, s.rr_depth = rr_depth;
    return s;
}

}  // namespace

// Every particle in a closed box arrives somewhere: the power at the first vertices is the power of the
// light, and every diffuse bounce keeps the fraction of the albedo in the mean, with roulette from the second
// vertex on, from the fourth, or never.
TEST_CASE("the VPLs of each depth carry the light's power times albedo^depth", "[vpl][particles]") {
    const auto scene = scene_from(closed_box(diffuse, ""));
    const double power = 4.0 * std::acos(-1.0) * 2.0;  // red
    constexpr std::size_t depths = 6;
    const int sets = 64;
    for (const int rr_depth : {1, 3, 1000}) {
        std::array<double, depths> sum{}, squares{};
        std::size_t vpls = 0;
        auto settings = paths(256, rr_depth);
        settings.max_vertices = int(depths);
        for (int s = 0; s < sets; ++s) {
            const auto set =
                lights::trace_light_paths(*scene, settings, 5, std::uint32_t(s), SamplerKind::independent);
            CHECK(set.paths == 256);
            vpls += set.lights.size();
            std::array<double, depths> set_sum{};
            // I_j = albedo / pi * alpha / paths on a diffuse surface.
            for (const auto& vpl : set.lights)
                set_sum[vpl.depth - 1] += double(vpl.intensity.x) * std::acos(-1.0) / 0.5;
            for (std::size_t d = 0; d < depths; ++d)
                sum[d] += set_sum[d], squares[d] += set_sum[d] * set_sum[d];
        }
        CHECK((vpls < sets * 256 * depths) == (rr_depth < int(depths)));  // roulette ended some
        for (std::size_t d = 0; d < depths; ++d) {
            const double mean = sum[d] / sets, variance = (squares[d] / sets - mean * mean) / (sets - 1);
            INFO("roulette from " << rr_depth << ", depth " << d + 1 << ": " << mean << " +- "
                                  << std::sqrt(variance));
            // 4 sigma; without roulette there is no variance at all.
            CHECK(std::fabs(mean - power * std::pow(0.5, double(d))) <
                  4.0 * std::sqrt(variance) + 1e-4 * power);
        }
    }
}

TEST_CASE("light paths are the same bits on one thread and on two", "[vpl][determinism]") {
    const auto scene = scene_from(closed_box(glossy, fog));
    const auto trace = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return lights::trace_light_paths(*scene, paths(500), 9, 3, SamplerKind::sobol);
    };
    const auto one = trace(1), two = trace(2);
    REQUIRE(one.lights.size() == two.lights.size());
    REQUIRE(!one.lights.empty());
    REQUIRE(!one.details.empty());
    CHECK(std::memcmp(one.lights.data(), two.lights.data(), one.lights.size() * sizeof one.lights[0]) == 0);
    CHECK(one.rays.closest == two.rays.closest);
}

// Light of power alpha that arrives along wo leaves a diffuse surface with a shading normal as albedo / pi
// alpha times |wo.ns| / |wo.ng| (Veach 1997, Sec. 5.3): what a plain VPL keeps is what its vertex would say.
TEST_CASE("a VPL on a surface with a shading normal has the light's end of the adjoint correction", "[vpl]") {
    const auto scene = scene_from(closed_box(diffuse, ""));
    Rng rng(4);
    for (int i = 0; i < 100; ++i) {
        ScatteringVertex v;
        v.hit.shape = scene->shapes().front().get(), v.bsdf = v.hit.shape->bsdf.get();
        v.hit.geometric_normal = Vec3(0, 0, 1);
        v.hit.shading = Frame(glm::normalize(Vec3(0.4f * rng.next_float(), 0.4f * rng.next_float(), 1.0f)));
        v.wo = square_to_cosine_hemisphere(rng.next_vec2());
        const float cos_ns = glm::dot(v.wo, v.hit.shading.n), cos_ng = v.wo.z;
        lights::VplSet set;
        lights::append_vpl(set, v, Rgb(1, 2, 3), 1, 0);
        REQUIRE(set.lights.size() == (cos_ns > 0.0f ? 1u : 0u));
        if (cos_ns <= 0.0f) continue;
        const Rgb expected = 0.5f * inv_pi * (cos_ns / cos_ng) * Rgb(1, 2, 3);
        for (int c = 0; c < 3; ++c) CHECK(set.lights[0].intensity[c] == Approx(expected[c]).epsilon(1e-4));
        // In all directions above it, this is the power that a detailed vertex would send.
        const lights::VplDetail detail{v};
        CHECK((detail.eval(v.wo) * Rgb(1, 2, 3)).y == Approx(expected.y).epsilon(1e-4));
    }
}

// The gather of a tile against a plain loop over VPLs and receivers, written from Eqs. 10.4 and 10.5.
TEST_CASE("gathering sixteen receivers equals the plain sum", "[vpl][gather]") {
    for (const std::string& bsdf : {diffuse, glossy})
        for (const float bound : {infinity, 2.0f}) {
            const auto scene = scene_from(closed_box(bsdf, ""));
            const auto vpls = lights::trace_light_paths(*scene, paths(64), 7, 0, SamplerKind::independent);
            lights::ReceiverTile tile;
            std::vector<ScatteringVertex> vertices(lights::ReceiverTile::width);
            Rng rng(3);
            MediumState state;
            for (int i = 0; i < lights::ReceiverTile::width; ++i) {
                if (i == 5) continue;  // an idle lane
                const Vec2 u = rng.next_vec2();
                const float r = std::sqrt(1.0f - sqr(2.0f * u.x - 1.0f)), phi = 2.0f * pi * u.y;
                const Ray ray{{0, 0, 0}, {r * std::cos(phi), r * std::sin(phi), 2.0f * u.x - 1.0f}};
                WalkContext context;
                PathWeights weights;
                Rgb emitted;
                vertices[std::size_t(i)] =
                    make_vertex(walk<false>(*scene, ray, state, weights, emitted, context), ray);
                tile.set(i, vertices[std::size_t(i)], Rgb(1.0f, 0.5f, 2.0f), state, rng, i == 7 ? 1 : 1000);
            }
            lights::GatherScratch scratch;
            RayCounters rays;
            TrackingCounters tracking;
            const auto light = lights::gather({*scene, scratch, rays, tracking}, vpls, lights::VplRange{},
                                              lights::BoundedGeometry{bound}, tile);
            CHECK(rays.occlusion > 0);
            for (std::size_t i = 0; i < vertices.size(); ++i) {
                glm::dvec3 expected(0.0);
                const ScatteringVertex& v = vertices[i];
                for (const auto& vpl : vpls.lights) {
                    if (i == 5 || (i == 7 && vpl.depth > 1)) continue;
                    const Vec3 d = vpl.position - v.position;
                    const float distance = glm::length(d);
                    const Vec3 wi = d / distance;
                    const float cos_x = std::max(0.0f, glm::dot(v.hit.geometric_normal, wi));
                    const float cos_y = std::max(0.0f, -glm::dot(vpl.normal, wi));
                    const Rgb i_j = vpl.detail == lights::VirtualPointLight::no_detail
                                        ? vpl.intensity
                                        : vpl.intensity * vpls.details[vpl.detail].eval(-wi);
                    const float g = std::min(cos_x * cos_y / (distance * distance), bound);
                    if (g > 0.0f && !scene->rays().occluded({v.ray_origin(wi), wi, 0.0f, 0.9999f * distance}))
                        expected +=
                            glm::dvec3(Rgb(1.0f, 0.5f, 2.0f) * v.eval(wi, TransportMode::radiance) * i_j * g);
                }
                for (int c = 0; c < 3; ++c)
                    CHECK(light[i][c] == Approx(expected[c]).epsilon(2e-3).margin(1e-9));
            }
        }
}

TEST_CASE("no paths, a dark light, and a receiver on a VPL stay finite", "[vpl][extremes]") {
    const auto scene = scene_from(closed_box(diffuse, fog));
    CHECK(lights::trace_light_paths(*scene, paths(0), 1, 0, SamplerKind::sobol).lights.empty());

    const auto vpls = lights::trace_light_paths(*scene, paths(32), 1, 0, SamplerKind::sobol);
    REQUIRE(!vpls.lights.empty());
    lights::ReceiverTile tile;
    ScatteringVertex vertex;
    const auto phase = scene->media()[0];
    vertex.phase = &phase->phase(), vertex.position = vpls.lights[0].position, vertex.wo = {0, 0, 1};
    MediumState state = scene->medium_state_at(vertex.position, nullptr);
    tile.set(0, vertex, Rgb(1.0f), state, Rng(1), 1000);
    lights::GatherScratch scratch;
    RayCounters rays;
    TrackingCounters tracking;
    for (const float bound : {infinity, 10.0f})
        CHECK(is_finite(lights::gather({*scene, scratch, rays, tracking}, vpls, lights::VplRange{},
                                       lights::BoundedGeometry{bound}, tile)[0]));
}
