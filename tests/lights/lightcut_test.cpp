// Lightcuts: all lights to rounding where the threshold is 0, within the threshold of them else, over one
// point a pixel and over many.
#include "lights/selection/lightcuts/lightcut.h"
#include "core/scene/scene.h"
#include "lights/selection/hierarchy/vertex_bounds.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "media/phase_functions.h"
#include "tests/lights/closed_box.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using lights::ReceiverKind, lights::GatherPoints, lights::LightcutSettings, lights::TileLight;

namespace {

/// A room with an obstacle, its VPLs, and points seen along sixteen rays: in the air, and on the walls.
struct Room {
    static constexpr int points = 6;  ///< in the air along each ray
    std::unique_ptr<Scene> scene;
    lights::VplSet vpls;
    media::IsotropicPhase isotropic;
    media::HenyeyGreensteinPhase forward{0.6f};
    std::array<std::array<ScatteringVertex, 16>, points + 1> vertices;
    std::array<lights::ReceiverTile, points + 1> tiles;  ///< the last: on walls
    std::unique_ptr<lights::GatherScratch> scratch = std::make_unique<lights::GatherScratch>();
    RayCounters rays;
    TrackingCounters tracking;

    Room(const std::string& bsdf, std::uint32_t paths)
        : scene(tests::scene_from(tests::closed_box(bsdf, obstacle))),
          vpls(lights::trace_light_paths(*scene, {.paths = paths}, 7, 0, SamplerKind::sobol)) {
        Rng rng(3);
        for (int i = 0; i < 16; ++i) {
            const Vec3 towards(1.0f, 0.1f * float(i % 4) - 0.2f, 0.1f * float(i / 4) - 0.3f);
            const Ray ray{{-0.9f, 0.0f, 0.4f}, glm::normalize(towards)};
            WalkContext context;
            PathWeights weights;
            MediumState state;
            Rgb emitted;
            const WalkEvent event = walk<false>(*scene, ray, state, weights, emitted, context);
            for (int n = 0; n <= points; ++n) {
                ScatteringVertex& v = vertices[std::size_t(n)][std::size_t(i)];
                if (n == points) {
                    v = make_vertex(event, ray);
                } else {
                    v.position = ray.at(event.hit.t * (float(n) + 0.5f) / float(points));
                    v.wo = -ray.direction;
                    v.phase = i % 2 ? static_cast<const PhaseFunction*>(&forward) : &isotropic;
                }
                const Rgb throughput = n == points ? Rgb(0.6f) : Rgb(0.1f + 0.02f * float(n));
                tiles[std::size_t(n)].set(i, v, throughput, state, rng, n == 2 ? 3 : 1000);
            }
        }
    }
    lights::GatherContext context() { return {*scene, *scratch, rays, tracking}; }

    /// All lights at all points, by kind of point.
    lights::LightByKind all(float bound) {
        lights::LightByKind sum{};
        for (int n = 0; n <= points; ++n) {
            const TileLight light = lights::gather(context(), vpls, lights::VplRange{},
                                                   lights::BoundedGeometry{bound}, tiles[std::size_t(n)]);
            for (std::size_t i = 0; i < 16; ++i) sum[n == points ? 0 : 1][i] += light[i];
        }
        return sum;
    }
    lights::LightByKind cut(float bound, const LightcutSettings& settings, std::uint64_t seed = 1) {
        const lights::VplLeaves leaves(vpls);
        const lights::LightHierarchy tree(leaves);
        lights::Lightcut cut(vpls, tree, bound, settings);
        GatherPoints gather;
        for (int n = 0; n <= points; ++n)
            gather.add(tiles[std::size_t(n)], n == points ? ReceiverKind::surface : ReceiverKind::medium);
        Rng rng(seed);
        gather.build(rng);
        const auto light = cut.gather(context(), gather, rng);
        counters = cut.counters();
        return light;
    }
    lights::LightcutCounters counters;

    static inline const std::string obstacle = R"(<shape type="cube"><transform name="to_world">
        <scale x="0.05" y="0.6" z="0.5"/><translate x="0.2" y="-0.3"/></transform>
        <bsdf type="diffuse"/></shape>)";
};

}  // namespace

TEST_CASE("A lightcut with a threshold of 0 is the light of all", "[light_selection][lightcuts]") {
    for (const std::string& material : {tests::diffuse, tests::glossy})
        for (const float bound : {0.2f, infinity}) {
            Room room(material, 100);
            const auto all = room.all(bound), cut = room.cut(bound, {0.0f, 1u << 30});
            const auto too_few = room.cut(bound, {0.0f, 40});
            bool differ = false;
            for (std::size_t kind = 0; kind < 2; ++kind)
                for (std::size_t i = 0; i < 16; ++i)
                    for (int c = 0; c < 3; ++c) {
                        CHECK(cut[kind][i][c] == Approx(all[kind][i][c]).epsilon(2e-5));
                        differ |= std::fabs(too_few[kind][i][c] - all[kind][i][c]) > 1e-2f * all[kind][i][c];
                    }
            CHECK(differ);
            CHECK(room.counters.pairs <= 40);
            CHECK(room.counters.at_limit == 1);
        }
}

TEST_CASE("A lightcut's error is what its threshold lets it be", "[light_selection][lightcuts]") {
    Room room(tests::diffuse, 3000);
    const auto all = room.all(20.0f);
    // Root of the mean square over pixels and over representatives of clusters. A threshold holds for one
    // node.
    const auto relative_error = [&](float threshold) {
        double squares = 0.0;
        for (std::uint64_t seed = 1; seed < 4; ++seed) {
            const auto cut = room.cut(20.0f, {threshold, 1u << 30}, seed);
            for (std::size_t i = 0; i < 16; ++i) {
                const double right = double(average(all[0][i] + all[1][i]));
                squares += sqr(double(average(cut[0][i] + cut[1][i])) / right - 1.0);
            }
        }
        return std::sqrt(squares / 48.0);
    };
    const double fine = relative_error(0.005f), middle = relative_error(0.02f), coarse = relative_error(0.3f);
    const auto pairs = room.counters.pairs;
    INFO("errors " << fine << ", " << middle << ", " << coarse << "; " << room.vpls.lights.size()
                   << " lights, pairs " << pairs);
    // Errors of some hundred clusters add up, those of the points of a ray with one sign: one light
    // represents all.
    CHECK(fine < middle);
    CHECK(middle < coarse);
    CHECK(middle < 0.1);
    CHECK(pairs < 7 * room.vpls.lights.size() / 20);
    // A lightcut of every point alone evaluates more pairs than one of all points of the pixels.
    room.cut(20.0f, {0.02f, 1u << 30});
    const auto together = room.counters.pairs;
    const lights::VplLeaves leaves(room.vpls);
    const lights::LightHierarchy tree(leaves);
    lights::Lightcut alone(room.vpls, tree, 20.0f, {0.02f, 1u << 30});
    for (const auto& tile : room.tiles) {
        GatherPoints points;
        Rng rng(1);
        points.add(tile, ReceiverKind::medium);
        points.build(rng);
        alone.gather(room.context(), points, rng);
    }
    CHECK(together < alone.counters().pairs);
}

TEST_CASE("Lightcuts without lights, of one light, and at a light",
          "[light_selection][lightcuts][extremes]") {
    Room room(tests::diffuse, 20);
    const auto set = room.vpls;
    for (const std::size_t count : {0, 1, 2}) {
        room.vpls = set;
        room.vpls.lights.resize(count);
        const auto all = room.all(1.0f), cut = room.cut(1.0f, {});
        for (std::size_t i = 0; i < 16; ++i) CHECK(cut[0][i].y == Approx(all[0][i].y).epsilon(1e-5));
    }
    // Receivers in the places of lights in the air, unbounded: whatever comes of it is a number.
    room.vpls = set;
    for (auto& vpl : room.vpls.lights) vpl.normal = vpl.shading_normal = Vec3(0.0f);
    for (std::size_t j = 0; j < room.vpls.lights.size(); ++j)
        room.vpls.lights[j].position = room.tiles[0].position(int(j % 16));
    for (const auto& kind : room.cut(100.0f, {}))
        for (const Rgb& light : kind) CHECK(std::isfinite(light.y));
}

TEST_CASE("A lightcut of single groups has the mean of all lights", "[light_selection][lightcuts]") {
    Room room(tests::diffuse, 300);
    const lights::VplLeaves leaves(room.vpls);
    const lights::LightHierarchy tree(leaves);
    // Two groups: of all lights at walls, and of all at points in the air. Whose shadow ray is shared by a
    // tile is sampled so that the tile's light is right.
    for (const float angle : {0.0f, 10.0f}) {
        lights::Lightcut cut(room.vpls, tree, 20.0f, {0.02f, 2, 0.0f, angle});
        constexpr int samples = 4000;
        double sum[2] = {}, squares[2] = {};
        for (std::uint64_t seed = 0; seed < samples; ++seed) {
            GatherPoints points;
            points.add(room.tiles[Room::points], ReceiverKind::surface);
            points.add(room.tiles[0], ReceiverKind::medium), points.add(room.tiles[5], ReceiverKind::medium);
            Rng rng(seed + 1);
            points.build(rng);
            const auto light = cut.gather(room.context(), points, rng);
            for (std::size_t kind = 0; kind < 2; ++kind) {
                double tile = 0.0;
                for (const Rgb& c : light[kind]) tile += double(average(c));
                sum[kind] += tile / samples, squares[kind] += tile * tile / samples;
            }
        }
        CHECK(cut.counters().pairs == 2 * samples);
        double right[2] = {};
        for (const int n : {0, 5, Room::points})
            for (const Rgb& c : lights::gather(room.context(), room.vpls, lights::VplRange{},
                                               lights::BoundedGeometry{20.0f}, room.tiles[std::size_t(n)]))
                right[n == Room::points ? 0 : 1] += double(average(c));
        for (std::size_t kind = 0; kind < 2; ++kind) {
            const double deviation = std::sqrt((squares[kind] - sqr(sum[kind])) / samples);
            INFO("angle " << angle << ", kind " << kind << ": " << sum[kind] << " for " << right[kind]
                          << " +- " << deviation);
            CHECK(std::fabs(sum[kind] - right[kind]) < 4.0 * deviation);
            CHECK(deviation < 0.03 * right[kind]);
        }
    }
}

TEST_CASE("A shadow ray that receivers share is right in the mean", "[light_selection][lightcuts]") {
    Room room(tests::diffuse, 40);
    const auto lights = room.vpls.lights;
    const lights::ReceiverTile& tile = room.tiles[3];
    int mixed = 0;
    for (const auto& light : lights) {
        room.vpls.lights.assign(1, light);
        double right = 0.0;
        lights::ReceiverTile exact = tile;
        const TileLight of_all = lights::gather(room.context(), room.vpls, lights::VplRange{},
                                                lights::BoundedGeometry{20.0f}, exact);
        for (const Rgb& c : of_all) right += double(average(c));
        const lights::VplLeaves leaves(room.vpls);
        const lights::LightHierarchy tree(leaves);
        if (tree.empty()) continue;
        lights::Lightcut cut(room.vpls, tree, 20.0f, {0.02f, 1000, 0.0f, 10.0f});
        constexpr int samples = 200;
        double sum = 0.0, squares = 0.0;
        for (std::uint64_t seed = 0; seed < samples; ++seed) {
            GatherPoints points;
            points.add(tile, ReceiverKind::medium);
            Rng rng(seed + 1);
            points.build(rng);
            double all = 0.0;
            const auto light_of_tile = cut.gather(room.context(), points, rng);
            for (const Rgb& c : light_of_tile[1]) all += double(average(c));
            sum += all / samples, squares += all * all / samples;
        }
        const double deviation = std::sqrt(std::max(squares - sqr(sum), 0.0) / samples);
        // All lanes that get light see the light, or none does: the same for every receiver.
        if (deviation < 1e-6 * sum || sum == 0.0) {
            CHECK(sum == Approx(right).epsilon(1e-4).margin(1e-12));
            continue;
        }
        ++mixed;
        INFO("light " << (&light - lights.data()) << ": " << sum << " for " << right << " +- " << deviation);
        CHECK(std::fabs(sum - right) < 4.0 * deviation);
    }
    CHECK(mixed > 5);
}

TEST_CASE("A lightcut that has seen tiles before plans, and is right still", "[light_selection][lightcuts]") {
    Room room(tests::diffuse, 3000);
    const auto all = room.all(20.0f);
    const lights::VplLeaves leaves(room.vpls);
    const lights::LightHierarchy tree(leaves);
    const auto gather = [&](lights::Lightcut& cut, std::uint64_t seed) {
        GatherPoints points;
        for (int n = 0; n <= Room::points; ++n)
            points.add(room.tiles[std::size_t(n)],
                       n == Room::points ? ReceiverKind::surface : ReceiverKind::medium);
        Rng rng(seed);
        points.build(rng);
        return cut.gather(room.context(), points, rng);
    };
    // With few clusters, which those that were seen divide better; estimates that no_representative uses are
    // fewer.
    lights::Lightcut cut(room.vpls, tree, 20.0f, {0.001f, 400});
    gather(cut, 1);
    const double first = double(cut.counters().evaluated);
    double squares = 0.0, predicted = 0.0;
    constexpr int tiles = 12;
    for (std::uint64_t seed = 2; seed < 2 + tiles; ++seed) {
        const auto light = gather(cut, seed);
        for (std::size_t i = 0; i < 16; ++i)
            squares +=
                sqr(double(average(light[0][i] + light[1][i])) / double(average(all[0][i] + all[1][i])) -
                    1.0) /
                (16.0 * tiles);
    }
    const double later = (double(cut.counters().evaluated) - first) / tiles;
    predicted = std::sqrt(cut.counters().predicted_squares / double(cut.counters().cuts));
    INFO("estimates " << first << ", then " << later << "; error " << std::sqrt(squares) << ", predicted "
                      << predicted);
    CHECK(later < 0.95 * first);
    CHECK(std::sqrt(squares) < 0.15);
    // An estimate, not a bound: of the right size.
    CHECK(predicted > 0.4 * std::sqrt(squares));
    CHECK(predicted < 4.0 * std::sqrt(squares));
    // Nothing of what was seen, and no shared ray, is in the light of all.
    lights::Lightcut exact(room.vpls, tree, 20.0f, {0.0f, 1u << 30, 0.5f, 10.0f});
    for (std::uint64_t seed = 1; seed < 3; ++seed) {
        const auto light = gather(exact, seed);
        for (std::size_t i = 0; i < 16; ++i) CHECK(light[0][i].y == Approx(all[0][i].y).epsilon(2e-5));
    }
}
