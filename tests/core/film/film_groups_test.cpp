// The error that groups of passes and estimates of missing light state (core/film/film_groups.cpp).
#include <cmath>

#include "core/film/film.h"
#include "core/math/random.h"
#include "core/metrics/relative_error.h"
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
    std::vector<Rgb> all, found;
    for (std::size_t p = 0; p < film.pixels(); ++p)
        all.emplace_back(lit(p) ? 1.3f : 0.05f), found.emplace_back(lit(p) ? 0.3f : 0.05f);
    const double exact = relative_error(found, all, relative_weights(all, w, h)).error;
    const auto error = film.error();
    REQUIRE(error);
    CHECK(error->low < exact);
    CHECK(error->high > exact);
    // 960 lit pixels, each with 4 % of noise in the mean: 0.1 %; four standard deviations.
    CHECK(error->error == Approx(exact).epsilon(0.005));
}

TEST_CASE("A pixel that few passes light is bright by the lower end, its light is noise by the upper one",
          "[film][groups]") {
    // Light of 1 without noise, but for one pixel that gets 1000 in k of 32 passes, each of another group.
    const int size = 64, passes = 32;
    const double count = size * size, bright = 1000.0;
    for (const std::uint32_t k : {1u, 2u, 4u}) {
        CAPTURE(k);
        Film film(size, size, {{"indirect", "", false}}, false, PassSplit::groups);
        for (std::uint32_t i = 0; i < passes; ++i) {
            PassImage image(size, size, 1);
            for (std::size_t p = 0; p < film.pixels(); ++p) image.layer(0)[p] = Rgb(1.0f);
            if (i < k) image.layer(0)[film.pixels() / 2] += Rgb(float(bright));
            film.add_pass(image);
        }
        const auto error = film.error();
        REQUIRE(error);
        // Eq. (2) of group_error.h in that pixel, and the variance of its mean.
        const double unit = sqr(bright / passes), squared = unit * k * (8.0 - k) / 7.0;
        const double v = unit * k * double(passes - k) / (passes - 1.0), c = 1.0 + k * bright / passes;
        const double lower = std::sqrt(squared / (c * c + v) / count),
                     upper = std::sqrt(squared / 1.01 / count);
        CHECK(error->low < 1.01 * lower);
        CHECK(error->high > 0.99 * upper);
        // Where no two groups share noise, Fisher's F is 1.
        if (k == 1) CHECK(error->low == Approx(lower).epsilon(0.01));
        if (k == 1) CHECK(error->high == Approx(upper).epsilon(0.01));
    }
}

TEST_CASE("The error is within the interval where rare bright paths make the light of dark surroundings",
          "[film][groups][coverage][statistics]") {
    // Each tenth pixel has most of its light from few passes, and neighbours that may have had none.
    const int w = 40, h = 30, seeds = 20, passes = 32;
    const auto rare = [](std::size_t p) { return p % 10 == 3; };
    std::vector<Rgb> exact;
    for (std::size_t p = 0; p < std::size_t(w * h); ++p) exact.emplace_back(rare(p) ? 21.0f : 1.0f);
    const RelativeWeights weights = relative_weights(exact, w, h);
    int within = 0, count = 0;
    for (const float hits : {0.5f, 1.0f, 2.0f, 4.0f, 8.0f})
        for (std::uint64_t seed = 0; seed < seeds; ++seed, ++count) {
            Film film(w, h, {{"indirect", "", false}}, false, PassSplit::groups);
            const float probability = hits / float(passes);
            for (std::uint32_t i = 0; i < passes; ++i) {
                PassImage image(w, h, 1);
                Rng rng(hash_keys(seed, i));
                for (std::size_t p = 0; p < film.pixels(); ++p) {
                    const float dark = 2.0f * rng.next_float(), hit = rng.next_float();
                    image.layer(0)[p] =
                        Rgb(dark + (rare(p) && hit < probability ? 20.0f / probability : 0.0f));
                }
                film.add_pass(image);
            }
            const auto said = film.error();
            REQUIRE(said);
            const double error = relative_error(film.beauty(), exact, weights).error;
            within += said->low <= error && error <= said->high;
        }
    CHECK(within > count * 0.95 - 3.0 * std::sqrt(0.95 * 0.05 * count));
}
