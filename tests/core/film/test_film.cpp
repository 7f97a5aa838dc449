// The film: exact sums, films that are added up, noise, non-finite pixels, serialisation.
#include <cmath>
#include <limits>

#include "core/film/film.h"
#include "core/film/film_image.h"
#include "core/math/random.h"
#include "core/objects/error.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

const std::vector<Layer> layers = {{"direct", "", false}, {"Albedo", "", true}, {"indirect", "", false}};

PassImage random_pass(int width, int height, std::uint32_t index) {
    PassImage image(width, height, layers.size());
    Rng rng(hash_keys(77, index));
    for (std::size_t l = 0; l < layers.size(); ++l)
        for (Rgb& p : image.layer(l))
            for (int c = 0; c < 3; ++c) p[c] = std::exp(6.0f * rng.next_float() - 3.0f);
    return image;
}

Film film_of(int width, int height, std::uint32_t passes, bool all_squares = false) {
    Film film(width, height, layers, all_squares);
    for (std::uint32_t i = 0; i < passes; ++i) film.add_pass(random_pass(width, height, i));
    return film;
}

Film film_of_range(int width, int height, std::uint32_t first, std::uint32_t end, bool all_squares = false) {
    Film film(width, height, layers, all_squares);
    film.begin_at(0, first);
    for (std::uint32_t i = first; i < end; ++i) film.add_pass(random_pass(width, height, i));
    return film;
}

}  // namespace

TEST_CASE("A film's means are those of exact sums", "[film]") {
    const int w = 7, h = 5;
    for (const std::uint32_t passes : {1u, 15u, 16u, 17u, 40u}) {
        const Film film = film_of(w, h, passes);
        REQUIRE(film.pass_count() == passes);
        std::vector<PassImage> images;
        for (std::uint32_t i = 0; i < passes; ++i) images.push_back(random_pass(w, h, i));
        for (const std::size_t layer : {0u, 1u, 2u}) {
            const auto mean = film.mean(layer);
            for (const std::size_t pixel : {0u, 13u, 34u})
                for (int c = 0; c < 3; ++c) {
                    long double sum = 0.0L;  // 64 bits: floats of 2^-4 to 2^5 add up without rounding
                    for (const PassImage& image : images) sum += image.layer(layer)[pixel][c];
                    CHECK(mean[pixel][c] == float(double(sum) / passes));
                }
        }
    }
}

TEST_CASE("The noise of a film does not depend on the unit of light", "[film][noise]") {
    const int w = 24, h = 16;
    const auto noise = [&](float unit) {
        Film film(w, h, layers);
        for (std::uint32_t i = 0; i < 8; ++i) {
            PassImage image = random_pass(w, h, i);
            for (std::size_t l = 0; l < layers.size(); ++l)
                for (Rgb& p : image.layer(l)) p *= unit;
            film.add_pass(image);
        }
        return film.gain_and_noise();
    };
    const Film::GainAndNoise usual = noise(1.0f);
    REQUIRE(usual.noise > 0.1);
    // Squares beyond single precision at both ends: 1e60 and 1e-60.
    for (const float unit : {0x1p100f, 0x1p-100f, 0x1p40f, 0x1p-50f}) {
        CHECK(noise(unit).noise == Approx(usual.noise).epsilon(1e-5));
        CHECK(noise(unit).gain == Approx(usual.gain).epsilon(1e-5));
    }
}

TEST_CASE("Films of passes that follow each other add up to the film of all, in any grouping",
          "[film][ranges]") {
    const int w = 5, h = 4;
    constexpr std::uint32_t n = 23;
    const auto whole = film_of(w, h, n, true);
    const auto part = [&](std::uint32_t first, std::uint32_t end) {
        return film_of_range(w, h, first, end, true);
    };
    const auto bits = whole.serialize();
    for (std::uint32_t a = 0; a <= n; ++a)
        for (const std::uint32_t b : {a, (a + n) / 2, n}) {
            Film left = part(0, a), right = part(a, b);
            right.add(part(b, n));  // the right ones first
            left.add(right);
            REQUIRE(left.serialize() == bits);
        }
    Film one_by_one(w, h, layers, true);
    for (std::uint32_t i = 0; i < n; ++i) one_by_one.add(part(i, i + 1));
    CHECK(one_by_one.serialize() == bits);
    CHECK(one_by_one.noise() == whole.noise());
    CHECK(one_by_one.beauty() == whole.beauty());

    Film film = part(0, 6);
    CHECK_THROWS_AS(film.add(part(7, 9)), std::invalid_argument);                 // a gap
    CHECK_THROWS_AS(film.add(part(5, 9)), std::invalid_argument);                 // an overlap
    CHECK_THROWS_AS(film.add(film_of_range(w, h, 6, 9)), std::invalid_argument);  // other squares
    CHECK_THROWS_AS(film.begin_at(0, 3), std::logic_error);
    CHECK(film.serialize() == part(0, 6).serialize());
    // A film that begins later is a film: it can be written, read again, continued, and has a noise.
    Film late = part(6, 11), copy(w, h, layers, true);
    copy.deserialize(late.serialize());
    CHECK(copy.first_pass() == 6);
    for (Film* f : {&late, &copy}) f->add_pass(random_pass(w, h, 11));
    CHECK(copy.serialize() == late.serialize());
    CHECK(std::isfinite(late.noise()));
    film.add(copy);
    CHECK(film.serialize() == part(0, 12).serialize());
}

TEST_CASE("The beauty is the float sum of the layers that are not auxiliary", "[film]") {
    const Film film = film_of(6, 6, 21);
    const auto beauty = film.beauty(), direct = film.mean(0), indirect = film.mean(2);
    for (std::size_t p = 0; p < film.pixels(); ++p) CHECK(beauty[p] == direct[p] + indirect[p]);
}

TEST_CASE("The variance agrees with the two-pass formula", "[film]") {
    const int w = 4, h = 3;
    constexpr std::uint32_t n = 37;
    const Film film = film_of(w, h, n, true);
    const auto variance = film.beauty_variance_of_mean(), of_layer = film.layer_variance_of_mean(1);
    for (std::size_t p = 0; p < film.pixels(); ++p) {
        std::vector<double> red, albedo;
        for (std::uint32_t i = 0; i < n; ++i) {
            const PassImage image = random_pass(w, h, i);
            const auto a = image.layer(0)[p], b = image.layer(2)[p];
            red.push_back(double(a.x) + b.x);
            albedo.push_back(image.layer(1)[p].z);
        }
        const auto moments = [](const std::vector<double>& v) {
            double mean = 0.0, spread = 0.0;
            for (const double x : v) mean += x / n;
            for (const double x : v) spread += (x - mean) * (x - mean);
            return std::pair(mean, spread / n / (n - 1.0));
        };
        CHECK(variance[p].x == Approx(moments(red).second).epsilon(1e-6));
        CHECK(of_layer[p].z == Approx(moments(albedo).second).epsilon(1e-6));
    }

    CHECK(film_of(w, h, 1).beauty_variance_of_mean()[0] == Rgb(0.0f));
    CHECK(std::isinf(film_of(w, h, 1).noise()));
    CHECK_THROWS_AS(film_of(w, h, 2).layer_variance_of_mean(0), std::logic_error);
    Film black(w, h, layers);
    black.add_pass(PassImage(w, h, 3)), black.add_pass(PassImage(w, h, 3));
    CHECK(black.noise() == 0.0);
}

TEST_CASE("Means where another layer is one, and variances of single layers", "[film]") {
    const std::vector<Layer> kept = {{"direct", ""}, {"hit", "", true}, {"Depth", "", true, true, "hit"}};
    const int w = 3, h = 2;
    constexpr std::uint32_t n = 19;
    Film film(w, h, kept);
    double sum = 0.0, squares = 0.0;
    int hits = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
        PassImage image(w, h, 3);
        for (int p = 0; p < w * h; ++p) {
            const bool hit = p < 4 && (i * 7u + unsigned(p)) % 3u != 0u;  // the last pixels are never hit
            image.layer(0)[std::size_t(p)] = Rgb(1.0f);
            image.layer(1)[std::size_t(p)] = Rgb(hit ? 1.0f : 0.0f);
            image.layer(2)[std::size_t(p)] = Rgb(hit ? 10.0f + float(i) : 0.0f);
            if (p != 2 || !hit) continue;
            ++hits, sum += 10.0 + i, squares += (10.0 + i) * (10.0 + i);
        }
        film.add_pass(image);
    }
    REQUIRE((hits > 5 && hits < int(n)));
    const double mean = sum / hits;
    CHECK(film.mean(2)[2].y == Approx(mean).epsilon(1e-6));
    CHECK(film.layer_variance_of_mean(2)[2].y ==
          Approx((squares / hits - mean * mean) / (hits - 1)).epsilon(1e-6));
    CHECK(film.mean(2)[5] == Rgb(0.0f));
    CHECK(film.layer_variance_of_mean(2)[5] == Rgb(0.0f));
    CHECK(film.has_squares(2));
    CHECK_FALSE(film.has_squares(0));
    CHECK_THROWS_AS(film.layer_variance_of_mean(0), std::logic_error);
    // The squares go into checkpoints.
    Film copy(w, h, kept);
    copy.deserialize(film.serialize());
    CHECK(copy.layer_variance_of_mean(2) == film.layer_variance_of_mean(2));
    CHECK(copy.serialize() == film.serialize());

    CHECK_THROWS_AS(Film(w, h, {{"a", ""}, {"a", ""}}), std::invalid_argument);
    CHECK_THROWS_AS(Film(w, h, {{"a", "", true, false, "b"}}), std::invalid_argument);
}

TEST_CASE("Pixels that are not finite are counted and add zero", "[film]") {
    Film film(3, 2, layers);
    for (std::uint32_t i = 0; i < 4; ++i) {
        PassImage image(3, 2, 3);
        for (std::size_t l = 0; l < 3; ++l)
            for (Rgb& p : image.layer(l)) p = Rgb(1.0f);
        if (i == 1) image.at(0, 2, 1).y = std::numeric_limits<float>::quiet_NaN();
        if (i == 1) image.at(2, 2, 1).x = infinity;  // the same pixel: counted once
        if (i == 3) image.at(1, 0, 0).z = -infinity;
        film.add_pass(image);
    }
    CHECK(film.non_finite() == 2);
    CHECK(film.mean(0)[5] == Rgb(0.75f));
    CHECK(film.mean(2)[5] == Rgb(0.75f));
    CHECK(film.mean(0)[0] == Rgb(0.75f));
    CHECK(film.beauty()[1] == Rgb(2.0f));
}

TEST_CASE("A post-process replaces a mean but not the statistics", "[film]") {
    Film film = film_of(4, 4, 9);
    const auto variance = film.beauty_variance_of_mean();
    const auto bytes = film.serialize();
    std::vector<Rgb> values(film.pixels());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = Rgb(0.1f * float(i));
    film.set_mean(2, values);
    CHECK(film.mean(2) == values);
    CHECK(film.beauty()[5] == film.mean(0)[5] + values[5]);
    CHECK(film.beauty_variance_of_mean() == variance);
    CHECK(film.serialize() == bytes);
    film.add_pass(random_pass(4, 4, 9));
    CHECK(film.mean(2) == film_of(4, 4, 10).mean(2));
    CHECK_THROWS_AS(film.set_mean(0, std::span<const Rgb>(values).first(3)), std::invalid_argument);
}

TEST_CASE("A film survives serialisation to the same bits", "[film][checkpoint]") {
    for (const bool all_squares : {false, true}) {
        const Film whole = film_of(5, 4, 43, all_squares);
        Film resumed(5, 4, layers, all_squares);
        resumed.deserialize(film_of(5, 4, 21, all_squares).serialize());
        REQUIRE(resumed.pass_count() == 21);
        for (std::uint32_t i = 21; i < 43; ++i) resumed.add_pass(random_pass(5, 4, i));
        CHECK(resumed.serialize() == whole.serialize());
        CHECK(resumed.beauty() == whole.beauty());
    }
}

TEST_CASE("Bytes that are damaged or of another film are refused, and leave the film as it was",
          "[film][checkpoint]") {
    const auto good = film_of(3, 3, 5).serialize();
    Film film = film_of(3, 3, 2);
    const auto before = film.serialize();
    for (std::size_t i = 0; i < good.size(); ++i) {
        auto bytes = good;
        bytes[i] ^= std::byte(1u << (i % 8));
        REQUIRE_THROWS_AS(film.deserialize(bytes), InputError);
    }
    for (std::size_t size = 0; size < good.size(); ++size)
        REQUIRE_THROWS_AS(film.deserialize(std::span(good).first(size)), InputError);
    auto longer = good;
    longer.push_back(std::byte(0));
    CHECK_THROWS_AS(film.deserialize(longer), InputError);
    CHECK_THROWS_AS(film.deserialize(film_of(3, 4, 5).serialize()), InputError);
    CHECK_THROWS_AS(film.deserialize(film_of(3, 3, 5, true).serialize()), InputError);
    CHECK(film.serialize() == before);
}

TEST_CASE("Channels of a film's picture bear the names that other programs use", "[film][exr]") {
    Film film(2, 1, {{"direct", "", false}, {"Depth", "", true}, {"N", "", true}, {"Albedo", "", true}});
    film.add_pass(PassImage(2, 1, 4));
    CHECK(film_image(film).names == std::vector<std::string>{"R", "G", "B", "direct.R", "direct.G",
                                                             "direct.B", "Depth.Z", "N.X", "N.Y", "N.Z",
                                                             "Albedo.R", "Albedo.G", "Albedo.B"});
    film.add_pass(PassImage(2, 1, 4));
    CHECK(film_image(film).find("Variance.G") != nullptr);
}

TEST_CASE("A picture states no variance while a part of it has a single pass", "[film][exr]") {
    Film film(2, 1, {{"direct", ""}, {"indirect", "", false, false, "", {}, 1}});
    for (int i = 0; i < 3; ++i) film.add_pass(PassImage(2, 1, 1), 0);
    film.add_pass(PassImage(2, 1, 1), 1);
    CHECK(film_image(film).find("Variance.G") == nullptr);
    film.add_pass(PassImage(2, 1, 1), 1);
    CHECK(film_image(film).find("Variance.G") != nullptr);
}

TEST_CASE("parts of a film have passes, variances and work of their own", "[film]") {
    const std::vector<Layer> in_parts{{"a", ""}, {"b", "", false, false, "", {}, 1}, {"c", ""}};
    const auto pass = [](std::size_t count, float value) {
        PassImage image(2, 2, count);
        for (std::size_t i = 0; i < count; ++i)
            for (Rgb& pixel : image.layer(i)) pixel = Rgb(value * float(i + 1));
        return image;
    };
    Film film(2, 2, in_parts);
    REQUIRE(film.parts() == 2);
    CHECK(std::vector<std::size_t>(film.layers_of(0).begin(), film.layers_of(0).end()) ==
          std::vector<std::size_t>{0, 2});
    for (int i = 0; i < 40; ++i) film.add_pass(pass(2, float(i % 2)), 0, 3.0);  // a: 0, 1; c: 0, 2
    CHECK_FALSE(film.has_passes(1));
    CHECK(std::isinf(film.noise()));
    for (int i = 0; i < 5; ++i) film.add_pass(pass(1, float(i)), 1, 0.5);  // b: 0 ... 4
    CHECK(film.has_passes(5));
    CHECK(film.pass_count() == 45);
    CHECK(film.work(0) == 120.0);
    CHECK(film.work(1) == 2.5);
    CHECK(film.mean(0)[0].x == 0.5f);
    CHECK(film.mean(1)[0].x == 2.0f);
    CHECK(film.mean(2)[0].x == 1.0f);
    CHECK(film.beauty()[3].y == 3.5f);
    // a + c is 0 or 3: variance 9/4 of one pass; b: that of 0 ... 4 is 2.
    CHECK(film.part_variance_of_mean(0)[0].x == Approx(2.25 / 39.0));
    CHECK(film.part_variance_of_mean(1)[0].x == Approx(2.0 / 4.0));
    CHECK(film.beauty_variance_of_mean()[0].x == Approx(2.25 / 39.0 + 0.5));
    CHECK(std::isfinite(film.noise()));

    Film other(2, 2, in_parts);
    other.deserialize(film.serialize());
    CHECK((other.serialize() == film.serialize()));
    CHECK(other.pass_count(1) == 5);
    CHECK(other.work(0) == 120.0);
    // Passes added after deserialization give the same bits.
    for (Film* f : {&film, &other}) f->add_pass(pass(1, 7.0f), 1), f->add_pass(pass(2, 5.0f), 0);
    CHECK((other.serialize() == film.serialize()));
    CHECK_THROWS_AS(film.add_pass(pass(2, 0.0f), 1), std::invalid_argument);
    Film one_part(2, 2, {{"a", ""}, {"b", ""}, {"c", ""}});
    CHECK_THROWS_AS(one_part.deserialize(film.serialize()), InputError);
    CHECK_THROWS_AS(Film(2, 2, {{"a", "", false, false, "", {}, 1}}), std::invalid_argument);
}

TEST_CASE("what a post-process leaves of a layer's variance is in the noise, in place of the layer's own",
          "[film][noise]") {
    // Two independent layers of one part, with variances of 4 and 1 a pass, mean 10 each.
    constexpr int w = 64, h = 64;
    const std::vector<Layer> layers{{"a", "", false, true}, {"b", ""}};
    Film film(w, h, layers);
    Rng rng(5);
    for (int i = 0; i < 16; ++i) {
        PassImage image(w, h, 2);
        for (Rgb& v : image.layer(0)) v = Rgb(10.0f + 2.0f * std::sqrt(12.0f) * (rng.next_float() - 0.5f));
        for (Rgb& v : image.layer(1)) v = Rgb(10.0f + std::sqrt(12.0f) * (rng.next_float() - 0.5f));
        film.add_pass(image);
    }
    const auto bytes = film.serialize();
    const double before = film.noise(), gain = film.gain_and_noise().gain;
    const std::vector<Rgb> mean = film.mean(0);
    const auto with = [&](float fraction) {
        std::vector<float> left;
        for (const Rgb& v : film.layer_variance_of_mean(0)) left.push_back(fraction * v.x);
        film.set_mean(0, mean, left);
        return std::pow(film.noise() / before, 2.0);
    };
    // Sums over 4096 pixels of variances from 16 passes: known to sqrt(2 / (15 * 4096)) = 0.6 % each, and
    // their covariance to as much; four standard errors of the difference of three of them.
    const double within = 4.0 * std::sqrt(3.0) * std::sqrt(2.0 / (15.0 * 4096.0));
    CHECK(std::fabs(with(1.0f) - 1.0) < 1e-3);
    CHECK(std::fabs(with(0.25f) - (1.0 + 0.25 * 4.0) / 5.0) < within);
    CHECK(std::fabs(with(0.0f) - 1.0 / 5.0) < within);
    CHECK(film.gain_and_noise().gain == Approx(gain).epsilon(1e-3));  // of the passes
    CHECK((film.serialize() == bytes));
    film.set_mean(0, mean);  // without a word about its variance: that of the passes
    CHECK(film.noise() == before);
    film.set_mean(0, mean, std::vector<float>(film.pixels(), 0.0f));
    const Film::Replacements taken = film.exchange_replaced();
    CHECK(film.noise() == before);
    film.exchange_replaced(taken);
    CHECK(film.noise() < 0.6 * before);
    CHECK_THROWS_AS(film.set_mean(1, mean, std::vector<float>(film.pixels())), std::invalid_argument);
    CHECK_THROWS_AS(film.set_mean(0, mean, std::vector<float>(3)), std::invalid_argument);
}

TEST_CASE("The halves of a film are the passes of even and of odd index", "[film][halves]") {
    const int w = 6, h = 4;
    std::vector<Layer> with = layers;
    with[2].squares = true;
    const auto filled = [&](std::uint32_t first, std::uint32_t end) {
        Film film(w, h, with, false, PassSplit::halves);
        film.begin_at(0, first);
        for (std::uint32_t i = first; i < end; ++i) film.add_pass(random_pass(w, h, i));
        return film;
    };
    const Film film = filled(0, 7);
    CHECK(film.half_passes(0, 0) == 4);
    CHECK(film.half_passes(0, 1) == 3);
    for (const int half : {0, 1}) {
        Film alone(w, h, with);
        for (std::uint32_t i = std::uint32_t(half); i < 7; i += 2) alone.add_pass(random_pass(w, h, i));
        const auto mean = film.half_mean(2, half), expected = alone.mean(2);
        const auto variance = film.half_variance_of_mean(2, half),
                   expected_variance = alone.layer_variance_of_mean(2);
        const auto beauty = film.half_beauty(half).passes, expected_beauty = alone.beauty();
        for (std::size_t p = 0; p < film.pixels(); ++p)
            for (int c = 0; c < 3; ++c) {
                CHECK(mean[p][c] == Approx(expected[p][c]).epsilon(1e-6));
                CHECK(variance[p][c] == Approx(expected_variance[p][c]).epsilon(1e-5));
                CHECK(beauty[p][c] == Approx(expected_beauty[p][c]).epsilon(1e-6));
            }
    }
    Film sum = filled(0, 3);
    sum.add(filled(3, 7));
    Film read(w, h, with, false, PassSplit::halves);
    read.deserialize(film.serialize());
    for (const Film* other : {&sum, &read}) {
        CHECK(other->serialize() == film.serialize());
        for (const int half : {0, 1}) CHECK(other->half_mean(2, half) == film.half_mean(2, half));
    }
    CHECK_THROWS_AS(film.half_mean(0, 0), std::logic_error);  // without squares
}

TEST_CASE("The error of a film includes what a filter of its halves has done", "[film][halves]") {
    const int w = 40, h = 40;
    std::vector<Layer> with = layers;
    with[2].squares = true;
    Film film(w, h, with, false, PassSplit::halves);
    const auto unfiltered = [&] { return film.error(); };
    for (std::uint32_t i = 0; i < 3; ++i) film.add_pass(random_pass(w, h, i));
    CHECK(!unfiltered());  // a half of one pass
    for (std::uint32_t i = 3; i < 16; ++i) film.add_pass(random_pass(w, h, i));
    REQUIRE(unfiltered());
    CHECK(unfiltered()->error == Approx(film.noise()).epsilon(0.1));
    CHECK(unfiltered()->low < unfiltered()->error);
    CHECK(unfiltered()->high > unfiltered()->error);

    const std::vector<Rgb> half(film.pixels(), Rgb(3.0f));
    const std::vector<Rgb> before = film.mean(2);
    film.set_mean(2, half);
    CHECK(!film.error());  // worked on the mean of all passes: nothing is known
    film.set_halves(2, {half, half});
    CHECK(film.mean(2) == half);
    REQUIRE(film.error());
    const double noisy = film.error()->high;
    film.set_halves(2, {film.half_mean(2, 0), film.half_mean(2, 1)});
    CHECK(film.error()->error == Approx(unfiltered()->error).epsilon(1e-4));
    for (std::size_t p = 0; p < film.pixels(); ++p)
        CHECK(film.mean(2)[p].x == Approx(before[p].x).epsilon(1e-5));
    CHECK(std::isfinite(noisy));
    CHECK_THROWS_AS(film.set_halves(0, {half, half}), std::logic_error);
    CHECK_THROWS_AS(film.set_halves(2, {half, {}}), std::invalid_argument);
}

TEST_CASE("The groups of a film are every eighth pass", "[film][groups]") {
    const int w = 12, h = 10;
    std::vector<Layer> with = layers;
    with[1].squares = with[1].missing = true;
    const auto filled = [&](std::uint32_t first, std::uint32_t end) {
        Film film(w, h, with, false, PassSplit::groups);
        film.begin_at(0, first);
        for (std::uint32_t i = first; i < end; ++i) film.add_pass(random_pass(w, h, i));
        return film;
    };
    CHECK_FALSE(filled(0, 7).error());  // a group without a pass
    const Film film = filled(0, 19);
    const auto error = film.error();
    REQUIRE(error);
    CHECK(error->low < error->error);
    CHECK(error->high > error->error);
    // The layer of missing light is ten times as bright as in the other film: its error is larger.
    Film brighter(w, h, with, false, PassSplit::groups);
    for (std::uint32_t i = 0; i < 19; ++i) {
        PassImage image = random_pass(w, h, i);
        for (Rgb& p : image.layer(1)) p *= 10.0f;
        brighter.add_pass(image);
    }
    CHECK(brighter.error()->error > 1.5 * error->error);
    for (const int half : {0, 1}) {
        Film alone(w, h, with);
        for (std::uint32_t i = std::uint32_t(half); i < 19; i += 2) alone.add_pass(random_pass(w, h, i));
        CHECK(film.half_mean(1, half)[5][0] == Approx(alone.mean(1)[5][0]).epsilon(1e-6));
    }
    Film sum = filled(0, 5);
    sum.add(filled(5, 19));
    Film read(w, h, with, false, PassSplit::groups);
    read.deserialize(film.serialize());
    for (const Film* other : {&sum, &read}) {
        CHECK(other->serialize() == film.serialize());
        CHECK(other->error()->high == error->high);
    }
    CHECK_THROWS_AS(Film(w, h, with, false, PassSplit::halves).add(film), std::invalid_argument);
    with[2].part = 1;
    CHECK_THROWS_AS(Film(w, h, with, false, PassSplit::groups), std::invalid_argument);
}
