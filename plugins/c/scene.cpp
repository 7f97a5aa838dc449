// Scenes of the C interface: loading, building, and what is known of them.
#include <span>

#include "core/objects/memory_budget.h"
#include "plugins/c/handles.h"

namespace mote::c {

void LastError::set(const core::InputError& error) {
    if (const auto* several = dynamic_cast<const core::SceneErrors*>(&error))
        errors_ = several->all();
    else
        errors_.assign(1, error);
}

namespace {

constexpr std::size_t max_mesh_count = 0xffffffff;  ///< indices have 32 bits
constexpr double max_grid_values = double(std::size_t(1) << 34);

std::string text_or(const char* text, const char* otherwise) { return text ? text : otherwise; }

session::SceneChanges changes_of(const mote_load_options& options) {
    session::SceneChanges changes;
    changes.integrator = text_or(options.integrator, "");
    changes.lenient = options.lenient != 0;
    for (std::size_t i = 0; i < options.define_count; ++i) {
        const char* name = (&required(options.define_names, "define_names"))[i];
        const char* value = (&required(options.define_values, "define_values"))[i];
        changes.defines.emplace_back(&required(name, "a name of define_names"),
                                     &required(value, "a value of define_values"));
    }
    return changes;
}

/// The new scene takes the place of the old one once it is there.
template <typename Load>
mote_status load(mote_scene* scene, const mote_load_options* given, const Load& load_now) {
    if (!scene) return MOTE_INVALID_ARGUMENT;
    return guarded(scene->error, [&] {
        const mote_load_options options = known_options(given);
        session::LoadedScene loaded = load_now(options, changes_of(options));
        loaded.integrator();  // what is missing is said now
        scene->warnings = loaded.warnings();
        scene->loaded.emplace(std::move(loaded));
        scene->plan.clear();
    });
}

/// A step of building.
template <typename Step>
mote_status build(mote_scene* scene, const Step& step) {
    if (!scene) return MOTE_INVALID_ARGUMENT;
    return guarded(scene->error, [&] { step(scene->tree); });
}

}  // namespace

}  // namespace mote::c

using namespace mote;
using mote::c::required;

mote_scene* mote_scene_new(void) { return new (std::nothrow) mote_scene; }
void mote_scene_free(mote_scene* scene) { delete scene; }

mote_status mote_scene_load_file(mote_scene* scene, const char* path, const mote_load_options* options) {
    return c::load(scene, options, [&](const mote_load_options&, const session::SceneChanges& changes) {
        return session::LoadedScene::from_file(&required(path, "the path"), changes);
    });
}

mote_status mote_scene_load_text(mote_scene* scene, const char* xml, const mote_load_options* options) {
    return c::load(scene, options, [&](const mote_load_options& known, const session::SceneChanges& changes) {
        return session::LoadedScene::from_text(&required(xml, "the text"), c::text_or(known.folder, ""),
                                               changes, c::text_or(known.name, "<string>"));
    });
}

const char* mote_scene_error(const mote_scene* scene) {
    return scene ? scene->error.text() : "the scene is null";
}
const char* mote_scene_error_file(const mote_scene* scene) { return scene ? scene->error.file() : ""; }
int mote_scene_error_line(const mote_scene* scene) { return scene ? scene->error.line() : 0; }
size_t mote_scene_error_count(const mote_scene* scene) { return scene ? scene->error.count() : 0; }
const char* mote_scene_error_at(const mote_scene* scene, size_t index) {
    return scene ? scene->error.text_at(index) : nullptr;
}

int mote_scene_width(const mote_scene* scene) {
    return scene && scene->loaded ? scene->loaded->scene().film().width : 0;
}
int mote_scene_height(const mote_scene* scene) {
    return scene && scene->loaded ? scene->loaded->scene().film().height : 0;
}
size_t mote_scene_warning_count(const mote_scene* scene) { return scene ? scene->warnings.size() : 0; }
const char* mote_scene_warning(const mote_scene* scene, size_t index) {
    return scene && index < scene->warnings.size() ? scene->warnings[index].c_str() : nullptr;
}

const char* mote_scene_plan(mote_scene* scene) {
    if (!scene || !scene->loaded) return "";
    c::guarded(scene->error, [&] {
        if (scene->plan.empty()) scene->plan = scene->loaded->plan().to_text();
    });
    return scene->plan.c_str();
}

mote_status mote_scene_add_mesh(mote_scene* scene, const char* name, const mote_mesh* mesh) {
    return c::build(scene, [&](session::SceneTree& tree) {
        const mote_mesh m = c::known_options(&required(mesh, "the mesh"));
        core::MeshData data;
        if (m.vertex_count > c::max_mesh_count || m.triangle_count > c::max_mesh_count)
            throw c::InvalidArgument("a mesh has at most 2^32 - 1 vertices and triangles");
        core::MemoryBudget().require(double(m.vertex_count) * (2 * sizeof(core::Vec3) + sizeof(core::Vec2)) +
                                         double(m.triangle_count) * sizeof(data.triangles[0]),
                                     "the copy of a mesh");
        for (std::size_t i = 0; i < m.vertex_count; ++i) {
            const float* p = &required(m.positions, "positions") + 3 * i;
            data.positions.emplace_back(p[0], p[1], p[2]);
            if (m.normals)
                data.normals.emplace_back(m.normals[3 * i], m.normals[3 * i + 1], m.normals[3 * i + 2]);
            if (m.uvs) data.uvs.emplace_back(m.uvs[2 * i], m.uvs[2 * i + 1]);
        }
        for (std::size_t i = 0; i < m.triangle_count; ++i) {
            const std::uint32_t* t = &required(m.triangles, "triangles") + 3 * i;
            data.triangles.push_back({t[0], t[1], t[2]});
        }
        tree.arrays().add_mesh(&required(name, "the name"), std::move(data));
    });
}

mote_status mote_scene_add_grid(mote_scene* scene, const char* name, const mote_grid* grid) {
    return c::build(scene, [&](session::SceneTree& tree) {
        const mote_grid g = c::known_options(&required(grid, "the grid"));
        const int channels = g.channels == 0 ? 1 : g.channels;
        if (g.width < 1 || g.height < 1 || g.depth < 1 || (channels != 1 && channels != 3))
            throw c::InvalidArgument(
                "a grid has at least one voxel along each axis, and one or three channels");
        if (double(g.width) * double(g.height) * double(g.depth) * channels > c::max_grid_values)
            throw c::InvalidArgument("a grid has at most 2^34 values");
        const std::size_t count =
            std::size_t(g.width) * std::size_t(g.height) * std::size_t(g.depth) * std::size_t(channels);
        const float* values = &required(g.values, "values");
        core::MemoryBudget().require(double(count) * sizeof(float), "the copy of a grid");
        media::VolFile file;
        file.resolution = {g.width, g.height, g.depth}, file.channels = channels;
        file.bounds.lower = {g.lower[0], g.lower[1], g.lower[2]};
        file.bounds.upper = {g.upper[0], g.upper[1], g.upper[2]};
        file.values.assign(values, values + count);
        tree.arrays().add_grid(&required(name, "the name"), std::move(file));
    });
}

mote_status mote_scene_begin(mote_scene* scene, const char* kind, const char* type, const char* name,
                             const char* id) {
    return c::build(scene, [&](session::SceneTree& tree) {
        tree.begin(&required(kind, "the kind"), &required(type, "the type"), c::text_or(name, ""),
                   c::text_or(id, ""));
    });
}
mote_status mote_scene_end(mote_scene* scene) {
    return c::build(scene, [](session::SceneTree& tree) { tree.end(); });
}
mote_status mote_scene_set_float(mote_scene* scene, const char* name, double value) {
    return c::build(scene,
                    [&](session::SceneTree& tree) { tree.number(&required(name, "the name"), value); });
}
mote_status mote_scene_set_integer(mote_scene* scene, const char* name, int64_t value) {
    return c::build(scene,
                    [&](session::SceneTree& tree) { tree.integer(&required(name, "the name"), value); });
}
mote_status mote_scene_set_boolean(mote_scene* scene, const char* name, int value) {
    return c::build(scene,
                    [&](session::SceneTree& tree) { tree.boolean(&required(name, "the name"), value != 0); });
}
mote_status mote_scene_set_string(mote_scene* scene, const char* name, const char* value) {
    return c::build(scene, [&](session::SceneTree& tree) {
        tree.value("string", &required(name, "the name"), &required(value, "the value"));
    });
}
mote_status mote_scene_set_rgb(mote_scene* scene, const char* name, double r, double g, double b) {
    return c::build(
        scene, [&](session::SceneTree& tree) { tree.triple("rgb", &required(name, "the name"), r, g, b); });
}
mote_status mote_scene_set_point(mote_scene* scene, const char* name, double x, double y, double z) {
    return c::build(
        scene, [&](session::SceneTree& tree) { tree.triple("point", &required(name, "the name"), x, y, z); });
}
mote_status mote_scene_set_vector(mote_scene* scene, const char* name, double x, double y, double z) {
    return c::build(scene, [&](session::SceneTree& tree) {
        tree.triple("vector", &required(name, "the name"), x, y, z);
    });
}
mote_status mote_scene_set_transform(mote_scene* scene, const char* name, const double* rows) {
    return c::build(scene, [&](session::SceneTree& tree) {
        tree.transform(&required(name, "the name"), std::span(&required(rows, "the matrix"), 16));
    });
}
mote_status mote_scene_refer(mote_scene* scene, const char* id, const char* name) {
    return c::build(scene, [&](session::SceneTree& tree) {
        tree.reference(&required(id, "the id"), c::text_or(name, ""));
    });
}

mote_status mote_scene_build(mote_scene* scene, const mote_load_options* options) {
    return c::load(scene, options, [&](const mote_load_options& known, const session::SceneChanges& changes) {
        session::SceneTree tree = std::move(scene->tree);
        scene->tree = session::SceneTree();
        tree.place(c::text_or(known.name, "scene"), c::text_or(known.folder, ""));
        return session::LoadedScene::from_tree(tree, changes);
    });
}
