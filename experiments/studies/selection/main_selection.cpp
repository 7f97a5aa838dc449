// Error and cost of selecting virtual point lights, at tiles of pixels drawn from a picture: CSV, a line a
// method. All methods have the same VPLs, the same eye paths and the same points along them, so the error is
// that of the selection alone: against the light of all, which `--references FILE` keeps for the next time.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>

#include "experiments/studies/selection/references.h"

namespace {

using namespace mote;
using namespace mote::studies;

/// Relative to what stands in all light; dark pixels count as if they had a hundredth of the mean.
struct Errors {
    double relative = 0.0, deviation = 0.0;  ///< root of the mean square, and its standard error over tiles
    double of_mean = 0.0, bias = 0.0, median = 0.0, worst = 0.0;
};

Errors errors_of(const std::vector<Pixels>& references, const std::vector<Pixels>& lights) {
    Errors e;
    const double n = double(16 * references.size());
    double mean = 0.0, squares = 0.0;
    for (const Pixels& tile : references)
        for (const double v : tile) mean += v / n;
    std::vector<double> of_tiles, of_pixels;
    for (std::size_t t = 0; t < references.size(); ++t) {
        double sum = 0.0;
        for (std::size_t i = 0; i < 16; ++i) {
            const double r = references[t][i], d = lights[t][i] - r;
            e.bias += d / n / mean, squares += d * d / n, sum += d * d / (r * r + 1e-4 * mean * mean) / 16.0;
            of_pixels.push_back(std::fabs(d) / (r + 0.01 * mean));
        }
        of_tiles.push_back(sum);
    }
    double square = 0.0, spread = 0.0;
    for (const double v : of_tiles) square += v / double(of_tiles.size());
    for (const double v : of_tiles) spread += (v - square) * (v - square);
    e.relative = std::sqrt(square), e.of_mean = std::sqrt(squares) / mean;
    if (square > 0.0) e.deviation = 0.5 * std::sqrt(spread) / double(of_tiles.size()) / e.relative;
    std::sort(of_pixels.begin(), of_pixels.end());
    e.median = of_pixels[of_pixels.size() / 2], e.worst = of_pixels.back();
    return e;
}

void measure(const Study& study, const std::vector<Pixels>& references, const std::string& method,
             const Arguments& a) {
    TileCost cost, nothing;
    const double begin = now(CLOCK_PROCESS_CPUTIME_ID);
    const auto matrix = study.prepare(settings_of(method));
    const double preparing = now(CLOCK_PROCESS_CPUTIME_ID) - begin;
    std::vector<Pixels> lights;
    for (std::size_t t = 0; t < study.tiles(); ++t)
        lights.push_back(study.render(t, settings_of(method), cost, matrix.get()));
    // What eye paths and direct light take, which all methods have.
    for (std::size_t t = 0; t < study.tiles(); ++t) study.render(t, settings_of("tree:1"), nothing);
    if (!a.pixels.empty()) {
        std::ofstream file(a.pixels, std::ios::app);
        for (std::size_t t = 0; t < references.size(); ++t)
            for (int i = 0; i < 16; ++i)
                file << fmt::format("{},{},{},{:.6g},{:.6g}\n", method, study.tile(t).x + i % 4,
                                    study.tile(t).y + i / 4, references[t][std::size_t(i)],
                                    lights[t][std::size_t(i)]);
    }
    const Errors e = references.empty() ? Errors{} : errors_of(references, lights);
    const double pixels = double(a.width) * double(a.height), seen = 16.0 * double(cost.tiles);
    const double cuts = double(std::max<std::uint64_t>(cost.cuts.cuts, 1));
    const double own = cost.seconds / seen - nothing.seconds / (16.0 * double(nothing.tiles));
    std::cout << fmt::format(
                     "{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.2f},{:.2f},{:.0f},{:.0f},"
                     "{:.0f},{:.2f},{:.2f}\n",
                     method, study.lights(), 100.0 * e.relative, 100.0 * e.deviation,
                     100.0 * std::sqrt(cost.cuts.predicted_squares / cuts), 100.0 * e.of_mean, 100.0 * e.bias,
                     100.0 * e.median, 100.0 * e.worst, cost.seconds / seen * pixels, own * pixels,
                     cost.rays / seen, double(cost.cuts.pairs) / cuts, double(cost.cuts.evaluated) / cuts,
                     double(cost.cuts.at_limit) / cuts, preparing)
              << std::flush;
}

}  // namespace

int main(int argc, char** argv) try {
    Arguments a;
    CLI::App app{"Error and cost of selecting virtual point lights, as CSV"};
    app.add_option("scene", a.scene, "scene file, with media")->required();
    app.add_option("methods", a.methods,
                   "all lightcuts:T:N multidimensional:T:N stochastic:N tree:N "
                   "ris:CANDIDATES:SAMPLES:REUSE:BY matrix:ROWS:COLUMNS:SLICES:VISIBILITY");
    app.add_option("--paths", a.paths, "light paths");
    app.add_option("--tiles", a.tiles, "of 4 x 4 pixels");
    app.add_option("--points", a.points, "along each eye ray in media");
    app.add_option("--bound", a.bound, "on the geometry term [1/m^2]");
    app.add_option("--width", a.width, "of the picture"), app.add_option("--height", a.height, "");
    app.add_flag("--costs", a.costs_only, "no reference, and errors are 0");
    app.add_option("--references", a.references, "file that keeps sums of all lights");
    app.add_option("--pixels", a.pixels, "file that gets a line a pixel: method, x, y, reference, light");
    app.add_option("--threads", a.threads, "for all lights; methods have one");
    CLI11_PARSE(app, argc, argv);
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, a.threads);
    const Study study(a);
    std::cerr << fmt::format(
        "{} lights, {:.1f} bytes a light with the hierarchy, {:.1f} with the tree; traced in {:.2f} s, "
        "hierarchy in "
        "{:.2f} s, tree in {:.2f} s of the processor\n",
        study.lights(), study.bytes_a_light(false), study.bytes_a_light(true), study.tracing, study.building,
        study.planting);
    const double begin = now(CLOCK_PROCESS_CPUTIME_ID);
    const std::vector<Pixels> references = a.costs_only ? std::vector<Pixels>{} : references_of(study, a);
    std::cerr << fmt::format("reference in {:.1f} s\n", now(CLOCK_PROCESS_CPUTIME_ID) - begin);
    std::cout << "method,lights,relative_error_percent,its_standard_error,predicted_percent,"
                 "error_of_mean_percent,bias_percent,median_percent,worst_percent,picture_seconds,"
                 "gather_seconds,rays_a_pixel,groups_a_cut,estimates_a_cut,at_limit,prepare_seconds\n";
    for (const std::string& method : a.methods) measure(study, references, method, a);
} catch (const std::exception& e) {
    std::cerr << e.what() << "\n";
    return 1;
}
