#include "session/scene_tree.h"

#include <fmt/format.h>

#include "core/files/checksum.h"
#include "core/objects/registry.h"

namespace mote::session {

using core::Element, core::InputError;

namespace {

/// Deeper than any scene: every level costs a call of the loader.
constexpr std::size_t max_depth = 64;

/// Shortest text that reads back as the same number.
std::string text_of(double number) { return fmt::format("{}", number); }

void add_text(const Element& e, std::string& text) {
    text += "<" + e.tag;
    for (const auto& [name, value] : e.attributes) text += " " + name + "='" + value + "'";
    for (const Element& child : e.children) add_text(child, text);
    text += ">";
}

}  // namespace

SceneTree::SceneTree(std::string name, std::string folder)
    : name_(std::move(name)), folder_(std::move(folder)) {
    scene_ = made("scene");
    scene_.set("version", "3.0.0");
}

void SceneTree::place(const std::string& name, const std::string& folder) {
    const auto move = [&](auto&& self, Element& e) -> void {
        e.where.file.replace(0, name_.size(), name), e.folder = folder;
        for (Element& child : e.children) self(self, child);
    };
    move(move, scene_);
    name_ = name, folder_ = folder;
}

Element& SceneTree::open() {
    Element* e = &scene_;
    for (const std::size_t child : path_) e = &e->children[child];
    return *e;
}

/// An element that stands here.
Element SceneTree::made(const std::string& tag) const {
    Element e;
    e.tag = tag, e.folder = folder_;
    e.where.file = name_;
    for (const std::string& label : labels_) e.where.file += "." + label;
    return e;
}

void SceneTree::begin(const std::string& category, const std::string& type, const std::string& name,
                      const std::string& id, const std::string& label) {
    if (path_.size() >= max_depth)
        throw InputError("objects are nested more than " + std::to_string(max_depth) + " deep", {name_, 0});
    labels_.push_back(!label.empty() ? label : !name.empty() ? name : !id.empty() ? id : category);
    Element e = made(category);
    if (!core::find_category(category)) {
        std::vector<std::string> known;
        for (int c = 0; c < core::category_count; ++c)
            known.push_back(core::category_name(core::Category(c)));
        labels_.pop_back();
        throw InputError("there is no kind of object '" + core::printable(category) + "'" +
                             core::suggestion(category, known),
                         e.where);
    }
    e.set("type", type);
    if (!name.empty()) e.set("name", name);
    if (!id.empty()) e.set("id", id);
    Element& parent = open();
    path_.push_back(parent.children.size());
    parent.children.push_back(std::move(e));
}

void SceneTree::end() {
    if (path_.empty()) throw InputError("no object is open", {name_, 0});
    path_.pop_back(), labels_.pop_back();
}

void SceneTree::value(const std::string& kind, const std::string& name, const std::string& text) {
    Element e = made(kind);
    e.attributes = {{"name", name}, {"value", text}};
    open().children.push_back(std::move(e));
}

void SceneTree::number(const std::string& name, double number) { value("float", name, text_of(number)); }
void SceneTree::integer(const std::string& name, std::int64_t number) {
    value("integer", name, std::to_string(number));
}
void SceneTree::boolean(const std::string& name, bool state) {
    value("boolean", name, state ? "true" : "false");
}
void SceneTree::triple(const std::string& kind, const std::string& name, double x, double y, double z) {
    value(kind, name, text_of(x) + " " + text_of(y) + " " + text_of(z));
}

void SceneTree::transform(const std::string& name, std::span<const double> rows) {
    Element e = made("transform"), matrix = made("matrix");
    std::string text;
    for (const double x : rows) text += (text.empty() ? "" : " ") + text_of(x);
    matrix.set("value", text);
    e.set("name", name);
    e.children.push_back(std::move(matrix));
    open().children.push_back(std::move(e));
}

void SceneTree::reference(const std::string& id, const std::string& name) {
    Element e = made("ref");
    e.set("id", id);
    if (!name.empty()) e.set("name", name);
    open().children.push_back(std::move(e));
}

core::SceneDocument SceneTree::document() const {
    if (!path_.empty()) throw InputError("'" + labels_.back() + "' is still open", {name_, 0});
    core::SceneDocument document;
    document.scene = scene_;
    document.search_paths = {folder_};
    return document;
}

std::string SceneTree::checksum() const {
    std::string text;
    add_text(scene_, text);
    text += arrays_->checksum();
    return fmt::format("{:016x}", core::checksum(std::as_bytes(std::span(text))));
}

}  // namespace mote::session
