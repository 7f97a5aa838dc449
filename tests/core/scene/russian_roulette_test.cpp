// Russian roulette of paths that lose nothing keeps the light of those that end seldom.
#include "core/scene/russian_roulette.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/math/random.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

constexpr double vertices = 500.0;  ///< of a path in the mean: each ends it with one over that
constexpr int paths = 100, renders = 40;

/// Means over 100 paths that lose nothing, 40 times: of the sum of the weights of a path's vertices, which is
/// `vertices` without roulette.
std::vector<double> means_of_weights(const LongPath& path) {
    Rng rng(7);
    std::vector<double> means(renders, 0.0);
    for (double& mean : means)
        for (int i = 0; i < paths; ++i) {
            double weight = 1.0;
            for (int depth = 1;; ++depth) {
                mean += weight / paths;
                if (rng.next_float() < 1.0 / vertices) break;
                const float q = survival_chance(1.0f, depth, path);
                if (rng.next_float() >= q) break;
                weight /= q;
            }
        }
    std::sort(means.begin(), means.end());
    return means;
}

}  // namespace

TEST_CASE("Light paths keep the light of rooms where they end after 500 vertices", "[russian_roulette]") {
    const std::vector<double> means = means_of_weights(long_light_path);
    double sum = 0.0, squares = 0.0;
    for (const double mean : means) sum += mean / renders, squares += mean * mean / renders;
    const double error = std::sqrt((squares - sum * sum) / renders);
    CHECK(error < 0.03 * vertices);
    CHECK(std::abs(sum - vertices) < 4.5 * error);
    // The median: most renders show it, whatever rare paths bring to the mean.
    CHECK(means[renders / 2] > 0.9 * vertices);
    CHECK(means_of_weights({500, 0.95f})[renders / 2] < 0.75 * vertices);
}
