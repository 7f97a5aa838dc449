// Distributions: probabilities, zero weights, remapped numbers, and the density of the table.
#include "core/math/distribution.h"

#include "core/math/random.h"
#include "tests/support/catch.h"

using namespace mote::core;

TEST_CASE("discrete choices follow the weights", "[math][distribution]") {
    const std::vector<float> weights = {1, 0, 3, 0, 0, 4, 0};
    const Distribution1D d(weights);
    CHECK(d.total() == Approx(8.0));
    Rng rng(1);
    const int n = 80000;
    std::vector<int> counts(weights.size(), 0);
    double remapped_sum = 0.0, remapped_square = 0.0;
    for (int i = 0; i < n; ++i) {
        const auto s = d.sample_discrete(rng.next_float());
        ++counts[s.index];
        CHECK(s.probability == d.probability(s.index));
        CHECK((s.remapped >= 0.0f && s.remapped < 1.0f));
        remapped_sum += double(s.remapped), remapped_square += double(s.remapped * s.remapped);
    }
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const double p = double(weights[i]) / 8.0;
        CHECK(std::fabs(counts[i] - n * p) <= 4.0 * std::sqrt(n * p * (1.0 - p)));
        if (weights[i] == 0.0f) CHECK(counts[i] == 0);
    }
    // Remapped numbers are uniform again: mean 1/2 and mean square 1/3 within 4 sigma.
    CHECK(std::fabs(remapped_sum / n - 0.5) < 4.0 * std::sqrt(1.0 / 12.0 / n));
    CHECK(std::fabs(remapped_square / n - 1.0 / 3.0) < 4.0 * std::sqrt(4.0 / 45.0 / n));
}

TEST_CASE("zero weights are never chosen, not even at the ends", "[math][distribution]") {
    const std::vector<float> weights = {0, 0, 1e-30f, 0, 1e30f, 0, 0};
    const Distribution1D d(weights);
    for (const float u : {0.0f, 1e-30f, 0.5f, one_minus_epsilon, 1.0f}) {
        const auto s = d.sample_discrete(u);
        CHECK((s.index == 2 || s.index == 4));
        CHECK(std::isfinite(s.remapped));
    }
    CHECK(d.sample_discrete(0.0f).index == 2);
    CHECK(d.sample_discrete(1.0f).index == 4);
}

TEST_CASE("bad tables are refused and empty ones known", "[math][distribution]") {
    CHECK_THROWS_AS(Distribution1D(std::vector<float>{1, -1}), std::invalid_argument);
    CHECK_THROWS_AS(Distribution1D(std::vector<float>{std::nanf("")}), std::invalid_argument);
    CHECK_THROWS_AS(Distribution1D(std::vector<float>{infinity}), std::invalid_argument);
    CHECK_THROWS_AS(Distribution2D(std::vector<float>{1, 2, 3}, 2, 2), std::invalid_argument);
    CHECK(Distribution1D(std::vector<float>{0, 0}).empty());
    CHECK(Distribution1D().empty());
    CHECK(Distribution1D().probability(0) == 0.0f);
    CHECK(Distribution2D(std::vector<float>{0, 0, 0, 0}, 2, 2).empty());
    CHECK(Distribution2D().pdf({0.5f, 0.5f}) == 0.0f);
}

TEST_CASE("a two-dimensional table is sampled by its density", "[math][distribution]") {
    const std::vector<float> table = {1, 2, 0, 4, 0, 0, 0, 0, 5, 1, 3, 8};  // 4 x 3
    const Distribution2D d(table, 4, 3);
    Rng rng(2);
    const int n = 96000;
    std::vector<int> counts(12, 0);
    for (int i = 0; i < n; ++i) {
        const auto s = d.sample(rng.next_vec2());
        CHECK(s.pdf == Approx(d.pdf(s.uv)));
        ++counts[std::size_t(s.uv.y * 3.0f) * 4 + std::size_t(s.uv.x * 4.0f)];
    }
    double integral = 0.0;
    for (std::size_t i = 0; i < 12; ++i) {
        const double p = double(table[i]) / 24.0;
        CHECK(std::fabs(counts[i] - n * p) <= 4.0 * std::sqrt(n * p * (1.0 - p)));
        integral += double(d.pdf({(float(i % 4) + 0.5f) / 4.0f, (float(i / 4) + 0.5f) / 3.0f})) / 12.0;
    }
    CHECK(integral == Approx(1.0));
    CHECK(d.pdf({1.5f, 0.5f}) == 0.0f);
    CHECK(d.pdf({-0.1f, 0.5f}) == 0.0f);
    const Distribution1D one(std::vector<float>{1, 3});
    CHECK(one.sample_continuous(one_minus_epsilon).x < 1.0f);
    CHECK(one.pdf(0.75f) == Approx(1.5));
    CHECK(one.pdf(0.25f) == Approx(0.5));
}
