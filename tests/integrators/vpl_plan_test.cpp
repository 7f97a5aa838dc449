// Plans of `mote_vpl` for the selection of virtual point lights: the recommended one, its reason and its
// cost; and refusal of passes that exceed their memory.
#include "core/objects/error.h"
#include "core/render/pass_runner.h"
#include "core/scene/requirements.h"
#include "integrators/virtual_point_lights/plan_selection.h"
#include "lights/selection/register_selection.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::tests;

namespace {

std::string vpl(int paths, const std::string& settings = "") {
    return fmt::format(R"(<integrator type="mote_vpl"><integer name="paths" value="{}"/>
        <float name="bound" value="1"/>{}</integrator>)",
                       paths, settings);
}

const core::PlanEntry* entry_of(const core::Plan& plan, const std::string& topic) {
    for (const core::PlanEntry& e : plan.runs)
        if (e.topic == topic) return &e;
    return nullptr;
}

core::Plan plan_of(const core::Scene& scene, const std::string& integrator) {
    return integrator_from(integrator)->plan(scene, core::find_requirements(scene));
}

/// Choice and reason of an entry; "" where there is none.
std::string said(const core::Plan& plan, const std::string& topic) {
    const core::PlanEntry* entry = entry_of(plan, topic);
    return entry ? entry->choice + ": " + entry->reason : "";
}

std::string advice(const core::Scene& scene, int paths, const std::string& settings = "") {
    return said(plan_of(scene, vpl(paths, settings)), "selection for this scene");
}

/// A selection as a scene file names it.
std::shared_ptr<lights::Selection> selection_of(const std::string& type,
                                                const std::map<std::string, std::int64_t>& values = {}) {
    core::Registry registry;
    lights::register_selection(registry);
    core::Properties properties;
    properties.category = core::Category::selection, properties.type = type;
    for (const auto& [name, value] : values) properties.values[name].value = value;
    return std::dynamic_pointer_cast<lights::Selection>(registry.make(properties));
}

}  // namespace

TEST_CASE("Plans choose a selection by lights, receivers and media, and say why", "[vpl][selection][plan]") {
    const auto surfaces = scene_from(box(grey, ""), 64);
    CHECK_THAT(advice(*surfaces, 20), ContainsSubstring("all: 60 VPLs are fewer"));
    CHECK_THAT(advice(*surfaces, 300),
               ContainsSubstring("all: ") && ContainsSubstring("saves less than it errs"));
    CHECK_THAT(advice(*surfaces, 2000),
               ContainsSubstring("stochastic_lightcuts, 64 samples") && ContainsSubstring("shadow rays"));
    CHECK_THAT(advice(*surfaces, 20000),
               ContainsSubstring("stochastic_lightcuts, 256 samples") && ContainsSubstring("learns"));
    CHECK_THAT(advice(*surfaces, 300000), ContainsSubstring("stochastic_lightcuts, 256 samples"));
    // A larger picture of the same lights is worth more than brute force.
    CHECK_THAT(advice(*scene_from(box(grey, ""), 300), 300), ContainsSubstring("stochastic_lightcuts"));
    for (const int paths : {2000, 20000, 300000})
        CHECK_THAT(advice(*surfaces, paths, R"(<boolean name="filter" value="true"/>)"),
                   ContainsSubstring("with interleaving 4") && ContainsSubstring("filter removes"));
    CHECK(said(plan_of(*surfaces, vpl(2000)), "integrator for this medium").empty());

    // A box of 2 x 2 x 1.3 metres: haze leaves the choice to surfaces, fog takes it.
    const auto haze = scene_from(box(grey, fog("0.1, 0.1, 0.1", "")), 64);
    CHECK(integrators::depth_of_media(*haze) == Approx(0.1 * 5.3 / 3.0));
    CHECK_THAT(advice(*haze, 2000), ContainsSubstring("stochastic_lightcuts, 64 samples"));
    CHECK_THAT(advice(*haze, 20000), ContainsSubstring("stochastic_lightcuts, 256 samples"));
    CHECK(said(plan_of(*haze, vpl(2000)), "integrator for this medium").empty());
    const auto foggy = scene_from(box(grey, fog("1, 2, 3", "")), 64);
    CHECK(integrators::depth_of_media(*foggy) == Approx(2.0 * 5.3 / 3.0));
    for (const int paths : {2000, 20000, 300000})
        CHECK_THAT(advice(*foggy, paths),
                   ContainsSubstring("multidimensional_lightcuts with shared_angle 0.2") &&
                       ContainsSubstring("optical depth 3.5"));
    CHECK_THAT(said(plan_of(*foggy, vpl(2000)), "integrator for this medium"),
               ContainsSubstring("mote_ray_lights") && ContainsSubstring("in homogeneous fog"));
    const TemporaryFolder folder;
    const auto smoky = scene_from(box(grey, smoke_medium(folder.file("smoke.vol"))), 64);
    CHECK_THAT(said(plan_of(*smoky, vpl(2000)), "integrator for this medium"),
               ContainsSubstring("mote_ray_lights") && ContainsSubstring("in smoke"));
    // A medium that only absorbs does not count.
    const auto dark = scene_from(box(grey, R"(<medium type="homogeneous" name="interior">
        <float name="sigma_t" value="3"/><float name="albedo" value="0"/></medium>)"),
                                 64);
    CHECK(integrators::depth_of_media(*dark) == 0.0);
}

TEST_CASE("Plans warn of passes that take long, where every receiver takes all VPLs",
          "[vpl][selection][plan]") {
    const auto scene = scene_from(box(grey, ""), 512);
    // 3 VPLs a path at 2^18 receivers, 60 ns a ray: 30 s are 636 paths.
    CHECK(plan_of(*scene, vpl(600)).costly.empty());
    const core::Plan slow = plan_of(*scene, vpl(1024));
    REQUIRE(slow.costly.size() == 1);
    CHECK_THAT(slow.costly.front(), ContainsSubstring("8.1e+08 shadow rays, 48 s of processor time"));
    CHECK(plan_of(*scene, vpl(1024, R"(<selection type="stochastic_lightcuts"/>)")).costly.empty());
}

TEST_CASE("Plans say what is selected, and what it takes", "[vpl][selection][plan]") {
    const auto scene = scene_from(box(grey, fog("0.8, 1.0, 1.3", "")), 64);
    const auto plan_text = [&](const std::string& selection, int paths = 100000) {
        const core::Plan plan = plan_of(*scene, vpl(paths, selection));
        std::string text;
        for (const auto& entries : {plan.runs, plan.missing})
            for (const core::PlanEntry& e : entries)
                text += e.topic + ": " + e.choice + ": " + e.reason + "\n";
        return text;
    };
    CHECK_THAT(plan_text(""), ContainsSubstring("all VPLs at every receiver") &&
                                  !ContainsSubstring("a VPL while it is built"));
    CHECK_THAT(plan_text(R"(<selection type="lightcuts"/>)"), ContainsSubstring("lightcuts, threshold 2 %") &&
                                                                  ContainsSubstring("31.5 MB") &&
                                                                  ContainsSubstring("at most 105 bytes"));
    CHECK_THAT(plan_text(R"(<selection type="light_tree"/>)"),
               ContainsSubstring("18.0 MB") && ContainsSubstring("at most 60"));
    CHECK_THAT(plan_text(R"(<selection type="resampling"/>)"),
               ContainsSubstring("32 of 256 candidates from a cut") && ContainsSubstring("at most 60") &&
                   ContainsSubstring("unbiased"));
    const std::string matrix = R"(<selection type="matrix"><integer name="rows" value="200"/>
        <integer name="columns" value="100"/></selection>)";
    CHECK_THAT(plan_text(matrix), ContainsSubstring("256 rows, 100 columns for each of 4 slices") &&
                                      ContainsSubstring("shadow maps of receivers") &&
                                      ContainsSubstring("on surfaces and in media") &&
                                      ContainsSubstring("at most 336 bytes") &&
                                      !ContainsSubstring("refused"));
    CHECK_THAT(plan_text(matrix, 1 << 23), ContainsSubstring("more than 4295 MB, refused"));
}

TEST_CASE("Selections keep less memory than they state", "[vpl][selection][extremes]") {
    const auto scene = scene_from(box(grey, ""), 8);
    struct Case {
        std::string type, settings;
        std::size_t bytes_a_light;
        std::string kept;
    };
    for (const Case& c :
         {Case{"lightcuts", "", 105, "light_hierarchy_bytes"},
          Case{"light_tree", "", 60, "light_hierarchy_bytes"},
          Case{"stochastic_lightcuts", "", 60, "light_hierarchy_bytes"},
          Case{"resampling", "", 60, "light_hierarchy_bytes"},
          Case{"matrix", R"(<integer name="rows" value="64"/>)", 4 * 16 + 32 + 4 * 12, "matrix_bytes"},
          Case{"matrix", R"(<integer name="slices" value="20"/>)", 4 * 16 + 32 + 20 * 12, "matrix_bytes"}}) {
        INFO(c.type << " " << c.settings);
        const std::string selection = "<selection type=\"" + c.type + "\">" + c.settings + "</selection>";
        const auto method = integrator_from(vpl(500, selection));
        core::Film film(8, 8, method->layers(*scene));
        core::PassRunner runner(*scene, *method, 3, film);
        const std::atomic<bool> cancelled = false;
        runner.run_pass(cancelled);
        core::Statistics statistics;
        runner.estimator().add_statistics(statistics);
        const double bytes = double(c.bytes_a_light) * statistics.values.at("vpls");
        // Kept bytes: at most those of the plan, but more than 15 % of them.
        CHECK(statistics.values.at(c.kept) <= bytes);
        CHECK(statistics.values.at(c.kept) > 0.15 * bytes);
        CHECK_THAT(said(plan_of(*scene, vpl(500, selection)), c.type == "matrix" ? "memory of the matrix"
                                                              : c.type == "lightcuts"
                                                                  ? "memory of the light hierarchy"
                                                                  : "memory of the light tree"),
                   ContainsSubstring(fmt::format("at most {} bytes", c.bytes_a_light)));
    }
}

TEST_CASE("A selection from 2^24 VPLs is within its memory, or refused before it is allocated",
          "[vpl][selection][extremes]") {
    constexpr std::size_t count = std::size_t(1) << 24;
    CHECK(lights::all_vpls()->memory_bytes(count) == 0);
    for (const char* type : {"lightcuts", "light_tree", "resampling"})
        CHECK(selection_of(type)->memory_bytes(count) < 150 * count);
    lights::VplSet vpls;
    vpls.lights.resize(100000);
    core::RayCounters rays;
    core::TrackingCounters tracking;
    core::Statistics statistics;
    const auto scene = scene_from(box(grey, ""), 8);
    CHECK_THROWS_WITH(selection_of("matrix", {{"slices", 4096}})
                          ->prepare({*scene, vpls, 1.0f, 1, rays, tracking, statistics, {}, {}}),
                      ContainsSubstring("100000 virtual point lights takes 4925 MB"));
    CHECK(selection_of("matrix", {{"rows", 64}})->memory_bytes(count) < lights::Selection::max_bytes);
}
