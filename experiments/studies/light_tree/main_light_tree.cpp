// Cost of sampling lights by a tree, for a thousand to 2^24 of them: CSV, one line for each number of lights.
// Half of them stand on the inner walls of a box, half in the air within, where the receivers are: every
// light reaches all of them.
//   bytes_a_light: of the lights and the tree; peak_bytes_a_light: growth of the process while it was built
//   us_by_tree, us_by_cut: processor time a light [us], 64 sampled for a tile
//   z: of the mean sum of weights times energy against the energy of all lights; beyond 4 the program fails,
//     as it does for a weight that is not finite
// A tree that does not fit into its budget is refused, and a line says so. --quick: up to 10^5.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <ctime>
#include <fstream>
#include <iostream>

#include "core/objects/error.h"
#include "lights/selection/hierarchy/vertex_bounds.h"
#include "lights/selection/stochastic/light_sampler.h"
#include "media/phase_functions.h"

namespace {

using namespace mote;
using namespace mote::core;

double processor_seconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// A number of /proc/self/status [bytes]: "VmRSS:", or its peak "VmHWM:".
double memory(const std::string& what) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (double kilobytes = 0.0; word == what && status >> kilobytes) return 1024.0 * kilobytes;
    return 0.0;
}
void forget_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }

lights::VplSet lights_in_a_box(std::size_t count) {
    lights::VplSet set;
    set.lights.resize(count);
    Rng rng(1);
    for (lights::VirtualPointLight& vpl : set.lights) {
        vpl.position = Vec3(rng.next_float(), rng.next_float(), rng.next_float());
        vpl.intensity = Rgb(rng.next_float());
        const std::uint32_t side = rng.next_u32() % 12;
        if (side >= 6) continue;
        vpl.position[int(side / 2)] = float(side % 2);
        vpl.normal[int(side / 2)] = side % 2 ? -1.0f : 1.0f;
        vpl.shading_normal = vpl.normal;
    }
    return set;
}

lights::ReceiverBounds tile_of(const PhaseFunction& phase, Rng& rng) {
    const Vec3 corner(0.05f + 0.9f * rng.next_float(), 0.05f + 0.9f * rng.next_float(),
                      0.05f + 0.9f * rng.next_float());
    lights::ReceiverTile tile;
    for (int i = 0; i < 16; ++i) {
        ScatteringVertex v;
        v.position = corner + 0.005f * Vec3(float(i % 4), float(i / 4), 0.0f);
        v.wo = {0, 0, 1}, v.phase = &phase;
        tile.set(i, v, Rgb(1.0f), MediumState{}, Rng(0), 1000);
    }
    return lights::ReceiverBounds(tile);
}

/// Result of one sampling method: processor time a light [us], z-score of the energy, finite weights.
struct Samples {
    double microseconds = 0.0, z = 0.0;
    bool finite = true;
};

Samples sample(const lights::WideLightTree& tree, const lights::VplSet& set, bool cut) {
    constexpr int tiles = 300;
    constexpr std::uint32_t sampled = 64;
    const media::IsotropicPhase phase;
    Rng rng(2);
    lights::LightSampler sampler;
    Samples result;
    double sum = 0.0, squares = 0.0, all = 0.0, seconds = 0.0;
    for (const lights::VirtualPointLight& vpl : set.lights) all += double(average(vpl.intensity));
    for (int t = 0; t < tiles; ++t) {
        const lights::ReceiverBounds receivers = tile_of(phase, rng);
        const double begin = processor_seconds();
        const lights::ReceiverClusters clusters(receivers, tree);
        const auto found = cut ? sampler.by_cut(tree, clusters, infinity, sampled, rng)
                               : sampler.by_tree(tree, clusters, infinity, sampled, rng);
        seconds += processor_seconds() - begin;
        double x = 0.0;
        for (const lights::WeightedVpl& light : found) {
            result.finite &= std::isfinite(light.weight);
            x += double(light.weight) * double(average(set.lights[light.index].intensity));
        }
        sum += x, squares += x * x;
    }
    const double mean = sum / tiles, variance = std::max(squares / tiles - mean * mean, 0.0) / (tiles - 1);
    result.microseconds = 1e6 * seconds / (tiles * double(sampled));
    result.z = variance > 0.0 ? (mean - all) / std::sqrt(variance) : 0.0;
    return result;
}

bool measure(std::size_t count, double budget) {
    const lights::VplSet set = lights_in_a_box(count);
    const double before = memory("VmRSS:");
    forget_peak();
    const double begin = processor_seconds();
    try {
        const lights::VplLeaves leaves(set);
        const lights::WideLightTree tree(leaves, std::size_t(budget));
        const double seconds = processor_seconds() - begin, own = sizeof(lights::VirtualPointLight);
        const double peak = own + (memory("VmHWM:") - before) / double(count);
        const Samples by_tree = sample(tree, set, false), by_cut = sample(tree, set, true);
        std::cout << fmt::format("{},{:.3f},{:.1f},{:.1f},{:.3f},{:.3f},{:.2f},{:.2f}\n", count, seconds,
                                 own + double(tree.memory_bytes()) / double(count), peak,
                                 by_tree.microseconds, by_cut.microseconds, by_tree.z, by_cut.z)
                  << std::flush;
        return by_tree.finite && by_cut.finite && std::fabs(by_tree.z) < 4.0 && std::fabs(by_cut.z) < 4.0;
    } catch (const InputError& error) {
        std::cout << count << ",refused: " << error.what() << "\n";
        return true;
    }
}

}  // namespace

int main(int argc, char** argv) {
    bool quick = false;
    double budget = 4096.0;
    CLI::App app{"Cost of sampling lights by a tree, by their number, as CSV"};
    app.add_flag("--quick", quick, "up to 10^5 lights");
    app.add_option("--megabytes", budget, "of a tree while it is built");
    CLI11_PARSE(app, argc, argv);
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 2);
    std::vector<std::size_t> numbers{1000, 10000, 100000};
    if (!quick) numbers.insert(numbers.end(), {1000000, 10000000, std::size_t(1) << 24});
    std::cout
        << "lights,build_seconds,bytes_a_light,peak_bytes_a_light,us_by_tree,us_by_cut,z_by_tree,z_by_cut\n";
    bool right = true;
    for (const std::size_t count : numbers) right &= measure(count, 1e6 * budget);
    return right ? 0 : 1;
}
