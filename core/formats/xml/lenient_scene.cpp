// Each fault is taken where it stands; the tree is checked anew afterwards.
#include "core/formats/xml/lenient_scene.h"

#include <algorithm>
#include <map>

#include "core/formats/xml/element_checks.h"
#include "core/formats/xml/scene_values.h"

namespace mote::core {
namespace {

class Remedy {
  public:
    Remedy(const Faults& faults, const Element& scene, const Registry& registry) : registry_(registry) {
        for (const Fault& f : faults.all())
            if (f.element) errors_.emplace(f.element, f.error);
        remember_ids(scene);
    }

    void below(Element& parent) {
        std::vector<Element> kept;
        for (Element& c : parent.children) {
            const auto it = errors_.find(&c);
            if (it == errors_.end())
                below(c);
            else if (!mend(c, it->second))
                continue;
            kept.push_back(std::move(c));
        }
        parent.children = std::move(kept);
    }
    void note(const InputError& error, const std::string& done) {
        notes.push_back(std::string(error.what()) + ": " + done);
    }

    std::vector<std::string> notes;

  private:
    void remember_ids(const Element& parent) {
        for (const Element& e : parent.children) {
            if (e.find("id")) ids_.emplace(e.get("id"), &e);
            remember_ids(e);
        }
    }
    /// Returns whether the element stays.
    bool mend(Element& e, const InputError& error) {
        const auto category = find_category(e.tag);
        if (!category) return note(error, "ignored"), false;
        if (mend_attributes(e, error) || mend_value(e, *category, error)) return true;
        return replace(e, *category, error);
    }
    /// Mends the element's own attributes, but for its type. Returns true where something changed.
    bool mend_attributes(Element& e, const InputError& error) {
        const std::size_t before = e.attributes.size();
        const bool was_faulty = bool(e.fault);
        e.fault.reset();
        std::erase_if(e.attributes, [&](const auto& attribute) {
            const auto& [name, value] = attribute;
            if (name == "id") return ids_[value] != &e || value.find('$') != std::string::npos;
            return name != "type" && (name != "name" || value.find('$') != std::string::npos);
        });
        if (!was_faulty && before == e.attributes.size()) return false;
        note(error, "ignored");
        return true;
    }
    /// A value that the object cannot be made with, where the error names its line.
    bool mend_value(Element& e, Category category, const InputError& error) {
        const auto culprit = std::find_if(e.children.begin(), e.children.end(), [&](const Element& c) {
            return is_value_tag(c.tag) && c.where.line != e.where.line &&
                   c.where.line == error.where().line && c.where.file == error.where().file;
        });
        const Manual* manual = registry_.find(category, e.get("type"));
        const bool clamps = manual && !e.child("clamp_negative") &&
                            std::any_of(manual->parameters.begin(), manual->parameters.end(),
                                        [](const Parameter& p) { return p.name == "clamp_negative"; });
        if (clamps && std::string(error.what()).find("is negative") != std::string::npos) {
            e.children.push_back(e.make_value("boolean", "clamp_negative", "true"));
            note(error, "negative values count as 0");
            return true;
        }
        if (culprit == e.children.end() || culprit->get("name") == "filename") return false;
        e.children.erase(culprit);
        note(error, "ignored");
        return true;
    }
    bool replace(Element& e, Category category, const InputError& error) {
        if (category == Category::bsdf) {
            e.set("type", "diffuse");
            e.children.clear();
            note(error, "a grey diffuse stands in its place");
            return true;
        }
        static const std::map<Category, std::string> usual = {{Category::integrator, "volpath"},
                                                              {Category::sensor, "perspective"},
                                                              {Category::film, "hdrfilm"},
                                                              {Category::sampler, "sobol"}};
        const auto it = usual.find(category);
        const bool other = it != usual.end() && e.get("type") != it->second;
        if (!other || !registry_.find(category, it->second)) return note(error, "left out"), false;
        e.set("type", it->second);
        note(error, "'" + it->second + "' stands in its place");
        return true;
    }

    const Registry& registry_;
    std::map<const Element*, InputError> errors_;
    std::map<std::string, const Element*> ids_;  ///< where each is first given
};

}  // namespace

std::vector<std::string> remedy(Element& scene, const Faults& faults, const Registry& registry) {
    Remedy remedy(faults, scene, registry);
    remedy.below(scene);
    if (faults.has(scene)) {  // attributes of <scene> itself
        scene.fault.reset();
        std::erase_if(scene.attributes, [](const auto& attribute) { return attribute.first != "version"; });
        for (const Fault& f : faults.all())
            if (f.element == &scene) remedy.note(f.error, "ignored");
    }
    return std::move(remedy.notes);
}

}  // namespace mote::core
