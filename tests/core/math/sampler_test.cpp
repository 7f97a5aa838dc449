// Samplers: keyed by what they must be keyed by, stratified as promised, independent where promised.
#include "core/math/sampler.h"

#include <cmath>
#include <set>
#include <vector>

#include "tests/support/catch.h"

using namespace mote::core;

namespace {

/// One (0,m,2)-net: every elementary interval of area 2^-m holds exactly one of the 2^m points.
bool is_net(const std::vector<Vec2>& points, int m) {
    for (int a = 0; a <= m; ++a) {
        std::set<std::pair<int, int>> cells;
        for (const Vec2& p : points) cells.emplace(int(p.x * float(1 << a)), int(p.y * float(1 << (m - a))));
        if (cells.size() != points.size()) return false;
    }
    return true;
}

Vec2 point(SamplerKind kind, std::uint64_t seed, std::uint32_t pass, std::uint64_t item, int dimension) {
    Sampler sampler(kind, seed, pass, item);
    for (int i = 0; i < dimension; ++i) sampler.next_2d();
    return sampler.next_2d();
}

}  // namespace

TEST_CASE("passes of one pixel form (0,2)-nets in every pair of dimensions", "[math][sampler]") {
    for (int dimension = 0; dimension < 6; ++dimension)
        for (std::uint64_t item = 0; item < 5; ++item)
            for (const int m : {4, 6, 8})
                // Every aligned block of 2^m passes, as a (0,2)-sequence has it.
                for (std::uint32_t block = 0; block < 3; ++block) {
                    std::vector<Vec2> points;
                    for (std::uint32_t i = 0; i < (1u << m); ++i)
                        points.push_back(point(SamplerKind::sobol, 7, (block << m) + i, item, dimension));
                    CHECK(is_net(points, m));
                }
    std::vector<Vec2> independent;
    for (std::uint32_t i = 0; i < 256; ++i)
        independent.push_back(point(SamplerKind::independent, 7, i, 0, 0));
    CHECK_FALSE(is_net(independent, 8));
}

TEST_CASE("dimensions, pixels and seeds are not correlated", "[math][sampler]") {
    // Correlation of 1e5 pairs of uniform numbers: sigma = 1/sqrt(n) of the unit-variance product.
    const int n = 100000;
    const double limit = 4.5 / std::sqrt(double(n));
    for (const SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol}) {
        double between_dimensions = 0, between_pixels = 0, between_passes = 0, between_seeds = 0, within = 0;
        for (int i = 0; i < n; ++i) {
            const auto item = std::uint64_t(i);
            const Vec2 a = point(kind, 1, 0, item, 0), b = point(kind, 1, 0, item, 1);
            const Vec2 c = point(kind, 1, 0, item + 1000000, 0), d = point(kind, 2, 0, item, 0);
            const Vec2 e = point(kind, 1, 2, item, 0);
            between_dimensions += 12.0 * (double(a.x) - 0.5) * (double(b.x) - 0.5);
            between_pixels += 12.0 * (double(a.x) - 0.5) * (double(c.x) - 0.5);
            between_seeds += 12.0 * (double(a.x) - 0.5) * (double(d.x) - 0.5);
            within += 12.0 * (double(a.x) - 0.5) * (double(a.y) - 0.5);
            between_passes += 12.0 * (double(a.y) - 0.5) * (double(e.x) - 0.5);
        }
        CHECK(std::fabs(between_dimensions / n) < limit);
        CHECK(std::fabs(between_pixels / n) < limit);
        CHECK(std::fabs(between_seeds / n) < limit);
        CHECK(std::fabs(within / n) < limit);
        CHECK(std::fabs(between_passes / n) < limit);
    }
}

TEST_CASE("halves of the passes are nets of their own, and independent of each other",
          "[math][sampler][halves][statistics]") {
    // Correlation of the errors of the means over even and over odd passes: of 4096 pixels within 4.5
    // standard deviations of 0 in halves; of one sequence the second half fills the gaps of the first.
    const auto correlation = [](SamplerKind kind) {
        constexpr int pixels = 4096, passes = 8;
        double product = 0.0, squares = 0.0;
        for (std::uint64_t item = 0; item < pixels; ++item) {
            double error[2] = {0.0, 0.0};
            for (std::uint32_t pass = 0; pass < passes; ++pass)
                error[pass % 2] += double(point(kind, 7, pass, item, 0).x) - 0.5;
            product += error[0] * error[1], squares += error[0] * error[0];
        }
        return product / squares;
    };
    CHECK(std::fabs(correlation(SamplerKind::sobol_halves)) < 4.5 / 64.0);
    CHECK(std::fabs(correlation(SamplerKind::independent)) < 4.5 / 64.0);
    CHECK(correlation(SamplerKind::sobol) < -0.2);
    CHECK(std::fabs(correlation(SamplerKind::sobol_groups)) < 4.5 / 64.0);
    for (const std::uint32_t half : {0u, 1u}) {
        std::vector<Vec2> points;
        for (std::uint32_t i = 0; i < 64; ++i)
            points.push_back(point(SamplerKind::sobol_halves, 7, 2 * i + half, 3, 1));
        CHECK(is_net(points, 6));
        for (std::uint32_t i = 0; i < 64; ++i)
            points[i] = point(SamplerKind::sobol_groups, 7, pass_group_count * i + half, 3, 1);
        CHECK(is_net(points, 6));
    }
}

TEST_CASE("padded pairs of one pixel's passes are not correlated", "[math][sampler]") {
    // Within one pixel the four numbers of two pairs, over 2^12 passes and many pixels: were the shuffles of
    // two pairs alike, their product would stay large.
    double sum = 0.0;
    const int pixels = 64, passes = 1024;
    for (int item = 0; item < pixels; ++item) {
        double product = 0.0;
        for (std::uint32_t pass = 0; pass < std::uint32_t(passes); ++pass)
            product += 12.0 * (double(point(SamplerKind::sobol, 3, pass, std::uint64_t(item), 0).x) - 0.5) *
                       (double(point(SamplerKind::sobol, 3, pass, std::uint64_t(item), 1).x) - 0.5);
        sum += std::fabs(product / passes);
    }
    CHECK(sum / pixels < 4.0 / std::sqrt(double(passes)));
}

TEST_CASE("numbers lie in [0, 1) and repeat from their keys", "[math][sampler]") {
    for (const SamplerKind kind : {SamplerKind::independent, SamplerKind::sobol})
        for (std::uint32_t pass : {0u, 1u, 12345u, 0xffffffffu})
            for (std::uint64_t item = 0; item < 2000; ++item) {
                const Vec2 p = point(kind, 9, pass, item, 3);
                CHECK((p.x >= 0.0f && p.x < 1.0f && p.y >= 0.0f && p.y < 1.0f));
                CHECK(p == point(kind, 9, pass, item, 3));
            }
    CHECK(to_unit_float(0xffffffffu) < 1.0f);
    // The generator of a path depends on the pass and on what was sampled before.
    Sampler a(SamplerKind::sobol, 1, 0, 0), b(SamplerKind::sobol, 1, 1, 0), c(SamplerKind::sobol, 1, 0, 0, 1);
    const auto first = a.make_rng().next_u32();
    CHECK(first != b.make_rng().next_u32());
    CHECK(first != c.make_rng().next_u32());
    a.next_2d();
    CHECK(first != a.make_rng().next_u32());
}

TEST_CASE("the generator is uniform and its streams differ", "[math][random]") {
    // 64 bins, 64000 samples of each of 50 neighbouring keys together: chi square by its normal limit.
    std::vector<int> bins(64, 0);
    for (std::uint64_t key = 0; key < 50; ++key) {
        Rng rng(key);
        for (int i = 0; i < 1280; ++i) ++bins[std::size_t(rng.next_float() * 64.0f)];
    }
    double statistic = 0.0;
    for (const int b : bins) statistic += (b - 1000.0) * (b - 1000.0) / 1000.0;
    CHECK(std::fabs(statistic - 63.0) < 4.5 * std::sqrt(2.0 * 63.0));
    std::set<std::uint32_t> firsts;
    for (std::uint64_t key = 0; key < 10000; ++key) firsts.insert(Rng(key).next_u32());
    CHECK(firsts.size() > 9990);
}
