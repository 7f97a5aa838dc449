// KHR_lights_punctual: lights at a point or at infinity, along the -z axis of their node, whose scale leaves
// their strength as it is.
#include <cmath>

#include "core/formats/gltf/gltf_view.h"
#include "core/formats/gltf/photometry.h"
#include "core/formats/conversion/scene_xml.h"
#include "core/objects/error.h"

namespace mote::core {
namespace {

constexpr double widest_cone = 89.9;  // degrees

Rgb strength(const GltfValue& light) {
    const auto n = light["color"].numbers({1.0, 1.0, 1.0});
    const double intensity = light["intensity"].number(1.0);
    if (intensity < 0.0) light["intensity"].refuse("is negative");
    return Rgb(float(n[0]), float(n[1]), float(n[2])) * float(intensity / lumens_per_watt);
}

void add_spot(pugi::xml_node scene, const GltfNode& node, const GltfValue& light, const Rgb& intensity) {
    pugi::xml_node emitter = add_object(scene, "emitter", "spot");
    const Vec3d origin = node.to_world.point(Vec3d(0.0));
    const Vec3d direction = glm::normalize(node.to_world.vector({0, 0, -1}));
    pugi::xml_node transform = emitter.append_child("transform");
    transform.append_attribute("name") = "to_world";
    pugi::xml_node lookat = transform.append_child("lookat");
    lookat.append_attribute("origin") = vector_text(origin).c_str();
    lookat.append_attribute("target") = vector_text(origin + direction).c_str();
    lookat.append_attribute("up") = vector_text(node.to_world.vector({0, 1, 0})).c_str();
    add_rgb(emitter, "intensity", intensity);
    const double outer = glm::degrees(light["spot"]["outerConeAngle"].number(glm::radians(45.0)));
    const double inner = glm::degrees(light["spot"]["innerConeAngle"].number(0.0));
    if (!(outer > 0.0 && outer <= 90.001 && inner >= 0.0 && inner <= outer))
        light["spot"].refuse("has cones that are none: 0 <= inner <= outer <= pi / 2");
    add_float(emitter, "cutoff_angle", std::fmin(outer, widest_cone));
    add_float(emitter, "beam_width", std::fmin(inner, widest_cone));
}

void add_light(pugi::xml_node scene, const GltfNode& node, const GltfValue& light, const Rgb& value) {
    const std::string type = light["type"].text();
    if (type == "spot") return add_spot(scene, node, light, value);
    if (type == "point") {
        pugi::xml_node emitter = add_object(scene, "emitter", "point");
        add_value(emitter, "point", "position", vector_text(node.to_world.point(Vec3d(0.0))));
        return add_rgb(emitter, "intensity", value);
    }
    if (type != "directional")
        light["type"].refuse("is '" + printable(type, 20) + "': known are directional, point, spot");
    pugi::xml_node emitter = add_object(scene, "emitter", "directional");
    add_value(emitter, "vector", "direction", vector_text(glm::normalize(node.to_world.vector({0, 0, -1}))));
    add_rgb(emitter, "irradiance", value);
}

}  // namespace

std::size_t add_gltf_lights(pugi::xml_node scene, const GltfFile& file, const std::vector<GltfNode>& nodes,
                            ConversionReport& report) {
    const GltfValue lights = file.root()["extensions"]["KHR_lights_punctual"]["lights"];
    std::size_t count = 0;
    for (const GltfNode& node : nodes) {
        const GltfValue named = node.value["extensions"]["KHR_lights_punctual"]["light"];
        const auto number = named.index_below(lights.size());
        if (!number) continue;
        const GltfValue light = lights.at(*number);
        const Rgb value = strength(light);
        if (is_black(value)) continue;
        if (light["range"].present())
            report.note(light.title() +
                        " has a range: light falls with the square of the distance here, without end");
        add_light(scene, node, light, value);
        ++count;
    }
    return count;
}

}  // namespace mote::core
