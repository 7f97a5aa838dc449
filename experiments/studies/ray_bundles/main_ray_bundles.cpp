// Times and counts of ray-bundles through the surfaces of a scene file, as CSV: one line a form and
// resolution.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <ctime>
#include <fstream>
#include <iostream>

#include "core/formats/xml/scene_loader.h"
#include "experiments/studies/ray_bundles/link_comparison.h"
#include "gathering/ray_bundles/bundle_directions.h"
#include "gathering/ray_bundles/bundle_tracer.h"
#include "gathering/ray_bundles/imperfect_bundles.h"
#include "session/registry.h"

namespace {

using namespace mote;
using namespace mote::gathering;

struct Arguments {
    std::string scene;
    std::vector<std::string> forms = {"rays", "scan", "automatic"};
    std::vector<std::uint32_t> sides = {128, 256, 512, 1024};
    std::uint32_t directions = 8;
    ImperfectSettings imperfect;
    std::uint32_t points = 16384;
    bool two_sided = false, compare = true;
    int threads = 1;
};

/// Processor time, which other programs do not lengthen.
double now() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// Memory of this program [B]: "VmRSS:" now, "VmHWM:" at most since forget_peak().
double memory_of(const std::string& which) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (double kilobytes = 0.0; word == which && status >> kilobytes) return 1024.0 * kilobytes;
    return 0.0;
}
void forget_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }

BundleForm form_of(const std::string& name) {
    if (name == "rays") return BundleForm::rays;
    if (name == "scan") return BundleForm::scan;
    if (name == "automatic") return BundleForm::automatic;
    throw core::InputError("no form '" + name + "': rays, scan or automatic");
}

/// `side` rays across the diagonal of the scene.
void measure(const BundleTracer& tracer, const ImperfectBundles& imperfect, const Arguments& a,
             const std::string& form, std::uint32_t side) {
    const core::Bounds3& bounds = tracer.triangles().bounds;
    const float spacing = glm::length(bounds.diagonal()) / float(side);
    double seconds = 0.0, hits = 0.0, links = 0.0, rays = 0.0;
    std::size_t deepest = 0;
    LinkComparison comparison;
    double size = 0.0, peak = 0.0;
    const std::uint32_t directions = a.directions;
    const bool points = form == "imperfect";
    const BundleSettings settings{points ? BundleForm::automatic : form_of(form), std::size_t(4) << 30, {}};
    for (std::uint32_t i = 0; i <= directions; ++i) {
        const BundleSample sample = bundle_sample(1, i);
        const BundleGrid grid = bundle_grid(sample.direction, bounds, spacing, sample.offset);
        forget_peak();
        const double before = memory_of("VmRSS:"), start = now();
        const RayBundle bundle =
            points ? imperfect.trace(grid, i, a.imperfect) : tracer.trace(grid, settings);
        if (i == 0) continue;  // first touches, and the hierarchy
        const double taken = now() - start;
        peak = std::max(peak, memory_of("VmHWM:") - before),
        size = std::max(size, double(bundle.memory_bytes()));
        if (points && a.compare) {
            const auto radius = float(imperfect.disc_radius(a.imperfect));
            comparison.add(compare_links(tracer.trace(grid), bundle, radius, a.two_sided));
        }
        seconds += taken;
        hits += double(bundle.hits.size()), rays += double(grid.rays());
        for_each_link(
            bundle, [&](std::uint32_t) { return a.two_sided; }, [&](auto, auto&, auto&) { links += 1.0; });
        for (std::size_t ray = 0; ray < grid.rays(); ++ray)
            deepest = std::max(deepest, bundle.hits_of(ray).size());
    }
    std::cout << fmt::format("{},{},{:.0f},{:.0f},{:.0f},{},{:.3f},{:.2f},{:.4f},{:.4f},{:.1f},{:.1f}\n",
                             form, side, rays / directions, hits / directions, links / directions, deepest,
                             1e3 * seconds / directions, 1e9 * seconds / std::max(hits, 1.0),
                             comparison.missing(), comparison.wrong(), 1e-6 * size, 1e-6 * peak)
              << std::flush;
}

}  // namespace

int main(int argc, char** argv) {
    Arguments a;
    CLI::App app("Times ray-bundles through the surfaces of a scene.");
    app.add_option("scene", a.scene)->required();
    app.add_option("--forms", a.forms)->delimiter(',');
    app.add_option("--sides", a.sides, "rays across the scene's diagonal")->delimiter(',');
    app.add_option("--directions", a.directions);
    app.add_option("--points", a.points, "of imperfect bundles");
    app.add_option("--splat", a.imperfect.splat_size, "size of their splats");
    app.add_option("--merge", a.imperfect.merge, "share of a disc's radius");
    app.add_flag("!--no-comparison", a.compare, "imperfect bundles without their errors");
    app.add_flag("--two-sided", a.two_sided, "all surfaces send and receive on both sides");
    app.add_option("--threads", a.threads);
    CLI11_PARSE(app, argc, argv);
    try {
        const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                          std::size_t(a.threads));
        const auto scene = core::load_scene(a.scene, session::make_registry());
        const SurfaceTriangles triangles = surface_triangles(scene->shapes());
        std::cerr << triangles.size() << " triangles\n";
        const BundleTracer tracer(triangles);
        const ImperfectBundles imperfect(triangles, a.points);
        std::cout
            << "form,side,rays,hits,links,deepest,ms_per_direction,ns_per_hit,missing,wrong,MB,peak_MB\n";
        for (const std::uint32_t side : a.sides)
            for (const std::string& form : a.forms) measure(tracer, imperfect, a, form, side);
    } catch (const std::exception& error) {
        std::cerr << error.what() << "\n";
        return 1;
    }
}
