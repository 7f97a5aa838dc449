// mote info: what a file holds, in a few lines.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "apps/command.h"
#include "apps/picture_file.h"
#include "apps/subcommands.h"
#include "core/formats/xml/converted_scenes.h"
#include "core/formats/pictures/exr_preflight.h"
#include "core/formats/pictures/image_file.h"
#include "core/geometry/triangle_mesh.h"
#include "core/objects/error.h"
#include "media/vdb_grid.h"
#include "media/vol_file.h"
#include "session/placement_notes.h"

namespace mote::apps {

namespace {

using core::Rgb;
using core::Vec3;

template <typename... Args>
void line(fmt::format_string<Args...> format, Args&&... args) {
    std::fputs((fmt::format(format, std::forward<Args>(args)...) + "\n").c_str(), stdout);
}

template <typename V>
std::string triple(const V& v) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", double(v.x), double(v.y), double(v.z));
}
std::string triple(const glm::ivec3& v) { return fmt::format("({}, {}, {})", v.x, v.y, v.z); }
std::string box(const core::Bounds3& b) { return triple(b.lower) + " to " + triple(b.upper); }

// Smallest, largest and mean value, and how many are not finite.
std::string range_text(std::span<const float> values) {
    double lowest = core::infinity, highest = -core::infinity, sum = 0.0;
    std::size_t finite = 0;
    for (const float v : values) {
        if (!std::isfinite(v)) continue;
        lowest = std::min(lowest, double(v)), highest = std::max(highest, double(v)), sum += v, ++finite;
    }
    std::string text =
        finite == 0 ? "no finite value"
                    : fmt::format("{:.6g} to {:.6g}, mean {:.6g}", lowest, highest, sum / double(finite));
    if (finite < values.size()) text += fmt::format(", {} NaN or infinite", values.size() - finite);
    return text;
}

void describe_scene(const std::string& path, const InfoArguments& arguments) {
    const LoadedScene loaded = load({path, "", {}, arguments.lenient, {}, arguments.plugins});
    const core::Scene& scene = loaded.scene();
    const core::Requirements r = core::find_requirements(scene);
    const core::FilmSettings& film = scene.film();
    line("scene {}", core::printable(path));
    line("  picture     {} x {} pixels, {} filter, {} sampler, {} passes", film.width, film.height,
         film.filter, film.sampler, film.sample_count);
    line("  integrator  {}", scene.integrator() ? scene.integrator()->type() : "none named");
    line("  shapes      {}: {} triangles, {} analytic", r.shapes, r.triangles, r.analytic_shapes);
    line("  bounds      {}", box(r.bounds));
    line("  bsdfs       {} diffuse, {} glossy, {} specular, {} null{}", r.bsdfs_diffuse, r.bsdfs_glossy,
         r.bsdfs_delta, r.bsdfs_null, r.textures ? ", with textures" : "");
    line("  lights      {} point, {} area, {} at infinity", r.lights_point, r.lights_area, r.lights_infinite);
    line("  media       {}: {} homogeneous, {} heterogeneous", r.media, r.media_homogeneous,
         r.media_heterogeneous);
    for (const std::string& description : r.media_descriptions) line("              {}", description);
    line("  files       {}", scene.parts().input_files.size());
    for (const std::string& text : loaded.report().approximations) line("  lenient     {}", text);
    for (const std::string& warning : scene.parts().warnings) line("  warning     {}", warning);
    for (const std::string& text : placement_notes(scene)) line("  warning     {}", text);
}

void describe_mesh(const std::string& path, bool flip_v) {
    std::vector<std::string> notes;
    core::MeshData data = core::load_mesh(path, false, flip_v, notes);
    const std::size_t vertices = data.positions.size();
    const bool normals = !data.normals.empty(), uvs = !data.uvs.empty();
    const core::TriangleMesh mesh(std::move(data));
    line("mesh {}", core::printable(path));
    line("  vertices    {}{}{}", vertices, normals ? ", normals" : "", uvs ? ", texture coordinates" : "");
    line("  triangles   {}", mesh.primitive_count());
    line("  bounds      {}", box(mesh.bounds()));
    line("  area        {:.6g} m^2, {}", mesh.area(), mesh.closed() ? "closed" : "open");
    for (const std::string& text : notes) line("  note        {}", text);
    for (const std::string& text : mesh.notes) line("  note        {}", text);
}

void describe_exr(const std::string& path) {
    const core::ExrSummary summary = core::check_exr_header(path);
    const core::ImageChannels image = core::read_exr(path);
    line("OpenEXR picture {}", core::printable(path));
    line("  size        {} x {} pixels, {} channels, {} compression, {}{}", image.width, image.height,
         image.names.size(), summary.compression,
         summary.tiled ? (summary.mip_mapped ? "tiled with levels" : "tiled") : "scan lines",
         summary.parts > 1 ? fmt::format(", first of {} parts", summary.parts) : "");
    for (std::size_t i = 0; i < image.names.size(); ++i)
        line("  {:<24} {}", core::printable(image.names[i]), range_text(image.channels[i]));
    for (const auto& [name, value] : image.metadata)
        line("  {} = {}", core::printable(name), core::printable(value, 400));
}

void describe_bitmap(const std::string& path) {
    const core::Bitmap bitmap = core::read_bitmap(path, false);
    line("picture {}", core::printable(path));
    line("  size        {} x {} pixels", bitmap.width, bitmap.height);
    const char* names[3] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
        std::vector<float> plane;
        for (const Rgb& p : bitmap.pixels) plane.push_back(p[c]);
        line("  {}           {} (linear)", names[c], range_text(plane));
    }
}

// From the outer faces of the first active voxels to those of the last, as the file places them [m].
std::string world_box(const media::VdbGridInfo& g) {
    core::Vec3d lower(double(core::infinity)), upper(-double(core::infinity));
    for (int corner = 0; corner < 8; ++corner) {
        core::Vec3d p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = (corner >> axis) & 1 ? g.upper[axis] + 0.5 : g.lower[axis] - 0.5;
        p = g.index_to_world.point(p);
        lower = glm::min(lower, p), upper = glm::max(upper, p);
    }
    return triple(lower) + " to " + triple(upper);
}

void describe_vdb(const std::string& path) {
    const std::vector<media::VdbGridInfo> grids = media::list_vdb_grids(path);
    line("OpenVDB volume {}: {} grid{}", core::printable(path), grids.size(), grids.size() == 1 ? "" : "s");
    for (const media::VdbGridInfo& g : grids) {
        line("  grid '{}': {}, {}", core::printable(g.name), core::printable(g.type),
             core::printable(g.grid_class));
        line("    voxels    {} active, index box {} to {}", g.active_voxels, triple(g.lower),
             triple(g.upper));
        line("    size      {}{}", triple(g.voxel_size), g.linear ? "" : ", in a frustum");
        if (g.linear && g.active_voxels > 0) line("    world     {}", world_box(g));
        for (const std::string& warning : g.warnings) line("    warning   {}", core::printable(warning, 400));
    }
}

void describe_vol(const std::string& path) {
    const media::VolFile file = media::read_vol_file(path, true);
    line("Mitsuba volume {}", core::printable(path));
    line("  voxels      {} x {} x {}, {} channel{}", file.resolution.x, file.resolution.y, file.resolution.z,
         file.channels, file.channels == 1 ? "" : "s");
    line("  bounds      {}", box(file.bounds));
    line("  values      {}", range_text(file.values));
    if (file.clamped > 0) line("  warning     {} negative voxels, down to {}", file.clamped, file.lowest);
}

}  // namespace

int info_command(const InfoArguments& arguments) {
    const std::string& path = arguments.file;
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) throw core::InputError("there is no such file", {path, 0});
    require_input(path);
    const std::string extension = extension_of(path);
    if (extension == ".xml" || core::is_foreign_scene(path))
        describe_scene(path, arguments);
    else if (extension == ".vdb")
        describe_vdb(path);
    else if (extension == ".vol")
        describe_vol(path);
    else if (extension == ".exr")
        describe_exr(path);
    else if (extension == ".obj" || extension == ".ply" || extension == ".stl" || extension == ".fbx" ||
             extension == ".dae" || extension == ".3ds" || extension == ".off")
        describe_mesh(path, extension == ".obj");
    else
        describe_bitmap(path);
    return exit_ok;
}

}  // namespace mote::apps
