// Gain of Sobol points, estimated from the differences between halves of blocks: cases with a known answer.
#include "core/film/sobol_gain.h"

#include <cmath>
#include <vector>

#include "tests/core/film/steps.h"
#include "tests/support/catch.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

constexpr double many = 1e6;  // effective pixels: no doubt about any difference

/// R[k] of a part that stays and one that falls by `rate` for each doubling.
double spread(double stays, double rate, int k) { return stays + (1.0 - stays) * std::pow(rate, k); }

std::vector<double> differences(double stays, double rate, std::uint32_t n) {
    std::vector<double> d;
    for (int k = 0; n >> (k + 1) > 0; ++k)
        d.push_back(spread(stays, rate, k) - spread(stays, rate, k + 1) / 2.0);
    return d;
}

/// Variance of the mean of 2^m passes over that of the same number of independent ones.
double known_gain(double stays, double rate, int m) {
    const double n = std::exp2(m), of_mean = spread(stays, rate, m) / n;
    return of_mean * (n - 1.0) / (1.0 - of_mean);
}

/// Squares of the error of a film whose pixels are steps at random places, and of what it says of itself.
struct Compared {
    double error = 0.0, said = 0.0;
};

Compared steps(SamplerKind kind, std::uint32_t passes) {
    // On a constant that is large, so that the weights of the noise are alike.
    const Film film = film_of_steps(64, 100.0f, kind, 3, passes, PassSplit::whole);
    Compared result;
    const std::vector<Rgb> mean = film.beauty();
    for (std::size_t p = 0; p < mean.size(); ++p)
        result.error += std::pow(double(mean[p].x) - 100.0 - double(step_of(p)), 2.0) / double(mean.size());
    result.said = std::pow(film.noise() * 100.5, 2.0);
    return result;
}

}  // namespace

TEST_CASE("The gain of Sobol points is found where it continues as it began", "[noise][gain]") {
    // Three quarters of the slope are assumed beyond the largest blocks. So what does not change is exact,
    // and what falls at one rate for ever is stated too high, but by no more than the root of
    // x(rate^(3/4)) / x(rate), with x(t) = t / (1 - t/2).
    for (const int m : {3, 6, 10})
        for (const double rate : {1.0, 0.9, 0.7, 0.5}) {
            const double gain = sobol_gain(differences(0.0, rate, 1u << m), 1u << m, many);
            const auto x = [](double t) { return t / (1.0 - t / 2.0); };
            INFO("2^" << m << " passes, rate " << rate);
            CHECK(gain / known_gain(0.0, rate, m) == Approx(x(std::pow(rate, 0.75)) / x(rate)).epsilon(0.02));
        }
    // A part that stays ends the fall.
    CHECK(sobol_gain(differences(0.2, 0.5, 1024), 1024, many) ==
          Approx(known_gain(0.2, 0.5, 10)).epsilon(0.05));
}

TEST_CASE("Few pixels and few passes are taken for independent", "[noise][gain]") {
    const std::vector<double> d = {1.0, 0.9, 0.85, 0.8};
    CHECK(sobol_gain(d, 16, 1.0) == Approx(1.0).epsilon(0.1));
    CHECK(sobol_gain(d, 16, many) < 0.85);
    CHECK(sobol_gain(std::vector<double>{1.0}, 2, many) == Approx(1.0).epsilon(1e-6));
    CHECK(sobol_gain(std::vector<double>{1.0, 0.0}, 4, many) == 1.0);
}

TEST_CASE("A film says what Sobol points gain, and nothing of a gain that there is not", "[noise][gain]") {
    for (const std::uint32_t passes : {16u, 64u, 256u}) {
        // Squares of 4096 pixels' errors are good to a few per cent.
        const Compared independent = steps(SamplerKind::independent, passes);
        CHECK(independent.said == Approx(independent.error).epsilon(0.1));
        // One edge: halved with every doubling, of which three quarters of the slope are assumed beyond the
        // largest blocks.
        const Compared sobol = steps(SamplerKind::sobol, passes);
        INFO(passes << " passes: error^2 " << sobol.error << ", said " << sobol.said << "; independent "
                    << independent.error);
        CHECK(sobol.error < 3.0 / passes * independent.error);
        CHECK(sobol.said > 0.9 * sobol.error);
        CHECK(sobol.said < 1.1 * 1.64 * sobol.error);
    }
}
