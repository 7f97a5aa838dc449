// Light sources of pbrt-v4 (its lights.cpp) by type. A light's colour times `scale` is its radiance or
// intensity; `power` and `illuminance` replace it, for a colour of luminance 1.
#include "core/formats/pbrt/pbrt_lights.h"

#include <cmath>
#include <numbers>

#include "core/formats/conversion/scene_xml.h"
#include "core/formats/pictures/image_file.h"

namespace mote::core {
namespace {

/// Factor on a light's colour; `unit`: power or illuminance of the light of colour 1 and scale 1.
double strength(const PbrtObject& light, const char* target, double unit, double exposure) {
    const double scale = light.number("scale", 1.0) * exposure, wanted = light.number(target, -1.0);
    if (scale < 0.0) throw InputError("the scale of a light is negative", light.where);
    return wanted > 0.0 && unit > 0.0 ? scale * wanted / unit : scale;
}

/// Turns +z to `direction`, at `origin`.
void add_placement(pugi::xml_node emitter, const Vec3d& origin, const Vec3d& direction) {
    const Vec3d d = glm::normalize(direction);
    pugi::xml_node transform = emitter.append_child("transform");
    transform.append_attribute("name") = "to_world";
    pugi::xml_node look = transform.append_child("lookat");
    look.append_attribute("origin") = vector_text(origin).c_str();
    look.append_attribute("target") = vector_text(origin + d).c_str();
    look.append_attribute("up") = std::fabs(d.y) < 0.9 ? "0, 1, 0" : "1, 0, 0";
}

struct Light {
    pugi::xml_node scene;
    const PbrtObject& object;
    const Transform& to_world;
    double exposure;
    const std::string& medium;
    PbrtFiles& files;

    pugi::xml_node add(const char* type) const {
        pugi::xml_node emitter = add_object(scene, "emitter", type);
        if (!medium.empty()) add_ref(emitter, medium, "medium");
        return emitter;
    }
    Rgb color(const char* name, double factor) const {
        return pbrt_light_color(object, name, files) * float(factor);
    }
    Vec3d from() const { return object.point("from", Vec3d(0.0)); }
    Vec3d beam() const {
        const Vec3d d = to_world.vector(object.point("to", {0, 0, 1}) - from());
        if (!(glm::length(d) > 0.0))
            throw InputError("a light has no direction: 'from' and 'to' are the same", object.where);
        return d;
    }
};

void add_point(const Light& l) {
    pugi::xml_node emitter = l.add("point");
    add_value(emitter, "point", "position", vector_text(l.to_world.point(l.from())));
    add_rgb(emitter, "intensity",
            l.color("I", strength(l.object, "power", 4.0 * std::numbers::pi, l.exposure)));
}

void add_distant(const Light& l) {
    pugi::xml_node emitter = add_object(l.scene, "emitter", "directional");
    add_value(emitter, "vector", "direction", vector_text(glm::normalize(l.beam())));
    add_rgb(emitter, "irradiance", l.color("L", strength(l.object, "illuminance", 1.0, l.exposure)));
}

/// Between the two cones intensity falls as a smooth step of the cosine; ours, linear in the angle, crosses
/// one half at nearly the same place.
void add_spot(const Light& l) {
    const double outer = l.object.number("coneangle", 30.0),
                 inner = outer - l.object.number("conedeltaangle", 5.0);
    if (!(outer > 0.0 && outer < 180.0))
        throw InputError("'coneangle' must lie between 0 and 180", l.object.where);
    const double c0 = std::cos(glm::radians(inner)), c1 = std::cos(glm::radians(outer));
    const double unit = 2.0 * std::numbers::pi * ((1.0 - c0) + (c0 - c1) / 2.0);
    if (inner < outer)
        l.files.note("the rim of a spot light falls off linearly in the angle, smoothly in pbrt");
    pugi::xml_node emitter = l.add("spot");
    add_placement(emitter, l.to_world.point(l.from()), l.beam());
    add_rgb(emitter, "intensity", l.color("I", strength(l.object, "power", unit, l.exposure)));
    add_float(emitter, "cutoff_angle", std::fmin(outer, 89.9));
    add_float(emitter, "beam_width", std::clamp(inner, 0.0, 89.9));
}

/// The mean of the picture as the intensity of a point light.
void add_goniometric(const Light& l) {
    l.files.fault(l.object.where, "the light 'goniometric' has no counterpart here",
                  "a point light of its mean intensity stands in its place");
    double mean = 1.0;
    if (const PbrtParameter* p = l.object.find("filename")) {
        const Bitmap b = read_bitmap(l.files.find(l.object.text("filename", ""), p->where), false);
        mean = 0.0;
        for (const Rgb& c : b.pixels) mean += double(c.x + c.y + c.z) / 3.0 / double(b.pixels.size());
    }
    pugi::xml_node emitter = l.add("point");
    add_value(emitter, "point", "position", vector_text(l.to_world.point(Vec3d(0.0))));
    add_rgb(emitter, "intensity",
            l.color("I", mean * strength(l.object, "power", 4.0 * std::numbers::pi * mean, l.exposure)));
}

/// pbrt's picture is intensity over the screen at distance 1, x to the right; ours has x to the left, and is
/// multiplied by pi.
void add_projection(const Light& l) {
    const PbrtParameter* p = l.object.find("filename");
    if (!p) throw InputError("the light 'projection' needs a filename", l.object.where);
    if (l.object.find("power"))
        l.files.fault(p->where, "the power of a projected picture is not computed here",
                      "scale alone counts");
    l.files.note(
        "a projected picture is irradiance at distance 1 here and intensity in pbrt: it differs off the "
        "axis");
    pugi::xml_node emitter = l.add("projector");
    pugi::xml_node picture = add_object(emitter, "texture", "bitmap", "irradiance");
    add_value(picture, "string", "filename", l.files.use(l.object.text("filename", ""), p->where));
    add_float(emitter, "scale", strength(l.object, "power", 0.0, l.exposure) / std::numbers::pi);
    add_transform(emitter, "to_world", l.to_world * Transform(glm::scale(glm::dmat4(1.0), {-1.0, 1.0, 1.0})));
    add_float(emitter, "fov", l.object.number("fov", 90.0));
    add_value(emitter, "string", "fov_axis", "smaller");
}

void add_infinite(const Light& l) {
    if (l.object.find("portal"))
        l.files.note("portals of infinite lights are ignored: they only guide sampling in closed rooms");
    if (l.object.find("filename")) {
        try {
            return add_pbrt_environment(l.scene, l.object, l.to_world, l.exposure, l.files);
        } catch (const InputError& error) {
            l.files.fault(error, "white light stands in its place");
        }
    }
    pugi::xml_node emitter = add_object(l.scene, "emitter", "constant");
    add_rgb(emitter, "radiance",
            l.color("L", strength(l.object, "illuminance", std::numbers::pi, l.exposure)));
}

}  // namespace

void add_pbrt_light(pugi::xml_node scene, const PbrtObject& light, const Transform& to_world, double exposure,
                    const std::string& medium, PbrtFiles& files) {
    static const std::map<std::string, void (*)(const Light&)> table = {{"point", add_point},
                                                                        {"distant", add_distant},
                                                                        {"spot", add_spot},
                                                                        {"goniometric", add_goniometric},
                                                                        {"projection", add_projection},
                                                                        {"infinite", add_infinite}};
    const auto it = table.find(light.type);
    if (it == table.end()) {
        std::vector<std::string> known;
        for (const auto& [name, add] : table) known.push_back(name);
        throw InputError("unknown light '" + printable(light.type, 40) + "'" + suggestion(light.type, known),
                         light.where);
    }
    if (!to_world.valid()) throw InputError("the transform of a light is singular", light.where);
    pugi::xml_document written;
    it->second({written, light, to_world, exposure, medium, files});
    for (const pugi::xml_node node : written) scene.append_copy(node);
    for (const InputError& error : light.unknown()) files.fault(error, "ignored");
}

bool pbrt_is_two_sided(const PbrtObject* light) { return light && light->flag("twosided", false); }

void add_pbrt_area_light(pugi::xml_node shape, const PbrtObject& light, double area, double exposure,
                         PbrtTextures& textures, PbrtFiles& files) {
    if (light.type != "diffuse")
        throw InputError("unknown area light '" + printable(light.type, 40) + "' (known: diffuse)",
                         light.where);
    double unit = (pbrt_is_two_sided(&light) ? 2.0 : 1.0) * area * std::numbers::pi;
    PbrtTexturePtr picture;
    if (const PbrtParameter* p = light.find("filename")) {
        picture = textures.picture(light.text("filename", ""), p->where, false);
        unit *= double(luminance(picture->mean()));
    }
    const float factor = float(strength(light, "power", unit, exposure));
    pugi::xml_node emitter = add_object(shape, "emitter", "area");
    if (picture) {
        textures.add(emitter, "radiance", picture, false);
        add_float(emitter, "scale", double(factor));
    } else {
        add_rgb(emitter, "radiance", pbrt_light_color(light, "L", files) * factor);
    }
    for (const InputError& error : light.unknown()) files.fault(error, "ignored");
}

}  // namespace mote::core
