// Small things that all parts of the export need.
#include "apps/export/export_context.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "core/formats/xml/scene_values.h"

namespace mote::apps {

using core::Element;

namespace fs = std::filesystem;

void ExportContext::note(const Element& where, const std::string& text) const {
    const std::string line = core::InputError(text, where.where).what();
    if (std::find(result.notes.begin(), result.notes.end(), line) == result.notes.end())
        result.notes.push_back(line);
}

std::string ExportContext::free_name(const std::string& folder, const std::string& stem,
                                     const std::string& extension) const {
    const auto taken = [&](const std::string& name) {
        return result.copies.count(name) || result.grids.count(name) || result.meshes.count(name);
    };
    std::string name = folder + "/" + stem + extension;
    for (int i = 2; taken(name); ++i) name = folder + "/" + stem + "_" + std::to_string(i) + extension;
    return name;
}

std::string ExportContext::find_file(const Element& object) const {
    core::Properties p;
    p.category = *core::find_category(object.tag), p.type = object.get("type"), p.where = object.where;
    p.search_paths = document.search_paths;
    p.search_paths.insert(p.search_paths.begin(), object.folder);
    for (const Element& c : object.children)
        if (c.get("name") == "filename") p.values["filename"] = {c.get("value"), c.where};
    return p.find_file("filename");
}

void ExportContext::copy_file(Element& object, const std::string& folder) const {
    const std::string source = find_file(object);
    const auto same = std::find_if(result.copies.begin(), result.copies.end(),
                                   [&](const auto& copy) { return copy.second == source; });
    std::string name = same == result.copies.end() ? "" : same->first;
    if (name.empty()) {
        name = free_name(folder, fs::path(source).stem().string(), fs::path(source).extension().string());
        result.copies[name] = source;
    }
    set_child(object, object.make_value("string", "filename", name));
}

Element make_object(const Element& parent, const std::string& tag, const std::string& type,
                    const std::string& name) {
    Element e;
    e.tag = tag, e.where = parent.where, e.folder = parent.folder;
    e.set("type", type);
    if (!name.empty()) e.set("name", name);
    return e;
}

Element make_reference(const Element& parent, const std::string& name, const std::string& id) {
    Element e;
    e.tag = "ref", e.where = parent.where, e.folder = parent.folder;
    e.set("name", name);
    e.set("id", id);
    return e;
}

Element make_rgb(const Element& parent, const std::string& name, const core::Rgb& value) {
    std::string text;
    for (int c = 0; c < 3; ++c) {
        char number[32];
        std::snprintf(number, sizeof number, "%.9g", double(value[c]));
        text += (c ? ", " : "") + std::string(number);
    }
    return parent.make_value("rgb", name, text);
}

void set_child(Element& parent, Element child) {
    if (Element* old = parent.child(child.get("name")))
        *old = std::move(child);
    else
        parent.children.push_back(std::move(child));
}

bool remove_child(Element& parent, const std::string& name) {
    return std::erase_if(parent.children, [&](const Element& c) { return c.get("name") == name; }) > 0;
}

core::Rgb colour_of(const Element& value, bool emission) {
    std::vector<std::string> warned_already;  // when the scene was built
    const core::PropertyValue v = core::parse_value(value, emission, warned_already);
    if (const auto* rgb = std::get_if<core::Rgb>(&v)) return *rgb;
    if (const auto* number = std::get_if<double>(&v)) return core::Rgb(float(*number));
    return core::Rgb(float(std::get<std::int64_t>(v)));
}

core::Transform transform_of(Element& object, const std::string& name) {
    Element* transform = object.child(name);
    return transform ? core::parse_transform(*transform) : core::Transform();
}

}  // namespace mote::apps
