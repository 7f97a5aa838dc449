// Scenes: building element by element, loading, plans; and the manual pages.
#include "python/bindings/bindings.h"
#include "session/registry.h"
#include "viewer/scene_knobs.h"

namespace mote::python {

namespace {

using session::LoadedScene, session::SceneTree;

void add_mesh(SceneTree& tree, const std::string& name, const Floats& positions, const Indices& triangles,
              const std::optional<Floats>& normals, const std::optional<Floats>& uvs) {
    const auto rows = [](const auto& array, std::size_t columns, const char* what) {
        if (array.ndim() != 2 || array.shape(1) != columns)
            throw std::invalid_argument(std::string(what) + " have the shape (n, " + std::to_string(columns) +
                                        ")");
        return array.shape(0);
    };
    core::MeshData mesh;
    for (std::size_t i = 0, n = rows(positions, 3, "positions"); i < n; ++i)
        mesh.positions.emplace_back(positions.data()[3 * i], positions.data()[3 * i + 1],
                                    positions.data()[3 * i + 2]);
    for (std::size_t i = 0, n = rows(triangles, 3, "triangles"); i < n; ++i)
        mesh.triangles.push_back(
            {triangles.data()[3 * i], triangles.data()[3 * i + 1], triangles.data()[3 * i + 2]});
    for (std::size_t i = 0, n = normals ? rows(*normals, 3, "normals") : 0; i < n; ++i)
        mesh.normals.emplace_back(normals->data()[3 * i], normals->data()[3 * i + 1],
                                  normals->data()[3 * i + 2]);
    for (std::size_t i = 0, n = uvs ? rows(*uvs, 2, "uvs") : 0; i < n; ++i)
        mesh.uvs.emplace_back(uvs->data()[2 * i], uvs->data()[2 * i + 1]);
    tree.arrays().add_mesh(name, std::move(mesh));
}

void add_grid(SceneTree& tree, const std::string& name, const Floats& values, const std::vector<float>& lower,
              const std::vector<float>& upper) {
    if ((values.ndim() != 3 && values.ndim() != 4) || lower.size() != 3 || upper.size() != 3)
        throw std::invalid_argument(
            "a grid has the shape (depth, height, width) or (depth, height, width, channels)");
    media::VolFile grid;
    grid.resolution = {int(values.shape(2)), int(values.shape(1)), int(values.shape(0))};
    grid.channels = values.ndim() == 4 ? int(values.shape(3)) : 1;
    grid.bounds.lower = {lower[0], lower[1], lower[2]}, grid.bounds.upper = {upper[0], upper[1], upper[2]};
    grid.values.assign(values.data(), values.data() + values.size());
    tree.arrays().add_grid(name, std::move(grid));
}

using Files = std::vector<std::string>;
using Defines = std::vector<std::pair<std::string, std::string>>;

/// Loading takes long: other threads of Python run meanwhile.
template <typename Load>
LoadedScene load(const session::SceneChanges& changes, const Load& load_now) {
    const nb::gil_scoped_release without_gil;
    LoadedScene loaded = load_now(changes);
    loaded.integrator();  // what is missing is said now
    return loaded;
}

/// An element and all below it: (tag, {attribute: text}, [elements]).
nb::tuple element(const core::Element& e) {
    nb::dict attributes;
    for (const auto& [name, text] : e.attributes) attributes[name.c_str()] = text;
    nb::list children;
    for (const core::Element& child : e.children) children.append(element(child));
    return nb::make_tuple(e.tag, attributes, children);
}

/// The scene with further definitions; those of the same path take the place of earlier ones.
LoadedScene changed(const LoadedScene& scene, const Defines& defines) {
    session::SceneChanges changes = scene.changes();
    for (const auto& [path, value] : defines) {
        std::erase_if(changes.defines, [&path = path](const auto& earlier) { return earlier.first == path; });
        changes.defines.emplace_back(path, value);
    }
    return load(changes, [&](const auto& now) { return scene.reloaded(now); });
}

nb::list entries(const std::vector<core::PlanEntry>& list) {
    nb::list result;
    for (const core::PlanEntry& e : list) {
        nb::dict d;
        d["topic"] = e.topic, d["choice"] = e.choice, d["reason"] = e.reason, d["cure"] = e.cure;
        result.append(d);
    }
    return result;
}

nb::dict described(const core::Parameter& p) {
    nb::dict d;
    d["name"] = p.name, d["type"] = p.type, d["default"] = p.default_value, d["required"] = p.required;
    d["values"] = core::values_text(p), d["choices"] = p.choices, d["unit"] = p.range.unit;
    d["lower"] = p.range.lower, d["upper"] = p.range.upper, d["description"] = p.description;
    return d;
}

/// The manual page of everything that a scene can name.
nb::list manuals() {
    core::Registry registry = session::make_registry();
    session::register_arrays(registry, std::make_shared<session::ArrayStore>());
    nb::list result;
    for (const core::Manual* manual : registry.manuals()) {
        nb::list parameters;
        for (const core::Parameter& p : manual->parameters) parameters.append(described(p));
        nb::dict d;
        d["category"] = core::category_name(manual->category), d["type"] = manual->type;
        d["summary"] = manual->summary, d["example"] = manual->example, d["parameters"] = parameters;
        result.append(d);
    }
    return result;
}

}  // namespace

void bind_scenes(nb::module_& m) {
    nb::class_<SceneTree>(m, "Tree", "A scene that is being built, element by element.")
        .def(nb::init<std::string, std::string>(), nb::arg("name"), nb::arg("folder"))
        .def("begin", &SceneTree::begin, nb::arg("category"), nb::arg("type"), nb::arg("name"), nb::arg("id"),
             nb::arg("label"))
        .def("end", &SceneTree::end)
        .def("value", &SceneTree::value, nb::arg("kind"), nb::arg("name"), nb::arg("text"))
        .def("number", &SceneTree::number, nb::arg("name"), nb::arg("number"))
        .def("triple", &SceneTree::triple, nb::arg("kind"), nb::arg("name"), nb::arg("x"), nb::arg("y"),
             nb::arg("z"))
        .def(
            "transform",
            [](SceneTree& tree, const std::string& name, const std::vector<double>& rows) {
                tree.transform(name, rows);
            },
            nb::arg("name"), nb::arg("rows"))
        .def("reference", &SceneTree::reference, nb::arg("id"), nb::arg("name"))
        .def("add_mesh", &add_mesh, nb::arg("name"), nb::arg("positions"), nb::arg("triangles"),
             nb::arg("normals").none(), nb::arg("uvs").none())
        .def("add_grid", &add_grid, nb::arg("name"), nb::arg("values"), nb::arg("lower"), nb::arg("upper"));

    nb::class_<LoadedScene>(m, "LoadedScene", "A scene that is ready to be rendered.")
        .def_static(
            "from_file",
            [](const std::string& path, const std::string& integrator, const Defines& defines, bool lenient,
               const Files& plugins) {
                return load({integrator, defines, lenient, {}, plugins},
                            [&](const auto& changes) { return LoadedScene::from_file(path, changes); });
            },
            nb::arg("path"), nb::arg("integrator"), nb::arg("defines"), nb::arg("lenient"),
            nb::arg("plugins"))
        .def_static(
            "from_text",
            [](const std::string& xml, const std::string& folder, const std::string& name,
               const std::string& integrator, const Defines& defines, bool lenient, const Files& plugins) {
                return load({integrator, defines, lenient, {}, plugins}, [&](const auto& changes) {
                    return LoadedScene::from_text(xml, folder, changes, name);
                });
            },
            nb::arg("xml"), nb::arg("folder"), nb::arg("name"), nb::arg("integrator"), nb::arg("defines"),
            nb::arg("lenient"), nb::arg("plugins"))
        .def_static(
            "from_tree",
            [](const SceneTree& tree, const std::string& integrator, const Defines& defines, bool lenient,
               const Files& plugins) {
                return load({integrator, defines, lenient, {}, plugins},
                            [&](const auto& changes) { return LoadedScene::from_tree(tree, changes); });
            },
            nb::arg("tree"), nb::arg("integrator"), nb::arg("defines"), nb::arg("lenient"),
            nb::arg("plugins"))
        .def("changed", &changed, nb::arg("defines"))
        .def("elements", [](const LoadedScene& s) { return element(s.elements()); })
        .def("xml", [](const LoadedScene& s) { return viewer::scene_xml(s.elements()); })
        .def_prop_ro("defines", [](const LoadedScene& s) { return s.changes().defines; })
        .def_prop_ro("plugins", [](const LoadedScene& s) { return s.changes().plugins; })
        .def_prop_ro("width", [](const LoadedScene& s) { return s.scene().film().width; })
        .def_prop_ro("height", [](const LoadedScene& s) { return s.scene().film().height; })
        .def_prop_ro("sample_count", [](const LoadedScene& s) { return s.scene().film().sample_count; })
        .def_prop_ro("integrator", [](const LoadedScene& s) { return s.integrator().type(); })
        .def_prop_ro("files", [](const LoadedScene& s) { return s.scene().parts().input_files; })
        .def_prop_ro("warnings", &LoadedScene::warnings)
        .def_prop_ro("hash", [](const LoadedScene& s) { return s.scene_hash(); })
        .def("plan_text", [](const LoadedScene& s) { return s.plan().to_text(); })
        .def("plan", [](const LoadedScene& s) {
            const core::Plan plan = s.plan();
            nb::dict d;
            d["integrator"] = plan.integrator, d["runs"] = entries(plan.runs);
            d["left_out"] = entries(plan.left_out), d["missing"] = entries(plan.missing);
            d["costly"] = plan.costly;
            return d;
        });
    m.def("manuals", &manuals);
}

}  // namespace mote::python
