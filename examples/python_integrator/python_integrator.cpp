// A plugin with the integrator `python`: a class in a Python file that receives the camera's rays and returns
// their radiance, for prototypes. It takes part in render, plan, trade, resume and merge as any other type
// does, and it is slow: each pass calls Python for batches of rays, on one thread.
//
//   mote render scene.xml --plugin python_integrator.so --integrator python -D integrator.file=my.py
//
// The file has a class (`class`, Integrator by default) without arguments and with the method
// radiance(scene, origins, directions, seed); ambient_occlusion.py shows what `scene` can do.
#include "python_side.h"

#include <mote/core/objects/plugin.h>
#include <mote/core/parameters/add_type.h>
#include <mote/core/render/camera_ray.h>

using namespace mote;
using core::Vec3;
using python_side::checked, python_side::Lock, python_side::Object;

namespace {

struct Settings {
    core::FileName file;
    std::string name = "Integrator";
};

/// Calls a function of python_side.h with arguments as Py_BuildValue() takes them.
template <typename... Arguments>
Object call(PyObject* side, const char* name, const char* format, Arguments... arguments) {
    const Object function = checked(PyObject_GetAttrString(side, name)),
                 with = checked(Py_BuildValue(format, arguments...));
    return checked(PyObject_CallObject(function.get(), with.get()));
}

class PythonEstimator final : public core::Estimator {
  public:
    PythonEstimator(const core::Scene& scene, const core::RenderOptions& options, const Settings& settings)
        : scene_(scene), options_(options) {
        if (settings.file.path.empty())
            throw core::InputError("integrator 'python' needs the parameter 'file'");
        const Lock lock;  // also of what an exception leaves
        Object side = python_side::load(), queries = python_side::queries(scene_);
        object_ = call(side.get(), "load", "(ss)", settings.file.path.c_str(), settings.name.c_str());
        side_ = std::move(side), queries_ = std::move(queries);
    }
    ~PythonEstimator() override {
        const Lock lock;
        object_.reset(), queries_.reset(), side_.reset();
    }

    bool pass(const core::PassContext& context, core::PassImage& image) override {
        const int rows = std::max(1, 65536 / image.width());
        for (int y = 0; y < image.height(); y += rows) {
            if (context.cancelled) return false;
            render(context, image, y, std::min(y + rows, image.height()));
        }
        return true;
    }

  private:
    void render(const core::PassContext& context, core::PassImage& image, int begin, int end) {
        std::vector<Vec3> origins, directions;
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < image.width(); ++x) {
                const core::Ray ray = core::camera_ray(scene_.camera(), options_, context, x, y);
                origins.push_back(ray.origin), directions.push_back(ray.direction);
            }
        const auto bytes = Py_ssize_t(origins.size() * sizeof(Vec3));
        const std::uint64_t keys[] = {options_.seed, context.index, std::uint64_t(begin)};
        const Lock lock;
        const Object light = call(side_.get(), "radiance", "(OOy#y#(KKK))", object_.get(), queries_.get(),
                                  origins.data(), bytes, directions.data(), bytes, keys[0], keys[1], keys[2]);
        const auto* values = reinterpret_cast<const float*>(PyBytes_AS_STRING(light.get()));
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < image.width(); ++x, values += 3) {
                image.at(0, x, y) = {values[0], values[1], values[2]};
                image.finish(x, y);
            }
    }

    const core::Scene& scene_;
    core::RenderOptions options_;
    Object side_, queries_, object_;
};

class PythonIntegrator final : public core::Integrator {
  public:
    explicit PythonIntegrator(const Settings& settings) : settings_(settings) {}
    std::string type() const override { return "python"; }
    std::vector<core::Layer> layers(const core::Scene&) const override {
        core::Layer layer{"radiance", "light by a Python class"};
        layer.transport = core::TransportSet::all();
        return {layer};
    }
    core::Plan plan(const core::Scene&, const core::Requirements&) const override {
        core::Plan plan;
        plan.integrator = type();
        plan.run("radiance", settings_.name + " of " + settings_.file.written,
                 "a prototype: one thread, batches of rays");
        return plan;
    }
    std::unique_ptr<core::Estimator> prepare(const core::Scene& scene,
                                             const core::RenderOptions& options) const override {
        return std::make_unique<PythonEstimator>(scene, options, settings_);
    }

  private:
    Settings settings_;
};

void register_types(core::Registry& registry) {
    core::add_type(registry, core::Category::integrator, "python",
                   "A Python class that returns the radiance of rays: for prototypes.",
                   core::ParameterList<Settings>{core::row("file", &Settings::file, "The Python file."),
                                                 core::row("class", &Settings::name, "Its class.")},
                   R"(<integrator type="python"><string name="file" value="my.py"/></integrator>)",
                   [](const Settings& s) { return std::make_shared<PythonIntegrator>(s); });
}

}  // namespace

MOTE_PLUGIN(register_types)
