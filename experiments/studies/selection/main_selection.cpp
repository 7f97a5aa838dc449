// Error and cost of selecting virtual point lights, at tiles of pixels sampled from a picture: CSV, a line a
// method. All methods have the same VPLs, the same eye paths and the same points along them, so the error is
// that of the selection alone: against the light of all, which `--references FILE` keeps for the next time.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>

#include "core/metrics/series_error.h"
#include "experiments/studies/selection/references.h"

namespace {

using namespace mote;
using namespace mote::studies;

/// Over all pixels of the tiles, against all lights (core/metrics/series_error.h).
struct Errors {
    double relative = 0.0, standard_error = 0.0, bias = 0.0;
    double median = 0.0, worst = 0.0;  ///< of single pixels
};

/// A row of grey pixels a tile.
std::vector<core::Rgb> picture_of(const std::vector<Pixels>& tiles) {
    std::vector<core::Rgb> picture;
    for (const Pixels& tile : tiles)
        for (const double v : tile) picture.emplace_back(float(v));
    return picture;
}

Errors errors_of(const std::vector<Pixels>& references, const std::vector<Pixels>& lights) {
    const core::ErrorMeasure measure(picture_of(references), {}, 16, int(references.size()));
    const std::vector<std::vector<core::Rgb>> picture = {picture_of(lights)};
    const core::SeriesError e = measure.measure(picture);
    std::vector<double> squares = measure.pixel_errors(picture.front());
    std::sort(squares.begin(), squares.end());
    return {e.error, e.error_standard_error, e.bias, std::sqrt(squares[squares.size() / 2]),
            std::sqrt(squares.back())};
}

void measure(const Study& study, const std::vector<Pixels>& references, const std::string& method,
             const Arguments& a) {
    TileCost cost, nothing;
    const double begin = now(CLOCK_PROCESS_CPUTIME_ID);
    const Study::Method prepared = study.prepare(method);
    const double preparing = now(CLOCK_PROCESS_CPUTIME_ID) - begin;
    std::vector<Pixels> lights;
    for (std::size_t t = 0; t < study.tiles(); ++t) lights.push_back(study.render(t, prepared, cost));
    // Eye paths and direct light, which all methods have.
    const Study::Method least = study.prepare("tree:1");
    for (std::size_t t = 0; t < study.tiles(); ++t) study.render(t, least, nothing);
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
    auto& counted = cost.selection.values;
    const double cuts = std::max(counted["lightcuts"], 1.0);
    const double own = cost.seconds / seen - nothing.seconds / (16.0 * double(nothing.tiles));
    std::cout << fmt::format(
                     "{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.2f},{:.2f},{:.0f},{:.0f},"
                     "{:.0f},{:.2f},{:.2f}\n",
                     method, study.lights(), 100.0 * e.relative, 100.0 * e.standard_error,
                     100.0 * std::sqrt(counted["lightcut_predicted_squares"] / cuts), 100.0 * e.bias,
                     100.0 * e.median, 100.0 * e.worst, cost.seconds / seen * pixels, own * pixels,
                     cost.rays / seen, counted["lightcut_pairs"] / cuts,
                     counted["lightcut_pairs_evaluated"] / cuts, counted["lightcuts_at_limit"] / cuts,
                     preparing)
              << std::flush;
}

}  // namespace

int main(int argc, char** argv) try {
    Arguments a;
    CLI::App app{"Error and cost of selecting virtual point lights, as CSV"};
    app.add_option("scene", a.scene, "scene file, with media")->required();
    app.add_option("methods", a.methods,
                   "all uniform:N lightcuts:T:N multidimensional:T:N stochastic:N tree:N "
                   "ris:CANDIDATES:SAMPLES matrix:ROWS:COLUMNS:SLICES:VISIBILITY");
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
    std::cerr << fmt::format("{} VPLs, traced in {:.2f} s of the processor\n", study.lights(), study.tracing);
    const double begin = now(CLOCK_PROCESS_CPUTIME_ID);
    const std::vector<Pixels> references = a.costs_only ? std::vector<Pixels>{} : references_of(study, a);
    std::cerr << fmt::format("reference in {:.1f} s\n", now(CLOCK_PROCESS_CPUTIME_ID) - begin);
    std::cout << "method,lights,relative_error_percent,its_standard_error,predicted_percent,"
                 "bias_percent,median_percent,worst_percent,picture_seconds,"
                 "gather_seconds,rays_a_pixel,groups_a_cut,estimates_a_cut,at_limit,prepare_seconds\n";
    for (const std::string& method : a.methods) measure(study, references, method, a);
} catch (const std::exception& e) {
    std::cerr << e.what() << "\n";
    return 1;
}
