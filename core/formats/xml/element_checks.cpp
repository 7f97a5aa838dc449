// Nothing in a scene file is skipped in silence: what is not known is an error with the nearest known name.
#include "core/formats/xml/element_checks.h"

#include <algorithm>
#include <set>

#include "core/formats/xml/foreign_names.h"
#include "core/formats/xml/scene_values.h"

namespace mote::core {
namespace {

std::vector<std::string> known_tags() {
    std::vector<std::string> tags = value_tags();
    for (int c = 0; c < category_count; ++c) tags.push_back(category_name(Category(c)));
    for (const char* tag : {"ref", "alias", "default", "include", "path"}) tags.emplace_back(tag);
    return tags;
}

[[noreturn]] void unknown_element(const Element& e) {
    throw InputError("unknown element <" + printable(e.tag) + ">" + suggestion(e.tag, known_tags()), e.where);
}

/// True if a value written with `tag` can be given to a parameter of type `type`.
bool accepts_value(const std::string& type, const std::string& tag) {
    const bool number = tag == "float" || tag == "integer";
    const bool colour = tag == "rgb" || tag == "spectrum";
    // Some numbers have names (an index of refraction "water"); a parameter without names refuses them on
    // reading.
    if (type == "float") return number || tag == "string";
    if (type == "rgb" || type == "texture" || type == "volume") return number || colour;
    if (type == "point" || type == "vector") return tag == "point" || tag == "vector";
    return type == tag;
}

std::string article(const std::string& noun) {
    const bool vowel = !noun.empty() && std::string("aeiou").find(noun[0]) != std::string::npos;
    return (vowel || noun == "rgb" ? "an " : "a ") + noun;
}

std::string kind(const Manual& manual) { return category_name(manual.category) + " '" + manual.type + "'"; }

void check_value(const Element& e, const Manual& manual) {
    const std::string& name = e.require("name");
    const Parameter& parameter = require_parameter(manual, name, e.where);
    if (!accepts_value(parameter.type, e.tag))
        throw InputError("'" + printable(name) + "' of " + kind(manual) + " is " + article(parameter.type) +
                             ", not " + article(e.tag),
                         e.where);
}

void check_reference(const Element& e) {
    e.check_attributes({"id", "name"});
    e.require("id");
    if (!e.children.empty()) throw InputError("<ref> holds no other elements", e.children.front().where);
}

/// One run over the scene; what it finds goes to `faults`.
struct Checker {
    const Registry& registry;
    std::vector<std::string>& warnings;
    Faults& faults;

    void check_object(Element& e) {
        const Manual* manual = registry.find(*find_category(e.tag), e.get("type"));
        if (manual) drop_foreign_parameters(e, *manual, warnings);
        if (take_up(e))
            faults.attempt(e, [&] {
                e.check_attributes({"type", "id", "name"});
                require_manual(e, registry);
            });
        std::set<std::string> names;
        for (Element& c : e.children) {
            if (find_category(c.tag)) check_object(c);
            if (faults.has(c) || !take_up(c)) continue;
            faults.attempt(c, [&] {
                if (const std::string* name = c.find("name"); name && !names.insert(*name).second)
                    throw InputError("'" + printable(*name) + "' is given twice", c.where);
                if (manual) check_child(c, *manual);
            });
        }
    }
    /// Takes over what reading found. Returns true if it found nothing.
    bool take_up(const Element& e) {
        if (e.fault && !faults.has(e)) faults.add(&e, *e.fault);
        return !e.fault;
    }
};

/// Elements that are no objects, directly in <scene>.
void check_at_top(const Element& e) {
    if (e.tag == "alias") {
        e.check_attributes({"id", "as"});
        e.require("id"), e.require("as");
    } else if (e.tag == "ref") {
        throw InputError("a <ref> directly in <scene> has no effect", e.where);
    } else if (is_value_tag(e.tag)) {
        throw InputError("<" + e.tag + "> belongs into an object, not directly into <scene>", e.where);
    } else {
        unknown_element(e);
    }
}

void collect(const Element& parent, IdTable& ids, Faults& faults) {
    for (const Element& e : parent.children) {
        if (!find_category(e.tag)) continue;
        if (const std::string* id = e.find("id")) {
            const auto [it, fresh] = ids.emplace(*id, &e);
            if (!fresh)
                faults.add(&e, InputError("id '" + printable(*id) + "' is taken already by line " +
                                              std::to_string(it->second->where.line) + " of " +
                                              printable(it->second->where.file),
                                          e.where));
        }
        collect(e, ids, faults);
    }
}

/// Throws when `parent` has no use for the object `child` (written as `written`, which may be a <ref>).
void check_nested(const Manual& parent, const Element& written, const Element& child) {
    const Category category = *find_category(child.tag);
    const auto& common = common_children(parent.category);
    if (std::find(common.begin(), common.end(), category) != common.end()) return;
    if (!parameter_for_child(parent, category, written.get("name")).empty()) return;
    const std::string what = "a nested " + category_name(category);
    std::vector<std::string> names;
    for (const Parameter& p : parent.parameters)
        if (p.type == category_name(category)) names.push_back(p.name);
    if (names.empty())
        throw InputError(kind(parent) + " takes no nested " + category_name(category), written.where);
    if (!written.find("name"))
        throw InputError(what + " of " + kind(parent) + " needs a name" + suggestion("", names),
                         written.where);
    throw InputError(kind(parent) + " has no " + category_name(category) + " '" +
                         printable(written.get("name")) + "'" + suggestion(written.get("name"), names),
                     written.where);
}

void check_references_below(const Element& e, const Manual* manual, const IdTable& ids,
                            const Registry& registry, Faults& faults) {
    for (const Element& c : e.children) {
        const auto category = find_category(c.tag);
        if (c.tag != "ref" && !category) continue;
        if (manual && !faults.has(c)) faults.attempt(c, [&] { check_nested(*manual, c, resolve(c, ids)); });
        if (category)
            check_references_below(c, registry.find(*category, c.get("type")), ids, registry, faults);
    }
}

}  // namespace

const Manual& require_manual(const Element& e, const Registry& registry) {
    const Category category = *find_category(e.tag);
    const std::string& type = e.require("type");
    if (const Manual* manual = registry.find(category, type)) return *manual;
    throw InputError(
        "unknown " + e.tag + " type '" + printable(type) + "'" + suggestion(type, registry.types(category)),
        e.where);
}

void check_child(const Element& child, const Manual& manual) {
    if (is_value_tag(child.tag))
        check_value(child, manual);
    else if (child.tag == "ref")
        check_reference(child);
    else if (!find_category(child.tag))
        unknown_element(child);
}

void check_elements(Element& scene, const Registry& registry, std::vector<std::string>& warnings,
                    Faults& faults) {
    Checker checker{registry, warnings, faults};
    if (checker.take_up(scene)) faults.attempt(scene, [&] { scene.check_attributes({"version"}); });
    for (Element& e : scene.children) {
        if (find_category(e.tag))
            checker.check_object(e);
        else if (checker.take_up(e))
            faults.attempt(e, [&] { check_at_top(e); });
    }
}

IdTable collect_ids(const Element& scene, Faults& faults) {
    IdTable ids;
    collect(scene, ids, faults);
    for (const Element& e : scene.children) {
        if (e.tag != "alias" || faults.has(e)) continue;
        faults.attempt(e, [&] {
            const Element& target = resolve(e, ids);
            if (!ids.emplace(e.require("as"), &target).second)
                throw InputError("id '" + printable(e.require("as")) + "' is taken already", e.where);
        });
    }
    return ids;
}

IdTable collect_ids(const Element& scene) {
    Faults faults;
    IdTable ids = collect_ids(scene, faults);
    faults.throw_all({});
    return ids;
}

const Element& resolve(const Element& child, const IdTable& ids) {
    if (child.tag != "ref" && child.tag != "alias") return child;
    const std::string& id = child.require("id");
    if (const auto it = ids.find(id); it != ids.end()) return *it->second;
    std::vector<std::string> known;
    for (const auto& [key, element] : ids) known.push_back(key);
    throw InputError("nothing has the id '" + printable(id) + "'" + suggestion(id, known), child.where);
}

void check_references(const Element& scene, const IdTable& ids, const Registry& registry, Faults& faults) {
    check_references_below(scene, nullptr, ids, registry, faults);
}

const std::vector<Category>& common_children(Category category) {
    static const std::vector<Category> none, shape = {Category::bsdf, Category::emitter, Category::medium},
                                             sensor = {Category::film, Category::sampler, Category::medium},
                                             film = {Category::rfilter}, emitter = {Category::medium};
    if (category == Category::shape) return shape;
    if (category == Category::sensor) return sensor;
    if (category == Category::film) return film;
    if (category == Category::emitter) return emitter;
    return none;
}

bool has_place_for(const Manual& manual, const Element& child) {
    const std::string name = child.get("name");
    return std::any_of(manual.parameters.begin(), manual.parameters.end(), [&](const Parameter& p) {
        return p.name == name || (name.empty() && p.type == child.tag);
    });
}

std::string parameter_for_child(const Manual& manual, Category child, const std::string& name) {
    const std::string& wanted = category_name(child);
    std::vector<std::string> fitting;
    for (const Parameter& p : manual.parameters) {
        if (p.type != wanted) continue;
        if (p.name == name) return name;
        fitting.push_back(p.name);
    }
    if (fitting.size() != 1) return "";
    // There may be several nested integrators, whose names say what each is for.
    if (child == Category::integrator) return name.empty() ? fitting.front() : name;
    // Textures and volumes are values and named, but where the parameter is just called "texture"; other
    // objects are found by what they are, and so is the volume of a texture.
    const bool is_value =
        child == Category::texture || (child == Category::volume && manual.category != Category::texture);
    return is_value && fitting.front() != wanted ? "" : fitting.front();
}

}  // namespace mote::core
