// Lights sampled by a hierarchy: probabilities add up to 1 whatever the scale and the depth, means are those
// of all lights, and sets that are no sets are dealt with.
#include "core/objects/error.h"
#include "lights/selection/stochastic/light_sampler.h"
#include "tests/lights/random_lights.h"
#include "tests/support/catch.h"
#include "tests/support/mean_of.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;
using lights::LightHierarchy, lights::WideLightTree, lights::ReceiverBounds, lights::ReceiverClusters;
using lights::VplLeaves, lights::WeightedVpl;

namespace {

lights::VirtualPointLight light_at(const Vec3& position, const Vec3& normal = Vec3(0.0f)) {
    lights::VirtualPointLight vpl;
    vpl.position = position, vpl.normal = vpl.shading_normal = normal;
    vpl.intensity = Rgb(0.5f, 1.0f, 2.0f);
    return vpl;
}

/// Sixteen diffuse receivers around a point, facing up.
struct Floor {
    std::shared_ptr<Bsdf> bsdf = make_diffuse();
    std::array<ScatteringVertex, 16> vertices;
    lights::ReceiverTile tile;

    explicit Floor(const Vec3& middle, float spacing) {
        for (std::size_t i = 0; i < 16; ++i) {
            ScatteringVertex& v = vertices[i];
            v.position = middle + spacing * Vec3(float(i % 4), float(i / 4), 0.0f);
            v.wo = {0, 0, 1}, v.bsdf = bsdf.get(), v.hit.position = v.position;
            tile.set(int(i), v, Rgb(1.0f), MediumState{}, Rng(i), 1000);
        }
    }
};

/// Sum of the probabilities of all lights, each of which is checked to be in [0, 1].
double check_probabilities(const WideLightTree& tree, const Floor& floor, float bound) {
    double sum = 0.0;
    const ReceiverClusters receivers(ReceiverBounds(floor.tile), tree);
    for (const double p : lights::probabilities(tree, receivers, bound, tree.size())) {
        if (!(p >= 0.0 && p <= 1.0)) FAIL_CHECK(p << " is no probability");
        sum += p;
    }
    return sum;
}

double light_of(const lights::VplSet& set, std::span<const WeightedVpl> sampled,
                const lights::ReceiverTile& tile) {
    double sum = 0.0;
    for (const WeightedVpl& light : sampled)
        for (const double v : sent(set, light.index, tile, infinity)) sum += double(light.weight) * v;
    return sum;
}

}  // namespace

TEST_CASE("Probabilities of all lights add up to 1, in any scale", "[light_selection][sampling]") {
    const Materials& materials = all_materials();
    Rng rng(3);
    for (const Lights kind : {Lights::plain, Lights::glossy, Lights::isotropic, Lights::lobes, Lights::all}) {
        auto set = random_lights(rng, materials, kind, 400, 2.0f, 3.0f);
        Floor floor(Vec3(0.1f, 0.0f, -0.7f), 0.05f);
        const auto probabilities_of = [&](const lights::VplSet& vpls, const Floor& x) {
            const VplLeaves leaves(vpls);
            const WideLightTree tree(leaves);
            REQUIRE(tree.size() == 400);
            const ReceiverClusters receivers(ReceiverBounds(x.tile), tree);
            return lights::probabilities(tree, receivers, infinity, 400);
        };
        const auto p = probabilities_of(set, floor);
        for (const float scale : {1000.0f, 0.001f}) {
            auto scaled = set;
            for (auto& vpl : scaled.lights) vpl.position *= scale;
            for (auto& detail : scaled.details) detail.vertex.position *= scale;
            const auto q = probabilities_of(scaled, Floor(scale * Vec3(0.1f, 0.0f, -0.7f), scale * 0.05f));
            double sum = 0.0, moved = 0.0;
            for (std::size_t j = 0; j < 400; ++j) sum += q[j], moved += std::fabs(p[j] - q[j]);
            CHECK(sum == Approx(1.0).epsilon(1e-12));
            CHECK(moved < 1e-3);
        }
    }
}

TEST_CASE("Lights at distances 2^-i, and a million in one index", "[light_selection][sampling]") {
    lights::VplSet powers, many;
    for (int i = 0; i < 120; ++i)
        powers.lights.push_back(light_at({std::ldexp(1.0f, -i), 0.0f, 1.0f}, {0, 0, -1}));
    many.lights.assign(std::size_t(1) << 20, light_at({0.3f, 0.2f, 1.0f}));
    const Floor floor(Vec3(0.0f), 1e-3f);
    lights::LightSampler sampler;
    Rng rng(1);
    for (const lights::VplSet* set : {&powers, &many}) {
        const VplLeaves leaves(*set);
        const WideLightTree tree(leaves);
        const ReceiverClusters receivers(ReceiverBounds(floor.tile), tree);
        CHECK(tree.size() == set->lights.size());
        CHECK(check_probabilities(tree, floor, infinity) == Approx(1.0).epsilon(1e-9));
        double all = 0.0;
        if (set == &many)
            for (const double v : sent(*set, 0, floor.tile, infinity)) all += v * double(set->lights.size());
        else
            for (std::size_t j = 0; j < set->lights.size(); ++j)
                for (const double v : sent(*set, j, floor.tile, infinity)) all += v;
        // These are nearly all alike, and so nearly any sample has the sum.
        for (const bool cut : {false, true}) {
            const auto sampled = cut ? sampler.by_cut(tree, receivers, infinity, 64, rng)
                                     : sampler.by_tree(tree, receivers, infinity, 64, rng);
            CHECK(light_of(*set, sampled, floor.tile) == Approx(all).epsilon(0.02));
        }
    }
    // A chain of clusters deeper than 32, where nothing but depth distinguishes lights: 2^-i from the
    // receiver.
    lights::VplSet deep;
    for (int i = 0; i < 120; ++i) deep.lights.push_back(light_at({0.0f, 0.0f, std::ldexp(1.0f, -i)}));
    const VplLeaves leaves(deep);
    const WideLightTree tree(leaves);
    const Floor below(Vec3(0.0f, 0.0f, -1.0f), 1e-6f);
    CHECK(check_probabilities(tree, below, infinity) == Approx(1.0).epsilon(1e-9));
    const Floor on_them(Vec3(0.0f), 0.0f);
    CHECK(check_probabilities(tree, on_them, infinity) == Approx(1.0).epsilon(1e-9));
}

TEST_CASE("Lights sampled by the tree and by a cut have the mean of all",
          "[light_selection][sampling][statistics]") {
    constexpr double critical = 3.3;  // two-sided, 0.1 %: of twenty tests one in fifty fails for no reason
    const Materials& materials = all_materials();
    Rng rng(4), samples(5);
    lights::LightSampler sampler;
    for (const Lights kind : {Lights::plain, Lights::glossy, Lights::isotropic, Lights::lobes, Lights::all}) {
        const auto set = random_lights(rng, materials, kind, 500, 1.0f, 0.5f);
        const VplLeaves leaves(set);
        const WideLightTree tree(leaves);
        const Floor floor(Vec3(0.5f, -1.0f, -1.5f), 0.1f);
        const ReceiverClusters receivers(ReceiverBounds(floor.tile), tree);
        double all = 0.0;
        for (std::size_t j = 0; j < set.lights.size(); ++j)
            for (const double v : sent(set, j, floor.tile, infinity)) all += v;
        REQUIRE(all > 0.0);
        for (const bool cut : {false, true}) {
            const auto sample = [&] {
                const auto sampled = cut ? sampler.by_cut(tree, receivers, infinity, 64, samples)
                                         : sampler.by_tree(tree, receivers, infinity, 64, samples);
                return light_of(set, sampled, floor.tile);
            };
            const Mean found = mean_of(6000, sample);
            INFO("kind " << int(kind) << ", cut " << cut << ": " << found.mean << " +- " << found.error
                         << " of " << all);
            CHECK(std::fabs(found.mean - all) < critical * found.error);
            // Errors of weights that are planted are found.
            const double power = critical * found.error / all;
            // Clusters of all kinds say little of each light: there errors are larger.
            const double planted = kind == Lights::all ? 0.5 : 0.1;
            CHECK(power < 0.7 * planted);
            for (const double wrong : {1.0 - planted, 1.0 + planted})
                CHECK(std::fabs(wrong * found.mean - all) > critical * found.error);
        }
    }
}

TEST_CASE("Learned probabilities have the mean of all, whatever was learned",
          "[light_selection][sampling][statistics]") {
    constexpr double critical = 3.5;  // two-sided, 0.05 %
    const Materials& materials = all_materials();
    Rng rng(14), samples(15);
    const auto set = random_lights(rng, materials, Lights::plain, 800, 1.0f, 0.5f);
    const VplLeaves leaves(set);
    const WideLightTree tree(leaves);
    const Floor floor(Vec3(0.5f, -1.0f, -1.5f), 0.1f);
    const ReceiverClusters receivers(ReceiverBounds(floor.tile), tree);
    // Half of the lights are hidden: what arrives, and what these would send.
    std::vector<double> light(set.lights.size(), 0.0), other(set.lights.size(), 0.0);
    double all = 0.0;
    for (std::size_t j = 0; j < set.lights.size(); ++j) {
        double sum = 0.0;
        for (const double v : sent(set, j, floor.tile, infinity)) sum += v;
        if (set.lights[j].position.x < 0.0f)
            other[j] = sum;
        else
            light[j] = sum, all += sum;
    }
    for (const std::string way : {"tree", "cut", "clusters"}) {
        std::array<double, 3> errors{};
        for (const int taught : {0, 1, 2}) {  // nothing, what is so, that all others are hidden
            lights::LightSampler sampler;
            lights::LearnedImportance learned;
            sampler.learn_into(&learned);
            const auto sampled = [&] {
                return way == "tree"  ? sampler.by_tree(tree, receivers, infinity, 32, samples)
                       : way == "cut" ? sampler.by_cut(tree, receivers, infinity, 32, samples)
                                      : sampler.from_clusters(tree, receivers, infinity, 16, 2, samples);
            };
            for (int k = 0; taught > 0 && k < 150; ++k) {
                const auto lights = sampled();
                for (std::size_t i = 0; i < lights.size(); ++i)
                    sampler.learn(i,
                                  double(lights[i].weight) * (taught == 1 ? light : other)[lights[i].index]);
            }
            const auto sample = [&] {
                double sum = 0.0;
                for (const WeightedVpl& l : sampled()) sum += double(l.weight) * light[l.index];
                return sum;
            };
            const Mean found = mean_of(6000, sample);
            INFO(way << ", taught " << taught << ": " << found.mean << " +- " << found.error << " of "
                     << all);
            errors[std::size_t(taught)] = found.error;
            CHECK(std::fabs(found.mean - all) < critical * found.error);
            CHECK(found.error < 0.02 * all);
            for (const double wrong : {0.85, 1.15})
                CHECK(std::fabs(wrong * found.mean - all) > critical * found.error);
        }
        CHECK(errors[1] < 0.85 * errors[0]);
        CHECK(errors[2] > errors[0]);
    }
}

TEST_CASE("More lights, less noise", "[light_selection][sampling][statistics]") {
    const Materials& materials = all_materials();
    Rng rng(6);
    lights::LightSampler sampler;
    const auto set = random_lights(rng, materials, Lights::plain, 5000, 2.0f, 3.0f);
    const VplLeaves leaves(set);
    const WideLightTree tree(leaves);
    const Floor floor(Vec3(0.5f, -1.0f, -1.5f), 0.1f);
    const ReceiverClusters receivers(ReceiverBounds(floor.tile), tree);
    for (const bool cut : {false, true}) {
        const auto error = [&](std::uint32_t n) {
            return mean_of(1000,
                           [&] {
                               return light_of(set,
                                               cut ? sampler.by_cut(tree, receivers, infinity, n, rng)
                                                   : sampler.by_tree(tree, receivers, infinity, n, rng),
                                               floor.tile);
                           })
                .error;
        };
        CHECK(error(64) < 0.5 * error(4));  // independent samples: 0.25
    }
}

TEST_CASE("Every node holds what is below it, and one array holds all", "[light_selection]") {
    const Materials& materials = all_materials();
    Rng rng(8);
    const auto set = random_lights(rng, materials, Lights::all, 1000, 2.0f, 3.0f);
    const VplLeaves leaves(set);
    const LightHierarchy tree(leaves);
    CHECK(tree.memory_bytes() <= LightHierarchy::bytes_a_light * set.lights.size());
    std::vector<int> seen(set.lights.size());
    std::size_t wrong = 0;
    const auto visit = [&](const auto& self, const lights::LightCluster& c) -> void {
        const lights::LightNode node = tree.node(c);
        for (const double fraction : {0.0, 0.3, 0.999999}) {
            const std::uint32_t index = tree.index_at(c, fraction);
            wrong += index < c.first || index >= c.first + c.count;
        }
        Rgb energy(0.0f);
        for (const std::uint32_t light : tree.lights(c)) {
            const auto leaf = leaves.leaf(light);
            energy += leaf.energy;
            wrong += !glm::all(glm::lessThanEqual(node.lower, leaf.lower)) ||
                     !glm::all(glm::greaterThanEqual(node.upper, leaf.upper)) || leaf.peak > node.peak ||
                     leaf.min_depth < node.min_depth;
        }
        for (int k = 0; k < 3; ++k) wrong += std::fabs(energy[k] - node.energy[k]) > 1e-3f * energy[k];
        if (c.single()) {
            ++seen[tree.light_at(c.first)];
            return;
        }
        self(self, tree.left(c)), self(self, tree.right(c));
    };
    visit(visit, tree.root());
    CHECK(wrong == 0);
    for (const int count : seen) CHECK(count == 1);
}

TEST_CASE("Every child of a node that is sampled from holds what is below it", "[light_selection]") {
    const Materials& materials = all_materials();
    Rng rng(9);
    for (const Lights kind : {Lights::plain, Lights::lobes, Lights::all}) {
        const auto set = random_lights(rng, materials, kind, 3000, 2.0f, 0.3f);
        const VplLeaves leaves(set);
        const WideLightTree tree(leaves);
        CHECK(tree.memory_bytes() <= WideLightTree::bytes_a_light * set.lights.size());
        std::vector<int> seen(set.lights.size());
        std::size_t outside = 0, wide = 0;
        const auto holds = [&](const lights::LightChildren& parts, int i, const lights::LightNode& leaf) {
            const Vec3 lower(parts.lower_x[i], parts.lower_y[i], parts.lower_z[i]);
            const Vec3 upper(parts.upper_x[i], parts.upper_y[i], parts.upper_z[i]);
            const Vec3 axis(parts.axis_x[i], parts.axis_y[i], parts.axis_z[i]);
            const float rounding = 1e-6f * glm::length(upper - lower) + 1e-6f;
            bool held = glm::all(glm::lessThanEqual(lower, leaf.lower + rounding)) &&
                        glm::all(glm::greaterThanEqual(upper, leaf.upper - rounding)) &&
                        parts.min_depth[i] <= float(leaf.min_depth);
            const bool surface =
                leaf.kind == lights::LightKind::surface || leaf.kind == lights::LightKind::glossy;
            held &= surface || parts.has_cosine[i] == 0.0f;
            // A cone is requested where there is a cosine or a lobe.
            if (parts.has_cosine[i] == 1.0f || (parts.any_lobe && parts.g_high[i] > 0.0f))
                held &= glm::dot(axis, leaf.axis()) >= parts.cos_angle[i] - 1e-6f;
            if (parts.any_lobe && parts.g_high[i] > 0.0f)
                held &= parts.g_low[i] <= float(leaf.g_low) / 65535.0f + 1e-6f &&
                        parts.g_high[i] >= float(leaf.g_high) / 65535.0f - 1e-6f;
            return held;
        };
        const auto visit = [&](const auto& self,
                               const lights::WideLightNode& node) -> std::vector<std::uint32_t> {
            const lights::LightChildren parts(node);
            std::vector<std::uint32_t> all;
            double energy = 0.0;
            for (int i = 0; i < node.count; ++i) {
                const auto below = node.leaf(i) ? std::vector<std::uint32_t>{node.child[i]}
                                                : self(self, tree.node(node.child[i]));
                for (const std::uint32_t light : below) outside += !holds(parts, i, leaves.leaf(light));
                if (node.leaf(i)) {
                    ++seen[node.child[i]];
                    wide += parts.cos_angle[i] < 0.9995f && parts.has_cosine[i] == 1.0f;  // 1.8 degrees
                }
                energy += double(node.energy_fraction[i]);
                all.insert(all.end(), below.begin(), below.end());
            }
            if (std::fabs(energy - 1.0) > 1e-4) FAIL_CHECK(energy << " is not all energy");
            return all;
        };
        CHECK(visit(visit, tree.root()).size() == set.lights.size());
        CHECK(outside == 0);
        CHECK(wide == 0);
        for (const int count : seen) CHECK(count == 1);
    }
}

TEST_CASE("ChildProbabilities of a cluster's energy are places in proportion to energy",
          "[light_selection]") {
    const Materials& materials = all_materials();
    Rng rng(11);
    const auto set = random_lights(rng, materials, Lights::plain, 300, 2.0f, 3.0f);
    const VplLeaves leaves(set);
    const LightHierarchy tree(leaves);
    constexpr int steps = 20000;
    for (lights::LightCluster c = tree.root(); !c.single();
         c = c.count % 2 == 0 ? tree.left(c) : tree.right(c)) {
        std::vector<double> count(c.count);
        double all = 0.0, worst = 0.0;
        for (int k = 0; k < steps; ++k)
            count[tree.index_at(c, (double(k) + 0.5) / double(steps)) - c.first] += 1.0;
        for (std::uint32_t i = 0; i < c.count; ++i) all += double(tree.weight_at(c.first + i));
        CHECK(std::fabs(all / double(tree.weight(c)) - 1.0) < 1e-5);
        for (std::uint32_t i = 0; i < c.count; ++i)
            worst = std::max(worst,
                             std::fabs(count[i] - double(steps) * double(tree.weight_at(c.first + i)) / all));
        CHECK(worst < 1.5);  // even steps: each light has what it is due, but for one at either end
    }
}

TEST_CASE("No lights, one light, dark ones, and more than memory holds", "[light_selection][extremes]") {
    const Floor floor(Vec3(0.0f), 0.1f);
    const auto receivers = [&](const WideLightTree& tree) {
        return ReceiverClusters(ReceiverBounds(floor.tile), tree);
    };
    lights::LightSampler sampler;
    Rng rng(1);
    lights::VplSet set;
    const VplLeaves leaves(set);
    CHECK(LightHierarchy(leaves).empty());
    const WideLightTree none(leaves);
    CHECK(none.empty());
    CHECK(sampler.by_tree(none, receivers(none), 1.0f, 4, rng).empty());
    CHECK(sampler.by_cut(none, receivers(none), 1.0f, 4, rng).empty());

    set.lights.push_back(light_at({0.0f, 0.0f, 1.0f}));
    const WideLightTree one(leaves);
    REQUIRE(one.size() == 1);
    const auto sampled = sampler.by_tree(one, receivers(one), 1.0f, 4, rng);
    REQUIRE(sampled.size() == 1);
    CHECK(sampled[0].weight == 1.0f);
    CHECK(sampler.by_cut(one, receivers(one), 1.0f, 4, rng).size() == 1);

    set.lights.assign(100, light_at({0.0f, 0.0f, 1.0f}));
    for (auto& vpl : set.lights) vpl.intensity = Rgb(0.0f);
    CHECK(LightHierarchy(leaves).empty());
    set.lights[70].intensity = Rgb(1e-30f);
    CHECK(LightHierarchy(leaves).size() == 1);
    CHECK(WideLightTree(leaves).size() == 1);
    set.lights[70].intensity = Rgb(infinity);
    CHECK_THROWS_AS(LightHierarchy(leaves), InputError);
    CHECK_THROWS_AS(WideLightTree(leaves), InputError);
    set.lights[70].intensity = Rgb(-1.0f);
    CHECK_THROWS_AS(LightHierarchy(leaves), InputError);
    CHECK_THROWS_AS(WideLightTree(leaves), InputError);

    // A receiver on a light: finite weights.
    set.lights[70] = light_at(floor.tile.position(3));
    set.lights[71] = light_at({0.0f, 0.0f, 1.0f});
    const WideLightTree two(leaves);
    for (const WeightedVpl& light : sampler.by_tree(two, receivers(two), infinity, 64, rng))
        CHECK(std::isfinite(light.weight));

    /// 2^24 lights that are never made: requested nothing but their number.
    struct Many final : lights::LightLeaves {
        std::size_t size() const override { return std::size_t(1) << 24; }
        lights::LightNode leaf(std::uint32_t) const override { return {}; }
    };
    CHECK_THROWS_AS(LightHierarchy(Many(), std::size_t(1) << 30), InputError);
    CHECK_THROWS_AS(WideLightTree(Many(), std::size_t(900) << 20), InputError);
}
