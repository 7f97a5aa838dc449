// Media: coefficients in Mitsuba's words, emission dropped, grids as .vol files.
//
// Mitsuba's heterogeneous medium ends at the bounding box of its sigma_t, and that of a <volume
// type="constvolume"> is the unit cube (src/media/heterogeneous.cpp, intersect_aabb; Volume::bbox). So does
// ours for a gridvolume, which is written as it is; a constant is passed to the shape that bounds it, and is
// therefore written as a homogeneous medium or as a grid of one voxel.
#include <fmt/format.h>

#include <filesystem>

#include "apps/export/export_context.h"
#include "core/formats/xml/scene_values.h"
#include "media/vdb_grid.h"
#include "media/vdb_to_vol.h"

namespace mote::apps {

using core::Element, core::Rgb;

namespace {

Rgb coefficient(Element& medium, const std::string& name, float default_value) {
    const Element* value = medium.child(name);
    return value ? colour_of(*value, false) : Rgb(default_value);
}

/// sigma_s and sigma_a as sigma_t and albedo; all of them written out.
void export_homogeneous(Element& medium) {
    Rgb sigma_t, albedo;
    if (medium.child("sigma_s") || medium.child("sigma_a")) {
        const Rgb sigma_s = coefficient(medium, "sigma_s", 0.0f);
        sigma_t = sigma_s + coefficient(medium, "sigma_a", 0.0f);
        for (int c = 0; c < 3; ++c) albedo[c] = sigma_t[c] > 0.0f ? sigma_s[c] / sigma_t[c] : 0.0f;
        remove_child(medium, "sigma_s"), remove_child(medium, "sigma_a");
    } else {
        sigma_t = coefficient(medium, "sigma_t", 1.0f), albedo = coefficient(medium, "albedo", 0.75f);
    }
    set_child(medium, make_rgb(medium, "sigma_t", sigma_t));
    set_child(medium, make_rgb(medium, "albedo", albedo));
}

void drop_emission(Element& medium, bool emissive, const ExportContext& context) {
    std::string dropped;
    for (const char* name : {"Le", "Lescale", "temperature", "temperature_scale", "temperature_offset"})
        if (remove_child(medium, name)) dropped += (dropped.empty() ? "" : ", ") + std::string(name);
    if (!dropped.empty())
        context.note(medium, "emission was dropped (" + dropped + ")" +
                                 (emissive ? ": this medium glows here and does not there" : ""));
}

/// References become copies: a volume or phase function then stands in its medium alone.
void inline_references(Element& medium, const ExportContext& context) {
    for (Element& c : medium.children) {
        if (c.tag != "ref") continue;
        Element copy = core::resolve(c, context.ids);
        copy.erase("id");
        copy.erase("name");
        if (c.find("name")) copy.set("name", c.get("name"));
        c = copy;
    }
}

void export_phase(Element& medium) {
    Element* phase = medium.child_with_tag("phase");
    if (!phase) {
        medium.children.push_back(make_object(medium, "phase", "isotropic", ""));
        return;
    }
    if (phase->get("type") == "hg" && !phase->child("g"))
        phase->children.push_back(phase->make_value("float", "g", "0.8"));
}

void replace_by_grid(Element& volume, const std::string& name, Element to_world) {
    volume.set("type", "gridvolume");
    volume.children = {volume.make_value("string", "filename", name),
                       volume.make_value("boolean", "use_grid_bbox", "true")};
    if (!to_world.children.empty()) volume.children.push_back(std::move(to_world));
}

/// The box of everything, a little enlarged: for a constant.
core::Bounds3 surroundings(const core::Scene& scene) {
    core::Bounds3 box = scene.bounds();
    const core::Vec3 margin = 0.01f * box.diagonal() + 1e-3f;
    return {box.lower - margin, box.upper + margin};
}

void write_constant_grid(Element& volume, const Rgb& value, const ExportContext& context) {
    media::VolFile file;
    file.resolution = {1, 1, 1};
    file.channels = 3;
    file.bounds = surroundings(context.scene);
    file.values = {value.x, value.y, value.z};
    const std::string name = context.free_name("volumes", "constant", ".vol");
    context.result.grids[name] = std::move(file);
    context.note(volume, "a constant became " + name + ", one voxel as large as the scene");
    replace_by_grid(volume, name, {});
}

std::string text_of(Element& object, const std::string& name, const std::string& default_value) {
    const Element* value = object.child(name);
    return value ? value->get("value") : default_value;
}

/// The grid's own transform goes before that of the scene file, which stays as it is written.
Element grid_transform(Element& volume, const core::Transform& index_to_world) {
    Element* written = volume.child("to_world");
    Element result = volume.make_value("transform", "to_world", "");
    result.erase("value");
    Element matrix = result;
    matrix.tag = "matrix", matrix.attributes.clear();
    std::string numbers;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            numbers += (numbers.empty() ? "" : " ") + fmt::format("{}", index_to_world.matrix[column][row]);
    matrix.set("value", numbers);
    result.children.push_back(matrix);
    if (written)
        result.children.insert(result.children.end(), written->children.begin(), written->children.end());
    return result;
}

void export_vdb(Element& volume, bool is_extinction, const ExportContext& context) {
    const std::string path = context.find_file(volume), grid_name = text_of(volume, "grid", "density");
    const std::string clamp = text_of(volume, "clamp_negative", "false");
    media::VdbLoadOptions options;
    options.clamp_negative = clamp == "true" || clamp == "True";
    const auto grid = media::load_vdb_grid(path, grid_name, options);
    if (grid->uniform()) {
        write_constant_grid(volume, Rgb(grid->background()), context);
        return;
    }
    if (is_extinction && grid->background() > 0.0f)
        context.note(volume, fmt::format("grid '{}' has the background {}: Mitsuba's medium ends one voxel "
                                         "beyond the grid",
                                         grid->name(), grid->background()));
    // Two volumes of one grid share its twin.
    const std::string stem = std::filesystem::path(path).stem().string() + "_" + grid->name();
    const std::string key = "volumes/" + stem + ".vol";
    media::VolFile file = media::dense_twin(*grid, context.max_grid_bytes);
    const auto old = context.result.grids.find(key);
    const bool same = old != context.result.grids.end() && old->second.values == file.values &&
                      old->second.resolution == file.resolution &&
                      old->second.bounds.lower == file.bounds.lower;
    const std::string name = same ? key : context.free_name("volumes", stem, ".vol");
    context.note(volume, fmt::format("vdbvolume '{}' became {}, {} x {} x {} voxels", grid->name(), name,
                                     file.resolution.x, file.resolution.y, file.resolution.z));
    Element to_world = grid_transform(volume, grid->index_to_world());
    if (!same) context.result.grids[name] = std::move(file);
    replace_by_grid(volume, name, std::move(to_world));
}

void export_vol(Element& volume, const ExportContext& context) {
    if (remove_child(volume, "clamp_negative")) {
        const std::string path = context.find_file(volume);
        const std::string name =
            context.free_name("volumes", std::filesystem::path(path).stem().string(), ".vol");
        context.result.grids[name] = media::read_vol_file(path, true);
        set_child(volume, volume.make_value("string", "filename", name));
        context.note(volume, "negative voxels of " + name + " were raised to 0");
        return;
    }
    context.copy_file(volume, "volumes");
}

}  // namespace

void export_volume(Element& volume, bool is_extinction, const ExportContext& context) {
    if (volume.get("type") == "vdbvolume") export_vdb(volume, is_extinction, context);
    if (volume.get("type") == "gridvolume" && text_of(volume, "filename", "").rfind("volumes/", 0) != 0)
        export_vol(volume, context);
}

namespace {

/// A constant parameter of a medium, or nothing when it is a grid.
std::optional<Rgb> constant_of(Element& medium, const std::string& name, float default_value) {
    Element* value = medium.child(name);
    if (!value) return Rgb(default_value);
    if (core::is_value_tag(value->tag)) return colour_of(*value, false);
    if (value->get("type") != "constvolume") return std::nullopt;
    if (name == "sigma_t" && value->child("to_world")) return std::nullopt;  // it ends there as well
    return coefficient(*value, "value", 1.0f);
}

void export_heterogeneous(Element& medium, const ExportContext& context) {
    if (Element* density = medium.child("density")) density->set("name", "sigma_t");
    const auto sigma_t = constant_of(medium, "sigma_t", 1.0f), albedo = constant_of(medium, "albedo", 0.75f);
    if (sigma_t && albedo) {
        context.note(medium,
                     "a heterogeneous medium with constants became 'homogeneous': Mitsuba would end it at "
                     "the unit cube");
        medium.set("type", "homogeneous");
        set_child(medium, make_rgb(medium, "sigma_t", *sigma_t));
        set_child(medium, make_rgb(medium, "albedo", *albedo));
        return;
    }
    if (sigma_t) {
        Element volume = make_object(medium, "volume", "gridvolume", "sigma_t");
        write_constant_grid(volume, *sigma_t, context);
        set_child(medium, volume);
    }
    if (albedo) set_child(medium, make_rgb(medium, "albedo", *albedo));
    for (Element& c : medium.children)
        if (c.tag == "volume") export_volume(c, c.get("name") == "sigma_t", context);
}

}  // namespace

void export_medium(Element& medium, const ExportContext& context) {
    bool emissive = false;
    for (const auto& object : context.scene.media())
        if (object->id == medium.get("id")) emissive = object->traits().emissive;
    drop_emission(medium, emissive, context);
    inline_references(medium, context);
    export_phase(medium);
    if (medium.get("type") == "homogeneous")
        export_homogeneous(medium);
    else
        export_heterogeneous(medium, context);
}

}  // namespace mote::apps
