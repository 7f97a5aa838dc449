// Fewer lights than samples, one light, and none: the other end of what selections are made for.
#include "lights/ray_lights/ray_light.h"
#include "lights/selection/stochastic/light_sampler.h"
#include "tests/lights/random_lights.h"
#include "tests/support/catch.h"
#include "tests/support/mean_of.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;
using lights::VplLeaves, lights::WeightedVpl;

namespace {

/// Sum of the weights of each light over many samples, by index; 1 where they are unbiased.
template <typename Sample>
std::vector<Mean> mean_weights(std::size_t lights, const Sample& sample) {
    std::vector<Mean> means;
    for (std::size_t k = 0; k < lights; ++k)
        means.push_back(mean_of(2000, [&] {
            double weight = 0.0;
            for (const WeightedVpl& l : sample())
                if (l.index == k) weight += double(l.weight);
            return weight;
        }));
    return means;
}

}  // namespace

TEST_CASE("with fewer lights than samples every light counts once in the mean",
          "[light_selection][sampling][sizes]") {
    const Materials& materials = all_materials();
    Rng rng(21), samples(22);
    for (const std::size_t count : {std::size_t(1), std::size_t(2), std::size_t(5)}) {
        auto set = random_lights(rng, materials, Lights::isotropic, count, 1.0f, 0.5f);
        for (std::size_t k = 0; k < count; ++k)  // all reach all receivers, and none is rarely sampled
            set.lights[k].depth = 1, set.lights[k].intensity = Rgb(float(1 + k));
        const RandomReceivers random(rng, materials, set.lights[0].position, false);
        const VplLeaves leaves(set);
        const lights::WideLightTree tree(leaves);
        const lights::ReceiverClusters receivers(lights::ReceiverBounds(random.tile), tree);
        lights::LightSampler sampler;
        const auto check = [&](const char* way, const auto& sample) {
            for (const Mean& m : mean_weights(count, sample)) {
                INFO(way << ", " << count << " lights: " << m.mean << " +- " << m.error);
                CHECK(std::fabs(m.mean - 1.0) < 4.0 * m.error + 1e-4);
            }
        };
        check("tree", [&] { return sampler.by_tree(tree, receivers, infinity, 16, samples); });
        check("cut", [&] { return sampler.by_cut(tree, receivers, infinity, 16, samples); });
        check("clusters", [&] { return sampler.from_clusters(tree, receivers, infinity, 8, 2, samples); });
    }
}

TEST_CASE("a subset of as many ray lights as there are is all of them", "[ray_lights][sizes]") {
    for (const std::size_t count : {std::size_t(1), std::size_t(3)}) {
        const std::vector<double> power = count == 1 ? std::vector{2.0} : std::vector{0.5, 0.75, 9.0};
        for (const std::size_t most : {count, count + 1, 16 * count}) {
            std::vector<WeightedVpl> chosen;
            lights::PowerSampling(power, most).choose_all(0.7f, chosen);
            REQUIRE(chosen.size() == count);
            for (std::size_t k = 0; k < count; ++k) {
                CHECK(chosen[k].index == k);
                CHECK(chosen[k].weight == 1.0f);
            }
        }
    }
}
