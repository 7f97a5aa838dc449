// Previews adapt to their picture, and can be made again from the number that says how.
#include <cmath>
#include <limits>
#include <vector>

#include "core/film/exposure.h"
#include "tests/support/catch.h"

using namespace mote::core;

TEST_CASE("An even picture comes to lie at the key value, whatever its scale", "[exposure]") {
    for (const float level : {1e-6f, 0.18f, 3.0f, 1e6f}) {
        const std::vector<Rgb> picture(64, Rgb(level));
        const double shown = level * std::exp2(double(adapted_exposure(picture)));
        CHECK(shown == Approx(key_value).epsilon(0.005));  // hundredths of a stop
    }
}

TEST_CASE("A lamp, black and broken pixels do not change what is seen of the rest", "[exposure]") {
    std::vector<Rgb> picture(1000, Rgb(0.5f));
    const float plain = adapted_exposure(picture);
    for (std::size_t i = 0; i < 10; ++i) picture[i] = Rgb(1e4f);
    picture[20] = Rgb(std::numeric_limits<float>::quiet_NaN()),
    picture[21] = Rgb(std::numeric_limits<float>::infinity());
    CHECK(adapted_exposure(picture) == Approx(plain).margin(0.15));  // one of a hundred, 14 stops brighter
    picture.resize(3000, Rgb(0.0f));
    CHECK(adapted_exposure(picture) == Approx(plain).margin(0.15));
}

TEST_CASE("Bright parts stay below white in a picture that is mostly dark", "[exposure]") {
    std::vector<Rgb> picture(1000, Rgb(1e-3f));
    for (std::size_t i = 0; i < 100; ++i) picture[i] = Rgb(5.0f);
    CHECK(5.0 * std::exp2(double(adapted_exposure(picture))) == Approx(1.0).epsilon(0.005));
}

TEST_CASE("A picture without light is shown as it is", "[exposure]") {
    CHECK(adapted_exposure({}) == 0.0f);
    const std::vector<Rgb> black(4, Rgb(0.0f)), broken(4, Rgb(std::numeric_limits<float>::infinity()));
    CHECK(adapted_exposure(black) == 0.0f);
    CHECK(adapted_exposure(broken) == 0.0f);
}
