// The Python half of the plugin `python`: interpreter, errors, and the queries to the scene that the class
// has.
#pragma once

#define PY_SSIZE_T_CLEAN
#include <Python.h>
#include <dlfcn.h>

#include <mote/core/scene/scattering_vertex.h>
#include <mote/core/scene/scene.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace python_side {

using namespace mote;
using core::Rgb, core::Vec3;

/// A reference, released under the interpreter's lock.
using Object = std::unique_ptr<PyObject, decltype([](PyObject* o) { Py_XDECREF(o); })>;

/// The interpreter's lock; starts an interpreter where none runs.
class Lock {
  public:
    Lock() : state_(ensure()) {}
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;
    ~Lock() { PyGILState_Release(state_); }

  private:
    static PyGILState_STATE ensure() {
        if (!Py_IsInitialized()) {
            // The extensions of NumPy look for the interpreter's names among those that all libraries see.
            Dl_info info;
            if (dladdr(reinterpret_cast<void*>(&Py_IsInitialized), &info))
                dlopen(info.dli_fname, RTLD_NOW | RTLD_GLOBAL);
            PyConfig config;
            PyConfig_InitPythonConfig(&config);
            config.install_signal_handlers = 0;
            // Packages are those of the interpreter that the plugin was configured with.
            PyConfig_SetBytesString(&config, &config.program_name, PYTHON_EXECUTABLE);
            const PyStatus status = Py_InitializeFromConfig(&config);
            PyConfig_Clear(&config);
            if (PyStatus_Exception(status)) throw core::InputError(std::string("Python: ") + status.err_msg);
            PyEval_SaveThread();
        }
        return PyGILState_Ensure();
    }
    PyGILState_STATE state_;
};

/// The object, or the exception that Python raised instead.
inline Object checked(PyObject* made) {
    if (made) return Object(made);
    PyObject *type = nullptr, *value = nullptr, *trace = nullptr;
    PyErr_Fetch(&type, &value, &trace);
    PyErr_NormalizeException(&type, &value, &trace);
    const Object kept[] = {Object(type), Object(value), Object(trace)};
    const Object text(PyObject_Str(value));
    throw core::InputError(std::string(reinterpret_cast<PyTypeObject*>(type)->tp_name) + ": " +
                           (text ? PyUnicode_AsUTF8(text.get()) : ""));
}

inline constexpr const char* code = R"(
import collections, importlib.util
import numpy as np

Hit = collections.namedtuple("Hit", "t position normal albedo emitted")
Light = collections.namedtuple("Light", "direction distance weight")

def vectors(values):
    return np.ascontiguousarray(values, np.float32).reshape(-1, 3).tobytes()

def numbers(data, n):
    return np.frombuffer(data, np.float32).reshape(-1, n)

class Scene:
    """Rays are (n, 3) arrays; directions are unit."""
    def __init__(self, queries):
        self.queries = queries
    def first_hit(self, origins, directions):
        """t [m], infinite where nothing is hit; position, a little off the surface; normal, towards the ray's origin; albedo;
        emitted radiance."""
        v = numbers(self.queries["first_hit"](vectors(origins), vectors(directions)), 13)
        return Hit(v[:, 0], v[:, 1:4], v[:, 4:7], v[:, 7:10], v[:, 10:13])
    def visible(self, origins, directions, distances):
        """True where nothing lies before the distance [m]."""
        distances = np.broadcast_to(np.asarray(distances, np.float32), (len(origins),))
        return numbers(self.queries["visible"](vectors(origins), vectors(directions), np.ascontiguousarray(distances).tobytes()), 1)[:, 0] > 0
    def light(self, positions, u):
        """A light sampled by u (n, 3): unit direction, distance [m], and radiance over its density per solid angle."""
        v = numbers(self.queries["light"](vectors(positions), vectors(u)), 7)
        return Light(v[:, :3], v[:, 3], v[:, 4:])

def load(file, name):
    spec = importlib.util.spec_from_file_location("mote_integrator", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return getattr(module, name)()

def radiance(integrator, queries, origins, directions, seed):
    found = integrator.radiance(Scene(queries), numbers(origins, 3), numbers(directions, 3), seed)
    found = np.ascontiguousarray(found, np.float32)
    if found.nbytes != len(origins):
        raise ValueError(f"radiance() returned the shape {found.shape} for {len(origins) // 12} rays")
    return found.tobytes()
)";

/// The module with this code.
inline Object load() {
    const Object compiled = checked(Py_CompileString(code, "python_side.h", Py_file_input));
    return checked(PyImport_ExecCodeModule("mote_python_side", compiled.get()));
}

inline std::span<const Vec3> vectors(PyObject* bytes) {
    return {reinterpret_cast<const Vec3*>(PyBytes_AS_STRING(bytes)),
            std::size_t(PyBytes_GET_SIZE(bytes)) / sizeof(Vec3)};
}
inline PyObject* bytes(const std::vector<float>& values) {
    return PyBytes_FromStringAndSize(reinterpret_cast<const char*>(values.data()),
                                     Py_ssize_t(values.size() * sizeof(float)));
}
inline void append(std::vector<float>& values, const Vec3& v) {
    values.insert(values.end(), {v.x, v.y, v.z});
}
inline const core::Scene& scene_of(PyObject* self) {
    return *static_cast<const core::Scene*>(PyCapsule_GetPointer(self, nullptr));
}

/// t, position, normal, albedo and emitted radiance of the first surface of each ray.
inline PyObject* first_hit(PyObject* self, PyObject* arguments) {
    PyObject *origins, *directions;
    if (!PyArg_ParseTuple(arguments, "SS", &origins, &directions)) return nullptr;
    const auto from = vectors(origins), to = vectors(directions);
    std::vector<float> values;
    for (std::size_t i = 0; i < from.size() && i < to.size(); ++i) {
        const core::Ray ray{from[i], to[i]};
        core::WalkEvent event;
        const auto hit = scene_of(self).first_hit(ray);
        values.push_back(hit ? hit->t : core::infinity);
        if (!hit) {
            values.insert(values.end(), 12, 0.0f);
            continue;
        }
        event.kind = core::WalkEvent::Kind::surface, event.hit = *hit;
        const core::ScatteringVertex vertex = core::make_vertex(event, ray);
        const bool front = glm::dot(hit->shading.n, ray.direction) < 0.0f;
        const Vec3 normal = front ? hit->shading.n : -hit->shading.n;
        append(values, vertex.ray_origin(normal));
        append(values, normal);
        append(values, vertex.diffuse_reflectance().value_or(Rgb(0.0f)));
        append(values, hit->shape->emitter ? hit->shape->emitter->radiance(*hit, -ray.direction) : Rgb(0.0f));
    }
    return bytes(values);
}

/// 1 where nothing lies before the distance, else 0.
inline PyObject* visible(PyObject* self, PyObject* arguments) {
    PyObject *origins, *directions, *distances;
    if (!PyArg_ParseTuple(arguments, "SSS", &origins, &directions, &distances)) return nullptr;
    const auto from = vectors(origins), to = vectors(directions);
    const auto* distance = reinterpret_cast<const float*>(PyBytes_AS_STRING(distances));
    std::vector<float> values;
    for (std::size_t i = 0; i < from.size() && i < to.size(); ++i)
        values.push_back(scene_of(self).visible({from[i], to[i], 0.0f, 0.9999f * distance[i]}) ? 1.0f : 0.0f);
    return bytes(values);
}

/// Direction, distance and weight of a light sampled for each position.
inline PyObject* light(PyObject* self, PyObject* arguments) {
    PyObject *positions, *numbers;
    if (!PyArg_ParseTuple(arguments, "SS", &positions, &numbers)) return nullptr;
    const auto at = vectors(positions), u = vectors(numbers);
    std::vector<float> values;
    for (std::size_t i = 0; i < at.size() && i < u.size(); ++i) {
        const core::LightChoice choice = scene_of(self).choose_light({at[i], Vec3(0.0f)}, u[i].x);
        const auto found =
            choice.emitter ? choice.emitter->sample_direct(at[i], {u[i].y, u[i].z}) : std::nullopt;
        append(values, found ? found->wi : Vec3(0.0f, 0.0f, 1.0f));
        values.push_back(found ? found->distance : 0.0f);
        append(values, found ? found->weight / choice.probability : Rgb(0.0f));
    }
    return bytes(values);
}

/// The three functions by name; the scene must outlive them.
inline Object queries(const core::Scene& scene) {
    static PyMethodDef functions[] = {{"first_hit", &first_hit, METH_VARARGS, nullptr},
                                      {"visible", &visible, METH_VARARGS, nullptr},
                                      {"light", &light, METH_VARARGS, nullptr}};
    const Object self = checked(PyCapsule_New(const_cast<core::Scene*>(&scene), nullptr, nullptr));
    Object all = checked(PyDict_New());
    for (PyMethodDef& function : functions)
        PyDict_SetItemString(all.get(), function.ml_name,
                             checked(PyCFunction_New(&function, self.get())).get());
    return all;
}

}  // namespace python_side
