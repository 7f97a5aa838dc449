// Every scene file by others either loads, or is refused with a line that says what is not supported.
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>

#include "core/formats/xml/mitsuba_features.h"
#include "core/formats/xml/scene_loader.h"
#include "integrators/register_integrators.h"
#include "lights/register_lights.h"
#include "media/register_media.h"
#include "tests/core/scene/scene_fixture.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

Registry full_registry() {
    Registry registry;
    register_core(registry);
    mote::media::register_media(registry);
    mote::lights::register_lights(registry);
    mote::integrators::register_integrators(registry);
    return registry;
}

/// The message that loading ends with, "" for success; the number of warnings is added to `warnings`.
std::string outcome(const std::function<std::unique_ptr<Scene>()>& loading, std::size_t& warnings) {
    try {
        warnings += loading()->parts().warnings.size();
        return "";
    } catch (const InputError& error) {
        return error.what();
    }
}

}  // namespace

TEST_CASE("Scene files by others load, but for a grid that is itself at fault", "[scene][data]") {
    const auto folder = test_data("scenes");
    if (!folder) return;
    const Registry registry = full_registry();
    int loaded = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder)) {
        if (entry.path().extension() != ".xml") continue;
        const std::string path = entry.path().string();
        INFO(path);
        std::size_t warnings = 0;
        const std::string message = outcome([&] { return load_scene(path, registry); }, warnings);
        INFO(message);
        if (path.find("hetvol_colored") == std::string::npos) {
            CHECK(message.empty());
            ++loaded;
            continue;
        }
        CHECK(contains(message, "is negative"));
        LoadOptions lenient;
        LoadReport report;
        lenient.lenient = true, lenient.report = &report;
        load_scene(path, registry, lenient);
        REQUIRE(report.approximations.size() == 1);
        CHECK(contains(report.approximations[0], "is negative"));
        CHECK(contains(report.approximations[0], ": negative values count as 0"));
    }
    std::cout << "scene files by others: " << loaded << " loaded\n";
    CHECK(loaded == 17);
}

TEST_CASE("The table of Mitsuba's plugins agrees with the registry", "[scene][foreign]") {
    const Registry registry = full_registry();
    std::map<std::string, int> states;
    for (const MitsubaFeature& f : mitsuba_features(registry)) {
        INFO(category_name(f.category) << " " << f.type);
        const bool ours = registry.find(f.category, f.type) != nullptr;
        CHECK((f.state == "supported") == ours);
        CHECK((ours || f.remark != ""));
        ++states[f.state];
        if (f.state != "approximated" || f.category != Category::integrator) continue;
        // Loading does as the table says.
        const bool wraps = !f.remark.starts_with('`');  // else it is called one of ours
        const std::string nested = wraps ? "<integrator type='path'/>" : "";
        const auto scene = load_scene_from_string(
            scene_xml("<shape type='sphere'/><integrator type='" + f.type + "'>" + nested + "</integrator>"),
            ".", registry);
        CHECK(scene->integrator() != nullptr);
    }
    CHECK(states["supported"] >= 35);
    CHECK(states["approximated"] >= 10);
    CHECK(states.size() == 3);
}

TEST_CASE("Idioms of Mitsuba's tutorials load", "[scene][foreign]") {
    const Registry registry = full_registry();
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.file("fragments"));
    std::ofstream(folder.file("fragments/materials.xml"))
        << "<scene version='3.0.0'><bsdf type='twosided' id='wall'><bsdf type='diffuse' id='inner'>"
           "<rgb name='reflectance' value='0.4, 0.5, 0.6'/></bsdf></bsdf></scene>";
    const std::string path = folder.file("scene.xml");
    std::ofstream(path) << R"(<scene version="3.0.0">
        <default name="spp" value="8"/><default name="integrator" value="volpath"/><default name="max_depth" value="4"/>
        <path value="fragments"/><include filename="materials.xml"/>
        <integrator type="$integrator"><integer name="max_depth" value="$max_depth"/></integrator>
        <sensor type="perspective" id="camera"><string name="fov_axis" value="smaller"/>
            <float name="focus_distance" value="5"/>
            <transform name="to_world"><lookat origin="0 0 4" target="0 0 0" up="0 1 0"/></transform>
            <sampler type="multijitter"><integer name="sample_count" value="$spp"/></sampler>
            <film type="hdrfilm"><string name="pixel_format" value="rgba"/><rfilter type="gaussian"/></film></sensor>
        <medium type="homogeneous" id="fog"><float name="scale" value="2"/><phase type="hg"/></medium>
        <shape type="cube"><bsdf type="null"/><ref name="interior" id="fog"/></shape>
        <shape type="sphere"><ref id="wall"/></shape>
        <shape type="rectangle"><ref id="inner"/><emitter type="area"><spectrum name="radiance" value="3"/></emitter></shape>
    </scene>)";
    for (const char* integrator : {"volpath", "path", "direct", "ptracer", "volpathmis"}) {
        INFO(integrator);
        LoadOptions options;
        options.defines = {{"integrator", integrator}};
        const auto scene = load_scene(path, registry, options);
        CHECK(scene->film().sample_count == 8);
        CHECK(scene->shapes().size() == 3);
        CHECK(scene->integrator() != nullptr);
    }
}
