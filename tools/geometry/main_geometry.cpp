// mote_geometry: makes the meshes of the generated scenes, one binary PLY for every material, and a sky.
//
//   mote_geometry atrium -o FOLDER     writes FOLDER/atrium_wall.ply, FOLDER/atrium_marble.ply, ...
//
// The same options give the same bytes. The counts go to stdout. Exit codes as the mote command's: 0, 1 (the
// input is at fault), 2 (usage), 3 (ours).

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "core/objects/error.h"
#include "tools/geometry/atrium.h"
#include "tools/geometry/city.h"
#include "tools/geometry/mesh.h"
#include "tools/geometry/perforated.h"
#include "tools/geometry/rotunda.h"
#include "tools/geometry/sky.h"
#include "tools/geometry/window.h"

namespace {

using namespace mote;
using namespace mote::tools;

struct Options {
    std::string what, folder = ".";
    float detail = 1.0f;
    std::uint64_t seed = 1;
    Sky sky;
};

using Maker = Parts (*)(float detail, std::uint64_t seed);
const std::map<std::string, Maker> makers = {
    {"atrium", make_atrium},   {"city", make_city},      {"rotunda", make_rotunda}, {"screen", make_screen},
    {"lantern", make_lantern}, {"tree", make_lone_tree}, {"window", make_window}};

void run(const Options& o) {
    if (!std::filesystem::is_directory(o.folder))
        throw core::InputError("cannot write there: no folder '" + o.folder + "'");
    if (o.what == "sky") {
        const std::filesystem::path path = std::filesystem::path(o.folder) / "sky.exr";
        write_sky(path, o.sky);
        std::printf("%s: %d x %d pixels\n", path.string().c_str(), 2 * o.sky.height, o.sky.height);
        return;
    }
    std::size_t total = 0;
    for (const auto& [name, soup] : makers.at(o.what)(o.detail, o.seed)) {
        const IndexedMesh mesh = weld(soup);
        const std::filesystem::path path = std::filesystem::path(o.folder) / (o.what + "_" + name + ".ply");
        write_ply(path, mesh);
        std::printf("%s: %zu triangles, %zu vertices\n", path.string().c_str(), mesh.triangles.size(),
                    mesh.positions.size());
        total += mesh.triangles.size();
    }
    std::printf("%s: %zu triangles\n", o.what.c_str(), total);
}

}  // namespace

int main(int argc, char* argv[]) {
    CLI::App app("mote_geometry: meshes of the generated scenes");
    Options o;
    std::vector<std::string> names{"sky"};
    for (const auto& [name, maker] : makers) names.push_back(name);
    app.add_option("what", o.what, "what to make")->required()->check(CLI::IsMember(names));
    app.add_option("-o,--output", o.folder, "an existing folder")->capture_default_str();
    app.add_option("--detail", o.detail, "finer or coarser: 0.05 to 4")
        ->check(CLI::Range(0.05f, 4.0f))
        ->capture_default_str();
    app.add_option("--seed", o.seed, "another seed, other plants and folds")->capture_default_str();
    app.add_option("--sun-elevation", o.sky.elevation, "of the sky, degrees")
        ->check(CLI::Range(0.0f, 90.0f))
        ->capture_default_str();
    app.add_option("--sun-azimuth", o.sky.azimuth, "from -z towards +x, degrees")
        ->check(CLI::Range(-360.0f, 360.0f))
        ->capture_default_str();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }
    try {
        run(o);
        return 0;
    } catch (const core::InputError& e) {
        std::cerr << "mote_geometry: " << e.what() << "\n";
        return 1;
    } catch (const std::exception& e) {
        std::cerr << "mote_geometry: internal error: " << e.what() << "\n";
        return 3;
    }
}
