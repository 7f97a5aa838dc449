// Attributes and children of an element by name.
#include "core/formats/xml/scene_element.h"

#include <algorithm>

namespace mote::core {

const std::string* Element::find(std::string_view name) const {
    for (const auto& [key, value] : attributes)
        if (key == name) return &value;
    return nullptr;
}

std::string Element::get(std::string_view name) const {
    const std::string* value = find(name);
    return value ? *value : std::string();
}

void Element::set(std::string_view name, std::string value) {
    for (auto& [key, old] : attributes)
        if (key == name) {
            old = std::move(value);
            return;
        }
    attributes.emplace_back(std::string(name), std::move(value));
}

void Element::erase(std::string_view name) {
    std::erase_if(attributes, [&](const auto& attribute) { return attribute.first == name; });
}

Element* Element::child(std::string_view name) {
    for (Element& c : children)
        if (const std::string* n = c.find("name"); n && *n == name) return &c;
    return nullptr;
}

Element* Element::child_with_tag(std::string_view tag_name) {
    for (Element& c : children)
        if (c.tag == tag_name) return &c;
    return nullptr;
}

Element Element::make_value(std::string_view value_tag, std::string_view name, std::string value) const {
    Element e;
    e.tag = value_tag;
    e.where = where;
    e.folder = folder;
    e.attributes = {{"name", std::string(name)}, {"value", std::move(value)}};
    return e;
}

void Element::check_attributes(const std::vector<std::string>& known) const {
    for (const auto& [key, value] : attributes)
        if (std::find(known.begin(), known.end(), key) == known.end())
            throw InputError(
                "<" + printable(tag) + "> has no attribute '" + printable(key) + "'" + suggestion(key, known),
                where);
}

const std::string& Element::require(std::string_view name) const {
    if (const std::string* value = find(name)) return *value;
    throw InputError("<" + printable(tag) + "> needs the attribute '" + std::string(name) + "'", where);
}

}  // namespace mote::core
