// A registry for tests of the scene language: the real core, and small lights, media and integrators that
// record what they were given.
#pragma once

#include <string>

#include "core/formats/xml/scene_loader.h"
#include "core/objects/properties.h"
#include "core/parameters/add_type.h"
#include "core/render/integrator.h"
#include "core/scene/emitter.h"
#include "core/scene/medium.h"
#include "tests/support/catch.h"

namespace mote::tests {

/// Point light, area light or environment with nothing but a position and a power.
struct FakeEmitter : core::Emitter {
    core::EmitterTraits kind;
    core::Vec3 position{0, 0, 0};
    core::Rgb strength{1.0f};
    const core::Shape* shape = nullptr;

    core::EmitterTraits traits() const override { return kind; }
    std::optional<core::DirectSample> sample_direct(const core::Vec3&, const core::Vec2&) const override {
        return std::nullopt;
    }
    float pdf_direct(const core::Vec3&, const core::Vec3&, const core::SurfaceHit*) const override {
        return 0.0f;
    }
    std::optional<core::EmissionSample> sample_emission(const core::Vec2&, const core::Vec2&) const override;
    core::EmissionDensity pdf_emission(const core::Vec3&, const core::Vec3&,
                                       const core::Vec3&) const override {
        return {1.0f, 1.0f};
    }
    core::Rgb power() const override { return strength; }
    std::optional<core::LightBounds> bounds() const override {
        if (!kind.delta_position) return std::nullopt;
        return core::LightBounds{.box = {position, position}, .intensity = double(core::average(strength))};
    }
    void set_shape(const core::Shape* s) override { shape = s; }
};

/// Homogeneous and purely absorbing.
struct FakeMedium : core::Medium {
    core::Rgb sigma_t{1.0f};
    bool emissive = false;

    core::MediumTraits traits() const override;
    const core::PhaseFunction& phase() const override { throw std::logic_error("no phase function"); }
    core::MediumCoefficients coefficients(const core::Vec3&) const override { return {sigma_t, {}, {}}; }
    float majorant() const override { return core::max_component(sigma_t); }
    core::Bounds3 bounds() const override {
        return {core::Vec3(-core::infinity), core::Vec3(core::infinity)};
    }
    std::optional<float> sample_collision(const core::Ray&, core::PathWeights&, core::Rgb&, core::Rng&,
                                          core::TrackingCounters&) const override {
        return std::nullopt;
    }
    void connect(const core::Ray& ray, core::PathWeights& w, core::Rng& rng,
                 core::TrackingCounters& counters) const override {
        w.throughput *= transmittance(ray, rng, counters);
    }
    core::Rgb transmittance(const core::Ray& ray, core::Rng&, core::TrackingCounters&) const override {
        return core::exp_minus(sigma_t * (ray.t_max - ray.t_min));
    }
};

/// Keeps the properties it was made of.
struct FakeIntegrator : core::Integrator {
    core::Properties properties;
    std::string type() const override { return properties.type; }
    std::vector<core::Layer> layers(const core::Scene&) const override { return {}; }
    core::Plan plan(const core::Scene&, const core::Requirements&) const override { return {}; }
    std::unique_ptr<core::Estimator> prepare(const core::Scene&, const core::RenderOptions&) const override {
        return nullptr;
    }
};

/// Emitters point, area and constant; media homogeneous (sigma_t, emissive); integrators fake (every kind of
/// parameter) and other (max_depth alone).
const core::Registry& test_registry();

/// A file of the version given, with a sensor and a light unless they are in `body` already.
std::string scene_xml(const std::string& body, const std::string& version = "3.0.0");

std::unique_ptr<core::Scene> load(const std::string& xml, const core::LoadOptions& options = {});
inline std::unique_ptr<core::Scene> load_body(const std::string& body,
                                              const core::LoadOptions& options = {}) {
    return load(scene_xml(body), options);
}
/// The properties of the fake integrator of a scene.
const core::Properties& integrator_of(const core::Scene& scene);
/// A value that an element was given, or another one.
template <typename T>
T value_of(const core::Properties& properties, const std::string& name, T otherwise = T()) {
    struct Holder {
        T value{};
    };
    return core::ParameterList<Holder>(Holder{std::move(otherwise)}, {core::row(name, &Holder::value, "")})
        .read(properties)
        .value;
}
/// The message of the InputError that loading ends with; "" when it loads. The file is called "test.xml".
std::string load_error(const std::string& xml, const core::LoadOptions& options = {});

/// Message of the InputError that loading the file ends with; "" when it loads.
std::string file_error(const std::string& path);
inline bool contains(const std::string& text, const std::string& part) {
    INFO(text << " should contain " << part);
    const bool found = text.find(part) != std::string::npos;
    CHECK(found);
    return found;
}

}  // namespace mote::tests
