// The walk over the scene's elements.
#include "apps/export/mitsuba_export.h"

#include <algorithm>
#include <map>
#include <set>

#include "apps/export/export_context.h"
#include "core/formats/xml/scene_builder.h"
#include "core/formats/xml/scene_values.h"
#include "core/geometry/instances.h"
#include "core/materials/bsdf.h"

namespace mote::apps {

using core::Element;

namespace {

bool is_object(const Element& e) { return core::find_category(e.tag).has_value(); }

/// Moves every nested medium to the top with an id, so that others (the camera) can refer to it.
void collect_media(Element& parent, bool top, const core::IdTable& ids, std::vector<Element>& media) {
    for (Element& c : parent.children) {
        if (c.tag != "medium") {
            collect_media(c, false, ids, media);
            continue;
        }
        const std::string name = c.get("name");
        for (int i = 1; !c.find("id"); ++i)
            if (const std::string id = "medium_" + std::to_string(i);
                !ids.count(id) &&
                std::none_of(media.begin(), media.end(), [&](const Element& m) { return m.get("id") == id; }))
                c.set("id", id);
        c.erase("name");
        media.push_back(c);
        if (!top) c = make_reference(parent, name, c.get("id"));
    }
    if (top) std::erase_if(parent.children, [](const Element& c) { return c.tag == "medium"; });
}

void resolve_aliases(Element& parent, const core::IdTable& ids) {
    for (Element& c : parent.children) {
        if (c.tag == "ref") c.set("id", core::resolve(c, ids).get("id"));
        resolve_aliases(c, ids);
    }
}

/// Moves the groups that instances hold to the front, with ids: Mitsuba takes them by reference only.
void collect_groups(Element& scene, const core::IdTable& ids) {
    std::vector<Element> groups;
    for (Element& e : scene.children) {
        if (e.tag != "shape" || e.get("type") != "instance") continue;
        for (Element& c : e.children) {
            if (c.tag != "shape") continue;
            std::string id = c.get("id");
            for (int i = int(groups.size()) + 1; id.empty(); ++i)
                if (const std::string free = "group_" + std::to_string(i); !ids.count(free)) id = free;
            c.set("id", id), c.erase("name");
            groups.push_back(c);
            c = make_reference(e, "", id), c.erase("name");
        }
    }
    scene.children.insert(scene.children.begin(), groups.begin(), groups.end());
}

/// Ids by name instead of aliases, and all media and groups in front.
void normalise(Element& scene) {
    const core::IdTable ids = core::collect_ids(scene);
    resolve_aliases(scene, ids);
    std::vector<Element> media;
    collect_media(scene, true, ids, media);
    std::erase_if(scene.children, [](const Element& c) { return c.tag == "alias"; });
    collect_groups(scene, ids);
    scene.children.insert(scene.children.begin(), media.begin(), media.end());
    scene.set("version", "3.0.0");
}

/// Colours that Mitsuba would convert in its own way, as linear RGB. It tints a <spectrum> on a light.
void export_colours(Element& object) {
    for (Element& c : object.children)
        if (c.tag == "spectrum") c = make_rgb(c, c.get("name"), colour_of(c, object.tag == "emitter"));
}

/// Elements inside any object, from the leaves up; media and sensors have been seen to.
void export_parts(Element& object, const ExportContext& context) {
    export_colours(object);
    for (Element& c : object.children)
        if (is_object(c)) export_parts(c, context);
    if (object.tag == "bsdf") export_bsdf(object, context);
    if (object.tag == "texture" && object.child("filename")) context.copy_file(object, "textures");
    if (object.tag == "volume") export_volume(object, false, context);
    if (object.tag == "emitter") export_emitter(object, context);
}

/// Mitsuba's `path` stops its shadow rays at the bare boundaries of media, which ours does not see.
bool is_bare_boundary(const Element& e, const core::Shape& shape, const ExportContext& context) {
    if (!shape.bsdf->traits().null) return false;
    context.note(e, "the boundary of a medium was dropped: 'path' sees no media");
    return true;
}

bool is_group(const Element& e) { return e.tag == "shape" && e.get("type") == "shapegroup"; }
bool is_member(const Element& e) { return e.tag == "shape" || e.tag == "ref"; }

/// The shapes of a group; `placed` are those of one of its instances.
void export_group(Element& group, std::span<const std::shared_ptr<core::Shape>> placed,
                  const std::string& integrator, const ExportContext& context) {
    std::size_t member = 0;
    std::erase_if(group.children, [&](Element& e) {
        if (!is_member(e)) return false;
        const auto& shape = dynamic_cast<const core::InstancedShape&>(*placed[member++]);
        if (e.tag == "ref") return false;  // it stands elsewhere, and is exported there
        if (integrator == "path" && is_bare_boundary(e, shape, context)) return true;
        export_shape(e, shape.original(), shape, context);
        return false;
    });
}

void export_shapes(Element& scene, const std::string& integrator, const ExportContext& context) {
    struct Group {
        Element* element;
        std::size_t size;  // before bare boundaries are dropped
    };
    std::map<std::string, Group> groups;
    std::set<const Element*> placed, dropped;
    for (Element& e : scene.children)
        if (is_group(e))
            groups[e.get("id")] = {
                &e, std::size_t(std::count_if(e.children.begin(), e.children.end(), is_member))};
    auto shapes = context.scene.shapes();  // those that are left
    for (Element& e : scene.children) {
        if (e.tag != "shape" || is_group(e)) continue;
        if (e.get("type") == "instance") {
            const auto reference = std::find_if(e.children.begin(), e.children.end(), is_member);
            const auto group = groups.find(reference->get("id"));
            if (group == groups.end())
                throw core::InputError("a shapegroup within another object cannot be exported", e.where);
            const auto& [element, size] = group->second;
            if (placed.insert(element).second)
                export_group(*element, shapes.first(size), integrator, context);
            shapes = shapes.subspan(size);
            continue;
        }
        if (integrator == "path" && is_bare_boundary(e, *shapes.front(), context))
            dropped.insert(&e);
        else
            export_shape(e, *shapes.front(), *shapes.front(), context);
        shapes = shapes.subspan(1);
    }
    for (const auto& [id, group] : groups) {
        if (placed.count(group.element)) continue;
        context.note(*group.element, "a shapegroup without an instance was dropped");
        dropped.insert(group.element);
    }
    std::erase_if(scene.children, [&](const Element& e) { return dropped.count(&e) > 0; });
}

}  // namespace

MitsubaExport export_to_mitsuba(core::SceneDocument document, const core::Registry& registry,
                                const std::string& file, std::uint64_t max_grid_bytes) {
    normalise(document.scene);
    const core::Scene scene(core::build_scene(document, registry, file));
    const core::IdTable ids = core::collect_ids(document.scene);
    MitsubaExport result;
    result.scene = document.scene, result.inputs = scene.parts().input_files;
    const ExportContext context{document, registry, scene, ids, max_grid_bytes, result};
    const std::string integrator = export_integrator(result.scene, context);
    for (Element& e : result.scene.children) {
        if (e.tag == "medium") export_medium(e, context);
        if (e.tag == "sensor") export_sensor(e, context);
    }
    // Volumes have been copied into their media.
    std::erase_if(result.scene.children, [](const Element& e) { return e.tag == "volume"; });
    export_shapes(result.scene, integrator, context);
    export_parts(result.scene, context);
    return result;
}

}  // namespace mote::apps
