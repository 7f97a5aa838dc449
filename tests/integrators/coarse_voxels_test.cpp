// Voxels too dense to be marched, or for lines: the default integrator does not march them, and marching
// methods and ray lights say so.
#include "integrators/eye_path/plan_coarse_voxels.h"

#include <fmt/format.h>

#include <fstream>

#include "core/scene/requirements.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;

namespace {

/// A .vol file of 4 x 4 x 4 voxels of extinction 0.1, but for one of 1.
void write_grid(const std::string& path) {
    std::ofstream file(path, std::ios::binary);
    const std::int32_t sizes[] = {1, 4, 4, 4, 1};
    const float box[] = {0, 0, 0, 1, 1, 1};
    float values[64];
    std::fill(std::begin(values), std::end(values), 0.1f);
    values[21] = 1.0f;
    file.write("VOL\x03", 4);
    file.write(reinterpret_cast<const char*>(sizes), sizeof sizes);
    file.write(reinterpret_cast<const char*>(box), sizeof box);
    file.write(reinterpret_cast<const char*>(values), sizeof values);
}

/// A spot light shines into a unit cube of the grid; `scale` is its greatest extinction [1/m].
std::unique_ptr<Scene> smoke(const std::string& folder, double scale) {
    write_grid(folder + "/spike.vol");
    return scene_from(fmt::format(R"(<scene version="3.0.0"><sensor type="perspective">
        <transform name="to_world"><lookat origin="0.5, 0.5, 3" target="0.5, 0.5, 0" up="0, 1, 0"/></transform></sensor>
        <shape type="cube"><transform name="to_world"><scale value="0.5"/><translate x="0.5" y="0.5" z="0.5"/></transform>
        <bsdf type="null"/><medium type="heterogeneous" name="interior"><volume type="gridvolume" name="sigma_t">
        <string name="filename" value="spike.vol"/></volume><rgb name="albedo" value="0.5"/><float name="scale" value="{}"/>
        </medium></shape><emitter type="point"><point name="position" value="0.5, 3, 0.5"/></emitter></scene>)",
                                  scale),
                      8, folder);
}

Plan plan_of(const std::string& integrator, const Scene& scene) {
    return integrator_from(fmt::format("<integrator type=\"{}\"/>", integrator))
        ->plan(scene, find_requirements(scene));
}

bool warns(const Plan& plan) {
    return std::any_of(plan.missing.begin(), plan.missing.end(),
                       [](const PlanEntry& entry) { return entry.topic == "the edges of dense voxels"; });
}

}  // namespace

TEST_CASE("voxels of many optical depths are not marched by default, and marching warns of them",
          "[coarse_voxels]") {
    const TemporaryFolder folder;
    const auto thin = smoke(folder.path(), 4.0), thick = smoke(folder.path(), 1e4);
    CHECK(integrators::depth_of_marching_step(*thin, 1.0f) == Approx(1.0).epsilon(0.01));
    CHECK(integrators::depth_of_marching_step(*thick, 1.0f) == Approx(2500.0).epsilon(0.01));
    for (const std::string marching : {"mote_single_scattering", "mote_epipolar"}) {
        CHECK_FALSE(warns(plan_of(marching, *thin)));
        CHECK(warns(plan_of(marching, *thick)));
    }
    // A line has a cell for two voxels: 5000 optical depths, which one connection in 2.5e7 meets.
    const Plan thin_lines = plan_of("mote_ray_lights", *thin),
               thick_lines = plan_of("mote_ray_lights", *thick);
    CHECK(thin_lines.noise_unknown.empty());
    CHECK_FALSE(thick_lines.noise_unknown.empty());
    CHECK(thick_lines.to_text().find("most light of dense media") != std::string::npos);
    CHECK(plan_of("volpath", *thick).noise_unknown.empty());
    CHECK(plan_of("mote_layers", *thin).to_text().find("mote_epipolar") != std::string::npos);
    const std::string layers = plan_of("mote_layers", *thick).to_text();
    CHECK(layers.find("mote_epipolar") == std::string::npos);
    CHECK(layers.find("too dense to be marched") != std::string::npos);
}
