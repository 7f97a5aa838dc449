// Matrix row-column sampling: the mean of all lights whatever the clusters are, rows by maps and by rays.
// Columns by themselves are in matrix_columns_test.cpp.
#include "lights/selection/matrix/matrix_clusters.h"

#include <tbb/global_control.h>

#include "core/scene/scene.h"
#include "lights/selection/matrix/light_clusters.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "tests/lights/random_lights.h"
#include "tests/support/catch.h"
#include "tests/support/mean_of.h"
#include "tests/support/render_statistics.h"

// After random_lights.h, whose functions have names of its materials as parameters.
#include "tests/lights/closed_box.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;
using lights::ColumnClusters, lights::ColumnSampler, lights::LightClass;
using lights::PathReceiver, lights::MatrixClusters, lights::MatrixSettings, lights::WeightedVpl;
using RowKind = lights::RowVisibilitySettings::Kind;

namespace {

const std::string plastic = R"(<bsdf type="roughplastic"><float name="alpha" value="0.4"/></bsdf>)";

/// A room with a wall across that leaves a gap above, its VPLs, and receivers on both sides of the wall: on
/// surfaces and in the air.
struct Room {
    std::unique_ptr<Scene> scene;
    lights::VplSet vpls;
    media::HenyeyGreensteinPhase forward{0.6f};
    std::vector<PathReceiver> receivers;
    RayCounters rays;
    TrackingCounters tracking;

    explicit Room(const std::string& bsdf, std::uint32_t paths = 300, const std::string& medium = "")
        : scene(tests::scene_from(tests::closed_box(bsdf, wall + medium))),
          vpls(lights::trace_light_paths(*scene, {.paths = paths}, 7, 0, SamplerKind::sobol)) {
        Rng rng(3);
        while (receivers.size() < 400) {
            const Vec3 from = 0.9f * Vec3(rng.next_float(), rng.next_float(), 1.6f * rng.next_float() - 0.6f);
            const Ray ray{from, random_direction(rng)};
            WalkContext context;
            PathWeights weights;
            MediumState state;
            Rgb emitted;
            const WalkEvent event = walk<false>(*scene, ray, state, weights, emitted, context);
            if (event.kind == WalkEvent::Kind::escaped) continue;
            PathReceiver r{make_vertex(event, ray), Rgb(0.5f, 0.6f, 0.7f), state, 1000};
            if (receivers.size() % 4 == 3) {
                r.vertex = {};
                r.vertex.position = ray.at(0.5f * event.hit.t), r.vertex.wo = -ray.direction;
                r.vertex.phase = &forward, r.throughput = Rgb(0.2f);
            }
            receivers.push_back(r);
        }
    }
    lights::RowContext context(RowKind visibility = RowKind::rays, float bound = 4.0f) {
        lights::RowVisibilitySettings settings;
        settings.kind = visibility, settings.map_size = 24;
        return {*scene, vpls, bound, settings, rays, tracking};
    }
    lights::ReceiverTile tile(std::size_t first) const {
        lights::ReceiverTile tile;
        tile.clear();
        for (std::size_t i = 0; i < 16; ++i) {
            const PathReceiver& r = receivers[(first + 23 * i) % receivers.size()];
            tile.set(int(i), r.vertex, r.throughput, r.state, Rng(i), r.max_vpl_depth);
        }
        return tile;
    }
    /// Sum of the gathered light over all lanes and channels.
    template <typename Choice>
    double light(lights::ReceiverTile tile, const Choice& choice) {
        const lights::GatherContext gather{*scene, *scratch, rays, tracking};
        double sum = 0.0;
        for (const Rgb& v : lights::gather(gather, vpls, choice, lights::BoundedGeometry{4.0f}, tile))
            sum += double(v.x) + double(v.y) + double(v.z);
        return sum;
    }

  private:
    static inline const std::string wall =
        R"(<shape type="cube"><transform name="to_world"><scale x="0.02" y="0.85" z="1"/>
        <translate x="0.45" y="-0.15"/></transform><bsdf type="diffuse"/></shape>)";
    std::unique_ptr<lights::GatherScratch> scratch = std::make_unique<lights::GatherScratch>();
};

MatrixSettings settings_of(std::uint32_t rows, std::uint32_t columns, std::uint32_t slices) {
    MatrixSettings settings;
    settings.rows = rows, settings.columns = columns, settings.slices = slices;
    return settings;
}

}  // namespace

TEST_CASE("Light by a matrix has the mean of all lights, on both sides of a wall and in the air",
          "[light_selection][matrix][statistics]") {
    constexpr double critical = 3.3;  // two-sided, 0.1 %
    Rng rng(6);
    for (const RowKind visibility : {RowKind::rays, RowKind::shadow_maps}) {
        Room room(visibility == RowKind::rays ? plastic : diffuse);
        REQUIRE(room.vpls.lights.size() > 500);
        // Few receivers make rows, others are lit.
        const auto few = std::span(room.receivers).first(20);
        const MatrixClusters matrix(room.context(visibility), few, settings_of(16, 24, 1), 5);
        std::vector<WeightedVpl> sampled;
        const lights::ReceiverTile tile = room.tile(100);
        const double all = room.light(tile, lights::VplRange{});
        REQUIRE(all > 0.0);
        const auto sample = [&] {
            return room.light(tile, lights::SampledVpls{matrix.sample(tile, rng, sampled)});
        };
        const Mean found = mean_of(5000, sample);
        INFO("visibility " << int(visibility) << ": " << found.mean << " +- " << found.error << " of "
                           << all);
        CHECK(std::fabs(found.mean - all) < critical * found.error);
        CHECK(critical * found.error < 0.12 * all);
        for (const double wrong : {0.7, 1.3})
            CHECK(std::fabs(wrong * found.mean - all) > critical * found.error);
    }
}

TEST_CASE("Wrong probabilities and a missing defensive part are found",
          "[light_selection][matrix][statistics][planted]") {
    constexpr double critical = 3.3;
    Rng rng(7);
    Room room(diffuse);
    // Rows behind the wall, and a tile before it.
    std::vector<PathReceiver> few, many;
    for (const PathReceiver& r : room.receivers) (r.vertex.position.x > 0.5f ? few : many).push_back(r);
    few.resize(16), room.receivers = many;
    const auto context = room.context();
    const auto matrix = lights::reduced_matrix(context, few, 1);
    const ColumnClusters clusters = lights::cluster_lights(matrix, 24, rng);
    const lights::ReceiverTile tile = room.tile(100);
    const double sum = room.light(tile, lights::VplRange{});
    const auto test = [&](const ColumnClusters& some, bool wrong_weight) {
        const ColumnSampler samples(some, matrix.weights);
        std::vector<WeightedVpl> sampled;
        const Mean found = mean_of(3000, [&] {
            sampled.clear();
            samples.sample(rng, sampled);
            if (wrong_weight)  // as if sampled evenly
                for (std::size_t k = 0; k < sampled.size(); ++k)
                    sampled[k].weight = float(some.cluster(k).size());
            return room.light(tile, lights::SampledVpls{sampled});
        });
        UNSCOPED_INFO(found.mean << " +- " << found.error << " of " << sum);
        return std::fabs(found.mean - sum) < critical * found.error;
    };
    CHECK(test(clusters, false));
    CHECK_FALSE(test(clusters, true));
    // Only lights that rows see, and all but those that face away from them.
    std::array<std::size_t, 4> of_class{};
    for (const LightClass c : matrix.classes) ++of_class[std::size_t(c)];
    for (const LightClass last : {LightClass::lit, LightClass::hidden}) {
        ColumnClusters some;
        for (std::size_t k = 0; k < clusters.size(); ++k) {
            if (matrix.classes[clusters.cluster(k)[0]] > last) continue;
            for (const std::uint32_t j : clusters.cluster(k)) some.members.push_back(j);
            some.first.push_back(some.members.size());
        }
        CHECK(some.members.size() < clusters.members.size());
        CHECK_FALSE(test(some, false));
    }
    INFO("lit " << of_class[0] << ", hidden " << of_class[1] << ", away " << of_class[2]);
    CHECK((of_class[0] > 0 && of_class[1] > 0 && of_class[2] > 0));
}

TEST_CASE("One thread has the clusters of many, to the bit", "[light_selection][matrix]") {
    Room room(glossy, 1500);  // several tasks of lights
    const auto clusters_of = [&](int threads, std::uint64_t key) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
        const MatrixClusters matrix(room.context(), room.receivers, settings_of(48, 64, 3), key);
        std::vector<double> all;
        for (std::size_t s = 0; s < matrix.slices(); ++s)
            for (std::size_t i = 0; i < matrix.slice(s).clusters().members.size(); ++i) {
                all.push_back(double(matrix.slice(s).clusters().members[i]));
                all.push_back(matrix.slice(s).probability(i));
            }
        return all;
    };
    const auto one = clusters_of(1, 9);
    REQUIRE(one.size() > 3 * room.vpls.lights.size());
    CHECK((one == clusters_of(4, 9)));
    CHECK_FALSE((one == clusters_of(1, 10)));
}

TEST_CASE("More columns than lights are all lights, each once", "[light_selection][matrix]") {
    Room room(diffuse, 30);
    const MatrixClusters matrix(room.context(), room.receivers, settings_of(16, 4000, 2), 1);
    std::vector<WeightedVpl> sampled;
    Rng rng(1);
    const auto tile = room.tile(7);
    matrix.sample(tile, rng, sampled);
    REQUIRE(sampled.size() == room.vpls.lights.size());
    for (std::size_t j = 0; j < sampled.size(); ++j)
        CHECK((sampled[j].index == j && sampled[j].weight == 1.0f));
    CHECK(room.light(tile, lights::SampledVpls{sampled}) == room.light(tile, lights::VplRange{}));
}

TEST_CASE("Maps of receivers see what rays see", "[light_selection][matrix]") {
    Room room(diffuse, 200);
    const auto few = std::span(room.receivers).first(32);
    const auto matrix_of = [&](RowKind visibility, std::span<const PathReceiver> receivers) {
        const auto context = room.context(visibility);
        return lights::reduced_matrix(context, receivers, 1);
    };
    const auto by_rays = matrix_of(RowKind::rays, few);
    const auto differ = [&](const lights::ReducedMatrix& other) {
        double difference = 0.0, sum = 0.0;
        for (std::size_t j = 0; j < by_rays.classes.size(); ++j)
            if (by_rays.classes[j] == LightClass::lit && other.classes[j] == LightClass::lit)
                for (std::size_t i = 0; i < 32; ++i) {
                    const double v = double(by_rays.values[32 * j + i]);
                    sum += v, difference += std::fabs(v - double(other.values[32 * j + i]));
                }
        REQUIRE(sum > 0.0);
        return difference / sum;
    };
    std::vector<PathReceiver> turned(few.begin(), few.end());
    std::rotate(turned.begin(), turned.begin() + 1, turned.end());
    for (const RowKind visibility : {RowKind::shadow_maps}) {
        const double maps = differ(matrix_of(visibility, few));
        INFO("visibility " << int(visibility) << ": " << maps);
        CHECK(maps < 0.2);
        CHECK(differ(matrix_of(visibility, turned)) > 3.0 * maps);
    }
}

TEST_CASE("Places are parted evenly, and found again", "[light_selection][matrix]") {
    Rng rng(8);
    std::vector<lights::SlicePoint> points;
    for (int i = 0; i < 500; ++i) {
        const Vec3 p(rng.next_float(), 2.0f * rng.next_float(), rng.next_float());
        points.push_back({p, i % 3 ? random_direction(rng) : Vec3(0.0f)});
    }
    const lights::SliceTree tree(points, 13);
    REQUIRE(tree.groups() == 13);
    std::size_t wrong = 0, count = 0;
    for (std::size_t g = 0; g < 13; ++g) {
        CHECK((tree.group(g).size() > 500 / 13 / 2 && tree.group(g).size() < 2 * 500 / 13));
        for (const std::uint32_t i : tree.group(g)) wrong += tree.find(points[i]) != g, ++count;
    }
    CHECK(count == 500);
    CHECK(wrong == 0);
    CHECK(lights::SliceTree(std::span(points).first(3), 13).groups() == 3);
    CHECK(lights::SliceTree({}, 13).groups() == 0);
    const std::vector<lights::SlicePoint> same(20);
    CHECK(lights::SliceTree(same, 4).groups() == 1);
}

TEST_CASE("No lights, one, dark ones, no receivers", "[light_selection][matrix][extremes]") {
    Room room(diffuse, 100);
    std::vector<WeightedVpl> sampled;
    Rng rng(1);
    const auto tile = room.tile(0);
    const MatrixSettings settings = settings_of(16, 8, 2);
    const auto vpls = room.vpls;
    const auto sample = [&](std::span<const PathReceiver> receivers, float bound = 4.0f) {
        const MatrixClusters matrix(room.context(RowKind::rays, bound), receivers, settings, 1);
        return matrix.sample(tile, rng, sampled);
    };
    room.vpls.lights.clear();
    CHECK(sample(room.receivers).empty());
    room.vpls.lights.assign(vpls.lights.begin(), vpls.lights.begin() + 1);
    CHECK(sample(room.receivers).size() == 1);
    room.vpls.lights.assign(100, vpls.lights[0]);
    for (auto& light : room.vpls.lights) light.intensity = Rgb(0.0f);
    CHECK(sample(room.receivers).empty());
    // One of a hundred, of hardly any power.
    room.vpls.lights[70].intensity = Rgb(1e-30f);
    REQUIRE(sample(room.receivers).size() == 1);
    CHECK((sampled[0].index == 70 && sampled[0].weight == 1.0f));
    // A hundred in one at, and receivers on a light without a bound.
    room.vpls.lights.assign(100, vpls.lights[0]);
    for (const WeightedVpl& light : sample(room.receivers)) CHECK(light.weight >= 1.0f);
    double sum = 0.0;
    for (const WeightedVpl& light : sampled) sum += double(light.weight);
    CHECK(sum == Approx(100.0));
    auto on_it = room.receivers;
    for (PathReceiver& r : on_it) r.vertex.position = r.vertex.hit.position = vpls.lights[0].position;
    for (const WeightedVpl& light : sample(on_it, infinity)) CHECK(std::isfinite(light.weight));
    // Powers that single precision has no squares of.
    room.vpls = vpls;
    for (const float scale : {1e-25f, 1e25f}) {
        for (std::size_t j = 0; j < vpls.lights.size(); ++j)
            room.vpls.lights[j].intensity = scale * vpls.lights[j].intensity;
        CHECK(sample(room.receivers).size() >= 8);
        for (const WeightedVpl& light : sampled) CHECK((std::isfinite(light.weight) && light.weight >= 1.0f));
    }
    room.vpls = vpls;
    CHECK(sample({}).size() >= 1);  // sampled by energy
}
