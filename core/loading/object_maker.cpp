// Factories see values and nested objects; what joins objects of different kinds (a shape's BSDF, light and
// media, a camera's medium) is done here.
#include "core/loading/object_maker.h"

#include <algorithm>

#include "core/cameras/film_objects.h"
#include "core/geometry/shape.h"
#include "core/loading/scene_values.h"
#include "core/materials/bsdf.h"

namespace mote::core {
namespace {

constexpr int max_depth = 64;  // of objects in objects, references included

bool is_emission(const Element& e, const std::string& name) {
    return e.tag == "emitter" || (e.tag == "medium" && name == "Le");
}

std::string named(const Element& e) {
    return e.tag + " '" + printable(e.get("type")) + "'" +
           (e.find("id") ? " (id '" + printable(e.get("id")) + "')" : "");
}

/// Errors of factories that say what, but not where.
std::shared_ptr<Object> call(const Factory& factory, const Properties& properties) {
    try {
        return factory(properties);
    } catch (const InputError& error) {
        if (!error.where().file.empty()) throw;
        throw InputError(error.what(), properties.where);
    }
}

}  // namespace

std::shared_ptr<Object> ObjectMaker::make(const Element& written) {
    const Element& element = resolve(written, ids_);
    if (const auto it = made_.find(&element); it != made_.end()) {
        if (!it->second) throw InputError(named(element) + " refers to itself", written.where);
        return it->second;
    }
    if (depth_ >= max_depth) throw InputError("objects are nested more than 64 deep", written.where);
    made_[&element] = nullptr;  // marks it as being made
    ++depth_;
    auto object = make_new(element);
    --depth_;
    made_[&element] = object;
    return object;
}

std::shared_ptr<Object> ObjectMaker::make_new(const Element& element) {
    const Properties properties = read_properties(element);
    auto object = call(registry_.factory(properties.category, properties.type), properties);
    if (!object) throw std::logic_error("the factory of " + named(element) + " made nothing");
    object->id = properties.id;
    attach(element, properties, *object);
    return object;
}

Properties ObjectMaker::read_properties(const Element& element) {
    const Manual& manual = require_manual(element, registry_);
    Properties p;
    p.category = manual.category, p.type = manual.type, p.id = element.get("id"), p.where = element.where;
    p.search_paths = search_paths_;
    if (search_paths_.empty() || search_paths_.front() != element.folder)
        p.search_paths.insert(p.search_paths.begin(), element.folder);
    p.warnings = &warnings, p.files = &files;
    for (const Element& c : element.children) {
        const std::string name = c.get("name");
        if (is_value_tag(c.tag)) {
            p.values[name] = {parse_value(c, is_emission(element, name), warnings), c.where};
            continue;
        }
        const Category category = *find_category(resolve(c, ids_).tag);
        const bool joined_here =
            manual.category == Category::shape &&
            (category == Category::bsdf || category == Category::emitter || category == Category::medium);
        if (joined_here) continue;
        std::string parameter = parameter_for_child(manual, category, name);
        p.children.push_back({parameter.empty() ? name : parameter, category, make(c), c.where});
    }
    return p;
}

std::shared_ptr<Medium> ObjectMaker::use_medium(const Element& element) {
    auto medium = make_as<Medium>(element);
    if (std::find(media.begin(), media.end(), medium) == media.end()) media.push_back(medium);
    return medium;
}

void ObjectMaker::attach(const Element& element, const Properties& properties, Object& object) {
    if (auto* shape = dynamic_cast<Shape*>(&object)) attach_to_shape(element, *shape);
    auto* camera = dynamic_cast<Camera*>(&object);
    auto* emitter = dynamic_cast<Emitter*>(&object);
    if (camera) film = film_settings(properties);
    if (!camera && !emitter) return;
    for (const Element& c : element.children) {
        if (is_value_tag(c.tag) || resolve(c, ids_).tag != "medium") continue;
        const auto medium = use_medium(c);
        // A light may have read its medium itself.
        if (camera ? bool(camera->medium) : emitter->medium != nullptr && emitter->medium != medium.get())
            throw InputError("more than one medium for " + named(element), c.where);
        if (camera) camera->medium = medium, camera->medium_where = c.where;
        if (emitter) emitter->medium = medium.get(), emitter->medium_where = c.where;
    }
}

void ObjectMaker::attach_to_shape(const Element& element, Shape& shape) {
    for (const Element& c : element.children) {
        if (is_value_tag(c.tag)) continue;
        const std::string tag = resolve(c, ids_).tag, name = c.get("name");
        const auto once = [&](bool taken) {
            if (taken) throw InputError("a shape has one " + tag, c.where);
        };
        if (tag == "bsdf") {
            once(bool(shape.bsdf));
            shape.bsdf = make_as<Bsdf>(c);
        } else if (tag == "emitter") {
            once(bool(shape.emitter));
            shape.emitter = make_as<Emitter>(c);
            if (shape.emitter->traits().kind != EmitterKind::area)
                throw InputError("only area lights belong to shapes", c.where);
        } else if (tag == "medium") {
            if (name != "interior" && name != "exterior")
                throw InputError("a medium of a shape is named 'interior' or 'exterior'", c.where);
            (name == "interior" ? shape.interior : shape.exterior) = use_medium(c);
            if (name == "exterior") shape.exterior_where = c.where;
        }
    }
    shape.has_medium_boundary = shape.interior || shape.exterior;
    if (!shape.bsdf) shape.bsdf = default_bsdf(element, shape);
    shape.tangent_matters = shape.bsdf->traits().anisotropic;
    if (shape.emitter && shape.bsdf->traits().null)
        throw InputError("an area light needs a surface: its BSDF cannot be null", element.where);
    for (const std::string& note : shape.notes)
        warnings.push_back(InputError(named(element) + ": " + note, element.where).what());
}

std::shared_ptr<Bsdf> ObjectMaker::default_bsdf(const Element& element, const Shape& shape) {
    if (shape.emitter) return built_in("diffuse", 0.0, element);
    if (!shape.has_medium_boundary) return built_in("diffuse", 0.5, element);
    // In version 0.x a shape with a medium and no BSDF is the bare boundary of that medium.
    if (element.legacy) return built_in("null", 0.0, element);
    if (shape.interior)
        warnings.push_back(InputError(named(element) +
                                          " has a medium inside but no BSDF: it is opaque, and the "
                                          "medium is not seen; give it <bsdf type=\"null\"/>",
                                      element.where)
                               .what());
    return built_in("diffuse", 0.5, element);
}

std::shared_ptr<Bsdf> ObjectMaker::built_in(const std::string& type, double reflectance,
                                            const Element& element) {
    auto& bsdf = defaults_[type + number_to_text(reflectance)];
    if (bsdf) return bsdf;
    Properties p;
    p.category = Category::bsdf, p.type = type, p.where = element.where;
    if (type == "diffuse") p.values["reflectance"] = {Rgb(float(reflectance)), element.where};
    bsdf = std::dynamic_pointer_cast<Bsdf>(registry_.factory(Category::bsdf, type)(p));
    return bsdf;
}

}  // namespace mote::core
