// Another way to the same picture is no error; what is lost on the way is said.
#include "core/formats/xml/foreign_integrators.h"

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>

#include "core/formats/xml/element_checks.h"
#include "core/formats/xml/foreign_names.h"
#include "core/formats/xml/lenient_scene.h"
#include "core/formats/xml/object_maker.h"
#include "core/formats/xml/scene_values.h"
#include "core/render/integrator.h"

namespace mote::core {

const std::vector<ForeignIntegrator>& foreign_integrators() {
    static const std::vector<ForeignIntegrator> table = {
        {"direct", "path", "paths of depth 2; samples of lights and of the BSDF are one each", 2},
        {"volpathmis", "volpath", "the same picture; ours always weights the channels against each other"},
        {"ptracer", "path",
         "the same picture from the eye's side, but for caustics of point lights, which 'mote_photon_map' "
         "sees"},
        {"prb", "path", "the same picture, without derivatives"},
        {"prb_basic", "path", "the same picture, without derivatives"},
        {"prb_projective", "path", "the same picture, without derivatives"},
        {"direct_projective", "path", "paths of depth 2, without derivatives", 2},
        {"prbvolpath", "volpath", "the same picture, without derivatives"},
        {"volpath_simple", "volpath", "the same picture"},
        {"aov", "", "its features are layers beside those of the nested integrator"},
        {"moment", "", "the nested integrator runs; for the second moments see --auxiliary and --stats"},
        {"stokes", "", "the nested integrator runs; light is not polarized here"},
    };
    return table;
}

namespace {

void warn(SceneDocument& document, const std::string& message, const SourceLocation& where) {
    document.warnings.push_back(InputError(message, where).what());
}

/// "dd:depth, nn:sh_normal" as names of our layers (core/render/first_hit_features.h).
void read_aovs(const Element& aovs, SceneDocument& document) {
    static const std::map<std::string, std::string> layers = {{"albedo", "Albedo"},
                                                              {"depth", "Depth"},
                                                              {"position", "P"},
                                                              {"geo_normal", "N"},
                                                              {"sh_normal", "Ns"}};
    std::string text = aovs.get("value"), entry;
    std::replace(text.begin(), text.end(), ',', ' ');
    for (std::istringstream stream(text); stream >> entry;) {
        const std::string kind = entry.substr(entry.find(':') + 1);
        const auto it = layers.find(kind);
        if (it == layers.end()) {
            warn(document, "the feature '" + printable(kind) + "' of 'aov' has no layer here", aovs.where);
            continue;
        }
        document.features.push_back(it->second);
        warn(document, "the feature '" + printable(entry) + "' is the layer " + it->second, aovs.where);
    }
}

/// The nested integrator takes the place of `e`. Returns false where there is none.
bool take_nested(Element& e, SceneDocument& document) {
    if (const Element* aovs = e.child("aovs")) read_aovs(*aovs, document);
    const auto is_integrator = [](const Element& c) { return c.tag == "integrator"; };
    const auto nested = std::find_if(e.children.begin(), e.children.end(), is_integrator);
    if (nested == e.children.end()) return false;
    if (std::count_if(e.children.begin(), e.children.end(), is_integrator) > 1)
        warn(document, "of several nested integrators the first runs", nested->where);
    Element inner = std::move(*nested);
    inner.erase("name");
    e = std::move(inner);
    return true;
}

void replace(Element& e, SceneDocument& document, const Registry& registry, int depth) {
    for (const ForeignIntegrator& f : foreign_integrators()) {
        if (e.get("type") != f.from || registry.find(Category::integrator, f.from)) continue;
        const SourceLocation where = e.where;
        std::string to = f.to;
        if (to.empty() && take_nested(e, document)) {
            replace(e, document, registry, depth + 1);
            to = e.get("type");
        } else if (to.empty()) {
            e.children.clear();
            to = "path";
            e.set("type", to);
            e.children.push_back(e.make_value("integer", "max_depth", "2"));
        } else {
            e.set("type", to);
            std::erase_if(e.children,
                          [&](const Element& c) { return f.max_depth > 0 && c.get("name") == "max_depth"; });
            if (f.max_depth > 0)
                e.children.push_back(e.make_value("integer", "max_depth", std::to_string(f.max_depth)));
        }
        warn(document, std::string("integrator '") + f.from + "' is replaced by '" + to + "': " + f.note,
             where);
        return;
    }
}

/// The scene's integrator of this type, else its first, else a fresh one; the only one from then on.
Element& own_integrator(SceneDocument& document, const std::string& type) {
    Element& scene = document.scene;
    const auto integrator = [](const Element& e) { return e.tag == "integrator"; };
    const auto wanted = [&](const Element& e) { return integrator(e) && e.get("type") == type; };
    if (std::any_of(scene.children.begin(), scene.children.end(), wanted))
        std::erase_if(scene.children, [&](const Element& e) { return integrator(e) && !wanted(e); });
    std::optional<std::string> first;
    std::erase_if(scene.children, [&](const Element& e) {
        if (!integrator(e)) return false;
        if (first && *first == e.get("type"))
            warn(document,
                 "the scene has more than one integrator of type '" + printable(*first) + "': ignored",
                 e.where);
        return std::exchange(first, first.value_or(e.get("type"))).has_value();
    });
    if (Element* element = scene.child_with_tag("integrator")) return *element;
    Element fresh;
    fresh.tag = "integrator";
    fresh.where = scene.where, fresh.folder = scene.folder;
    scene.children.push_back(fresh);
    return scene.children.back();
}

/// Everything about the integrator that could be wrong, alone in a scene of its own.
Faults faults_of(Element& alone, const Registry& registry) {
    Faults faults;
    std::vector<std::string> unused;
    check_elements(alone, registry, unused, faults);
    const IdTable ids = collect_ids(alone, faults);
    check_references(alone, ids, registry, faults);
    ObjectMaker maker(registry, ids, {}, faults);
    if (faults.empty()) maker.make_as<Integrator>(alone.children.front());
    return faults;
}

/// The integrator becomes one of another type, with the parameters that it has.
void replace_type(SceneDocument& document, const std::string& type, const Registry& registry) {
    Element& element = own_integrator(document, type);
    const Manual* own = registry.find(Category::integrator, element.get("type"));
    element.set("type", type);
    if (!registry.find(Category::integrator, type)) element.where = {"--integrator " + printable(type), 0};
    const Manual& manual = require_manual(element, registry);
    std::vector<std::string>& warnings = document.warnings;
    drop_foreign_parameters(element, manual, warnings);
    std::erase_if(element.children, [&](const Element& c) {
        if (has_place_for(manual, c)) return false;
        if (!own || !has_place_for(*own, c))
            warn(document, "'" + printable(c.get("name")) + "' is ignored: --integrator is given", c.where);
        return true;
    });
    Element alone;
    alone.tag = "scene", alone.where = element.where;
    alone.children.push_back(element);
    for (int round = 0; round < 64; ++round) {
        const Faults faults = faults_of(alone, registry);
        if (faults.empty()) break;
        Element before = alone.children.front();
        for (const std::string& note : remedy(alone, faults, registry)) warnings.push_back(note);
        const bool another = alone.children.empty() || alone.children.front().get("type") != type;
        if (!another) continue;
        before.children.clear(), before.fault.reset();  // nothing of it is of use
        before.attributes = {{"type", type}};
        alone.children = {before};
    }
    element = alone.children.front();
}

}  // namespace

void replace_foreign_integrators(SceneDocument& document, const Registry& registry) {
    for (Element& e : document.scene.children)
        if (e.tag == "integrator" && !e.fault) replace(e, document, registry, 0);
}

void complete_integrator(SceneDocument& document, const std::string& type, const Registry& registry) {
    const Element* own = document.scene.child_with_tag("integrator");
    if (!own) {
        own_integrator(document, type).set("type", type);
        return;
    }
    const std::string unknown = own->get("type");
    if (unknown.empty() || own->fault || registry.find(Category::integrator, unknown)) return;
    warn(document,
         "unknown integrator type '" + printable(unknown) + "'" +
             suggestion(unknown, registry.types(Category::integrator)) + ": " + type + " takes its place",
         own->where);
    replace_type(document, type, registry);
}

void override_integrator(SceneDocument& document, const std::string& type, const Registry& registry) {
    const Element& element = own_integrator(document, type);
    if (element.get("type") == type && registry.find(Category::integrator, type)) return;  // with its faults
    if (element.find("type") && !registry.find(Category::integrator, element.get("type")))
        warn(document,
             "unknown integrator type '" + printable(element.get("type")) + "': --integrator takes its place",
             element.where);
    replace_type(document, type, registry);
}

}  // namespace mote::core
