// The error that groups of passes and estimates of missing light state (core/film/film_groups.cpp).
#include <cmath>

#include "core/film/film.h"
#include "core/math/random.h"
#include "tests/support/catch.h"

using namespace mote::core;

TEST_CASE("Light that is missing inside of sharp edges makes the exact error", "[film][groups]") {
    // Stripes in which a bound takes 1 of 1.3, beside darker ones in which it takes nothing. A film that
    // smooths what is missing across their edges finds 3 % more.
    const int w = 48, h = 32;
    std::vector<Layer> layers = {{"indirect", "", false}, {"missing", "", true}};
    layers[1].squares = layers[1].missing = true;
    const auto lit = [&](std::size_t p) { return p % std::size_t(w) % 8 < 5; };
    Film film(w, h, layers, false, PassSplit::groups);
    for (std::uint32_t i = 0; i < 64; ++i) {
        PassImage image(w, h, layers.size());
        Rng rng(hash_keys(78, i));
        const auto noisy = [&](float mean, float noise) {
            return Rgb(mean * (1.0f + noise * (2.0f * rng.next_float() - 1.0f)));
        };
        for (std::size_t p = 0; p < film.pixels(); ++p) {
            image.layer(0)[p] = noisy(lit(p) ? 0.3f : 0.05f, 0.05f);
            image.layer(1)[p] = noisy(lit(p) ? 1.0f : 0.0f, 0.5f);
        }
        film.add_pass(image);
    }
    // By the weights of relative_error.h. The median pixel is a lit one.
    double missing = 0.0, light = 0.0;
    for (std::size_t p = 0; p < film.pixels(); ++p) {
        const double r = lit(p) ? 1.3 : 0.05, weight = 1.0 / (r * r + 0.01 * 1.3 * 1.3);
        missing += weight * (lit(p) ? 1.0 : 0.0), light += weight * r * r;
    }
    const double exact = std::sqrt(missing / light);
    const auto error = film.error();
    REQUIRE(error);
    CHECK(error->low < exact);
    CHECK(error->high > exact);
    // 960 lit pixels, each with 4 % of noise in the mean: 0.1 %; four standard deviations.
    CHECK(error->error == Approx(exact).epsilon(0.005));
}
