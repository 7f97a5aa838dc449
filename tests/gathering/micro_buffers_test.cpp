// Micro-buffers against closed forms: what they gather, and what is right whatever they gather.
#include "tests/gathering/micro_scenes.h"

#include "core/objects/error.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;
using tests::receivers_in_sphere;
using tests::sphere_of_points;
using tests::TriangleBuilder;

namespace {

/// Largest distance of what receivers gather from pi, over pi.
double furnace_error(const Surfels& surfels, const MicroBufferSettings& settings, float radius) {
    const PointHierarchy hierarchy(surfels);
    const NodeRadiance radiance(hierarchy, std::vector<Rgb>(surfels.size(), Rgb(1.0f)));
    const auto receivers = receivers_in_sphere(64, radius, 7);
    std::vector<Rgb> irradiance(receivers.size());
    gather_irradiance(MicroBuffers(hierarchy, settings), radiance, receivers, irradiance);
    double largest = 0.0;
    for (const Rgb& e : irradiance) largest = std::max(largest, std::fabs(double(e.x) / M_PI - 1.0));
    return largest;
}

/// Projected solid angle of the points within an angle of the axis that a receiver at the middle looks
/// along.
double covered_cap(const Surfels& sphere, float angle, std::uint32_t side) {
    Surfels cap;
    for (std::size_t i = 0; i < sphere.size(); ++i) {
        if (glm::dot(sphere.positions[i] - Vec3(1, 2, 3), Vec3(0, 0, 1)) < 2.0f * std::cos(angle)) continue;
        cap.positions.push_back(sphere.positions[i]), cap.normals.push_back(sphere.normals[i]);
    }
    cap.radius = sphere.radius, cap.area = sphere.patch() * double(cap.size());
    const PointHierarchy hierarchy(cap);
    const MicroBuffers buffers(hierarchy, {.side = side});
    std::vector<MicroTexel> texels(buffers.texels_each());
    const MicroReceiver receiver{Vec3(1, 2, 3), Frame(Vec3(0, 0, 1))};
    buffers.render(std::span(&receiver, 1), texels);
    double sum = 0.0;
    for (std::size_t i = 0; i < texels.size(); ++i)
        if (!texels[i].empty()) sum += double(buffers.texels().cosine_weight());
    return sum;
}

}  // namespace

TEST_CASE("texels share out the hemisphere", "[micro_buffers]") {
    for (const std::uint32_t side : {1u, 2u, 7u, 16u, 24u}) {
        const HemisphereTexels texels(side);
        double cosines = 0.0;
        for (std::uint32_t i = 0; i < texels.count(); ++i) {
            const Vec3& w = texels.directions()[i];
            cosines += double(texels.cosine_weight()) * double(w.z);
            CHECK(std::fabs(glm::length(w) - 1.0f) < 1e-6f);
            const Vec2 place = hemisphere_to_square(w) * float(side);
            CHECK((std::uint32_t(place.y) * side + std::uint32_t(place.x)) == i);
        }
        CHECK(std::fabs(double(texels.cosine_weight()) * texels.count() - M_PI) < 1e-5);
        // The integral of the squared cosine, by one place a texel; its root at the horizon is n^-1.5.
        CHECK(std::fabs(cosines - 2.0 * M_PI / 3.0) < 2.0 * std::pow(double(side), -1.5));
    }
    CHECK_THROWS_AS(HemisphereTexels(0), InputError);
    CHECK_THROWS_AS(HemisphereTexels(257), InputError);
}

TEST_CASE("inside a closed sphere of radiance 1 a micro-buffer gathers exactly 1", "[micro_buffers]") {
    const Surfels surfels = sphere_of_points(5000);
    REQUIRE(surfels.size() == 5000);
    for (const std::uint32_t side : {1u, 2u, 8u, 16u, 24u, 48u})
        for (const float cut : {16.0f, 4.0f, 1.0f})
            // 1.99: receivers between the points, and beside them.
            CHECK(furnace_error(surfels, {.side = side, .cut = cut}, 1.99f) < 1e-6);
    // Discs two thirds the size leave holes, and so does a splat to one texel for each point (Fig. 8.13).
    Surfels small = surfels;
    small.radius *= 0.67f;
    CHECK(furnace_error(small, {.side = 24}, 1.5f) > 0.01);
    CHECK(furnace_error(sphere_of_points(500), {.side = 24, .cast_leaves = false}, 1.0f) > 0.2);
    CHECK(furnace_error(sphere_of_points(500), {.side = 24}, 1.0f) < 1e-6);
}

TEST_CASE("a cap of points covers pi sin^2 theta", "[micro_buffers]") {
    const Surfels few = sphere_of_points(4000), many = sphere_of_points(16000);
    for (const float angle : {0.3f, 0.8f, 1.2f}) {
        const auto cap = [](float a) { return M_PI * sqr(std::sin(double(a))); };
        double errors[2];
        for (int i = 0; i < 2; ++i) {
            const Surfels& s = i == 0 ? few : many;
            const double covered = covered_cap(s, angle, 128);
            // The border is one of discs, whose centers lie inside; texels count a border within a quarter.
            const double texels = 0.25 * std::sqrt(M_PI) / 128.0 * 2.0 * M_PI * std::sin(double(angle));
            CHECK(covered > cap(angle - 0.5f * s.radius) - texels);
            CHECK(covered < cap(angle + 0.5f * s.radius) + texels);
            errors[i] = covered - cap(angle);
        }
        CHECK(std::fabs(errors[1]) < 0.7 * std::fabs(errors[0]) + 0.005);
    }
}

TEST_CASE("a receiver's buffer does not depend on its group", "[micro_buffers]") {
    const PointHierarchy hierarchy(sphere_of_points(3000));
    const MicroBuffers buffers(hierarchy, {.side = 24, .cut = 4.0f});
    const auto receivers = receivers_in_sphere(19, 1.9f, 3);
    std::vector<MicroTexel> together(receivers.size() * buffers.texels_each()), alone(buffers.texels_each());
    buffers.render(receivers, together);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        buffers.render(std::span(receivers).subspan(i, 1), alone);
        bool same = true;
        for (std::size_t k = 0; k < alone.size(); ++k)
            same &= alone[k].hit == together[i * alone.size() + k].hit &&
                    alone[k].distance == together[i * alone.size() + k].distance;
        CHECK(same);
    }
}

TEST_CASE("micro-buffers at the extremes", "[micro_buffers]") {
    const PointHierarchy nothing{Surfels()};
    const MicroReceiver receiver{Vec3(0.0f), Frame(Vec3(0, 0, 1))};
    for (const std::uint32_t side : {1u, 16u}) {
        std::vector<MicroTexel> texels(side * side);
        MicroBuffers(nothing, {.side = side}).render(std::span(&receiver, 1), texels);
        for (const MicroTexel& t : texels) CHECK(t.empty());
    }
    CHECK_THROWS_AS(MicroBuffers(nothing, {.cut = 0.0f}), InputError);
    CHECK_THROWS_AS(MicroBuffers(nothing, {.cut = std::nanf("")}), InputError);
    CHECK_THROWS_AS(MicroBuffers(nothing, {.side = 0}), InputError);
    CHECK_THROWS_AS(MicroBuffers(nothing, {.side = 257}), InputError);
    // One point above, seen as its disc: pi r^2 cos / d^2 of projected solid angle.
    Surfels one;
    one.positions = {Vec3(0, 0, 2)}, one.normals = {Vec3(0, 0, -1)}, one.radius = 0.5f, one.area = 1.0;
    const auto irradiance = [&](const Surfels& s, const Vec3& at, std::uint32_t side) {
        const PointHierarchy hierarchy(s);
        const NodeRadiance radiance(hierarchy, std::vector<Rgb>(s.size(), Rgb(1.0f)));
        const MicroReceiver from{at, Frame(Vec3(0, 0, 1))};
        Rgb e(-1.0f);
        gather_irradiance(MicroBuffers(hierarchy, {.side = side}), radiance, std::span(&from, 1),
                          std::span(&e, 1));
        return double(e.x);
    };
    const double disc = M_PI * 0.25 / (4.0 + 0.25);  // E of a disc above: pi r^2 / (h^2 + r^2)
    // Of the 55 texels on its border a third more or less.
    CHECK(std::fabs(irradiance(one, Vec3(0.0f), 64) - disc) < 55.0 / 3.0 * M_PI / (64.0 * 64.0));
    CHECK(std::fabs(irradiance(one, Vec3(0.0f), 1) - M_PI) < 1e-5);  // its one ray meets the disc
    CHECK(irradiance(one, Vec3(0, 0, 3), 16) == 0.0);                // behind the receiver
    // A hundred coincident points are one; a receiver on points, and in the plane of one, is finite.
    Surfels same = one;
    for (int i = 1; i < 100; ++i)
        same.positions.push_back(one.positions[0]), same.normals.push_back(one.normals[0]);
    CHECK(irradiance(same, Vec3(0.0f), 64) == irradiance(one, Vec3(0.0f), 64));
    for (const Vec3& at : {Vec3(0, 0, 2), Vec3(0.3f, 0, 2), Vec3(0, 0, 1.9999f)})
        for (const std::uint32_t side : {1u, 8u}) {
            const double e = irradiance(same, at, side);
            CHECK((std::isfinite(e) && e >= 0.0 && e <= M_PI + 1e-5));
        }
    // Receivers exactly on the points of a sphere see all of it.
    const Surfels sphere = sphere_of_points(2000);
    const PointHierarchy hierarchy(sphere);
    const NodeRadiance radiance(hierarchy, std::vector<Rgb>(2000, Rgb(1.0f)));
    std::vector<MicroReceiver> receivers;
    for (std::size_t i = 0; i < 2000; i += 50)
        receivers.push_back({sphere.positions[i], Frame(sphere.normals[i])});
    std::vector<Rgb> gathered(receivers.size());
    gather_irradiance(MicroBuffers(hierarchy), radiance, receivers, gathered);
    for (const Rgb& e : gathered) CHECK(std::fabs(double(e.x) - M_PI) < 1e-5);
}
