// Writing elements.
#include "core/formats/conversion/scene_xml.h"

#include <fmt/format.h>

namespace mote::core {

pugi::xml_node add_object(pugi::xml_node parent, const char* tag, const std::string& type,
                          const std::string& name, const std::string& id) {
    pugi::xml_node node = parent.append_child(tag);
    node.append_attribute("type") = type.c_str();
    if (!name.empty()) node.append_attribute("name") = name.c_str();
    if (!id.empty()) node.append_attribute("id") = id.c_str();
    return node;
}

void add_value(pugi::xml_node parent, const char* tag, const std::string& name, const std::string& value) {
    pugi::xml_node node = parent.append_child(tag);
    node.append_attribute("name") = name.c_str();
    node.append_attribute("value") = value.c_str();
}

void add_float(pugi::xml_node parent, const std::string& name, double value) {
    add_value(parent, "float", name, fmt::format("{}", value));
}

void add_rgb(pugi::xml_node parent, const std::string& name, const Rgb& value) {
    add_value(parent, "rgb", name, fmt::format("{}, {}, {}", value.x, value.y, value.z));
}

void add_transform(pugi::xml_node parent, const std::string& name, const Transform& value) {
    std::string text;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            text += (text.empty() ? "" : " ") + fmt::format("{}", value.matrix[column][row]);
    pugi::xml_node node = parent.append_child("transform");
    node.append_attribute("name") = name.c_str();
    node.append_child("matrix").append_attribute("value") = text.c_str();
}

void add_ref(pugi::xml_node parent, const std::string& id, const std::string& name) {
    pugi::xml_node node = parent.append_child("ref");
    if (!name.empty()) node.append_attribute("name") = name.c_str();
    node.append_attribute("id") = id.c_str();
}

std::string vector_text(const Vec3d& v) { return fmt::format("{}, {}, {}", v.x, v.y, v.z); }

}  // namespace mote::core
