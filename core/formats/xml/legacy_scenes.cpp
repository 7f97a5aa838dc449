// Files of Mitsuba 0.x in today's words. Mitsuba 3 renames in the same way on reading; where it only renames,
// the old meaning is translated here as well.
#include <cctype>

#include "core/formats/xml/foreign_names.h"
#include "core/formats/xml/scene_values.h"
#include "core/math/srgb.h"
#include "core/objects/registry.h"

namespace mote::core {
namespace {

/// "diffuseReflectance" -> "diffuse_reflectance", "intIOR" -> "int_ior".
std::string snake_case(const std::string& name) {
    std::string result;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const auto c = static_cast<unsigned char>(name[i]);
        const bool after_lower = i > 0 && !std::isupper(static_cast<unsigned char>(name[i - 1]));
        if (std::isupper(c) && after_lower && result.back() != '_') result += '_';
        result += char(std::tolower(c));
    }
    return result;
}

void rename(Element& e, const char* from, const char* to) {
    if (Element* p = e.child(from)) p->set("name", to);
}

void remove(Element& e, const std::string& name) {
    std::erase_if(e.children, [&](const Element& c) { return c.get("name") == name; });
}

/// uscale, vscale, uoffset, voffset of textures as a to_uv transform.
void upgrade_texture(Element& e, std::vector<std::string>& warnings) {
    if (Element* filter = e.child("filter_type"); filter && filter->get("value") != "nearest") {
        if (filter->get("value") == "ewa" || filter->get("value") == "trilinear") {
            filter->set("value", "bilinear");
            warnings.push_back(InputError("texture filter is bilinear here", filter->where).what());
        }
    }
    rename(e, "wrap_mode_u", "wrap_mode");
    if (e.child("wrap_mode")) remove(e, "wrap_mode_v");
    if (Element* gamma = e.child("gamma")) {
        const double g = parse_number(gamma->get("value"), gamma->where);
        if (g == 1.0) {
            Element raw = e.make_value("boolean", "raw", "true");
            raw.where = gamma->where;
            e.children.push_back(raw);
        } else if (g != -1.0) {
            throw InputError("a texture's gamma other than 1 or -1 (sRGB) is not supported", gamma->where);
        }
        remove(e, "gamma");
    }
    const char* const names[] = {"uscale", "vscale", "uoffset", "voffset"};
    double values[] = {1.0, 1.0, 0.0, 0.0};
    bool any = false;
    for (int i = 0; i < 4; ++i)
        if (const Element* p = e.child(names[i])) {
            values[i] = parse_number(p->get("value"), p->where);
            any = true;
            remove(e, names[i]);
        }
    if (!any) return;
    Element transform = e.make_value("transform", "to_uv", "");
    transform.erase("value");
    Element scale = e, translate = e;
    for (Element* part : {&scale, &translate}) part->children.clear(), part->attributes.clear();
    scale.tag = "scale", translate.tag = "translate";
    scale.set("x", number_to_text(values[0])), scale.set("y", number_to_text(values[1]));
    translate.set("x", number_to_text(values[2])), translate.set("y", number_to_text(values[3]));
    transform.children = {scale, translate};
    e.children.push_back(transform);
}

/// <srgb> holds display values: "#b03020", or numbers of 0 to 1.
void upgrade_srgb(Element& e) {
    e.tag = "rgb";
    if (e.require("value").starts_with('#')) return;
    std::string text;
    for (const double v : parse_numbers(e.require("value"), e.where))
        text += (text.empty() ? "" : " ") + number_to_text(double(decode_srgb(float(v))));
    e.set("value", text);
}

void upgrade_element(Element& e, std::vector<std::string>& warnings) {
    if (e.tag == "lookAt") e.tag = "lookat";
    if (e.tag == "srgb") e.guard([&] { upgrade_srgb(e); });
    if (const std::string* name = e.find("name")) e.set("name", snake_case(*name));
    for (Element& c : e.children)
        if (c.legacy) upgrade_element(c, warnings);
    const std::string type = e.get("type");
    if (e.tag == "medium" && type == "heterogeneous") rename(e, "density", "sigma_t");
    if (e.tag == "bsdf" && type == "diffuse") rename(e, "diffuse_reflectance", "reflectance");
    if (e.tag == "texture") e.guard([&] { upgrade_texture(e, warnings); });
}

}  // namespace

void upgrade_legacy(Element& scene, std::vector<std::string>& warnings) {
    for (Element& e : scene.children)
        if (e.legacy) upgrade_element(e, warnings);
}

}  // namespace mote::core
