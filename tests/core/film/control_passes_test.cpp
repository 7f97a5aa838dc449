// Control passes: which pixels they have, what they add up to, and what a film makes of them.
#include "core/film/control_passes.h"

#include <algorithm>
#include <cmath>

#include "core/objects/error.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

std::vector<Layer> layers_of_parts(std::size_t parts) {
    std::vector<Layer> layers;
    for (std::size_t part = 0; part < parts; ++part) {
        layers.push_back({"light" + std::to_string(part), ""});
        layers.back().squares = true, layers.back().part = part;
    }
    return layers;
}

Film film_of(int width, int height, std::size_t parts = 1) {
    return Film(width, height, layers_of_parts(parts), false, PassSplit::halves);
}

/// A pass whose light is a function of its index, row and column.
PassImage pass_of(int width, int height, std::uint32_t index) {
    PassImage image(width, height, 1);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image.at(std::size_t(0), x, y) = Rgb(float(index), float(x), float(y) + float(index % 2));
    return image;
}

/// A film of noisy passes, brighter noise on the left, that a filter has worked on.
Film filtered_film(int width, int height, std::size_t parts = 1) {
    Film film = film_of(width, height, parts);
    Rng rng(3);
    for (std::uint32_t i = 0; i < 8; ++i)
        for (std::size_t part = 0; part < parts; ++part) {
            PassImage image(width, height, 1);
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x)
                    image.at(std::size_t(0), x, y) =
                        Rgb(1.0f + (2 * x < width ? 0.9f : 0.1f) * (rng.next_float() - 0.5f));
            film.add_pass(image, part);
        }
    for (std::size_t part = 0; part < parts; ++part)
        film.set_halves(part, {film.half_mean(part, 0), film.half_mean(part, 1)});
    return film;
}

/// `film`: with its halves.
ControlPasses controls_after(const Film& film, std::uint32_t passes, std::size_t part = 0,
                             std::uint64_t seed = 5) {
    ControlPasses controls(film);
    controls.choose(film, seed);
    const PixelColumns& columns = controls.columns();
    for (std::uint32_t i = 0; i < passes; ++i)
        controls.add_pass(pass_of(columns.columns(), columns.rows(), i), part);
    return controls;
}

}  // namespace

TEST_CASE("Control pixels represent all pixels, and are more where errors are expected", "[film][controls]") {
    for (const Vec2i& size : {Vec2i(1, 1), Vec2i(7, 1), Vec2i(96, 64), Vec2i(320, 200), Vec2i(641, 399)}) {
        CAPTURE(size.x, size.y);
        const Film film = filtered_film(size.x, size.y);
        const std::vector<double> importance = importance_for_error(film);
        double all = 0.0;
        for (const double of_pixel : importance) {
            CHECK(of_pixel >= 0.25);
            all += of_pixel;
        }
        CHECK(all == Approx(double(film.pixels())));
        double left = 0.0, sum = 0.0, chosen = 0.0;
        constexpr int trials = 20;
        for (int seed = 0; seed < trials; ++seed) {
            const ControlPasses controls = controls_after(film, 4, 0, std::uint64_t(seed));
            const PixelColumns& columns = controls.columns();
            const ControlPixels known = controls.pixels(film);
            const std::vector<ControlPixel>& pixels = known.chosen;
            REQUIRE(int(pixels.size()) == columns.columns());
            REQUIRE(known.represented.size() == film.pixels());
            for (std::size_t i = 0; i < pixels.size(); ++i) {
                const Vec2i at = columns.at(int(i), 0);
                CHECK(pixels[i].pixel == std::size_t(at.y * size.x + at.x));
                CHECK(columns.at(int(i), columns.rows() - 1) == at);
                const double represented = double(known.represented[pixels[i].pixel]);
                CHECK(represented == Approx(all / double(pixels.size()) / importance[pixels[i].pixel]));
                left += 2 * at.x < size.x, sum += represented / trials, chosen += 1.0;
            }
            const double samples = double(columns.columns()) * double(columns.rows());
            if (film.pixels() > 1000)
                CHECK(samples == Approx(ControlPasses::share * double(film.pixels())).epsilon(0.05));
        }
        CHECK(sum == Approx(double(film.pixels())).epsilon(0.05));  // on average
        if (size.x > 7) CHECK(left > 0.7 * chosen);
    }
    CHECK_THROWS_AS(ControlPasses(Film(4, 4, layers_of_parts(1))), std::invalid_argument);
}

TEST_CASE("Control pixels are chosen once, by film and seed", "[film][controls]") {
    const Film film = filtered_film(96, 64);
    const auto places = [&](std::uint64_t seed) {
        std::vector<std::size_t> all;
        for (const ControlPixel& pixel : controls_after(film, 4, 0, seed).pixels(film).chosen)
            all.push_back(pixel.pixel);
        return all;
    };
    CHECK(places(1) == places(1));
    CHECK(places(1) != places(2));
    ControlPasses controls(film);
    CHECK((controls.can_choose() && controls.empty()));
    controls.choose(film, 1);
    CHECK_FALSE((controls.can_choose() || controls.empty()));
    CHECK_FALSE(ControlPasses().can_choose());
    CHECK(ControlPasses().pixels(film).chosen.empty());
}

TEST_CASE("Control pixels have the mean of rows and passes, and its variance by rows", "[film][controls]") {
    const Film film = filtered_film(96, 64);
    CHECK(controls_after(film, 0).pixels(film).chosen.empty());
    const ControlPasses controls = controls_after(film, 7);
    CHECK(controls.next_pass(0) == 7);
    const std::vector<ControlPixel> pixels = controls.pixels(film).chosen;
    const int rows = controls.columns().rows();
    // k numbers 0, 2, 4, ... have the variance k (k + 1) / 3.
    const auto of_every_second = [](int k) { return double(k) * (k + 1) / 3.0; };
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        for (const Rgb& mean : pixels[i].mean) {
            CHECK(mean.x == 3.0f);                                  // of the passes 0 to 6
            CHECK(mean.y == float(i));                              // the column
            CHECK(mean.z == Approx(0.5 * (rows - 1) + 3.0 / 7.0));  // rows, and three odd passes of seven
        }
        CHECK(pixels[i].variance[0].z == Approx(of_every_second((rows + 1) / 2) / rows));
        CHECK(pixels[i].variance[1].z == Approx(of_every_second(rows / 2) / rows));
        for (const Rgb& variance : pixels[i].variance) CHECK(Vec2(variance.x, variance.y) == Vec2(0.0f));
    }
    ControlPasses other = controls_after(film, 0);
    CHECK_THROWS_AS(other.add_pass(PassImage(2, 2, 1), 0), std::invalid_argument);
}

TEST_CASE("Both variances of control pixels are right on average", "[film][controls][statistics]") {
    const Film film = filtered_film(96, 64);
    ControlPasses controls(film);
    controls.choose(film, 1);
    const int width = controls.columns().columns(), rows = controls.columns().rows();
    Rng rng(7);
    constexpr double passes = 4.0;
    for (int pass = 0; pass < int(passes); ++pass) {
        PassImage image(width, rows, 1);
        for (Rgb& value : image.layer(0)) value = Rgb(rng.next_float());
        controls.add_pass(image, 0);
    }
    const double variance = 1.0 / 12.0 / passes / double(rows);
    const ControlPixels known = controls.pixels(film);
    const double n = double(known.chosen.size());
    std::array<double, 2> sum{}, squares{};
    double around_mean = 0.0;
    for (const ControlPixel& c : known.chosen) {
        for (const std::size_t odd : {0u, 1u})
            sum[odd] += double(c.variance[odd].x), squares[odd] += sqr(double(c.variance[odd].x));
        around_mean += sqr(double(c.mean[0].x) - 0.5);
    }
    for (const std::size_t odd : {0u, 1u}) {
        const double mean = sum[odd] / n, error = std::sqrt((squares[odd] / n - mean * mean) / n);
        CHECK(std::fabs(mean - variance) < 4.0 * error);
    }
    CHECK(std::fabs(around_mean / n - variance) < 4.0 * variance * std::sqrt(2.0 / n));
}

TEST_CASE("Parts without control passes have the light of the film's own", "[film][controls]") {
    const Film film = filtered_film(96, 64, 2);
    const std::vector<ControlPixel> pixels = controls_after(film, 8, 1).pixels(film).chosen;
    REQUIRE_FALSE(pixels.empty());
    const Film one_part = filtered_film(96, 64);
    const std::vector<ControlPixel> alone = controls_after(one_part, 8).pixels(one_part).chosen;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        CHECK(pixels[i].variance == alone[i].variance);
        for (const std::size_t half : {0u, 1u}) {
            const Film::PartHalf own = film.part_half(0, int(half));
            CHECK(pixels[i].mean[half].x == Approx(own.mean[pixels[i].pixel].x + alone[i].mean[half].x));
        }
    }
}

TEST_CASE("Control passes are read as they were written, and count what is not finite", "[film][controls]") {
    const Film film = filtered_film(96, 64), larger = film_of(300, 200);
    ControlPasses controls = controls_after(film, 5), read(film);
    const std::vector<std::byte> bytes = controls.serialize();
    read.deserialize(bytes);
    CHECK(read.serialize() == bytes);
    CHECK(read.next_pass(0) == 5);
    CHECK(read.columns().at(3, 0) == controls.columns().at(3, 0));
    CHECK(read.pixels(film).chosen[3].mean == controls.pixels(film).chosen[3].mean);
    CHECK_THROWS_AS(read.deserialize(std::span(bytes).first(bytes.size() - 1)), InputError);
    CHECK_THROWS_AS(read.deserialize(std::span(bytes).first(9)), InputError);
    std::vector<std::byte> outside = bytes;
    std::fill_n(outside.begin(), 4, std::byte(0xff));  // the index of the first pixel
    CHECK_THROWS_AS(read.deserialize(outside), InputError);
    CHECK_THROWS_AS(ControlPasses(larger).deserialize(bytes), InputError);
    CHECK_THROWS_AS(ControlPasses().deserialize(bytes), InputError);
    CHECK(read.serialize() == bytes);  // unchanged
    CHECK(controls.non_finite() == 0);
    PassImage bad = pass_of(controls.columns().columns(), controls.columns().rows(), 5);
    bad.at(std::size_t(0), 3, 1) = Rgb(infinity);
    controls.add_pass(bad, 0);
    CHECK(controls.non_finite() == 1);
}

TEST_CASE("A film's error has a shorter interval with control pixels", "[film][controls]") {
    Film film = filtered_film(96, 64);
    const std::vector<Rgb> flat(film.pixels(), Rgb(1.1f));
    film.set_halves(0, {flat, flat});  // a tenth too bright
    const std::vector<float> of_a_row(film.pixels(), 96.0f);
    ControlPixels controls{{}, of_a_row};
    for (std::size_t p = 0; p < film.pixels(); p += 96)
        controls.chosen.push_back({p, {Rgb(1.0f), Rgb(1.0f)}, {}});
    const auto without = film.error(), with = film.error(controls);
    REQUIRE(with);
    // Relative to the light, 1. The passes' mean has 9 % of noise here, that of 14 neighbours at the border
    // 2.5 %, a weight twice that; 64 of them, of which five share neighbours, err by 1.4 % together, and the
    // error by half of that: four standard deviations.
    CHECK(with->error == Approx(0.1).epsilon(4.0 * 0.007));
    CHECK(with->high - with->low < 0.4 * (without->high - without->low));
}
