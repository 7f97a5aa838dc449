// Blocks of passes against their definition, whatever passes they begin with and however they are put
// together.
#include "core/film/pass_blocks.h"

#include <cmath>

#include "core/film/film.h"
#include "core/math/random.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

constexpr std::size_t pixels = 3;

float value(std::uint32_t pass, std::size_t pixel) {
    return float(hash_keys(pass, pixel, 9) % 1000) / 16.0f;  // sums of some hundred are exact
}

PassBlocks blocks_of(std::uint32_t first, std::uint32_t end, PassBlocks::Keeps keeps) {
    PassBlocks blocks(pixels, keeps);
    for (std::uint32_t pass = first; pass < end; ++pass) {
        PassBlocks::Next next(blocks, pass);
        for (std::size_t p = 0; p < pixels; ++p) next.put(p, value(pass, p));
        next.finish();
    }
    return blocks;
}

double squared_difference(std::uint32_t first, std::uint32_t level, std::size_t pixel) {
    double difference = 0.0;
    for (std::uint32_t i = 0; i < 1u << level; ++i)
        difference += (i < 1u << (level - 1) ? 1.0 : -1.0) * double(value(first + i, pixel));
    return difference * difference;
}

/// The first of the largest aligned blocks of passes.
std::pair<std::uint32_t, std::uint32_t> largest_block(std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t level = 20;; --level)
        for (std::uint64_t begin = 0; begin + (1u << level) <= end; begin += 1u << level)
            if (begin >= first) return {std::uint32_t(begin), level};
}

}  // namespace

TEST_CASE("Differences of blocks are those of the sums over their halves", "[film][blocks]") {
    const std::vector<double> weights{1.0, 0.5, 2.0};
    for (const std::uint32_t first : {0u, 3u, 4u, 6u})
        for (std::uint32_t end = first + 1; end < first + 40; ++end) {
            const PassBlocks blocks = blocks_of(first, end, PassBlocks::Keeps::all);
            const auto d = blocks.differences(weights, 2.0, {first, end - first});
            for (std::size_t k = 0; k < d.size(); ++k) {
                const std::uint32_t length = 2u << k;
                double sum = 0.0, count = 0.0;
                for (std::uint32_t b = (first + length - 1) / length * length; b + length <= end;
                     b += length, ++count)
                    for (std::size_t p = 0; p < pixels; ++p)
                        sum += weights[p] * squared_difference(b, std::uint32_t(k) + 1, p);
                REQUIRE(d[k] == Approx(sum / count / 4.0 / std::exp2(double(k) + 2.0)));
            }
        }
}

TEST_CASE("Of the largest block the difference of its halves is kept", "[film][blocks]") {
    for (const std::uint32_t first : {0u, 1u, 3u, 4u, 6u})
        for (std::uint32_t end = first + 1; end < first + 40; ++end) {
            const PassBlocks whole = blocks_of(first, end, PassBlocks::Keeps::largest);
            const auto [begin, level] = largest_block(first, end);
            REQUIRE(whole.largest_level() == level);
            REQUIRE(whole.largest_difference().size() == (level > 0 ? pixels : 0));
            for (std::size_t p = 0; level > 0 && p < pixels; ++p)
                REQUIRE(double(whole.largest_difference()[p]) == squared_difference(begin, level, p));

            for (std::uint32_t middle = first; middle <= end; ++middle) {
                PassBlocks joined = blocks_of(first, middle, PassBlocks::Keeps::largest);
                const PassBlocks more = blocks_of(middle, end, PassBlocks::Keeps::largest);
                CHECK(joined.add(more, {first, middle - first}).count == end - first);
                std::vector<std::vector<float>> of_whole, of_joined;
                const auto into = [](auto& all) {
                    return [&all](const auto& numbers) {
                        if constexpr (std::is_same_v<std::decay_t<decltype(numbers)>, std::vector<float>>)
                            all.push_back(numbers);
                    };
                };
                PassBlocks::for_each_array(whole, into(of_whole));
                PassBlocks::for_each_array(joined, into(of_joined));
                INFO(first << " " << middle << " " << end);
                REQUIRE(of_joined == of_whole);
            }
        }
}

TEST_CASE("A film keeps the blocks of layers that require squares, in one channel of a pixel",
          "[film][blocks]") {
    const std::vector<Layer> layers{{"a", "", false, true}, {"b", ""}, {"N", "", true, true}};
    Film film(3, 2, layers), halves(3, 2, layers, false, PassSplit::halves);
    std::vector<Rgb> sums[2];
    for (auto& sum : sums) sum.assign(6, Rgb(0.0f));
    for (std::uint32_t pass = 0; pass < 5; ++pass) {
        PassImage image(3, 2, 3);
        for (std::size_t p = 0; p < 6; ++p) {
            image.layer(0)[p] = Rgb(value(pass, p), value(pass, p + 10), value(pass, p + 20));
            if (pass < 4) sums[pass / 2][p] += image.layer(0)[p];
        }
        film.add_pass(image), halves.add_pass(image);
    }
    const Film::BlockDifference block = film.block_difference(0);
    REQUIRE(block.level == 2);
    int channels[3] = {0, 0, 0};
    for (std::size_t p = 0; p < 6; ++p) {
        const int c = film.block_channel(p);
        ++channels[c];
        CHECK(block.squares[p] == Approx(std::pow(double(sums[0][p][c] - sums[1][p][c]), 2.0)));
    }
    CHECK((channels[0] == 2 && channels[1] == 2 && channels[2] == 2));
    CHECK((film.block_difference(1).squares.empty() && film.block_difference(2).squares.empty()));
    CHECK(halves.block_difference(0).squares.empty());

    Film copy(3, 2, layers);
    copy.deserialize(film.serialize());
    CHECK(copy.serialize() == film.serialize());
    CHECK(std::ranges::equal(copy.block_difference(0).squares, block.squares));
}
