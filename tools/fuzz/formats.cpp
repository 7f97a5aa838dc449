// The readers, each called as the commands call it.
#include "tools/fuzz/formats.h"

#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "apps/partial_render.h"
#include "core/files/whole_file.h"
#include "core/formats/meshes/mesh_file.h"
#include "core/formats/pictures/image_file.h"
#include "core/formats/xml/scene_loader.h"
#include "core/geometry/triangle_mesh.h"
#include "core/objects/error.h"
#include "core/parameters/add_type.h"
#include "core/render/checkpoint.h"
#include "core/render/integrator.h"
#include "lights/register_lights.h"
#include "media/register_media.h"
#include "media/vdb_grid.h"
#include "media/vol_file.h"
#include "session/reference_metadata.h"
#include "tools/fuzz/seeds.h"
#include "trade/methods_file.h"
#include "trade/record.h"
#include "trade/reference.h"

namespace mote::fuzz {

namespace {

// Integrators read numbers and words as every object does; these represent all of them, so that the harness
// links no renderer.
class NoIntegrator final : public core::Integrator {
  public:
    std::string type() const override { return "path"; }
    std::vector<core::Layer> layers(const core::Scene&) const override { return {}; }
    core::Plan plan(const core::Scene&, const core::Requirements&) const override { return {}; }
    std::unique_ptr<core::Estimator> prepare(const core::Scene&, const core::RenderOptions&) const override {
        return nullptr;
    }
};

struct FuzzedParameters {
    int max_depth = -1, rr_depth = 5;
    bool hide_emitters = false;
    double clamp = 0.0;
    core::Rgb tint{1.0f};
    std::string mode;
};

std::shared_ptr<const core::Registry> make_registry() {
    auto registry = std::make_shared<core::Registry>();
    core::register_core(*registry);
    media::register_media(*registry);
    lights::register_lights(*registry);
    for (const char* type : {"path", "volpath"})
        core::add_type<FuzzedParameters>(
            *registry, core::Category::integrator, type, "",
            {core::row("max_depth", &FuzzedParameters::max_depth, ""),
             core::row("rr_depth", &FuzzedParameters::rr_depth, ""),
             core::row("hide_emitters", &FuzzedParameters::hide_emitters, ""),
             core::row("clamp", &FuzzedParameters::clamp, ""), core::row("tint", &FuzzedParameters::tint, ""),
             core::row("mode", &FuzzedParameters::mode, "")},
            "", [](const FuzzedParameters&) { return std::make_shared<NoIntegrator>(); });
    return registry;
}

const char* const small_scene = R"(<scene version="3.0.0"><shape type="sphere"/><emitter type="constant"/>
 <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="4"/><integer name="height" value="3"/>
 </film></sensor></scene>)";

std::string text_of(const std::string& path) {
    const std::vector<std::byte> bytes = core::read_whole_file(path);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void use_mesh(core::MeshData data) {
    const core::TriangleMesh mesh(std::move(data));
    if (std::isnan(mesh.area())) throw std::logic_error("the area of a mesh is NaN");
}

void read_mesh(const std::string& path) {
    std::vector<std::string> notes;
    use_mesh(core::load_mesh(path, false, path.ends_with(".obj"), notes));
}

// The second mesh is found by the table at the end of the file.
void read_serialized(const std::string& path) {
    std::vector<std::string> notes;
    for (const int index : {0, 1})
        use_mesh(core::load_mesh_as("serialized", path, false, false, notes, index));
}

// With a scene around them, for Embree is to build what was read.
void read_curves(const std::string& type, const std::string& path, const core::Registry& registry) {
    core::load_scene_from_string("<scene version=\"3.0.0\"><shape type=\"" + type +
                                     "\"><string name=\"filename\" value=\"" + path +
                                     "\"/></shape><emitter type=\"constant\"/><sensor "
                                     "type=\"perspective\"/></scene>",
                                 ".", registry);
}

void read_picture(const std::string& path) {
    const core::Bitmap bitmap = core::read_bitmap(path, false);
    if (bitmap.pixels.size() != std::size_t(bitmap.width) * std::size_t(bitmap.height))
        throw std::logic_error("a picture with other pixels than its size says");
}

// It has halves and control passes, or neither.
void read_checkpoint(const std::string& path) {
    try {
        core::Film halves = small_film(core::PassSplit::halves);
        core::ControlPasses controls(halves);
        core::read_checkpoint(path, {checkpoint_hash, 7}, halves, controls);
        halves.error(controls.pixels(halves));
        return;
    } catch (const core::InputError&) {
    }
    core::Film film = small_film();
    core::read_checkpoint(path, {checkpoint_hash, 7}, film);
    film.beauty(), film.beauty_variance_of_mean(), film.noise();
}

// Merged with the passes after it.
void read_partial_film(const std::string& path) {
    const std::string next = (std::filesystem::path(path).parent_path() / next_film).string();
    std::vector<std::string> paths = {path};
    if (std::filesystem::exists(next)) paths.push_back(next);
    const apps::MergedFilm merged = apps::merge_partials(paths);
    merged.film->beauty(), merged.film->beauty_variance_of_mean(), merged.film->noise();
}

void read_vdb(const std::string& path) {
    media::VdbLoadOptions options;
    options.clamp_negative = true, options.time_limit = 4.0;
    options.memory_limit = std::uint64_t(768) << 20;  // a page takes its time, and files here are small
    std::string name = "density";
    if (const auto grids = media::list_vdb_grids(path, options); !grids.empty()) name = grids.front().name;
    const auto grid = media::load_vdb_grid(path, name, options);
    std::vector<core::Vec3d> places = {core::Vec3d(0.0), core::Vec3d(1.5, 2.5, 3.5),
                                       core::Vec3d(-1e9, 0.0, 1e9)};
    std::vector<float> values(places.size());
    media::lookup_density(*grid, places, values);
}

Format mesh(const std::string& name, const std::string& extension, const std::vector<std::string>& exported) {
    return {name, extension, "assimp", read_mesh, [exported] { return exported_cubes(exported); }, {}};
}

Format picture(const std::string& name, const std::string& extension, std::vector<Bytes> (*seeds)(),
               const std::string& reader = "mote") {
    return {name, extension, reader, read_picture, seeds, {}};
}

Format textual(Format format) {
    format.text = true;
    return format;
}

}  // namespace

std::vector<Format> formats() {
    const auto registry = make_registry();
    const std::shared_ptr<const core::Scene> scene =
        core::load_scene_from_string(small_scene, ".", *registry);
    const std::string camera = session::world_to_camera(scene->camera());
    const auto pictures = [camera] { return exr_seeds(camera); };

    std::vector<Format> all;
    const auto read_scene = [registry](const std::string& path) { core::load_scene(path, *registry); };
    all.push_back(textual({"scene", ".xml", "mote", read_scene, scene_seeds, {}}));
    all.push_back(textual({"glTF scene", ".gltf", "mote", read_scene, gltf_scene_seeds, {}}));
    all.push_back(textual({"pbrt scene", ".pbrt", "mote", read_scene, pbrt_scene_seeds, {}}));
    all.push_back({"GLB scene", ".glb", "mote", read_scene, glb_scene_seeds, {}});
    all.push_back(textual({"obj", ".obj", "mote", read_mesh, obj_seeds, {}}));
    all.push_back(textual({"ply", ".ply", "mote", read_mesh, ply_seeds, {}}));
    all.push_back({"serialized", ".serialized", "mote", read_serialized, serialized_seeds, {}});
    for (const std::string type : {"bsplinecurve", "linearcurve"})
        all.push_back(
            textual({type,
                     ".txt",
                     "mote",
                     [registry, type](const std::string& path) { read_curves(type, path, *registry); },
                     curve_seeds,
                     {}}));
    all.push_back({"vol",
                   ".vol",
                   "mote",
                   [](const std::string& path) { media::read_vol_file(path, true); },
                   vol_seeds,
                   {}});
    all.push_back({"checkpoint", ".checkpoint", "mote", read_checkpoint, checkpoint_seeds, forge_checkpoint});
    all.push_back({"partial film", ".film", "mote", read_partial_film, partial_film_seeds, forge_checkpoint});
    all.push_back(textual({"methods",
                           ".json",
                           "mote",
                           [registry, scene](const std::string& path) {
                               std::vector<std::string> warnings;
                               trade::read_methods_file(path, *registry, *scene, warnings);
                           },
                           methods_seeds,
                           {}}));
    all.push_back(textual({"trade records",
                           ".csv",
                           "mote",
                           [](const std::string& path) { trade::records_from_csv(text_of(path), path); },
                           record_seeds,
                           {}}));
    Format metadata{
        "EXR metadata",
        ".exr",
        "mote",
        [scene](const std::string& path) { trade::load_reference(path, *scene, "0123456789abcdef", {}); },
        pictures,
        {}};
    metadata.head = 2048;
    all.push_back(metadata);
    all.push_back({"exr", ".exr", "OpenEXR", read_picture, pictures, {}});
    all.push_back(picture("png", ".png", png_seeds, "libpng"));
    all.back().forge = forge_png;
    all.push_back(picture("jpeg", ".jpg", jpeg_seeds, "libjpeg"));
    all.push_back(picture("hdr", ".hdr", hdr_seeds));
    all.push_back(picture("pnm", ".ppm", pnm_seeds));
    all.push_back(picture("pfm", ".pfm", pfm_seeds));
    all.push_back(picture("bmp", ".bmp", bmp_seeds));
    all.push_back(picture("tga", ".tga", targa_seeds));
    all.push_back({"vdb", ".vdb", "OpenVDB", read_vdb, [] { return std::vector<Bytes>(); }, {}});
    all.push_back(Format{"stl", ".stl", "assimp", read_mesh, stl_seeds, {}});
    all.push_back(mesh("glb", ".glb", {"glb2"}));
    all.push_back(textual({"gltf", ".gltf", "assimp", read_mesh, gltf_seeds, {}}));
    all.push_back(textual(mesh("dae", ".dae", {"collada"})));
    all.push_back(mesh("3ds", ".3ds", {"3ds"}));
    all.push_back(mesh("fbx", ".fbx", {"fbxa"}));
    all.push_back(textual({"off", ".off", "assimp", read_mesh, off_seeds, {}}));
    return all;
}

const Format& find_format(const std::vector<Format>& all, const std::string& name) {
    std::string known;
    for (const Format& format : all) {
        if (format.name == name) return format;
        known += " '" + format.name + "'";
    }
    throw std::invalid_argument("no format '" + name + "'; there are" + known);
}

Outcome try_file(const Format& format, const std::string& path, std::string& message) {
    try {
        format.read(path);
        return Outcome::read;
    } catch (const core::InputError& error) {
        message = error.what();
        return Outcome::refused;
    } catch (const std::exception& error) {
        message = error.what();
    } catch (...) {
        message = "something that is no std::exception was thrown";
    }
    return Outcome::defect;
}

}  // namespace mote::fuzz
