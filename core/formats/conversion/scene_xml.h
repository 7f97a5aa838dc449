// Elements of the scene language, for writers of scenes.
#pragma once

#include <pugixml.hpp>
#include <string>

#include "core/math/transform.h"
#include "core/math/vec.h"

namespace mote::core {

/// <tag type="..." name="..." id="...">; what is "" is left out.
pugi::xml_node add_object(pugi::xml_node parent, const char* tag, const std::string& type,
                          const std::string& name = "", const std::string& id = "");
/// <tag name="..." value="..."/>.
void add_value(pugi::xml_node parent, const char* tag, const std::string& name, const std::string& value);
/// The shortest text that reads back as the same number.
void add_float(pugi::xml_node parent, const std::string& name, double value);
void add_rgb(pugi::xml_node parent, const std::string& name, const Rgb& value);
/// <transform name="..."> with a matrix, row by row.
void add_transform(pugi::xml_node parent, const std::string& name, const Transform& value);
void add_ref(pugi::xml_node parent, const std::string& id, const std::string& name = "");

/// "x, y, z".
std::string vector_text(const Vec3d& v);

}  // namespace mote::core
