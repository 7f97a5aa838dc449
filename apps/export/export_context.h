// Shared by the parts of the export: the scene both as elements and as objects, and the files found so far.
#pragma once

#include <string>

#include "apps/export/mitsuba_export.h"
#include "core/formats/xml/element_checks.h"
#include "core/scene/scene.h"

namespace mote::apps {

struct ExportContext {
    const core::SceneDocument& document;
    const core::Registry& registry;
    const core::Scene& scene;
    const core::IdTable& ids;  ///< elements as they were before the export
    std::uint64_t max_grid_bytes;
    MitsubaExport& result;

    /// Adds to the list of what was dropped or changed.
    void note(const core::Element& where, const std::string& text) const;
    /// "cube.ply" in `folder`, or "cube_2.ply" when that is taken.
    std::string free_name(const std::string& folder, const std::string& stem,
                          const std::string& extension) const;
    /// The path behind the element's parameter `filename`, looked up as the loader does.
    std::string find_file(const core::Element& object) const;
    /// Replaces `filename` by that of a copy in `folder` of the export.
    void copy_file(core::Element& object, const std::string& folder) const;
};

/// A nested object such as <phase type="isotropic" name="..."/>, standing where `parent` stands.
core::Element make_object(const core::Element& parent, const std::string& tag, const std::string& type,
                          const std::string& name);
/// <ref name="..." id="..."/>
core::Element make_reference(const core::Element& parent, const std::string& name, const std::string& id);
/// <rgb name="..." value="r, g, b"/> with numbers that read back as the same floats.
core::Element make_rgb(const core::Element& parent, const std::string& name, const core::Rgb& value);
/// Replaces the child of the same name, or adds one.
void set_child(core::Element& parent, core::Element child);
/// True when a child of that name was there.
bool remove_child(core::Element& parent, const std::string& name);
/// The value of an <rgb>, <spectrum>, <float> or <integer>.
core::Rgb colour_of(const core::Element& value, bool emission);
/// The product of the element's transform of that name; the identity when it has none.
core::Transform transform_of(core::Element& object, const std::string& name);

// Export of each kind of element; one file each.

/// Returns the type of the integrator that the exported scene names.
std::string export_integrator(core::Element& scene, const ExportContext& context);
void export_sensor(core::Element& sensor, const ExportContext& context);
/// `placed`: the shape itself, or as an instance places it.
void export_shape(core::Element& element, const core::Shape& shape, const core::Shape& placed,
                  const ExportContext& context);
void export_emitter(core::Element& emitter, const ExportContext& context);
void export_bsdf(core::Element& bsdf, const ExportContext& context);
void export_medium(core::Element& medium, const ExportContext& context);
/// Exports a medium or a texture; one that is exported already stays.
void export_volume(core::Element& volume, bool is_extinction, const ExportContext& context);

}  // namespace mote::apps
