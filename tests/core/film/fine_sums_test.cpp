// Sums over quarters of pixels against their definition, in films that are put together in any way.
#include "core/film/fine_sums.h"

#include <limits>

#include "core/film/film.h"
#include "core/math/random.h"
#include "core/objects/error.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

constexpr int width = 9, height = 70;  // more rows than two bands

/// Samples fall anywhere up to two pixels from their pixel's middle.
Vec2 place_of(std::uint32_t pass, int x, int y) {
    const auto at = [&](int axis) {
        return 4.0f * float(hash_keys(pass, x, y, axis) % 1000) / 1000.0f - 2.0f;
    };
    return Vec2(float(x) + 0.5f, float(y) + 0.5f) + Vec2(at(0), at(1));
}
Rgb light_of(std::uint32_t pass, int x, int y) {
    const float v = float(hash_keys(pass, x, y, 7) % 1024) / 16.0f;
    return {v, 2.0f * v, 0.0f};
}

PassImage image_of(std::uint32_t pass) {
    PassImage image(width, height, 2);
    image.keep_places();
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image.at(0, x, y) = Rgb(1.0f), image.at(1, x, y) = light_of(pass, x, y),
                           image.place(x, y, place_of(pass, x, y));
    return image;
}

std::vector<Layer> fine_layers() {
    Layer fine{"fine", "", false, true};
    fine.fine = true;
    return {{"other", ""}, fine};
}

Film film_of(std::uint32_t first, std::uint32_t end, PassSplit split = PassSplit::whole) {
    Film film(width, height, fine_layers(), false, split);
    film.begin_at(0, first);
    for (std::uint32_t pass = first; pass < end; ++pass) film.add_pass(image_of(pass));
    return film;
}

}  // namespace

TEST_CASE("a quarter of a pixel has the mean of the samples that fell into it", "[film][fine]") {
    constexpr std::uint32_t passes = 5;
    std::vector<Vec3d> sums(4 * width * height, Vec3d(0.0));
    std::vector<double> counts(sums.size(), 0.0);
    for (std::uint32_t pass = 0; pass < passes; ++pass)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const Vec2 at = 2.0f * place_of(pass, x, y);
                if (at.x < 0.0f || at.y < 0.0f || at.x >= 2.0f * width || at.y >= 2.0f * height) continue;
                const std::size_t q = std::size_t(at.y) * 2 * width + std::size_t(at.x);
                sums[q] += Vec3d(light_of(pass, x, y)), counts[q] += 1.0;
            }
    const Film film = film_of(0, passes);
    CHECK(film.fine_sums(0).empty());
    const std::vector<Rgb> mean = film.fine_sums(1).mean();
    int without = 0;
    for (std::size_t q = 0; q < mean.size(); ++q) {
        CHECK(film.fine_sums(1).counts()[q] == float(counts[q]));
        if (counts[q] > 0.0) {
            CHECK(mean[q] == Rgb(sums[q] / counts[q]));
            continue;
        }
        ++without;  // the mean of its pixel's others
        const std::size_t row = q / (2 * width) & ~std::size_t(1), column = q % (2 * width) & ~std::size_t(1);
        Vec3d all(0.0);
        double samples = 0.0;
        for (const std::size_t other : {row * 2 * width + column, row * 2 * width + column + 1,
                                        (row + 1) * 2 * width + column, (row + 1) * 2 * width + column + 1})
            all += sums[other], samples += counts[other];
        CHECK(mean[q] == (samples > 0.0 ? Rgb(all / samples) : Rgb(0.0f)));
    }
    CHECK(without > 10);
}

TEST_CASE("films of quarters add up, and are read again, to the same bits", "[film][fine]") {
    const Film all = film_of(0, 7);
    Film together = film_of(0, 3);
    together.add(film_of(3, 4));
    Film rest = film_of(4, 6);
    rest.add(film_of(6, 7));
    together.add(rest);
    CHECK(together.fine_sums(1).mean() == all.fine_sums(1).mean());
    CHECK(together.serialize() == all.serialize());
    Film read(width, height, fine_layers());
    read.deserialize(all.serialize());
    CHECK(read.fine_sums(1).mean() == all.fine_sums(1).mean());
    // Films without quarters do not continue it.
    auto coarse = fine_layers();
    coarse[1].fine = false;
    CHECK_THROWS_AS(Film(width, height, fine_layers()).add(Film(width, height, coarse)),
                    std::invalid_argument);
    CHECK_THROWS_AS(Film(width, height, coarse).deserialize(all.serialize()), InputError);
    // Halves show the error of what is made of each; there are no quarters of them.
    CHECK(film_of(0, 4, PassSplit::halves).fine_sums(1).empty());
}

TEST_CASE("what is not finite, has no place or falls far away is in no quarter", "[film][fine]") {
    PassImage image(4, 40, 1);
    image.keep_places();
    const float bad = std::numeric_limits<float>::quiet_NaN();
    image.at(0, 1, 1) = Rgb(bad), image.place(1, 1, {1.2f, 1.2f});
    image.at(0, 2, 2) = Rgb(3.0f), image.place(2, 2, {2.7f, 2.7f + float(PassImage::max_reach)});
    image.at(0, 3, 3) = Rgb(5.0f), image.place(3, 3, {3.7f, 3.2f});
    image.at(0, 0, 0) = Rgb(7.0f), image.place(0, 0, {-0.1f, 0.5f});
    FineSums sums(4, 40);
    CHECK_FALSE(sums.has_light());
    sums.add(image, 0);
    CHECK(sums.has_light());
    float samples = 0.0f;
    for (const float count : sums.counts()) samples += count;
    CHECK(samples == 1.0f);
    CHECK(sums.mean()[6 * 8 + 7] == Rgb(5.0f));
    image.clear();  // places, too
    sums.add(image, 0);
    CHECK(sums.counts()[6 * 8 + 7] == 1.0f);
    CHECK_THROWS_AS(FineSums(5, 40).add(image, 0), std::invalid_argument);
    FineSums none;
    none.add(image, 0);
    CHECK(none.empty());
}
