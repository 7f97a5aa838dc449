// Every policy of the gather against a sum that is written out here: which lights, which geometry weight.
#include <cmath>
#include <functional>

#include "core/math/distribution.h"
#include "core/scene/scene.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "lights/virtual_lights/vpl_gather.h"
#include "tests/lights/closed_box.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using lights::TileLight, lights::WeightedVpl;

namespace {

/// A room of one material, its VPLs, and sixteen receivers seen from the middle.
struct Room {
    std::unique_ptr<Scene> scene;
    lights::VplSet vpls;
    lights::ReceiverTile tile;
    std::array<ScatteringVertex, lights::ReceiverLanes::width> vertices;
    std::unique_ptr<lights::GatherScratch> scratch = std::make_unique<lights::GatherScratch>();

    explicit Room(const std::string& bsdf) : scene(tests::scene_from(tests::closed_box(bsdf, ""))) {
        vpls = lights::trace_light_paths(*scene, {.paths = 48, .max_vertices = 3}, 7, 0,
                                         SamplerKind::independent);
        Rng rng(3);
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const Vec2 u = rng.next_vec2();
            const float z = 2.0f * u.x - 1.0f, r = std::sqrt(1.0f - z * z), phi = 2.0f * pi * u.y;
            WalkContext context;
            PathWeights weights;
            MediumState state;
            Rgb emitted;
            const Ray ray{{0, 0, 0}, {r * std::cos(phi), r * std::sin(phi), z}};
            vertices[i] = make_vertex(walk<false>(*scene, ray, state, weights, emitted, context), ray);
            tile.set(int(i), vertices[i], Rgb(1.0f), state, rng, 1000);
        }
    }

    template <typename Lights, typename Weight>
    TileLight gather(const Lights& lights, const Weight& weight) {
        RayCounters rays;
        TrackingCounters tracking;
        return lights::gather({*scene, *scratch, rays, tracking}, vpls, lights, weight, tile);
    }

    /// Eqs. 10.4 and 10.5 of Engelhardt 2013, one light and one receiver after the other, in double
    /// precision; the arguments of `weight` are G* and the distance.
    std::array<Vec3d, 16> plain_sum(const std::vector<WeightedVpl>& lights,
                                    const std::function<double(double, double)>& weight) const {
        std::array<Vec3d, 16> sum{};
        for (std::size_t i = 0; i < vertices.size(); ++i)
            for (const WeightedVpl& light : lights) {
                const auto& vpl = vpls.lights[light.index];
                const ScatteringVertex& x = vertices[i];
                const Vec3 d = vpl.position - x.position, w = glm::normalize(d);
                const double distance = double(glm::length(d));
                const double cos_x = std::max(0.0f, glm::dot(x.hit.geometric_normal, w));
                const double cos_y = std::max(0.0f, -glm::dot(vpl.normal, w));
                const double g = cos_x * cos_y / (distance * distance);
                const bool plain = vpl.detail == lights::VirtualPointLight::no_detail;
                const Rgb sent = plain ? vpl.intensity : vpl.intensity * vpls.details[vpl.detail].eval(-w);
                if (g > 0.0 && scene->visible({x.ray_origin(w), w, 0.0f, 0.9999f * float(distance)}))
                    sum[i] += Vec3d(x.eval(w, TransportMode::radiance) * sent) *
                              (weight(g, distance) * double(light.weight));
            }
        return sum;
    }
    std::vector<WeightedVpl> all() const {
        std::vector<WeightedVpl> lights;
        for (std::size_t j = 0; j < vpls.lights.size(); ++j) lights.push_back({j});
        return lights;
    }
};

/// Ends of shadow rays lie off their surfaces by some 1e-4 of the room, which moves 1/d^2 by twice that and
/// more at grazing angles: 2e-3, as in virtual_point_lights_test.cpp.
void check_equal(const TileLight& found, const std::array<Vec3d, 16>& expected) {
    double sum = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            sum += expected[i][c];
            CHECK(found[i][c] == Approx(expected[i][c]).epsilon(2e-3).margin(1e-9));
        }
    CHECK(sum > 0.0);
}

const std::vector<std::string> materials{tests::diffuse, tests::glossy};
constexpr float bound = 0.2f;

/// A balance heuristic against a technique that finds y with k cos_y / d^2 where this one finds it with 1.
struct BalancedGeometry {
    float k;
    float operator()(float g, float distance_squared, float, float cos_y) const {
        return g / (1.0f + k * cos_y / distance_squared);
    }
};

}  // namespace

TEST_CASE("geometry weights equal the plain sum", "[gather][policies]") {
    for (const std::string& material : materials) {
        Room room(material);
        const lights::VplRange every;
        const auto unbounded = room.gather(every, lights::UnboundedGeometry{});
        const auto bounded = room.gather(every, lights::BoundedGeometry{bound});
        const auto residual = room.gather(every, lights::ResidualGeometry{bound});
        check_equal(unbounded, room.plain_sum(room.all(), [](double g, double) { return g; }));
        check_equal(bounded,
                    room.plain_sum(room.all(), [](double g, double) { return std::min(g, double(bound)); }));
        check_equal(residual, room.plain_sum(room.all(), [](double g, double) {
            return std::max(g - double(bound), 0.0);
        }));
        bool differ = false;
        for (std::size_t i = 0; i < unbounded.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                CHECK(bounded[i][c] + residual[i][c] == Approx(unbounded[i][c]).epsilon(1e-5));
                differ |= residual[i][c] > 0.01f * unbounded[i][c];
            }
        CHECK(differ);
    }
}

TEST_CASE("a weight of one's own gets distance and cosines, and subsets add up", "[gather][policies]") {
    for (const std::string& material : materials) {
        Room room(material);
        constexpr float k = 0.5f;
        const auto ours = room.gather(lights::VplRange{}, BalancedGeometry{k});
        const auto other = room.gather(lights::VplRange{}, [](float g, float d2, float, float cos_y) {
            return g * (k * cos_y / d2) / (1.0f + k * cos_y / d2);
        });
        const auto all = room.gather(lights::VplRange{}, lights::UnboundedGeometry{});
        // cos_y from G* = cos_x cos_y / d^2 needs cos_x: 1 / (1 + k cos_y / d^2) cannot be written by G*
        // alone, so the two techniques must add up to all of the light, and be different from it and from
        // each other.
        for (std::size_t i = 0; i < all.size(); ++i) {
            CHECK(ours[i].y + other[i].y == Approx(all[i].y).epsilon(1e-5));
            CHECK(ours[i].y < 0.999f * all[i].y);
            CHECK(other[i].y < 0.999f * all[i].y);
        }
        // By distance alone there is a plain sum.
        const auto near =
            room.gather(lights::VplRange{}, [](float g, float d2, float, float) { return g / (1.0f + d2); });
        check_equal(near, room.plain_sum(room.all(), [](double g, double d) { return g / (1.0 + d * d); }));
    }
}

TEST_CASE("subsets of the lights add up, and sampled lights count by their weights", "[gather][policies]") {
    for (const std::string& material : materials) {
        Room room(material);
        const lights::BoundedGeometry weight{bound};
        const auto all = room.gather(lights::VplRange{}, weight);
        std::array<Vec3d, 16> subsets{};
        for (std::size_t first = 0; first < 3; ++first) {
            const lights::VplRange third{first, 3};
            const auto light = room.gather(third, weight);
            for (std::size_t i = 0; i < light.size(); ++i) subsets[i] += Vec3d(light[i]);
            std::vector<WeightedVpl> members;
            for (const WeightedVpl& vpl : room.all())
                if (third.contains(vpl.index)) members.push_back(vpl);
            check_equal(light,
                        room.plain_sum(members, [](double g, double) { return std::min(g, double(bound)); }));
        }
        for (std::size_t i = 0; i < all.size(); ++i)
            for (int c = 0; c < 3; ++c) CHECK(subsets[i][c] == Approx(all[i][c]).epsilon(1e-5));

        const std::vector<WeightedVpl> sampled{{5, 2.0f}, {0, 0.5f}, {5, 1.5f}, {17, 3.0f}};
        REQUIRE(room.vpls.lights.size() > 17);
        check_equal(room.gather(lights::SampledVpls{sampled}, weight),
                    room.plain_sum(sampled, [](double g, double) { return std::min(g, double(bound)); }));
    }
}

namespace {

struct Estimate {
    double mean, error;  ///< standard deviation of the mean
};

/// The light at all receivers from four lights sampled by their intensity, over many samples. `factor` not 1
/// plants an error in the weights.
Estimate sampled_light(Room& room, float factor, int samples) {
    std::vector<float> power;
    for (const auto& vpl : room.vpls.lights) power.push_back(average(vpl.intensity));
    const Distribution1D selector(power);
    constexpr std::size_t count = 4;
    Rng rng(11);
    double sum = 0.0, squares = 0.0;
    for (int k = 0; k < samples; ++k) {
        std::array<WeightedVpl, count> sampled;
        for (WeightedVpl& light : sampled) {
            const auto chosen = selector.sample_discrete(rng.next_float());
            light = {chosen.index, factor / (float(count) * chosen.probability)};
        }
        double light = 0.0;
        for (const Rgb& c : room.gather(lights::SampledVpls{sampled}, lights::BoundedGeometry{bound}))
            light += double(average(c));
        sum += light, squares += light * light;
    }
    const double mean = sum / samples;
    return {mean, std::sqrt((squares / samples - mean * mean) / (samples - 1.0))};
}

}  // namespace

TEST_CASE("the mean over sampled lights is the light of all", "[gather][policies][statistics]") {
    constexpr double critical = 2.576;  // two-sided, 1 %
    for (const std::string& material : materials) {
        Room room(material);
        double all = 0.0;
        for (const Rgb& c : room.gather(lights::VplRange{}, lights::BoundedGeometry{bound}))
            all += double(average(c));
        const Estimate right = sampled_light(room, 1.0f, 4000), wrong = sampled_light(room, 1.05f, 4000);
        CHECK(std::abs(right.mean - all) < critical * right.error);
        CHECK(std::abs(wrong.mean - all) > critical * wrong.error);  // 5 % too much is found
    }
}
