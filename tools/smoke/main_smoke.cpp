// mote_smoke: makes the smoke of scenes/smoke_room.xml, and with --cloud the cloud of scenes/cloud.xml.
//
// Progress goes to stderr, the result's line to stdout. Exit codes as the mote command's: 0, 1 (the input is
// at fault), 2 (usage), 3 (ours).

#include <tbb/global_control.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>

#include "core/objects/error.h"
#include "tools/smoke/cloud.h"
#include "tools/smoke/preview.h"
#include "tools/smoke/smoke_simulation.h"
#include "tools/smoke/vdb_writer.h"

namespace {

using namespace mote;
using namespace mote::tools;

struct Options {
    std::string output = "smoke.vdb", preview;
    bool cloud = false, open = false, quiet = false;
    std::vector<int> size;
    float cell = 0.0f, extinction = 4.0f, cut_off = 1e-3f;
    int steps = 100, threads = 0;
    std::vector<float> source;
    SmokeSettings smoke;
};

void declare(CLI::App& app, Options& o) {
    app.add_option("-o,--output", o.output, "the .vdb file to write")->capture_default_str();
    app.add_flag("--cloud", o.cloud, "a cumulus cloud from fractal noise instead of a simulation");
    app.add_option("--size", o.size, "cells along x, y (up) and z, each 8 to 1024")
        ->expected(3)
        ->check(CLI::Range(8, 1024));
    app.add_option("--cell", o.cell, "edge of a cell in metres")->check(CLI::Range(1e-6f, 1e6f));
    app.add_option("--seed", o.smoke.seed, "another seed, another smoke")->capture_default_str();
    app.add_option("--steps", o.steps, "time steps of 1/24 s")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    app.add_flag("--open", o.open, "open sides and top instead of a closed room");
    app.add_option("--source", o.source, "centre of the source, as fractions of the box")
        ->expected(3)
        ->check(CLI::Range(0.0f, 1.0f));
    app.add_option("--source-radius", o.smoke.source_radius, "metres")
        ->check(CLI::Range(1e-6f, 1e6f))
        ->capture_default_str();
    app.add_option("--buoyancy", o.smoke.buoyancy, "m/s^2 at the source")
        ->check(CLI::Range(0.0f, 1e3f))
        ->capture_default_str();
    app.add_option("--cooling", o.smoke.cooling, "share of the heat lost per second")
        ->check(CLI::Range(0.0f, 1e3f))
        ->capture_default_str();
    app.add_option("--confinement", o.smoke.confinement, "vorticity confinement")
        ->check(CLI::Range(0.0f, 10.0f))
        ->capture_default_str();
    app.add_option("--jitter", o.smoke.jitter, "turbulence of the source, m/s^2")
        ->check(CLI::Range(0.0f, 1e4f))
        ->capture_default_str();
    app.add_option("--haze", o.smoke.haze, "density of the air at the start (the source emits 1)")
        ->check(CLI::Range(0.0f, 1.0f))
        ->capture_default_str();
    app.add_option("--cut-off", o.cut_off, "densities below become vacuum")
        ->check(CLI::Range(0.0f, 1.0f))
        ->capture_default_str();
    app.add_option("--preview", o.preview, "also write a PNG, seen along z and lit from above");
    app.add_option("--extinction", o.extinction, "of the preview, per metre at density 1")
        ->check(CLI::Range(0.0f, 1e6f))
        ->capture_default_str();
    app.add_option("-t,--threads", o.threads, "0: all")->check(CLI::Range(0, 1024))->capture_default_str();
    app.add_flag("-q,--quiet", o.quiet, "no progress");
}

std::vector<float> simulate(const SmokeSettings& settings, int steps, bool quiet) {
    SmokeSimulation simulation(settings);
    const bool live = isatty(STDERR_FILENO) != 0;
    for (int i = 1; i <= steps; ++i) {
        simulation.step();
        if (quiet || (!live && i % 25 != 0 && i != steps)) continue;
        std::fprintf(stderr, "%ssmoke: step %d of %d%s", live ? "\r" : "", i, steps,
                     live && i < steps ? "" : "\n");
    }
    return simulation.density();
}

void run(Options& o) {
    const auto start = std::chrono::steady_clock::now();
    std::optional<tbb::global_control> limit;
    if (o.threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(o.threads));
    const std::filesystem::path folder = std::filesystem::path(o.output).parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder))
        throw core::InputError("cannot write '" + o.output + "': there is no folder '" + folder.string() +
                               "'");

    CloudSettings cloud;
    cloud.seed = o.smoke.seed;
    if (!o.size.empty()) o.smoke.size = cloud.size = {o.size[0], o.size[1], o.size[2]};
    if (!o.source.empty()) o.smoke.source = {o.source[0], o.source[1], o.source[2]};
    if (o.cell > 0.0f) o.smoke.cell = o.cell;
    if (o.open) o.smoke.sides = {true, true};
    const GridSize size = o.cloud ? cloud.size : o.smoke.size;
    const float cell = o.cloud && o.cell <= 0.0f ? 10.0f : o.smoke.cell;  // clouds are a kilometre high

    const std::vector<float> density = o.cloud ? make_cloud(cloud) : simulate(o.smoke, o.steps, o.quiet);
    const VdbSummary summary = write_vdb(o.output, size, density, cell, o.cut_off);
    if (!o.preview.empty()) write_preview(o.preview, size, density, cell, o.extinction);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf("%s: %dx%dx%d cells, %zu active, %.1f MB, %.1f s\n", o.output.c_str(), size.x, size.y, size.z,
                summary.active_voxels, double(summary.bytes) * 1e-6, seconds);
}

}  // namespace

int main(int argc, char* argv[]) {
    CLI::App app("mote_smoke: smoke from a simulation, or a cloud, as an OpenVDB fog volume");
    Options options;
    declare(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }
    try {
        run(options);
        return 0;
    } catch (const core::InputError& e) {
        std::cerr << "mote_smoke: " << e.what() << "\n";
        return 1;
    } catch (const std::exception& e) {
        std::cerr << "mote_smoke: internal error: " << e.what() << "\n";
        return 3;
    }
}
