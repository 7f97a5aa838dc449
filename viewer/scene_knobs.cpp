#include "viewer/scene_knobs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "core/formats/xml/element_checks.h"
#include "core/formats/xml/scene_defines.h"
#include "core/objects/registry.h"
#include "core/scene/camera.h"

namespace mote::viewer {

namespace {

using core::Element, core::Parameter;
using nlohmann::json;

const Element* child_of(const Element& element, const std::string& name) {
    for (const Element& c : element.children)
        if (c.get("name") == name) return &c;
    return nullptr;
}

/// The nested object that a parameter holds: by its name, or the only one of its category.
const Element* object_of(const Element& element, const Parameter& parameter) {
    for (const Element& c : element.children)
        if (c.tag == parameter.type && (!c.find("name") || c.get("name") == parameter.name)) return &c;
    return nullptr;
}

json knob(const Parameter& p, const std::string& path, const std::string& type, const std::string& value) {
    json k = {{"path", path},
              {"name", p.name},
              {"type", type},
              {"value", value},
              {"unit", p.range.unit},
              {"default", p.default_value},
              {"choices", p.choices},
              {"values", core::values_text(p)},
              {"sentence", p.description}};
    if (std::isfinite(p.range.lower)) k["lower"] = p.range.lower;
    if (std::isfinite(p.range.upper)) k["upper"] = p.range.upper;
    return k;
}

bool is_plain(const std::string& type) {
    return type == "boolean" || type == "integer" || type == "float" || type == "string" || type == "rgb";
}

/// Where a manual page allows a texture or volume, a number or colour in its place.
std::string plain_type(const Parameter& p, const Element* value) {
    if (is_plain(p.type)) return p.type;
    if (p.type != "texture" && p.type != "volume") return "";
    if (value && (value->tag == "rgb" || value->tag == "float")) return value->tag;
    return value || p.required ? "" : "rgb";
}

class KnobList {
  public:
    explicit KnobList(const core::Registry& registry) : registry_(registry) {}

    /// All parameters of an object, those of nested objects included.
    void add(json& knobs, const Element& element, const std::string& path) const {
        const auto category = core::find_category(element.tag);
        const core::Manual* manual = category ? registry_.find(*category, element.get("type")) : nullptr;
        if (!manual) return;
        for (const Parameter& p : manual->parameters) add_parameter(knobs, element, p, path + "." + p.name);
    }

  private:
    void add_parameter(json& knobs, const Element& element, const Parameter& p,
                       const std::string& path) const {
        if (p.name == "filename") return;
        const Element* value = child_of(element, p.name);
        if (const std::string type = plain_type(p, value); !type.empty()) {
            knobs.push_back(knob(p, path, type, value ? value->get("value") : ""));
        } else if (const auto category = core::find_category(p.type);
                   category && (element.tag == "integrator" || is_nested(element.tag))) {
            const Element* object = object_of(element, p);
            json k = knob(p, path, "object", object ? object->get("type") : "");
            k["choices"] = registry_.types(*category);
            knobs.push_back(std::move(k));
            if (object) add(knobs, *object, path);
        }
    }
    static bool is_nested(const std::string& tag) {
        return tag == "compensation" || tag == "visibility" || tag == "selection";
    }

    const core::Registry& registry_;
};

/// Elements of these tags in the order in which "tag:2" counts them, each with its path.
class PathFinder {
  public:
    explicit PathFinder(const Element& scene) { visit(scene); }
    const std::vector<std::pair<std::string, const Element*>>& found() const { return found_; }

  private:
    void visit(const Element& parent) {
        for (const Element& c : parent.children) {
            if (c.tag == "medium" || c.tag == "emitter") {
                const int number = ++counts_[c.tag];
                found_.emplace_back(c.find("id") ? c.get("id") : c.tag + ":" + std::to_string(number), &c);
            } else {
                visit(c);
            }
        }
    }
    std::map<std::string, int> counts_;
    std::vector<std::pair<std::string, const Element*>> found_;
};

json group(const std::string& title, const std::string& kind) {
    return {{"title", title}, {"kind", kind}, {"knobs", json::array()}};
}

void write_element(const Element& e, int depth, std::string& text) {
    const std::string indent(std::size_t(4 * depth), ' ');
    text += indent + "<" + e.tag;
    for (const auto& [name, value] : e.attributes) {
        text += " " + name + "=\"";
        for (const char c : value) {
            if (c == '&')
                text += "&amp;";
            else if (c == '<')
                text += "&lt;";
            else if (c == '"')
                text += "&quot;";
            else
                text += c;
        }
        text += "\"";
    }
    if (e.children.empty()) {
        text += "/>\n";
        return;
    }
    text += ">\n";
    for (const Element& c : e.children) write_element(c, depth + 1, text);
    text += indent + "</" + e.tag + ">\n";
}

/// The integrator that renders becomes one of this type, as with `--integrator`.
void set_integrator(Element& scene, const std::string& type, const core::Registry& registry) {
    const auto first =
        std::ranges::find_if(scene.children, [](const Element& e) { return e.tag == "integrator"; });
    Element chosen;
    chosen.tag = "integrator", chosen.folder = scene.folder;
    if (first != scene.children.end()) chosen = *first;
    for (const Element& e : scene.children)
        if (e.tag == "integrator" && e.get("type") == type) chosen = e;
    std::erase_if(scene.children, [](const Element& e) { return e.tag == "integrator"; });
    chosen.set("type", type);
    if (const core::Manual* manual = registry.find(core::Category::integrator, type))
        std::erase_if(chosen.children, [&](const Element& c) { return !core::has_place_for(*manual, c); });
    scene.children.insert(scene.children.begin(), chosen);
}

}  // namespace

Element changed_elements(const session::LoadedScene& scene, const session::SceneChanges& changes) {
    Element elements = scene.elements();
    if (!changes.integrator.empty()) set_integrator(elements, changes.integrator, scene.registry());
    for (const auto& [path, value] : changes.defines) {
        if (path.find('.') == std::string::npos) continue;  // a $parameter, which loading has applied
        try {
            core::set_by_path(elements, path, value, scene.registry(), {});
        } catch (const core::InputError&) {  // reported by the render
        }
    }
    return elements;
}

json scene_knobs(const Element& elements, const core::Registry& registry) {
    const KnobList list(registry);
    json groups = json::array();
    for (const Element& e : elements.children) {
        if (e.tag != "integrator" || !groups.empty()) continue;
        json integrator = group("integrator", "integrator");
        integrator["type"] = e.get("type"), integrator["types"] = registry.types(core::Category::integrator);
        list.add(integrator["knobs"], e, "integrator");
        groups.push_back(std::move(integrator));
    }
    const PathFinder finder(elements);
    for (const auto& [path, found] : finder.found()) {
        json g = group(found->tag + " " + path, found->tag);
        g["type"] = found->get("type");
        list.add(g["knobs"], *found, path);
        groups.push_back(std::move(g));
    }
    return groups;
}

json camera_view(const session::LoadedScene& scene) {
    const core::Camera& camera = scene.scene().camera();
    const core::FilmSettings& film = scene.scene().film();
    const core::Transform to_world = camera.to_world();
    const core::Vec3d origin = to_world.point(core::Vec3d(0.0));
    const core::Vec3d forward = glm::normalize(to_world.vector(core::Vec3d(0, 0, 1)));
    const core::Vec3d up = glm::normalize(to_world.vector(core::Vec3d(0, 1, 0)));
    const core::Ray middle =
        camera.sample_ray(0.5f * core::Vec2(float(film.width), float(film.height)), core::Vec2(0.5f));
    const auto hit = scene.scene().first_hit(middle);
    const core::Bounds3 bounds = scene.scene().bounds();
    const double distance =
        hit ? glm::distance(origin, core::Vec3d(hit->position)) : std::max(1e-3, double(bounds.radius()));
    const core::Vec3d target = origin + distance * forward;
    return {{"origin", {origin.x, origin.y, origin.z}},
            {"target", {target.x, target.y, target.z}},
            {"up", {up.x, up.y, up.z}},
            {"radius", bounds.radius()}};
}

std::string scene_xml(const Element& scene) {
    std::string text = "<?xml version=\"1.0\"?>\n";
    write_element(scene, 0, text);
    return text;
}

}  // namespace mote::viewer
