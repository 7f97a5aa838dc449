// -D with a path: "integrator.paths=4096", "sensor.film.width=64", "left_wall.reflectance=0.2".
//
// Each word but the last chooses an element by id, else by name, tag or type, and of those that are nested in
// each other the outermost, and of several integrators of a scene the first; the last is a parameter.
// "emitter:2" is the second of the elements that the word chooses. Where the parameter is a nested object,
// the value is its type: "integrator.compensation=approximate", and then "integrator.compensation.depth=2". A
// transform is sixteen numbers, a matrix row by row, or nine: origin, target and up of a lookat.
#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>

#include "core/formats/xml/element_checks.h"
#include "core/formats/xml/scene_defines.h"
#include "core/formats/xml/scene_values.h"
#include "core/objects/registry.h"

namespace mote::core {
namespace {

std::vector<std::string> split_path(const std::string& path) {
    std::vector<std::string> words;
    std::istringstream stream(path);
    for (std::string word; std::getline(stream, word, '.');) words.push_back(word);
    if (path.back() == '.') words.emplace_back();
    return words;
}

bool is_object(const Element& e) { return find_category(e.tag).has_value(); }

/// The elements below `parent` for which `predicate` holds, without those nested in one of them.
template <typename Predicate>
void collect(Element& parent, const Predicate& predicate, std::vector<Element*>& found) {
    for (Element& c : parent.children) {
        if (!is_object(c)) continue;
        if (predicate(c))
            found.push_back(&c);
        else
            collect(c, predicate, found);
    }
}

/// The elements below `parent` that `word` means: those with this id, else this name, tag, type.
std::vector<Element*> matches(Element& parent, const std::string& word) {
    std::vector<Element*> found;
    for (const char* attribute : {"id", "name", "", "type"}) {
        collect(
            parent, [&](const Element& e) { return (*attribute ? e.get(attribute) : e.tag) == word; }, found);
        if (!found.empty()) break;
    }
    return found;
}

void known_words(const Element& parent, std::vector<std::string>& words) {
    for (const Element& c : parent.children) {
        if (!is_object(c)) continue;
        words.push_back(c.tag);
        if (c.find("id")) words.push_back(c.get("id"));
        if (c.find("type")) words.push_back(c.get("type"));
        known_words(c, words);
    }
}

/// The elements that "word:2" means: the second one of matches(), or none.
std::vector<Element*> numbered_match(Element& parent, const std::string& word) {
    const auto colon = word.rfind(':');
    if (colon == std::string::npos) return {};
    std::size_t number = 0;
    const char* const end = word.data() + word.size();
    const auto read = std::from_chars(word.data() + colon + 1, end, number);
    const std::vector<Element*> all = matches(parent, word.substr(0, colon));
    if (read.ec != std::errc() || read.ptr != end || number < 1 || number > all.size()) return {};
    return {all[number - 1]};
}

Element& find_one(Element& parent, const std::string& word, const SourceLocation& where) {
    std::vector<Element*> found = matches(parent, word);
    if (found.empty()) found = numbered_match(parent, word);
    if (found.size() == 1) return *found.front();
    // The first integrator of a scene renders; the others are found by their types.
    if (found.size() > 1 && parent.tag == "scene" && word == "integrator") return *found.front();
    if (found.size() > 1)
        throw InputError("'" + printable(word) + "' fits " + std::to_string(found.size()) +
                             " elements; give the id of one, or '" + printable(word) + ":1' for the first",
                         where);
    std::vector<std::string> words;
    known_words(parent, words);
    throw InputError("the scene has no element '" + printable(word) + "'" + suggestion(word, words), where);
}

/// The value tag that a parameter of this type is written with.
std::string tag_for(const std::string& type, const std::string& value) {
    if (type == "float" && value.find_first_of("0123456789") == std::string::npos) return "string";
    if (type == "boolean" || type == "integer" || type == "float" || type == "string" || type == "rgb" ||
        type == "point" || type == "vector")
        return type;
    if (type == "texture" || type == "volume")
        return value.find_first_of(" ,") == std::string::npos ? "float" : "rgb";
    return "";
}

/// The nested object `parameter` becomes one of type `type`; what it held for another type goes.
void set_nested(Element& element, const Parameter& parameter, const std::string& type,
                const SourceLocation& where) {
    std::erase_if(element.children, [&](const Element& c) {
        return c.tag == parameter.type && (!c.find("name") || c.get("name") == parameter.name);
    });
    Element fresh;
    fresh.tag = parameter.type, fresh.where = where, fresh.folder = element.folder;
    fresh.set("type", type);
    if (parameter.name != parameter.type) fresh.set("name", parameter.name);
    element.children.push_back(fresh);
}

/// <transform name="name"> of sixteen numbers, or nine.
Element transform_element(const Element& element, const std::string& name, const std::string& value,
                          const SourceLocation& where) {
    const std::vector<double> numbers = parse_numbers(value, where);
    if (numbers.size() != 9 && numbers.size() != 16)
        throw InputError("'" + name +
                             "': expected 16 numbers, a matrix row by row, or 9, the origin, target " +
                             "and up of a lookat; not " + std::to_string(numbers.size()),
                         where);
    std::vector<std::string> words;
    std::string text = value;
    std::replace(text.begin(), text.end(), ',', ' ');
    std::istringstream stream(text);
    for (std::string word; stream >> word;) words.push_back(word);
    Element transform, step;
    transform.tag = "transform", step.tag = numbers.size() == 16 ? "matrix" : "lookat";
    transform.where = step.where = where, transform.folder = step.folder = element.folder;
    transform.set("name", name);
    if (numbers.size() == 16)
        step.set("value", value);
    else
        for (std::size_t i = 0; i < 3; ++i)
            step.set(std::array{"origin", "target", "up"}[i],
                     words[3 * i] + " " + words[3 * i + 1] + " " + words[3 * i + 2]);
    transform.children.push_back(step);
    return transform;
}

void set_parameter(Element& element, const std::string& name, const std::string& value,
                   const Registry& registry, const SourceLocation& where) {
    if (name == "type") {
        element.set("type", value);
        element.where = where;
        return;
    }
    const Manual& manual = require_manual(element, registry);
    const Parameter& parameter = require_parameter(manual, name, where);
    const std::string tag = tag_for(parameter.type, value);
    if (tag.empty() && find_category(parameter.type)) return set_nested(element, parameter, value, where);
    const bool is_transform = parameter.type == "transform";
    if (tag.empty() && !is_transform)
        throw InputError("'" + name + "' is a " + parameter.type + " and cannot be set on the command line",
                         where);
    Element changed =
        is_transform ? transform_element(element, name, value, where) : element.make_value(tag, name, value);
    changed.where = where;
    if (Element* old = element.child(name))
        *old = changed;
    else
        element.children.push_back(changed);
}

}  // namespace

void set_by_path(Element& root, const std::string& path, const std::string& value, const Registry& registry,
                 const SourceLocation& where) {
    const std::vector<std::string> words = split_path(path);
    Element* element = &root;
    for (std::size_t i = 0; i + 1 < words.size(); ++i) element = &find_one(*element, words[i], where);
    set_parameter(*element, words.back(), value, registry, where);
}

void SceneDefines::apply_paths(Element& scene, const Registry& registry, Faults& faults) const {
    for (const auto& [path, value] : paths_) try {
            set_by_path(scene, path, value, registry, {"-D " + path + "=" + value, 0});
        } catch (const InputError& error) {
            faults.add(nullptr, error);
        }
}

}  // namespace mote::core
