// Means over boxes of an octahedral map: against sums over the texels, and over the cuts of the map.

#include "tools/directional_maps/summed_area_octahedral.h"

#include <array>

#include "core/math/random.h"
#include "core/math/warp.h"
#include "core/objects/error.h"
#include "tests/support/catch.h"

using namespace mote::core;
using namespace mote::lights;
using namespace mote::tools;

namespace {

Rgb colour(const Vec3& d) {
    return {1.0f + d.x + 0.5f * d.y * d.z, 2.0f - d.z, std::exp(d.x - d.y + 0.3f * d.z)};
}

std::vector<Rgb> texels_of(OctahedralMap map, const Vec3& flip = Vec3(1.0f)) {
    std::vector<Rgb> result;
    for (int t = 0; t < map.texels(); ++t) result.push_back(colour(flip * map.direction(t)));
    return result;
}

double difference(const SummedAreaOctahedral::Mean& a, const SummedAreaOctahedral::Mean& b) {
    return double(glm::length(a.value - b.value)) + double(std::fabs(a.solid_angle - b.solid_angle));
}

}  // namespace

TEST_CASE("A box within the square is the weighted mean of its texels", "[summed_area]") {
    const OctahedralMap map{16};
    const std::vector<Rgb> texels = texels_of(map);
    const SummedAreaOctahedral sums(map, texels);
    // Around the corner between texels (9, 5) and (10, 6), three texels each way; within one octant the solid
    // angle of a texel is nearly its area over the cubed distance.
    Vec3d sum(0.0);
    double weights = 0.0;
    for (int j = 3; j < 9; ++j)
        for (int i = 7; i < 13; ++i) {
            const Vec3 d = map.direction(j * 16 + i);
            const double inverse_distance = double(std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z));
            const double weight = 4.0 / 256.0 * std::pow(inverse_distance, 3.0);
            sum += weight * Vec3d(texels[std::size_t(j * 16 + i)]);
            weights += weight;
        }
    const Vec3 centre = octahedral_unproject(2.0f / 16.0f * Vec2(10, 6) - 1.0f);
    const auto mean = sums.mean(centre, 3.0f);
    CHECK(glm::length(Vec3d(mean.value) - sum / weights) < 1e-5);
    CHECK(mean.solid_angle == Approx(weights).epsilon(1e-5));
}

TEST_CASE("Boxes over a cut equal their mirror images where nothing is cut", "[summed_area]") {
    // The layout below the horizon is the layout above, mirrored octant by octant: around the plane x = 0 (or
    // y = 0) a box below, over the cut, must give what the flipped map gives above.
    for (const int size : {32, 50}) {  // even, so that the mirror image of a texel is a texel
        const OctahedralMap map{size};
        const Vec3 down(1, 1, -1);
        const SummedAreaOctahedral sums(map, texels_of(map)), flipped(map, texels_of(map, down));
        Rng rng(9);
        double worst = 0.0, planted = 0.0;
        for (int i = 0; i < 2000; ++i) {
            const float across = 0.05f * (rng.next_float() - 0.5f), along = 0.45f + 0.1f * rng.next_float();
            Vec3 d(across, (i & 2) != 0 ? along : -along, along - 1.0f);
            if ((i & 1) != 0) std::swap(d.x, d.y);
            const float reach = 0.5f + 2.5f * rng.next_float();  // stays within the two octants
            worst = std::max(worst, difference(sums.mean(d, reach), flipped.mean(d * down, reach)));
            // Planted: the map above without the flip, as if the folded part came from elsewhere.
            planted = std::max(planted, difference(sums.mean(d, reach), sums.mean(d * down, reach)));
        }
        CHECK(worst < 2e-5);
        CHECK(planted > 0.1);
    }
}

TEST_CASE("Means stay near the value of small boxes, and never leave the range", "[summed_area]") {
    const OctahedralMap map{64};
    const std::vector<Rgb> texels = texels_of(map);
    const SummedAreaOctahedral sums(map, texels), ones(map, std::vector<Rgb>(texels.size(), Rgb(3.0f)));
    Rng rng(10);
    double worst_small = 0.0, worst_constant = 0.0;
    for (int i = 0; i < 20000; ++i) {
        Vec3 d = square_to_sphere({rng.next_float(), rng.next_float()});
        if (i % 2 == 0) d[i / 2 % 3] *= 0.02f;
        worst_small =
            std::max(worst_small, double(glm::length(sums.mean(d, 1.0f).value - colour(glm::normalize(d)))));
        worst_constant =
            std::max(worst_constant, std::fabs(double(ones.mean(d, 40.0f * rng.next_float()).value.x) - 3.0));
    }
    // A box of two texels lies within two texels' diagonals, 2 * sqrt(2) * 2 / 64 * sqrt(3), of the
    // direction, and the derivative of the colour stays below 4: half of that for a mean.
    CHECK(worst_small < 0.5 * 4.0 * 0.16);
    CHECK(worst_constant < 1e-5);
    // The widest box covers all directions but counts some twice: all sums stay means.
    CHECK(sums.mean({0, 0, 1}, 1e9f).solid_angle == Approx(4.0 * 3.14159265358979).epsilon(1e-3));
}

TEST_CASE("Summed areas refuse the wrong number of texels and keep NaN", "[summed_area]") {
    CHECK_THROWS_AS(SummedAreaOctahedral(OctahedralMap{3}, std::vector<Rgb>(8)), InputError);
    const SummedAreaOctahedral one(OctahedralMap{1}, std::vector<Rgb>(1, Rgb(2.0f)));
    CHECK(one.mean({0.3f, -0.4f, -0.5f}, 0.5f).value.x == Approx(2.0f));
    CHECK(std::isnan(one.mean(Vec3(std::numeric_limits<float>::quiet_NaN()), 0.5f).value.x));
}
