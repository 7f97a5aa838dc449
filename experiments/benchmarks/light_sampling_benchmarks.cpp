// A light sampled by the tree over a million virtual point lights, for a tile of sixteen receivers and for
// one: seconds of a light, and how often they are those of seven loads that depend on each other, three lines
// each, from as much memory as the tree has: a tree of eight parts a cluster is at least seven deep.
#include <benchmark/benchmark.h>

#include "core/materials/bsdfs.h"
#include "experiments/benchmarks/turns.h"
#include "lights/selection/hierarchy/vertex_bounds.h"
#include "lights/selection/stochastic/light_sampler.h"

namespace mote::benchmarks {
namespace {

using namespace core;

/// Diffuse lights on the inner walls of a box, and tiles of receivers on its floor.
class Walls {
  public:
    explicit Walls(std::size_t lights) {
        Rng rng(1);
        for (std::size_t j = 0; j < lights; ++j) {
            lights::VirtualPointLight vpl;
            const std::uint32_t side = rng.next_u32() % 6;
            const auto axis = int(side / 2);
            vpl.position = Vec3(rng.next_float(), rng.next_float(), rng.next_float());
            vpl.position[axis] = float(side % 2);
            vpl.normal[axis] = side % 2 ? -1.0f : 1.0f;
            vpl.shading_normal = vpl.normal, vpl.intensity = Rgb(rng.next_float());
            vpls_.lights.push_back(vpl);
        }
        tree_.emplace(lights::VplLeaves(vpls_));
        for (int t = 0; t < 64; ++t) {
            const Vec3 corner(0.95f * rng.next_float(), 0.95f * rng.next_float(), 0.0f);
            lights::ReceiverTile tile;
            for (int i = 0; i < 16; ++i) {
                ScatteringVertex v;
                v.position = corner + 0.005f * Vec3(float(i % 4), float(i / 4), 0.0f);
                v.wo = {0, 0, 1}, v.bsdf = bsdf_.get(), v.hit.position = v.position;
                tile.set(i, v, Rgb(1.0f), MediumState{}, Rng(0), 1000);
            }
            tiles_.emplace_back(tile);
            for (int i = 1; i < 16; ++i) tile.max_vpl_depth[i] = 0;
            single_.emplace_back(tile);
        }
    }
    const lights::WideLightTree& tree() const { return *tree_; }
    /// All receivers of a tile, or the first.
    const lights::ReceiverBounds& receivers(std::size_t i, bool one) const {
        return one ? single_[i % single_.size()] : tiles_[i % tiles_.size()];
    }

  private:
    std::shared_ptr<Bsdf> bsdf_ = make_diffuse();
    lights::VplSet vpls_;
    std::optional<lights::WideLightTree> tree_;
    std::vector<lights::ReceiverBounds> tiles_, single_;
};

/// Nodes of the tree's size that name each other in one random circle.
class Chain {
  public:
    explicit Chain(std::size_t bytes) : nodes_(bytes / sizeof(Node)) {
        Rng rng(3);
        std::vector<std::uint32_t> order(nodes_.size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = std::uint32_t(i);
        for (std::size_t i = order.size() - 1; i > 0; --i)
            std::swap(order[i], order[rng.next_u32() % (i + 1)]);
        for (std::size_t i = 0; i < order.size(); ++i) nodes_[order[i]].next = order[(i + 1) % order.size()];
    }
    std::uint32_t walk(std::uint32_t from, int steps) const {
        for (int i = 0; i < steps; ++i) {
            const Node& node = nodes_[from];
            from = node.next + node.second + node.third;  // 0, from other lines
        }
        return from;
    }

  private:
    struct alignas(64) Node {
        std::uint32_t next = 0, padding[15]{}, second = 0, more[15]{}, third = 0;
    };
    std::vector<Node> nodes_;
};

void light_sample(benchmark::State& state, bool cut, bool one) {
    static const Walls walls(1000000);
    static const Chain chain(walls.tree().memory_bytes());
    const auto n = std::uint32_t(state.range(0));
    constexpr int repeats = 256, depth = 7;
    lights::LightSampler sampler;
    Rng rng(2);
    std::size_t tile = 0;
    std::uint32_t at = 0;
    const auto ours = [&] {
        for (int k = 0; k < repeats; ++k) {
            const lights::ReceiverClusters receivers(walls.receivers(tile++, one), walls.tree());
            benchmark::DoNotOptimize(cut ? sampler.by_cut(walls.tree(), receivers, infinity, n, rng)
                                         : sampler.by_tree(walls.tree(), receivers, infinity, n, rng));
        }
    };
    const auto bare = [&] { benchmark::DoNotOptimize(at = chain.walk(at, depth * repeats * int(n))); };
    const double operations = double(n) * repeats;
    take_turns(
        state, no_target, operations, [&] { return seconds_of(ours); }, [&] { return seconds_of(bare); });
    state.counters["microseconds_a_light"] = 1.0 / state.counters["ours_M_per_s"];
}
#define LIGHT_SAMPLE(name, ...) \
    BENCHMARK_CAPTURE(light_sample, name, __VA_ARGS__)->UseManualTime()->Iterations(20)
LIGHT_SAMPLE(by_tree_for_a_tile, false, false)->Arg(1)->Arg(16)->Arg(64)->Arg(256);
LIGHT_SAMPLE(by_tree_for_a_receiver, false, true)->Arg(1)->Arg(16)->Arg(64);
LIGHT_SAMPLE(by_cut_for_a_tile, true, false)->Arg(64)->Arg(256);

}  // namespace
}  // namespace mote::benchmarks
