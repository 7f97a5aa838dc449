// Warped micro-buffers: the same light as those of cosine, by rays that go where the BSDF reflects.
#include "tests/gathering/micro_scenes.h"

#include "core/objects/error.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;
using tests::receivers_in_sphere;
using tests::sphere_of_points;

namespace {

/// A Phong lobe around the mirror of a viewer at 45 degrees, normalised to reflect 0.8 at normal incidence.
struct Phong {
    float exponent;
    Rgb operator()(const Vec3& w) const {
        const Vec3 mirror(-std::sqrt(0.5f), 0.0f, std::sqrt(0.5f));
        const float along = std::max(glm::dot(w, mirror), 0.0f);
        return Rgb(0.8f, 0.6f, 0.3f) * ((exponent + 2.0f) * inv_two_pi * std::pow(along, exponent));
    }
};

/// Radiance of a sphere's points that changes from place to place.
NodeRadiance patterned(const PointHierarchy& hierarchy, const Surfels& s) {
    std::vector<Rgb> front;
    for (const Vec3& p : s.positions)
        front.push_back(
            Rgb(1.0f + std::sin(4.0f * p.x) * std::sin(3.0f * p.y), 0.5f, 1.0f + std::sin(5.0f * p.z)));
    return NodeRadiance(hierarchy, front);
}

struct Reflected {
    Rgb warped, cosine;
};

/// One receiver's reflected radiance by both kinds of buffer.
Reflected reflected(const PointHierarchy& hierarchy, const NodeRadiance& radiance,
                    const MicroReceiver& receiver, const Phong& f, std::uint32_t cells,
                    const MicroBufferSettings& settings) {
    const MicroBuffers buffers(hierarchy, settings);
    std::vector<MicroTexel> texels(buffers.texels_each());
    std::vector<Rgb> weights(texels.size());
    const BrdfWarp warp(cells, f);
    warp.fill_weights(buffers.texels().side(), weights);
    buffers.render_warped(std::span(&receiver, 1), std::span(&warp, 1), texels);
    Reflected result;
    result.warped = gathered(texels, weights, radiance);
    for (std::size_t i = 0; i < weights.size(); ++i)
        weights[i] = f(buffers.texels().directions()[i]) * buffers.texels().cosine_weight();
    buffers.render(std::span(&receiver, 1), texels);
    result.cosine = gathered(texels, weights, radiance);
    return result;
}

}  // namespace

TEST_CASE("a warp goes there and back, and its texels sum to the table", "[micro_buffers][brdf_warp]") {
    Rng rng(1);
    for (const float exponent : {1.0f, 5.0f, 40.0f}) {
        const BrdfWarp warp(16, Phong{exponent});
        for (int i = 0; i < 500; ++i) {
            const Vec2 there = rng.next_vec2();
            CHECK(glm::length(warp.to_warped_square(warp.to_cosine_square(there)) - there) < 2e-3f);
        }
        // The lobe's integral by quadrature over the hemisphere.
        Vec3d sum(0.0);
        for (int i = 0; i < 250000; ++i)
            sum += Vec3d(Phong{exponent}(square_to_cosine_hemisphere(
                       {(float(i % 500) + 0.5f) / 500.0f, (float(i / 500) + 0.5f) / 500.0f}))) *
                   (M_PI / 250000.0);
        std::vector<Rgb> weights(24 * 24);
        warp.fill_weights(24, weights);
        Vec3d all(0.0);
        for (const Rgb& w : weights) all += Vec3d(w);
        CHECK(glm::length(all - Vec3d(warp.integral())) < 1e-4);
        CHECK(glm::length(all - sum) < 0.02 * glm::length(sum));
        // Boxes hold the images of what is inside.
        for (int i = 0; i < 200; ++i) {
            const Vec2 place = warp.to_cosine_square(rng.next_vec2()), image = warp.to_warped_square(place);
            Vec2 from, to;
            warp.warp_box(place - 0.2f * rng.next_vec2(), place + 0.2f * rng.next_vec2(), from, to);
            CHECK(glm::all(glm::greaterThanEqual(image, from - 1e-5f)));
            CHECK(glm::all(glm::lessThanEqual(image, to + 1e-5f)));
        }
    }
    CHECK_THROWS_AS(BrdfWarp(0, Phong{1.0f}), InputError);
    CHECK_THROWS_AS(BrdfWarp(257, Phong{1.0f}), InputError);
}

TEST_CASE("the warp of a diffuse BSDF is none", "[micro_buffers][brdf_warp]") {
    const PointHierarchy hierarchy(sphere_of_points(4000));
    const MicroBuffers buffers(hierarchy, {.side = 12, .cut = 0.01f});  // points alone: no cut to differ in
    const BrdfWarp warp(8, [](const Vec3&) { return Rgb(0.5f * inv_pi); });
    std::vector<MicroTexel> plain(buffers.texels_each()), warped(plain.size());
    std::vector<Rgb> weights(plain.size());
    warp.fill_weights(12, weights);
    for (const Rgb& w : weights) CHECK(std::fabs(w.x - 0.5f / 144.0f) < 1e-7f);
    int different = 0;
    for (const MicroReceiver& receiver : receivers_in_sphere(20, 1.8f, 2)) {
        buffers.render(std::span(&receiver, 1), plain);
        buffers.render_warped(std::span(&receiver, 1), std::span(&warp, 1), warped);
        for (std::size_t i = 0; i < plain.size(); ++i) different += plain[i].hit != warped[i].hit;
    }
    CHECK(different <= 6);  // of 2880: where rounding turns a ray from one disc to its neighbour
}

TEST_CASE("warped micro-buffers approach those of cosine, and have less noise for gloss",
          "[micro_buffers][brdf_warp]") {
    const Surfels surfels = sphere_of_points(20000);
    const PointHierarchy hierarchy(surfels);
    const NodeRadiance radiance = patterned(hierarchy, surfels);
    const NodeRadiance even(hierarchy, std::vector<Rgb>(surfels.size(), Rgb(1.0f)));
    for (const float exponent : {5.0f, 40.0f}) {
        const Phong f{exponent};
        double warped = 0.0, cosine = 0.0, limit = 0.0, planted = 0.0;
        for (const MicroReceiver& receiver : receivers_in_sphere(24, 1.5f, 4)) {
            const Reflected fine =
                reflected(hierarchy, radiance, receiver, f, 64, {.side = 64, .cut = 0.25f});
            const Reflected few = reflected(hierarchy, radiance, receiver, f, 16, {.side = 8});
            const auto relative = [&](const Rgb& a) {
                return glm::dot(a - fine.cosine, a - fine.cosine) / glm::dot(fine.cosine, fine.cosine);
            };
            limit += double(relative(fine.warped)), planted += double(relative(1.03f * fine.warped));
            warped += double(relative(few.warped)), cosine += double(relative(few.cosine));
            // A closed sphere of radiance 1 reflects the table's albedo, whatever its texels are.
            const BrdfWarp warp(16, f);
            const Rgb furnace = reflected(hierarchy, even, receiver, f, 16, {.side = 8}).warped;
            CHECK(glm::length(furnace - warp.integral()) < 1e-5f);
        }
        INFO("exponent " << exponent << ": in the limit " << std::sqrt(limit / 24.0) << ", with 8 x 8 texels "
                         << std::sqrt(warped / 24.0) << " against " << std::sqrt(cosine / 24.0));
        CHECK(std::sqrt(limit / 24.0) < 0.01);
        CHECK(std::sqrt(planted / 24.0) > 0.01);
        CHECK(warped < (exponent > 10.0f ? 0.1 : 0.5) * cosine);
    }
}

TEST_CASE("warps at the extremes", "[micro_buffers][brdf_warp]") {
    const PointHierarchy hierarchy(sphere_of_points(500));
    const NodeRadiance radiance(hierarchy, std::vector<Rgb>(500, Rgb(1.0f)));
    const MicroReceiver receiver{Vec3(1, 2, 3), Frame(Vec3(0, 0, 1))};
    const MicroBuffers buffers(hierarchy, {.side = 4});
    std::vector<MicroTexel> texels(16);
    std::vector<Rgb> weights(16);
    // Nothing is reflected; one cell is all; all is reflected within one cell.
    for (const auto& f : std::vector<std::function<Rgb(const Vec3&)>>{
             [](const Vec3&) { return Rgb(0.0f); },
             [](const Vec3& w) { return Rgb(w.x > 0.9f ? 1e6f : 0.0f); },
             [](const Vec3& w) { return Rgb(w.z > 0.999f ? 1.0f : 0.0f); }})
        for (const std::uint32_t cells : {1u, 16u}) {
            const BrdfWarp warp(cells, f);
            warp.fill_weights(4, weights);
            buffers.render_warped(std::span(&receiver, 1), std::span(&warp, 1), texels);
            const Rgb result = gathered(texels, weights, radiance);
            CHECK((is_finite(result) &&
                   glm::length(result - warp.integral()) <= 1e-5f * (1.0f + glm::length(warp.integral()))));
            CHECK(warp.black() == is_black(warp.integral()));
        }
}
