// Walks through what is nested in a shape.
#include "core/formats/xml/attribute_checks.h"

#include "core/formats/xml/scene_values.h"

namespace mote::core {
namespace {

const Element* value_of(const Element& object, const std::string& name) {
    for (const Element& c : object.children)
        if (is_value_tag(c.tag) && c.get("name") == name) return &c;
    return nullptr;
}

void check_texture(const Element& texture, bool light, const Shape& shape) {
    const Element* name_value = value_of(texture, "name");
    if (!name_value) return;  // the factory has complained
    const std::string name = name_value->get("value");
    const Element* scale_value = value_of(texture, "scale");
    const auto scale =
        scale_value ? float(parse_number(scale_value->get("value"), scale_value->where)) : 1.0f;
    const SurfaceAttributes* attributes = shape.attributes();
    if (!attributes || !attributes->has_attribute(name))
        throw InputError("a shape that uses this texture has no attribute '" + printable(name) + "'",
                         texture.where);
    const Vec2 range = scale * attributes->attribute_range(name);
    constexpr float rounding = 1e-5f;
    const float largest = light ? 1e30f : 1.0f + rounding;
    if (!(range.x >= 0.0f && range.y <= largest))
        throw InputError("attribute '" + printable(name) + "' has values from " +
                             number_to_text(double(range.x)) + " to " + number_to_text(double(range.y)) +
                             " but they must " + (light ? "not be negative" : "lie between 0 and 1"),
                         texture.where);
}

void check_below(const Element& element, bool light, const Shape& shape, const IdTable& ids) {
    if (element.tag == "texture" && element.get("type") == "mesh_attribute")
        check_texture(element, light, shape);
    for (const Element& c : element.children)
        if (!is_value_tag(c.tag)) check_below(resolve(c, ids), light, shape, ids);
}

}  // namespace

void check_mesh_attributes(const Element& element, const Shape& shape, const IdTable& ids) {
    for (const Element& c : element.children) {
        if (is_value_tag(c.tag)) continue;
        const Element& nested = resolve(c, ids);
        if (nested.tag == "bsdf" || nested.tag == "emitter")
            check_below(nested, nested.tag == "emitter", shape, ids);
    }
}

}  // namespace mote::core
