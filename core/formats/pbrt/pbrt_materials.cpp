// Names and ids of materials; what surrounds a BSDF: holes, two sides, bent normals.
#include "core/formats/pbrt/pbrt_materials.h"

#include <algorithm>

#include "core/formats/conversion/scene_xml.h"

namespace mote::core {

std::string PbrtMaterials::add(PbrtObject object) {
    const std::string id = "material_" + std::to_string(objects_.size());
    objects_.emplace(id, std::move(object));
    return id;
}

std::string PbrtMaterials::named(const std::string& name, const SourceLocation& where) {
    auto [it, added] = names_.emplace(name, "");
    if (added) {
        it->second = "named_" + std::to_string(names_.size() - 1) + "_";
        for (const char c : name.substr(0, 60))
            it->second += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    }
    wanted_.emplace(it->second, where);
    return it->second;
}

void PbrtMaterials::add_named(const std::string& name, PbrtObject object) {
    object.type = object.text("type", "");
    if (object.type.empty())
        throw InputError("a named material needs its type: \"string type\"", object.where);
    const std::string id = named(name, object.where);
    if (!objects_.emplace(id, object).second)
        throw InputError("the material '" + printable(name, 60) + "' is defined twice", object.where);
}

std::string PbrtMaterials::with_holes(const std::string& id, const PbrtTexturePtr& opacity) {
    for (const auto& [other, holes] : holes_)
        if (holes.id == id && holes.opacity == opacity) return other;
    const std::string masked = id + "_holes_" + std::to_string(holes_.size());
    holes_.emplace(masked, Holes{id, opacity});
    return masked;
}

void PbrtMaterials::replaced(const PbrtObject& object, const std::string& by) {
    files_.fault(object.where, "the material '" + object.type + "' has no counterpart here",
                 by + " stands in its place");
}

const std::map<std::string, PbrtMaterials::Writer>& PbrtMaterials::writers() {
    using M = PbrtMaterials;
    static const std::map<std::string, Writer> table = {{"diffuse", &M::diffuse},
                                                        {"coateddiffuse", &M::coated_diffuse},
                                                        {"conductor", &M::conductor},
                                                        {"coatedconductor", &M::coated_conductor},
                                                        {"dielectric", &M::dielectric},
                                                        {"thindielectric", &M::thin_dielectric},
                                                        {"diffusetransmission", &M::diffuse_transmission},
                                                        {"mix", &M::mix},
                                                        {"interface", &M::interface},
                                                        {"none", &M::interface},
                                                        {"", &M::interface},
                                                        {"measured", &M::measured},
                                                        {"subsurface", &M::subsurface},
                                                        {"hair", &M::hair}};
    return table;
}

/// Displacement and normal maps. Returns the parent of the BSDF; the id belongs to the outermost element.
pugi::xml_node PbrtMaterials::add_bent_normals(pugi::xml_node parent, std::string& id,
                                               const PbrtObject& object) {
    if (const auto heights = textures_.find(object, "displacement", false); heights && !heights->constant()) {
        parent = add_object(parent, "bsdf", "bumpmap", "", std::exchange(id, ""));
        textures_.add(parent, "texture", heights, true);
    }
    if (const PbrtParameter* map = object.find("normalmap")) {
        const auto normals = textures_.picture(object.text("normalmap", ""), map->where, true);
        parent = add_object(parent, "bsdf", "normalmap", "", std::exchange(id, ""));
        textures_.add(parent, "normalmap", normals, false);
    }
    return parent;
}

void PbrtMaterials::write_surface(pugi::xml_node parent, const std::string& id, const PbrtObject& object) {
    const auto it = writers().find(object.type);
    if (it == writers().end()) {
        std::vector<std::string> known;
        for (const auto& [name, writer] : writers())
            if (!name.empty()) known.push_back(name);
        throw InputError(
            "unknown material '" + printable(object.type, 40) + "'" + suggestion(object.type, known),
            object.where);
    }
    object.ignore({"type"});
    std::string outer = id;
    static const std::set<std::string> one_sided = {
        "dielectric", "thindielectric", "diffusetransmission", "mix", "interface", "none", ""};
    if (!one_sided.count(object.type))
        parent = add_object(parent, "bsdf", "twosided", "", std::exchange(outer, ""));
    parent = add_bent_normals(parent, outer, object);
    (this->*it->second)(parent, outer, object);
    for (const InputError& error : object.unknown()) files_.fault(error, "ignored");
}

/// A material that cannot be read is grey.
void PbrtMaterials::write_one(pugi::xml_node scene, const std::string& id, const PbrtObject& object) {
    pugi::xml_document written;
    try {
        write_surface(written, id, object);
    } catch (const InputError& error) {
        files_.fault(error, "a grey diffuse stands in its place");
        written.reset();
        add_object(add_object(written, "bsdf", "twosided", "", id), "bsdf", "diffuse");
    }
    for (const pugi::xml_node node : written) scene.append_copy(node);
}

void PbrtMaterials::write(pugi::xml_node scene) {
    for (const auto& [id, holes] : holes_) {
        if (!used_.count(id)) continue;
        use(holes.id);
        pugi::xml_node mask = add_object(scene, "bsdf", "mask", "", id);
        textures_.add(mask, "opacity", holes.opacity, true);
        add_ref(mask, holes.id);
    }
    // A mix uses others: until no id is new.
    for (std::set<std::string> done; done.size() < used_.size();)
        for (const std::string& id : std::set<std::string>(used_)) {
            if (!done.insert(id).second || holes_.count(id)) continue;
            const auto it = objects_.find(id);
            PbrtObject missing;
            if (it == objects_.end()) {
                missing.type = "diffuse", missing.where = wanted_.at(id);
                std::vector<std::string> known;
                std::string requested;
                for (const auto& [name, other] : names_)
                    if (objects_.count(other))
                        known.push_back(name);
                    else if (other == id)
                        requested = name;
                files_.fault(
                    missing.where,
                    "there is no material '" + printable(requested, 60) + "'" + suggestion(requested, known),
                    "a grey diffuse stands in its place");
            }
            write_one(scene, id, it == objects_.end() ? missing : it->second);
        }
}

}  // namespace mote::core
