#include "viewer/scene_knobs.h"

#include <nlohmann/json.hpp>

#include "core/formats/xml/scene_element.h"
#include "core/scene/camera.h"

#include "tests/support/catch.h"

using namespace mote;

namespace {

session::LoadedScene box(const session::SceneChanges& changes = {}) {
    return session::LoadedScene::from_file(std::string(MOTE_SOURCE_DIR) + "/scenes/cornell_box.xml", changes);
}

nlohmann::json find(const nlohmann::json& groups, const std::string& path) {
    for (const auto& group : groups)
        for (const auto& knob : group["knobs"])
            if (knob["path"] == path) return knob;
    return nullptr;
}

}  // namespace

TEST_CASE("Knobs are the declared parameters, and their paths set them", "[viewer][knobs]") {
    const session::LoadedScene scene = box();
    const session::SceneChanges changes{
        "mote_vpl", {{"integrator.paths", "77"}, {"integrator.compensation", "approximate"}}, false};
    const core::Element elements = viewer::changed_elements(scene, changes);
    const nlohmann::json knobs = viewer::scene_knobs(elements, scene.registry());
    CHECK(find(knobs, "integrator.paths")["value"] == "77");
    CHECK(find(knobs, "integrator.compensation")["value"] == "approximate");
    CHECK(!find(knobs, "integrator.compensation.depth").is_null());
    CHECK(find(knobs, "emitter:1.radiance")["unit"] == "W/(m^2 sr)");
    CHECK(box({"", {{"emitter:1.radiance", "1 2 3"}}, false}).scene().emitters().size() == 1);
}

TEST_CASE("The scene file of the page loads as what it shows", "[viewer][knobs]") {
    const session::SceneChanges changes{
        "path", {{"sensor.to_world", "1 2 -8 1 2 0 0 1 0"}, {"film.width", "17"}}, false};
    const std::string xml = viewer::scene_xml(viewer::changed_elements(box(), changes));
    const session::LoadedScene again =
        session::LoadedScene::from_text(xml, std::string(MOTE_SOURCE_DIR) + "/scenes");
    CHECK(again.scene().film().width == 17);
    CHECK(again.integrator().type() == "path");
    CHECK(again.scene().camera().position() == core::Vec3(1, 2, -8));
    const nlohmann::json camera = viewer::camera_view(again);
    CHECK(camera["origin"][2] == -8.0);
    CHECK(camera["up"][1] == 1.0);
}

TEST_CASE("A scene is loaded again with other changes", "[viewer][knobs]") {
    const session::LoadedScene scene = box();
    const session::LoadedScene other = scene.reloaded({"path", {{"film.width", "33"}}, false});
    CHECK(scene.scene().film().width == 400);
    CHECK(other.scene().film().width == 33);
    CHECK(other.integrator().type() == "path");
    CHECK(other.scene_hash() == box({"path", {{"film.width", "33"}}, false}).scene_hash());
}
