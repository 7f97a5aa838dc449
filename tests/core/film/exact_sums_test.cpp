// Exact sums: any order and any grouping give the same bits, and the right number.
#include "core/film/exact_sums.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/math/random.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

double sum_of(const std::vector<double>& terms) {
    ExactSums sum(1);
    for (const double term : terms) sum.add(0, term);
    return sum.at(0);
}

/// Random terms of either sign, or their squares, with exponents up to `range` apart; a tenth of them are 0.
std::vector<double> random_terms(std::size_t count, float range, std::uint64_t seed, bool squares) {
    Rng rng(seed);
    std::vector<double> terms(count);
    for (double& term : terms) {
        const float v = std::ldexp(rng.next_float() - 0.5f, int(range * (rng.next_float() - 0.5f)));
        term = rng.next_float() < 0.1f ? 0.0 : squares ? double(v) * double(v) : double(v);
    }
    return terms;
}

}  // namespace

TEST_CASE("A sum does not depend on the order of its terms, nor on how they are grouped", "[exact_sums]") {
    for (const float range : {0.0f, 20.0f, 100.0f, 250.0f})
        for (const bool squares : {false, true}) {
            std::vector<double> terms = random_terms(500, range, 7, squares);
            const double expected = sum_of(terms);
            Rng rng(3);
            int plain_differs = 0;
            const double plain = std::accumulate(terms.begin(), terms.end(), 0.0);
            for (int shuffle = 0; shuffle < 50; ++shuffle) {
                for (std::size_t i = terms.size() - 1; i > 0; --i)
                    std::swap(terms[i], terms[rng.next_u32() % (i + 1)]);
                REQUIRE(sum_of(terms) == expected);
                plain_differs += std::accumulate(terms.begin(), terms.end(), 0.0) != plain;
                ExactSums all(1);
                for (std::size_t begin = 0; begin < terms.size();) {
                    const std::size_t end = std::min(terms.size(), begin + 1 + rng.next_u32() % 100);
                    ExactSums group(1);
                    for (; begin < end; ++begin) group.add(0, terms[begin]);
                    all.add(0, group);
                }
                REQUIRE(all.at(0) == expected);
            }
            if (range == 100.0f && !squares) CHECK(plain_differs > 0);  // what it is there for
        }
}

TEST_CASE("A sum is off by less than 2^-40 of its largest term for each of its terms", "[exact_sums]") {
    for (const float range : {0.0f, 30.0f, 120.0f})
        for (std::uint64_t seed = 0; seed < 20; ++seed) {
            const std::vector<double> terms = random_terms(100, range, seed, seed % 2 == 1);
            long double sum = 0.0L, largest = 0.0L;
            for (const double term : terms)
                sum += term, largest = std::max<long double>(largest, std::fabs(term));
            CHECK(std::fabs(double(sum_of(terms) - sum)) <= double(100.0L * largest) * 0x1p-40);
        }
}

TEST_CASE("Floats of one size, constants and the ends of the range are summed to the bit", "[exact_sums]") {
    for (const double value : {1.0, -1.0, double(1.0f / 3.0f), double(std::numeric_limits<float>::max()),
                               double(std::numeric_limits<float>::denorm_min()), 0x1p-300, -0x1p255}) {
        CHECK(sum_of({value}) == value);
        CHECK(sum_of({value, 0.0, value, value}) == 3.0 * value);
        CHECK(sum_of({value, -value}) == 0.0);
    }
    CHECK(sum_of({}) == 0.0);
    // As many terms as may be, of the largest digits there are.
    const double most = 0x1p40 - 0x1p16;
    ExactSums doubled(1);
    doubled.add(0, most);
    double terms = 1.0;
    for (int i = 0; i < 22; ++i) {
        const ExactSums half = doubled;
        doubled.add(0, half), terms *= 2.0;
    }
    CHECK(doubled.at(0) == terms * most);
}
