// Resampled virtual point lights have the mean of all of them, on surfaces and in media.
#include "lights/selection/resampling/resampling.h"

#include <fmt/format.h>

#include "core/scene/scene.h"
#include "lights/selection/hierarchy/vertex_bounds.h"
#include "lights/selection/stochastic/light_sampler.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "media/phase_functions.h"
#include "tests/lights/closed_box.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;
using lights::RecordedReceivers, lights::Resampling, lights::TileLight, lights::WeightedVpl;

namespace {

/// A room with an obstacle, its VPLs, and tiles of points: on walls, seen along rays that begin at `eye`.
struct Room {
    std::unique_ptr<Scene> scene;
    lights::VplSet vpls;
    lights::VplLeaves leaves{vpls};
    lights::WideLightTree tree{leaves};
    std::unique_ptr<lights::GatherScratch> scratch = std::make_unique<lights::GatherScratch>();
    RayCounters rays;
    TrackingCounters tracking;
    media::IsotropicPhase isotropic;
    media::HenyeyGreensteinPhase forward{0.6f};

    Room(const std::string& bsdf, const std::string& inside, std::uint32_t paths)
        : scene(scene_from(closed_box(bsdf, inside))),
          vpls(lights::trace_light_paths(*scene, {.paths = paths}, 7, 0, SamplerKind::sobol)) {}
    lights::GatherContext context() { return {*scene, *scratch, rays, tracking}; }

    static Ray ray(int i) {
        const Vec3 towards(1.0f, 0.1f * float(i % 4) - 0.2f, 0.1f * float(i / 4) - 0.3f);
        return {{-0.5f, 0.0f, 0.3f}, glm::normalize(towards)};
    }
    /// On the wall behind the obstacle, around y: what a receiver sees depends on it.
    static Ray ray_at_wall(int i, float y) {
        return {{0.7f, y + 0.1f * float(i % 4) - 0.15f, 0.2f * float(i / 4) - 0.2f}, {1, 0, 0}};
    }
    void on_walls(RecordedReceivers& kept, float y, float throughput) {
        lights::ReceiverTile tile;
        std::array<ScatteringVertex, 16> vertices;
        for (int i = 0; i < 16; ++i) {
            ScatteringVertex& v = vertices[std::size_t(i)];
            const Ray own = ray_at_wall(i, y);
            const auto hit = scene->first_hit(own);
            REQUIRE(hit);
            v.position = hit->position, v.wo = -own.direction, v.hit = *hit, v.bsdf = hit->shape->bsdf.get();
            tile.set(i, v, Rgb(throughput), scene->eye_medium_state(own), Rng(std::uint64_t(i)),
                     i == 6 && y == 0.0f ? 1 : 1000);
        }
        kept.copy(tile);
    }
    /// At a distance along each ray.
    void in_air(RecordedReceivers& kept, float distance) {
        lights::ReceiverTile tile;
        std::array<ScatteringVertex, 16> vertices;
        for (int i = 0; i < 16; ++i) {
            ScatteringVertex& v = vertices[std::size_t(i)];
            const Ray own = ray(i);
            v.position = own.at(distance), v.wo = -own.direction;
            v.phase = i % 2 ? static_cast<const PhaseFunction*>(&forward) : &isotropic;
            tile.set(i, v, Rgb(0.2f + distance), scene->eye_medium_state(own), Rng(std::uint64_t(i)),
                     i == 3 ? 2 : 1000);
        }
        kept.copy(tile);
    }
    TileLight all(std::span<RecordedReceivers* const> points, float bound) {
        TileLight sum{};
        for (RecordedReceivers* p : points) {
            const auto one =
                lights::gather(context(), vpls, lights::VplRange{}, lights::BoundedGeometry{bound}, p->tile);
            for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += one[i];
        }
        return sum;
    }
    static inline const std::string obstacle = R"(<shape type="cube"><transform name="to_world">
        <scale x="0.05" y="0.3" z="0.5"/><translate x="0.5" y="-0.3"/></transform>
        <bsdf type="diffuse"/></shape>)";
};

/// z of every lane, of the mean of sample() against what is right, and the relative error of the mean of all.
struct Comparison {
    double min_z = 0.0, largest_z = 0.0, bias = 0.0, its_error = 0.0;
    bool unbiased() const { return min_z > -limit && largest_z < limit; }
    /// A lane passes by chance 6e-7 times less than 1.
    static constexpr double limit = 5.0;
};
template <typename Sample>
Comparison compare(const TileLight& right, int samples, const Sample& sample) {
    std::array<double, 16> sum{}, squares{};
    double whole = 0.0, of_all = 0.0, all_squares = 0.0;
    for (const Rgb& r : right) whole += double(average(r));
    for (int k = 0; k < samples; ++k) {
        const TileLight light = sample(std::uint64_t(k));
        double all = 0.0;
        for (std::size_t i = 0; i < 16; ++i) {
            const double x = double(average(light[i]));
            sum[i] += x, squares[i] += x * x, all += x / whole;
        }
        of_all += all, all_squares += all * all;
    }
    Comparison c;
    const auto error = [&](double mean, double mean_square) {
        return std::sqrt(std::max(0.0, mean_square - mean * mean) / (samples - 1.0));
    };
    for (std::size_t i = 0; i < 16; ++i) {
        const double mean = sum[i] / samples, r = double(average(right[i]));
        const double z = (mean - r) / (error(mean, squares[i] / samples) + 1e-5 * r + 1e-20);
        c.min_z = std::min(c.min_z, z), c.largest_z = std::max(c.largest_z, z);
    }
    c.bias = of_all / samples - 1.0, c.its_error = error(of_all / samples, all_squares / samples);
    return c;
}

std::string report(const Comparison& c) {
    return fmt::format("z of {:.2f} to {:.2f}, mean {:+.2f} +- {:.2f} %", c.min_z, c.largest_z, 100 * c.bias,
                       100 * c.its_error);
}

}  // namespace

TEST_CASE("Resampled lights have the mean of all", "[light_selection][resampling]") {
    for (const std::string& material : {diffuse, glossy}) {
        Room room(material, Room::obstacle, 60);
        RecordedReceivers tile;
        room.on_walls(tile, 0.0f, 0.7f);
        RecordedReceivers* const points[] = {&tile};
        for (const float bound : {3.0f, 100.0f}) {
            const TileLight right = room.all(points, bound);
            lights::LightSampler sampler;
            for (const std::string by : {"tree", "cut", "clusters"}) {
                Resampling resampling(room.vpls, bound, 3);
                const auto c = compare(right, 800, [&](std::uint64_t k) {
                    Rng rng(hash_keys(k, 3));
                    const lights::ReceiverClusters receivers(lights::ReceiverBounds(tile.tile), room.tree);
                    const auto candidates =
                        by == "cut"        ? sampler.by_cut(room.tree, receivers, bound, 12, rng)
                        : by == "clusters" ? sampler.from_clusters(room.tree, receivers, bound, 6, 3, rng)
                                           : sampler.by_tree(room.tree, receivers, bound, 12, rng);
                    std::vector<float> visibilities;  // any factors do
                    for (std::size_t i = 0; by == "clusters" && i < candidates.size(); ++i)
                        visibilities.push_back(0.5f * float(1 + i % 3));
                    return resampling.gather(room.context(), points, candidates, rng, visibilities);
                });
                INFO(by << ", bound " << bound << ": " << report(c));
                CHECK(c.unbiased());
                CHECK(c.its_error < 0.05);
            }
        }
    }
}

TEST_CASE("Pairs of a light and a distance have the mean of all", "[light_selection][resampling][media]") {
    Room room(diffuse, fog, 60);
    std::array<RecordedReceivers, 4> tiles;
    std::vector<RecordedReceivers*> points;
    for (std::size_t n = 0; n < tiles.size(); ++n)
        room.in_air(tiles[n], 0.1f + 0.2f * float(n)), points.push_back(&tiles[n]);
    const TileLight right = room.all(points, 5.0f);
    lights::LightSampler sampler;
    Resampling resampling(room.vpls, 5.0f, 3);
    std::vector<lights::ReceiverBounds> bounds;
    for (const RecordedReceivers* p : points) bounds.emplace_back(p->tile);
    const lights::ReceiverClusters receivers(bounds, room.tree);
    const auto sample = [&](std::uint64_t k) {
        Rng rng(hash_keys(k, 5));
        const auto candidates = sampler.by_tree(room.tree, receivers, 5.0f, 16, rng);
        return resampling.gather(room.context(), points, candidates, rng);
    };
    const auto c = compare(right, 1500, sample);
    INFO(report(c));
    CHECK(c.unbiased());
    // Four distances, and at most three shadow rays a ray.
    CHECK(resampling.counters().chosen <= 1500 * 16 * 3);
    CHECK(resampling.counters().candidates > 1500 * 4 * 8);
    const auto dark = compare(right, 1500, [&](std::uint64_t k) {
        TileLight light = sample(k);
        for (Rgb& l : light) l *= 0.95f;
        return light;
    });
    CHECK_FALSE(dark.unbiased());
}

TEST_CASE("No lights, one light, and a receiver on a light", "[light_selection][resampling][extremes]") {
    Room room(diffuse, "", 3);
    RecordedReceivers tile;
    room.on_walls(tile, 0.0f, 0.7f);
    RecordedReceivers* const points[] = {&tile};
    Rng rng(1);
    Resampling resampling(room.vpls, infinity, 4);
    for (const Rgb& l : resampling.gather(room.context(), points, {}, rng)) CHECK(l == Rgb(0.0f));
    // One light is exact.
    const std::vector<WeightedVpl> one{{0, 1.0f}};
    room.vpls.lights.resize(1);
    const TileLight right = room.all(points, infinity);
    for (int k = 0; k < 3; ++k) {
        const TileLight light = resampling.gather(room.context(), points, one, rng);
        for (std::size_t i = 0; i < 16; ++i) CHECK(light[i].x == Approx(right[i].x).epsilon(1e-5));
    }
    // At the position of a receiver, without a bound.
    room.vpls.lights[0].position = tile.tile.position(5);
    for (const Rgb& l : resampling.gather(room.context(), points, one, rng))
        CHECK((std::isfinite(l.x) && l.x >= 0.0f));
}
