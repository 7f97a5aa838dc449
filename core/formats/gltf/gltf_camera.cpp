// glTF cameras look along -z with +y up; ours are written by lookat, so that scales of nodes do not matter.
#include <cmath>

#include "core/formats/gltf/gltf_view.h"
#include "core/formats/conversion/scene_xml.h"
#include "core/objects/error.h"

namespace mote::core {
namespace {

constexpr double default_aspect = 4.0 / 3.0;
constexpr int default_height = 576;  // Mitsuba's film is 768 x 576

void add_film(pugi::xml_node sensor, double aspect) {
    if (!(aspect > 0.0)) aspect = default_aspect;
    pugi::xml_node film = add_object(sensor, "film", "hdrfilm");
    const double width = std::fmin(std::fmax(std::round(default_height * aspect), 1.0), 16384.0);
    add_value(film, "integer", "width", std::to_string(int(width)));
    add_value(film, "integer", "height", std::to_string(default_height));
    add_value(add_object(sensor, "sampler", "sobol"), "integer", "sample_count", "64");
}

void add_lookat(pugi::xml_node sensor, const Vec3d& origin, const Vec3d& target, const Vec3d& up,
                double scale) {
    pugi::xml_node transform = sensor.append_child("transform");
    transform.append_attribute("name") = "to_world";
    if (scale != 1.0) {
        pugi::xml_node node = transform.append_child("scale");
        for (const char* axis : {"x", "y"}) node.append_attribute(axis) = scale;
    }
    pugi::xml_node node = transform.append_child("lookat");
    node.append_attribute("origin") = vector_text(origin).c_str();
    node.append_attribute("target") = vector_text(target).c_str();
    node.append_attribute("up") = vector_text(up).c_str();
}

void add_clip_planes(pugi::xml_node sensor, const GltfValue& camera) {
    // A far plane that is not given is infinitely far.
    const double near = camera["znear"].number_in(0.01, 0.0, 1e30), far = camera["zfar"].number(0.0);
    if (near > 0.0) add_float(sensor, "near_clip", near);
    add_float(sensor, "far_clip", far > 0.0 ? far : 1e9);
}

void add_perspective(pugi::xml_node scene, const GltfNode& node, const GltfValue& camera) {
    pugi::xml_node sensor = add_object(scene, "sensor", "perspective");
    const double angle = camera["yfov"].number(0.0);
    if (!(angle > 0.0 && angle < 3.1415)) camera["yfov"].refuse("must lie between 0 and pi");
    add_value(sensor, "string", "fov_axis", "y");
    add_float(sensor, "fov", glm::degrees(angle));
    add_clip_planes(sensor, camera);
    const Vec3d origin = node.to_world.point(Vec3d(0.0));
    add_lookat(sensor, origin, origin + glm::normalize(node.to_world.vector({0, 0, -1})),
               node.to_world.vector({0, 1, 0}), 1.0);
    add_film(sensor, camera["aspectRatio"].number(default_aspect));
}

void add_orthographic(pugi::xml_node scene, const GltfNode& node, const GltfValue& camera) {
    pugi::xml_node sensor = add_object(scene, "sensor", "orthographic");
    const double x = camera["xmag"].number(0.0), y = camera["ymag"].number(0.0);
    if (!(x != 0.0 && y != 0.0)) camera.refuse("needs xmag and ymag");
    add_clip_planes(sensor, camera);
    const Vec3d origin = node.to_world.point(Vec3d(0.0));
    add_lookat(sensor, origin, origin + glm::normalize(node.to_world.vector({0, 0, -1})),
               node.to_world.vector({0, 1, 0}), std::fabs(x));
    add_film(sensor, std::fabs(x / y));
}

/// Distance from its center at which a box just fills the view along `forward`.
double distance_to_see(const Vec3d& half, const Vec3d& forward, double tan_x, double tan_y) {
    const Vec3d x = glm::normalize(glm::cross(forward, Vec3d(0, 1, 0))), y = glm::cross(x, forward);
    double distance = 0.0;
    for (int i = 0; i < 8; ++i) {
        const Vec3d corner = half * Vec3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        const double needed =
            std::fmax(std::fabs(glm::dot(corner, x)) / tan_x, std::fabs(glm::dot(corner, y)) / tan_y);
        distance = std::fmax(distance, needed - glm::dot(corner, forward));
    }
    return distance;
}

/// From in front, a little from the right and above: glTF models look along +z.
void add_overview(pugi::xml_node scene, const Bounds3& bounds) {
    constexpr double angle = 40.0, margin = 1.1;
    const Vec3d lower(bounds.lower), upper(bounds.upper), center = 0.5 * (lower + upper),
                                                          half = upper - center;
    const Vec3d forward = -glm::normalize(Vec3d(0.45, 0.3, 1.0));
    const double tan_y = std::tan(glm::radians(0.5 * angle));
    const double distance =
        margin * std::fmax(distance_to_see(half, forward, default_aspect * tan_y, tan_y), 1e-6);
    pugi::xml_node sensor = add_object(scene, "sensor", "perspective");
    add_value(sensor, "string", "fov_axis", "y");
    add_float(sensor, "fov", angle);
    add_float(sensor, "near_clip", 1e-3 * distance);
    add_float(sensor, "far_clip", 10.0 * (distance + glm::length(half)));
    add_lookat(sensor, center - distance * forward, center, {0, 1, 0}, 1.0);
    add_film(sensor, default_aspect);
}

struct Candidate {
    const GltfNode* node;
    GltfValue camera;
    std::string name;  ///< the node's where there is one, else the camera's
};

std::vector<Candidate> cameras_of(const GltfFile& file, const std::vector<GltfNode>& nodes) {
    const GltfValue cameras = file.root()["cameras"];
    std::vector<Candidate> found;
    for (const GltfNode& node : nodes) {
        const auto number = node.value["camera"].index_below(cameras.size());
        if (!number) continue;
        const GltfValue camera = cameras.at(*number);
        const std::string own = camera["name"].text("camera " + std::to_string(*number));
        found.push_back({&node, camera, node.value["name"].text(own)});
    }
    return found;
}

const Candidate& choose(const std::vector<Candidate>& all, const std::string& name, const GltfFile& file) {
    std::vector<std::string> names;
    for (const Candidate& c : all) {
        if (c.name == name || c.camera["name"].text() == name) return c;
        names.push_back(c.name);
    }
    throw InputError("has no camera '" + printable(name) + "'" + suggestion(name, names), {file.path(), 0});
}

}  // namespace

void add_gltf_camera(pugi::xml_node scene, const GltfFile& file, const std::vector<GltfNode>& nodes,
                     const std::string& name, const Bounds3& bounds, ConversionReport& report) {
    const std::vector<Candidate> all = cameras_of(file, nodes);
    if (all.empty() && name.empty()) {
        report.note("the scene has no camera: one that shows all of it stands in its place");
        return add_overview(scene, bounds);
    }
    const Candidate& c = name.empty() ? all.front() : choose(all, name, file);
    if (name.empty() && all.size() > 1) {
        std::string others;
        for (const Candidate& other : all) others += (others.empty() ? "" : ", ") + printable(other.name, 40);
        report.note("the first of " + std::to_string(all.size()) +
                    " cameras is used (-D camera=NAME chooses: " + others + ")");
    }
    const std::string type = c.camera["type"].text();
    if (type == "orthographic") return add_orthographic(scene, *c.node, c.camera["orthographic"]);
    if (type != "perspective")
        c.camera["type"].refuse("is '" + printable(type, 20) + "': known are perspective, orthographic");
    add_perspective(scene, *c.node, c.camera["perspective"]);
}

}  // namespace mote::core
