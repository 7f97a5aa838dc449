// Factories see values and nested objects; what joins objects of different kinds (a shape's BSDF, light and
// media, a camera's medium) is done here.
#include "core/formats/xml/object_maker.h"

#include <algorithm>

#include "core/cameras/sensors.h"
#include "core/formats/xml/attribute_checks.h"
#include "core/formats/xml/element_content.h"
#include "core/formats/xml/scene_values.h"
#include "core/geometry/curves.h"
#include "core/geometry/shape.h"
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
    if (too_deep_ || (written.tag == "ref" && faults_.has(written))) return nullptr;
    const Element* element = nullptr;
    const bool sound = faults_.attempt(written, [&] {
        element = &resolve(written, ids_);
        const auto it = made_.find(element);
        if (it != made_.end() && !it->second.done)
            throw InputError(named(*element) + " refers to itself", written.where);
        too_deep_ = depth_ >= max_depth;  // chains of such length cost too much to look for more
        if (too_deep_) throw InputError("objects are nested more than 64 deep", written.where);
    });
    if (!sound) return nullptr;
    if (const auto it = made_.find(element); it != made_.end()) return it->second.object;
    made_[element];  // marks it as being made
    ++depth_;
    auto object = element->tag == "medium" ? make_medium(*element) : make_new(*element);
    --depth_;
    made_[element] = {object, true};
    return object;
}

/// Media that are written alike are one: a light and a wall that each write out the fog they stand in stand
/// in the same.
std::shared_ptr<Object> ObjectMaker::make_medium(const Element& element) {
    std::string content;
    if (!faults_.attempt(element, [&] { content = content_of(element, ids_); })) return nullptr;
    auto& medium = media_by_content_[content];
    if (!medium) medium = make_new(element);
    return medium;
}

std::shared_ptr<Object> ObjectMaker::make_new(const Element& element) {
    Properties properties;
    if (!read_properties(element, properties)) return nullptr;
    std::shared_ptr<Object> object;
    const bool sound = faults_.attempt(element, [&] {
        object = call(registry_.factory(properties.category, properties.type), properties);
        if (!object) throw std::logic_error("the factory of " + named(element) + " made nothing");
        object->id = properties.id;
    });
    return sound && attach(element, properties, *object) ? object : nullptr;
}

/// Returns whether the element and all that it holds are sound.
bool ObjectMaker::read_properties(const Element& element, Properties& p) {
    const Manual* manual = registry_.find(*find_category(element.tag), element.get("type"));
    p.type = element.get("type"), p.id = element.get("id"), p.where = element.where;
    p.category = *find_category(element.tag);
    p.search_paths = search_paths_;
    if (search_paths_.empty() || search_paths_.front() != element.folder)
        p.search_paths.insert(p.search_paths.begin(), element.folder);
    p.warnings = &warnings, p.files = &files;
    bool sound = manual && !faults_.has(element);
    for (const Element& c : element.children) {
        // Where the type is not known, what it holds may be wrong as well.
        const bool good = manual ? read_child(c, element, *manual, p) : find_category(c.tag) && make(c);
        sound = sound && good;
    }
    return sound;
}

bool ObjectMaker::read_child(const Element& c, const Element& parent, const Manual& manual, Properties& p) {
    const std::string name = c.get("name");
    if (faults_.has(c) && !find_category(c.tag)) return false;
    if (is_value_tag(c.tag))
        return faults_.attempt(c, [&] {
            p.values[name] = {parse_value(c, is_emission(parent, name), warnings), c.where};
        });
    Category category{};
    if (!faults_.attempt(c, [&] { category = *find_category(resolve(c, ids_).tag); })) return false;
    const bool joined_here =
        manual.category == Category::shape &&
        (category == Category::bsdf || category == Category::emitter || category == Category::medium);
    auto object = make(c);
    if (!object) return false;
    const std::string parameter = parameter_for_child(manual, category, name);
    if (!joined_here)
        p.children.push_back({parameter.empty() ? name : parameter, category, std::move(object), c.where});
    return true;
}

std::shared_ptr<Medium> ObjectMaker::use_medium(const Element& element) {
    auto medium = make_as<Medium>(element);
    if (medium && std::find(media.begin(), media.end(), medium) == media.end()) media.push_back(medium);
    return medium;
}

/// Returns whether what belongs to the object could be joined to it.
bool ObjectMaker::attach(const Element& element, const Properties& properties, Object& object) {
    if (auto* shape = dynamic_cast<Shape*>(&object)) return attach_to_shape(element, *shape);
    if (properties.category == Category::shape) return refuse_materials(element);
    const bool camera = dynamic_cast<Camera*>(&object) != nullptr;
    if (camera && !faults_.attempt(element, [&] { film = film_settings(properties); })) return false;
    auto* const emitter = dynamic_cast<Emitter*>(&object);
    if (emitter) emitter->where = properties.where;
    if (!camera && !emitter) return true;
    bool sound = true;
    for (const Element& c : element.children)
        if (!is_value_tag(c.tag) && resolve(c, ids_).tag == "medium" && !attach_medium(c, element, object))
            sound = false;
    return sound;
}

bool ObjectMaker::attach_medium(const Element& c, const Element& element, Object& object) {
    auto* camera = dynamic_cast<Camera*>(&object);
    auto* emitter = dynamic_cast<Emitter*>(&object);
    const auto medium = use_medium(c);
    if (!medium) return false;
    return faults_.attempt(c, [&] {
        // A light may have read its medium itself.
        if (camera ? bool(camera->medium) : emitter->medium != nullptr && emitter->medium != medium.get())
            throw InputError("more than one medium for " + named(element), c.where);
        if (camera) camera->medium = medium, camera->medium_where = c.where;
        if (emitter) emitter->medium = medium.get(), emitter->medium_where = c.where;
    });
}

/// Groups and instances have no surface of their own.
bool ObjectMaker::refuse_materials(const Element& element) {
    bool sound = true;
    for (const Element& c : element.children) {
        if (is_value_tag(c.tag)) continue;
        const std::string& tag = resolve(c, ids_).tag;
        if (tag == "shape") continue;
        faults_.add(&c,
                    InputError(named(element) + " takes no " + tag + ": give it to the shapes of the group",
                               c.where));
        sound = false;
    }
    return sound;
}

bool ObjectMaker::attach_to_shape(const Element& element, Shape& shape) {
    bool sound = true;
    for (const Element& c : element.children)
        if (!is_value_tag(c.tag) && !attach_part(c, shape)) sound = false;
    if (!sound) return false;
    shape.has_medium_boundary = shape.interior || shape.exterior;
    if (!shape.bsdf) shape.bsdf = default_bsdf(element, shape);
    shape.tangent_matters = shape.bsdf->traits().anisotropic;
    for (const std::string& note : shape.notes)
        warnings.push_back(InputError(named(element) + ": " + note, element.where).what());
    return faults_.attempt(element, [&] {
        if (dynamic_cast<const Curves*>(&shape) && (shape.emitter || shape.has_medium_boundary))
            throw InputError(named(element) + (shape.emitter ? " cannot be a light" : " bounds no medium") +
                                 ": curves are met from outside only",
                             element.where);
        if (shape.emitter && shape.bsdf->traits().passes_straight())
            throw InputError(
                "an area light needs a surface: its BSDF cannot be " +
                    std::string(shape.bsdf->traits().null ? "null" : "one that lets light pass straight on"),
                element.where);
        check_mesh_attributes(element, shape, ids_);
    });
}

bool ObjectMaker::attach_part(const Element& c, Shape& shape) {
    const std::string tag = resolve(c, ids_).tag, name = c.get("name");
    if (tag != "bsdf" && tag != "emitter" && tag != "medium") return true;
    const auto object = make(c);
    if (!object) return false;
    return faults_.attempt(c, [&] {
        if (tag == "bsdf" ? bool(shape.bsdf) : tag == "emitter" && shape.emitter)
            throw InputError("a shape has one " + tag, c.where);
        if (tag == "bsdf") shape.bsdf = make_as<Bsdf>(c);
        if (tag == "emitter") {
            shape.emitter = make_as<Emitter>(c);
            if (shape.emitter->traits().kind != EmitterKind::area)
                throw InputError("only area lights belong to shapes", c.where);
        }
        if (tag != "medium") return;
        if (name != "interior" && name != "exterior")
            throw InputError("a medium of a shape is named 'interior' or 'exterior'", c.where);
        (name == "interior" ? shape.interior : shape.exterior) = use_medium(c);
        if (name == "exterior") shape.exterior_where = c.where;
    });
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
