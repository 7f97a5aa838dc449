// A light drawn by the hierarchy over a million virtual point lights: microseconds of one light for a tile of
// sixteen receivers.
#include <benchmark/benchmark.h>

#include "core/materials/bsdfs.h"
#include "lights/selection/light_sampler.h"
#include "lights/selection/vertex_bounds.h"

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
        leaves_.emplace(vpls_), tree_.emplace(*leaves_);
        for (int t = 0; t < 64; ++t) {
            const Vec3 corner(0.95f * rng.next_float(), 0.95f * rng.next_float(), 0.0f);
            lights::ReceiverTile tile;
            for (int i = 0; i < 16; ++i) {
                ScatteringVertex v;
                v.position = corner + 0.005f * Vec3(float(i % 4), float(i / 4), 0.0f);
                v.wo = {0, 0, 1}, v.bsdf = bsdf_.get(), v.hit.position = v.position;
                tile.set(i, v, Rgb(1.0f), MediumState{}, Rng(0), 1000);
            }
            receivers_.emplace_back(tile);
        }
    }
    const lights::LightHierarchy& tree() const { return *tree_; }
    const lights::ReceiverBounds& receivers(std::size_t i) const { return receivers_[i % receivers_.size()]; }

  private:
    std::shared_ptr<Bsdf> bsdf_ = make_diffuse(nullptr);
    lights::VplSet vpls_;
    std::optional<lights::VplLeaves> leaves_;
    std::optional<lights::LightHierarchy> tree_;
    std::vector<lights::ReceiverBounds> receivers_;
};

void light_sample(benchmark::State& state, bool cut) {
    static const Walls walls(1000000);
    const auto n = std::uint32_t(state.range(0));
    lights::LightSampler sampler;
    Rng rng(2);
    std::size_t tile = 0;
    for (auto _ : state) {
        const auto& receivers = walls.receivers(tile++);
        benchmark::DoNotOptimize(cut ? sampler.by_cut(walls.tree(), receivers, infinity, n, rng)
                                     : sampler.by_tree(walls.tree(), receivers, infinity, n, rng));
    }
    state.counters["seconds_a_light"] = benchmark::Counter(
        double(n) * double(state.iterations()), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(light_sample, by_tree, false)->Arg(1)->Arg(64)->Arg(256);
BENCHMARK_CAPTURE(light_sample, by_cut, true)->Arg(64)->Arg(256);

}  // namespace
}  // namespace mote::benchmarks
