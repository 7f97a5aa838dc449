// Matrix row-column sampling: costs of clusters by their definition, matrices whose answer is
// known, and the mean of all lights whatever the clusters are.
#include "lights/selection/matrix_selection.h"

#include <tbb/global_control.h>

#include "core/objects/error.h"
#include "core/scene/scene.h"
#include "lights/selection/column_split.h"
#include "lights/selection/light_clusters.h"
#include "lights/selection/shared_columns.h"
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
using lights::ColumnClusters, lights::ColumnDraws, lights::Columns, lights::LightClass;
using lights::MatrixReceiver, lights::MatrixSelection, lights::MatrixSettings, lights::WeightedVpl;
using Rows = lights::RowVisibilitySettings::Kind;

namespace {

/// Columns along a few directions that differ a little, of all sizes.
struct RandomColumns {
    std::size_t rows;
    std::vector<float> values;
    std::vector<std::uint32_t> members;
    std::vector<float> norms;

    RandomColumns(Rng& rng, std::size_t rows_, std::size_t count, float spread, int directions = 5)
        : rows(rows_) {
        std::vector<float> axes(rows * std::size_t(directions));
        for (float& v : axes) v = rng.next_float();
        for (std::uint32_t j = 0; j < count; ++j) {
            const std::size_t axis = rng.next_u32() % std::uint32_t(directions) * rows;
            const float size = random_size(rng, -2, 1);
            double squares = 0.0;
            for (std::size_t i = 0; i < rows; ++i) {
                values.push_back(size * (axes[axis + i] + spread * rng.next_float()));
                squares += sqr(double(values.back()));
            }
            members.push_back(j), norms.push_back(float(std::sqrt(squares)));
        }
    }
    Columns columns() const { return {values, rows}; }
};

/// Hasan et al. 2007: pairs.
double cost_by_pairs(const RandomColumns& m, std::span<const std::uint32_t> members) {
    double sum = 0.0;
    for (std::size_t a = 0; a < members.size(); ++a)
        for (std::size_t b = a + 1; b < members.size(); ++b) {
            double square = 0.0;
            for (std::size_t i = 0; i < m.rows; ++i)
                square += sqr(double(m.values[members[a] * m.rows + i]) / double(m.norms[members[a]]) -
                              double(m.values[members[b] * m.rows + i]) / double(m.norms[members[b]]));
            sum += double(m.norms[members[a]]) * double(m.norms[members[b]]) * square;
        }
    return sum;
}

double cost_of(const RandomColumns& m, const ColumnClusters& clusters) {
    double sum = 0.0;
    for (std::size_t k = 0; k < clusters.size(); ++k)
        sum += lights::cluster_cost(m.columns(), clusters.cluster(k));
    return sum;
}

std::vector<double> sum_of_columns(const RandomColumns& m) {
    std::vector<double> sum(m.rows);
    for (std::size_t v = 0; v < m.values.size(); ++v) sum[v % m.rows] += double(m.values[v]);
    return sum;
}

/// What one column of each cluster says about the sum of all, drawn once.
std::vector<double> estimate(const RandomColumns& m, const ColumnDraws& draws, Rng& rng) {
    std::vector<WeightedVpl> drawn;
    draws.draw(rng, drawn);
    std::vector<double> sum(m.rows);
    for (const WeightedVpl& light : drawn)
        for (std::size_t i = 0; i < m.rows; ++i)
            sum[i] += double(light.weight) * double(m.values[light.index * m.rows + i]);
    return sum;
}

const std::string plastic = R"(<bsdf type="roughplastic"><float name="alpha" value="0.4"/></bsdf>)";

/// A room with a wall across that leaves a gap above, its VPLs, and receivers on both sides of the wall: on
/// surfaces and in the air.
struct Room {
    std::unique_ptr<Scene> scene;
    lights::VplSet vpls;
    media::HenyeyGreensteinPhase forward{0.6f};
    std::vector<MatrixReceiver> receivers;
    RayCounters rays;
    TrackingCounters tracking;
    lights::SurfacePoints points;

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
            MatrixReceiver r{make_vertex(event, ray), Rgb(0.5f, 0.6f, 0.7f), state, 1000};
            if (receivers.size() % 4 == 3) {
                r.vertex = {};
                r.vertex.position = ray.at(0.5f * event.hit.t), r.vertex.wo = -ray.direction;
                r.vertex.phase = &forward, r.throughput = Rgb(0.2f);
            }
            receivers.push_back(r);
        }
        points = lights::sample_surface_points(*scene, 4096, 1);
    }
    lights::RowContext context(Rows visibility = Rows::rays, float bound = 4.0f) {
        lights::RowVisibilitySettings settings;
        settings.kind = visibility, settings.map_size = 24;
        settings.imperfect.size = 24, settings.imperfect.points = 2048;
        return {*scene, vpls, bound, settings, &points, rays, tracking};
    }
    lights::ReceiverTile tile(std::size_t first) const {
        lights::ReceiverTile tile;
        tile.clear();
        for (std::size_t i = 0; i < 16; ++i) {
            const MatrixReceiver& r = receivers[(first + 23 * i) % receivers.size()];
            tile.set(int(i), r.vertex, r.throughput, r.state, Rng(i), r.max_vpl_depth);
        }
        return tile;
    }
    /// Of all lanes and channels.
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

MatrixSettings settings_of(std::uint32_t rows, std::uint32_t columns, std::uint32_t slices,
                           std::size_t max_bytes = std::size_t(1) << 30) {
    MatrixSettings settings;
    settings.rows = rows, settings.columns = columns, settings.slices = slices;
    settings.max_bytes = max_bytes;
    return settings;
}

}  // namespace

TEST_CASE("The cost of a cluster is that of its pairs, and the mean square of its error",
          "[light_selection][matrix]") {
    Rng rng(1);
    for (const std::size_t rows : {1u, 2u, 16u, 37u})
        for (const float spread : {0.0f, 0.1f, 1.0f}) {
            const RandomColumns m(rng, rows, 60, spread);
            const auto members = std::span(m.members).subspan(rng.next_u32() % 20);
            const double cost = lights::cluster_cost(m.columns(), members);
            double norms = 0.0;
            for (const std::uint32_t j : members) norms += double(m.norms[j]);
            // Rounding: the difference of two squares of sums of norms of single precision.
            const double rounding = 4e-7 * norms * norms;
            CHECK(std::fabs(cost - cost_by_pairs(m, members)) < rounding);
            double square = 0.0;  // E ||x_j / p_j - sum||^2
            for (const std::uint32_t j : members)
                for (std::size_t i = 0; i < rows; ++i) {
                    double sum = 0.0;
                    for (const std::uint32_t k : members) sum += double(m.values[k * rows + i]);
                    const double p = double(m.norms[j]) / norms;
                    square += p * sqr(double(m.values[j * rows + i]) / p - sum);
                }
            CHECK(std::fabs(cost - square) < rounding);
            if (spread == 1.0f && rows > 1) CHECK(cost > 1e3 * rounding);
        }
}

TEST_CASE("A matrix of rank one is exact with one column", "[light_selection][matrix]") {
    Rng rng(2);
    for (const int directions : {1, 2}) {
        const RandomColumns m(rng, 24, 500, 0.0f, directions);
        const ColumnDraws draws(lights::cluster_columns(m.columns(), m.members, 1, rng), m.norms);
        REQUIRE(draws.size() == 1);
        const auto all = sum_of_columns(m);
        for (int k = 0; k < 20; ++k) {
            const auto found = estimate(m, draws, rng);
            double worst = 0.0;
            for (std::size_t i = 0; i < m.rows; ++i)
                worst = std::max(worst, std::fabs(found[i] - all[i]) / all[i]);
            // Rank two is not.
            CHECK((worst < 2e-6) == (directions == 1));
        }
    }
    // Rank five with some more columns.
    const RandomColumns m(rng, 24, 500, 0.0f, 5);
    const auto clusters = lights::cluster_columns(m.columns(), m.members, 15, rng);
    CHECK(cost_of(m, clusters) < 1e-6 * lights::cluster_cost(m.columns(), m.members));
}

TEST_CASE("Clusters hold each column once, and cost less the more there are", "[light_selection][matrix]") {
    Rng rng(3);
    const RandomColumns m(rng, 16, 3000, 0.5f, 40);
    double before = lights::cluster_cost(m.columns(), m.members);
    for (const std::size_t count : {1u, 2u, 3u, 10u, 100u, 1000u, 3000u}) {
        const auto clusters = lights::cluster_columns(m.columns(), m.members, count, rng);
        CHECK(clusters.size() <= count);
        CHECK(clusters.size() > count / 2);
        std::vector<int> seen(m.members.size());
        for (std::size_t k = 0; k < clusters.size(); ++k) {
            REQUIRE(!clusters.cluster(k).empty());
            for (const std::uint32_t j : clusters.cluster(k)) ++seen[j];
        }
        CHECK(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
        const double cost = cost_of(m, clusters);
        CHECK(cost <= before * (1.0 + 1e-6));
        before = cost;
        // Groups at random cost about 1 / count of all; these are found by what they send.
        if (count == 100) CHECK(cost < 0.3 * lights::cluster_cost(m.columns(), m.members) / 100.0);
    }
}

TEST_CASE("Splitting is best along its line", "[light_selection][matrix]") {
    Rng rng(4);
    RandomColumns m(rng, 3, 40, 0.7f);
    auto order = m.members;
    const std::size_t n = lights::split_columns(m.columns(), order);
    REQUIRE(n > 0);
    const auto both = [&](std::size_t k) {
        return lights::cluster_cost(m.columns(), std::span(order).first(k)) +
               lights::cluster_cost(m.columns(), std::span(order).subspan(k));
    };
    for (std::size_t k = 1; k < order.size(); ++k) CHECK(both(n) <= both(k) * (1.0 + 1e-6) + 1e-6);
    CHECK(both(n) < 0.7 * lights::cluster_cost(m.columns(), order));
    // Nothing to divide.
    std::vector<std::uint32_t> one{3};
    CHECK(lights::split_columns(m.columns(), one) == 0);
}

TEST_CASE("Columns are drawn with the probabilities that they are scaled by",
          "[light_selection][matrix][statistics]") {
    Rng rng(5);
    const RandomColumns m(rng, 8, 12, 0.5f);
    const ColumnDraws draws(lights::cluster_columns(m.columns(), m.members, 2, rng), m.norms);
    std::vector<double> count(12);
    constexpr int tries = 20000;
    std::vector<WeightedVpl> drawn;
    for (int k = 0; k < tries; ++k) {
        drawn.clear();
        draws.draw(rng, drawn);
        for (const WeightedVpl& light : drawn) count[light.index] += 1.0;
        if (k == 0) CHECK(drawn.size() == draws.size());
    }
    double chi2 = 0.0, sum = 0.0;
    int degrees = 0;
    for (std::size_t i = 0; i < 12; ++i) {
        const double p = draws.probability(i), expected = p * tries;
        sum += p, ++degrees;
        chi2 += sqr(count[draws.clusters().members[i]] - expected) / expected;
    }
    degrees -= int(draws.size());
    CHECK(sum == Approx(double(draws.size())).epsilon(1e-12));
    CHECK(chi2 < double(degrees) + 4.0 * std::sqrt(2.0 * double(degrees)) + 6.0);  // beyond 0.1 %
}

TEST_CASE("Light by a matrix has the mean of all lights, on both sides of a wall and in the air",
          "[light_selection][matrix][statistics]") {
    constexpr double critical = 3.3;  // two-sided, 0.1 %
    Rng rng(6);
    for (const Rows visibility : {Rows::rays, Rows::shadow_maps, Rows::imperfect}) {
        Room room(visibility == Rows::rays ? plastic : diffuse);
        REQUIRE(room.vpls.lights.size() > 500);
        // Few receivers make rows, others are lit.
        const auto few = std::span(room.receivers).first(20);
        const MatrixSelection matrix(room.context(visibility), few, settings_of(16, 24, 1), 5);
        std::vector<WeightedVpl> drawn;
        const lights::ReceiverTile tile = room.tile(100);
        const double all = room.light(tile, lights::VplRange{});
        REQUIRE(all > 0.0);
        const auto draw = [&] { return room.light(tile, lights::DrawnVpls{matrix.draw(tile, rng, drawn)}); };
        const Mean found = mean_of(5000, draw);
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
    std::vector<MatrixReceiver> few, many;
    for (const MatrixReceiver& r : room.receivers) (r.vertex.position.x > 0.5f ? few : many).push_back(r);
    few.resize(16), room.receivers = many;
    const auto context = room.context();
    const auto matrix = lights::reduced_matrix(context, few, 1);
    const ColumnClusters clusters = lights::cluster_lights(matrix, 24, rng);
    const lights::ReceiverTile tile = room.tile(100);
    const double sum = room.light(tile, lights::VplRange{});
    const auto test = [&](const ColumnClusters& some, bool wrong_weight) {
        const ColumnDraws draws(some, matrix.weights);
        std::vector<WeightedVpl> drawn;
        const Mean found = mean_of(3000, [&] {
            drawn.clear();
            draws.draw(rng, drawn);
            if (wrong_weight)  // as if drawn evenly
                for (std::size_t k = 0; k < drawn.size(); ++k)
                    drawn[k].weight = float(some.cluster(k).size());
            return room.light(tile, lights::DrawnVpls{drawn});
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
        const MatrixSelection matrix(room.context(), room.receivers, settings_of(48, 64, 3), key);
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
    const MatrixSelection matrix(room.context(), room.receivers, settings_of(16, 4000, 2), 1);
    std::vector<WeightedVpl> drawn;
    Rng rng(1);
    const auto tile = room.tile(7);
    matrix.draw(tile, rng, drawn);
    REQUIRE(drawn.size() == room.vpls.lights.size());
    for (std::size_t j = 0; j < drawn.size(); ++j) CHECK((drawn[j].index == j && drawn[j].weight == 1.0f));
    CHECK(room.light(tile, lights::DrawnVpls{drawn}) == room.light(tile, lights::VplRange{}));
}

TEST_CASE("Clusters of one frame serve the lights of another, without bias",
          "[light_selection][matrix][statistics]") {
    constexpr double critical = 3.3;
    Rng rng(9);
    Room room(diffuse, 300), other(diffuse, 200), one(diffuse, 1);
    other.vpls = lights::trace_light_paths(*room.scene, {.paths = 250}, 8, 3, SamplerKind::sobol);
    other.vpls.lights[5].intensity = Rgb(0.0f);
    const lights::ReceiverTile tile = other.tile(100);
    const double all = other.light(tile, lights::VplRange{});
    const auto settings = settings_of(32, 24, 2);
    std::array<double, 2> error{};
    // From a frame like it, and from one that had hardly any light.
    for (Room* before : {&room, &one}) {
        const lights::SharedColumns shared(
            before->vpls, MatrixSelection(before->context(), before->receivers, settings, 1));
        const MatrixSelection matrix = shared.for_lights(other.vpls);
        for (std::size_t s = 0; s < matrix.slices(); ++s)
            CHECK(matrix.slice(s).clusters().members.size() == other.vpls.lights.size() - 1);
        std::vector<WeightedVpl> drawn;
        const Mean found = mean_of(
            3000, [&] { return other.light(tile, lights::DrawnVpls{matrix.draw(tile, rng, drawn)}); });
        INFO(found.mean << " +- " << found.error << " of " << all);
        CHECK(std::fabs(found.mean - all) < critical * found.error);
        CHECK(critical * found.error < 0.1 * all);
        error[before == &one] = found.error;
        // Weights of the lights before are others.
        if (before == &room)
            CHECK_FALSE((matrix.slice(0).clusters().members == shared.found().slice(0).clusters().members));
    }
    CHECK(error[0] < error[1]);
    // Its own lights join their own clusters; none at all is dealt with.
    const lights::SharedColumns shared(room.vpls,
                                       MatrixSelection(room.context(), room.receivers, settings, 1));
    const MatrixSelection own = shared.for_lights(room.vpls);
    // A cluster whose only light stands in the place of another one's is empty, and those behind it move up.
    const auto cluster_of = [](const MatrixSelection& matrix, std::size_t lights) {
        std::vector<std::size_t> of(lights);
        for (std::size_t k = 0; k < matrix.slice(0).size(); ++k)
            for (const std::uint32_t j : matrix.slice(0).clusters().cluster(k)) of[j] = k;
        return of;
    };
    const auto before = cluster_of(shared.found(), room.vpls.lights.size()),
               after = cluster_of(own, room.vpls.lights.size());
    std::size_t parted = 0, together = 0;
    for (std::size_t j = 0; j < before.size(); ++j)
        for (std::size_t i = 0; i < j; ++i)
            if (before[i] == before[j]) ++together, parted += after[i] != after[j];
    INFO(parted << " of " << together << " pairs are parted");
    CHECK(parted < together / 20);  // a few stand in one place
    CHECK(shared.for_lights({}).slice(0).size() == 0);
    CHECK(lights::SharedColumns().for_lights(room.vpls).slices() == 0);
}

TEST_CASE("Maps of receivers see what rays see", "[light_selection][matrix]") {
    Room room(diffuse, 200);
    const auto few = std::span(room.receivers).first(32);
    const auto matrix_of = [&](Rows visibility, std::span<const MatrixReceiver> receivers) {
        const auto context = room.context(visibility);
        return lights::reduced_matrix(context, receivers, 1);
    };
    const auto by_rays = matrix_of(Rows::rays, few);
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
    std::vector<MatrixReceiver> turned(few.begin(), few.end());
    std::rotate(turned.begin(), turned.begin() + 1, turned.end());
    for (const Rows visibility : {Rows::shadow_maps, Rows::imperfect}) {
        const double maps = differ(matrix_of(visibility, few));
        INFO("visibility " << int(visibility) << ": " << maps);
        CHECK(maps < 0.2);
        CHECK(differ(matrix_of(visibility, turned)) > 3.0 * maps);
    }
}

TEST_CASE("Places are parted evenly, and found again", "[light_selection][matrix]") {
    Rng rng(8);
    std::vector<lights::Place> places;
    for (int i = 0; i < 500; ++i) {
        const Vec3 p(rng.next_float(), 2.0f * rng.next_float(), rng.next_float());
        places.push_back({p, i % 3 ? random_direction(rng) : Vec3(0.0f)});
    }
    const lights::PlaceTree tree(places, 13);
    REQUIRE(tree.groups() == 13);
    std::size_t wrong = 0, count = 0;
    for (std::size_t g = 0; g < 13; ++g) {
        CHECK((tree.group(g).size() > 500 / 13 / 2 && tree.group(g).size() < 2 * 500 / 13));
        for (const std::uint32_t i : tree.group(g)) wrong += tree.find(places[i]) != g, ++count;
    }
    CHECK(count == 500);
    CHECK(wrong == 0);
    CHECK(lights::PlaceTree(std::span(places).first(3), 13).groups() == 3);
    CHECK(lights::PlaceTree({}, 13).groups() == 0);
    const std::vector<lights::Place> same(20);
    CHECK(lights::PlaceTree(same, 4).groups() == 1);
}

TEST_CASE("No lights, one, dark ones, no receivers, and more than memory holds",
          "[light_selection][matrix][extremes]") {
    Room room(diffuse, 100);
    std::vector<WeightedVpl> drawn;
    Rng rng(1);
    const auto tile = room.tile(0);
    const MatrixSettings settings = settings_of(16, 8, 2);
    const auto vpls = room.vpls;
    const auto draw = [&](std::span<const MatrixReceiver> receivers, float bound = 4.0f) {
        const MatrixSelection matrix(room.context(Rows::rays, bound), receivers, settings, 1);
        return matrix.draw(tile, rng, drawn);
    };
    room.vpls.lights.clear();
    CHECK(draw(room.receivers).empty());
    room.vpls.lights.assign(vpls.lights.begin(), vpls.lights.begin() + 1);
    CHECK(draw(room.receivers).size() == 1);
    room.vpls.lights.assign(100, vpls.lights[0]);
    for (auto& light : room.vpls.lights) light.intensity = Rgb(0.0f);
    CHECK(draw(room.receivers).empty());
    // One of a hundred, of hardly any power.
    room.vpls.lights[70].intensity = Rgb(1e-30f);
    REQUIRE(draw(room.receivers).size() == 1);
    CHECK((drawn[0].index == 70 && drawn[0].weight == 1.0f));
    // A hundred in one place, and receivers on a light without a bound.
    room.vpls.lights.assign(100, vpls.lights[0]);
    for (const WeightedVpl& light : draw(room.receivers)) CHECK(light.weight >= 1.0f);
    double sum = 0.0;
    for (const WeightedVpl& light : drawn) sum += double(light.weight);
    CHECK(sum == Approx(100.0));
    auto on_it = room.receivers;
    for (MatrixReceiver& r : on_it) r.vertex.position = r.vertex.hit.position = vpls.lights[0].position;
    for (const WeightedVpl& light : draw(on_it, infinity)) CHECK(std::isfinite(light.weight));
    // Powers that single precision has no squares of.
    room.vpls = vpls;
    for (const float scale : {1e-25f, 1e25f}) {
        for (std::size_t j = 0; j < vpls.lights.size(); ++j)
            room.vpls.lights[j].intensity = scale * vpls.lights[j].intensity;
        CHECK(draw(room.receivers).size() >= 8);
        for (const WeightedVpl& light : drawn) CHECK((std::isfinite(light.weight) && light.weight >= 1.0f));
    }
    room.vpls = vpls;
    CHECK(draw({}).size() >= 1);  // drawn by energy
    CHECK_THROWS_AS(MatrixSelection(room.context(), room.receivers, settings_of(16, 8, 2, 1000), 1),
                    InputError);
}
