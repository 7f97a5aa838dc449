// Columns of a matrix: costs of clusters by their definition, matrices whose answer is known, and the
// probabilities that columns are sampled with.
#include "lights/selection/matrix/column_sampler.h"
#include "lights/selection/matrix/column_split.h"
#include "tests/lights/random_lights.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;
using lights::ColumnClusters, lights::ColumnSampler, lights::Columns, lights::WeightedVpl;

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

/// Estimate of the sum of all columns by one random column of each cluster.
std::vector<double> estimate(const RandomColumns& m, const ColumnSampler& samples, Rng& rng) {
    std::vector<WeightedVpl> sampled;
    samples.sample(rng, sampled);
    std::vector<double> sum(m.rows);
    for (const WeightedVpl& light : sampled)
        for (std::size_t i = 0; i < m.rows; ++i)
            sum[i] += double(light.weight) * double(m.values[light.index * m.rows + i]);
    return sum;
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
        const ColumnSampler samples(lights::cluster_columns(m.columns(), m.members, 1, rng), m.norms);
        REQUIRE(samples.size() == 1);
        const auto all = sum_of_columns(m);
        for (int k = 0; k < 20; ++k) {
            const auto found = estimate(m, samples, rng);
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

TEST_CASE("Columns are sampled with the probabilities that they are scaled by",
          "[light_selection][matrix][statistics]") {
    Rng rng(5);
    const RandomColumns m(rng, 8, 12, 0.5f);
    const ColumnSampler samples(lights::cluster_columns(m.columns(), m.members, 2, rng), m.norms);
    std::vector<double> count(12);
    constexpr int tries = 20000;
    std::vector<WeightedVpl> sampled;
    for (int k = 0; k < tries; ++k) {
        sampled.clear();
        samples.sample(rng, sampled);
        for (const WeightedVpl& light : sampled) count[light.index] += 1.0;
        if (k == 0) CHECK(sampled.size() == samples.size());
    }
    double chi2 = 0.0, sum = 0.0;
    int degrees = 0;
    for (std::size_t i = 0; i < 12; ++i) {
        const double p = samples.probability(i), expected = p * tries;
        sum += p, ++degrees;
        chi2 += sqr(count[samples.clusters().members[i]] - expected) / expected;
    }
    degrees -= int(samples.size());
    CHECK(sum == Approx(double(samples.size())).epsilon(1e-12));
    CHECK(chi2 < double(degrees) + 4.0 * std::sqrt(2.0 * double(degrees)) + 6.0);  // beyond 0.1 %
}
