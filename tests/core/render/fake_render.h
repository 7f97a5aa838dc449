// A scene and an integrator with nothing in them, for tests of the driver.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/triangle_mesh.h"
#include "core/materials/bsdf.h"
#include "core/render/render_driver.h"
#include "core/scene/emitter.h"
#include "core/scene/scene.h"

namespace mote::tests {

class FakeCamera final : public core::Camera {
  public:
    core::Ray sample_ray(const core::Vec2&, const core::Vec2&) const override { return {}; }
    core::CameraTraits traits() const override { return {.delta_position = true}; }
    std::optional<core::RayImportance> importance(const core::Vec3&, const core::Vec3&,
                                                  float) const override {
        return std::nullopt;
    }
    std::optional<core::CameraSample> sample_importance(const core::Vec3&, const core::Vec2&,
                                                        float) const override {
        return std::nullopt;
    }
    core::Vec3 position() const override { return core::Vec3(0.0f); }
    core::Transform to_world() const override { return {}; }
};

class FakeLight final : public core::Emitter {
  public:
    core::EmitterTraits traits() const override {
        return {core::EmitterKind::point, true, false, false, false};
    }
    std::optional<core::DirectSample> sample_direct(const core::Vec3&, const core::Vec2&) const override {
        return std::nullopt;
    }
    float pdf_direct(const core::Vec3&, const core::Vec3&, const core::SurfaceHit*) const override {
        return 0.0f;
    }
    std::optional<core::EmissionSample> sample_emission(const core::Vec2&, const core::Vec2&) const override {
        return std::nullopt;
    }
    core::EmissionDensity pdf_emission(const core::Vec3&, const core::Vec3&,
                                       const core::Vec3&) const override {
        return {};
    }
    core::Rgb power() const override { return core::Rgb(1.0f); }
};

class FakeBsdf final : public core::Bsdf {
  public:
    core::BsdfTraits traits() const override {
        core::BsdfTraits t;
        t.smooth = t.diffuse = true;
        return t;
    }
    core::Rgb eval(const core::BsdfPoint&, const core::Vec3&, const core::Vec3&,
                   core::TransportMode) const override {
        return core::Rgb(0.0f);
    }
    float pdf_solid_angle(const core::BsdfPoint&, const core::Vec3&, const core::Vec3&,
                          core::TransportMode) const override {
        return 0.0f;
    }
    std::optional<core::BsdfSample> sample(const core::BsdfPoint&, const core::Vec3&, float,
                                           const core::Vec2&, core::TransportMode) const override {
        return std::nullopt;
    }
    core::Rgb albedo(const core::BsdfPoint&, const core::Vec3&) const override { return core::Rgb(0.0f); }
};

inline std::unique_ptr<core::Scene> fake_scene(int width = 37, int height = 21,
                                               std::vector<std::string> files = {}) {
    core::Scene::Parts parts;
    auto mesh = std::make_shared<core::TriangleMesh>(core::make_rectangle());
    mesh->bsdf = std::make_shared<FakeBsdf>();
    parts.shapes.push_back(mesh);
    parts.emitters.push_back(std::make_shared<FakeLight>());
    parts.camera = std::make_shared<FakeCamera>();
    parts.film.width = width, parts.film.height = height, parts.film.sample_count = 20;
    parts.input_files = std::move(files);
    return std::make_unique<core::Scene>(std::move(parts));
}

/// Callback before each pass, with which a test counts, interrupts or throws.
using BeforePass = std::function<void(std::uint32_t index)>;
/// Callback at each pixel, before it is finished.
using AtPixel = std::function<void(int x, int y)>;

/// Noise in two layers of the beauty and one auxiliary layer, from Sampler and the pixel filter.
class FakeEstimator final : public core::Estimator {
  public:
    FakeEstimator(core::RenderOptions options, BeforePass before, AtPixel at_pixel = {})
        : options_(options), before_(std::move(before)), at_pixel_(std::move(at_pixel)) {}

    bool pass(const core::PassContext& context, core::PassImage& image) override {
        if (before_) before_(context.index);
        return core::for_each_tile(
            image.width(), image.height(), 8, context.cancelled, [&](int x0, int y0, int x1, int y1) {
                for (int y = y0; y < y1; ++y)
                    for (int x = x0; x < x1; ++x) {
                        const auto pixel = std::uint64_t(y) * std::uint64_t(image.width()) + std::uint64_t(x);
                        core::Sampler sampler(options_.sampler, options_.seed, context.index, pixel);
                        const core::Vec2 offset = context.filter.sample_offset(sampler.next_2d());
                        image.at(0, x, y) = core::Rgb(0.5f + sampler.next_1d());
                        image.at(1, x, y) = core::Rgb(sampler.next_1d(), 0.25f, offset.x * offset.x);
                        image.at(2, x, y) = core::Rgb(offset.x, offset.y, 0.0f);
                        if (at_pixel_) at_pixel_(x, y);
                        image.finish(x, y);
                    }
            });
    }
    void finish(core::Film& film, core::CancelToken) override {
        film.set_mean(0, std::vector<core::Rgb>(film.pixels(), core::Rgb(7.0f)));
    }

  private:
    core::RenderOptions options_;
    BeforePass before_;
    AtPixel at_pixel_;
};

class CountingIntegrator final : public core::Integrator {
  public:
    explicit CountingIntegrator(BeforePass before = {}, std::string second_layer = "indirect")
        : before_(std::move(before)), second_layer_(std::move(second_layer)) {}
    AtPixel at_pixel;
    std::string type() const override { return "fake"; }
    std::vector<core::Layer> layers(const core::Scene&) const override {
        return {{"direct", "", false}, {second_layer_, "", false}, {"N", "", true}};
    }
    core::Plan plan(const core::Scene&, const core::Requirements&) const override { return {}; }
    std::unique_ptr<core::Estimator> prepare(const core::Scene&,
                                             const core::RenderOptions& options) const override {
        return std::make_unique<FakeEstimator>(options, before_, at_pixel);
    }

  private:
    BeforePass before_;
    std::string second_layer_;
};

inline core::RenderRequest request_for(std::uint32_t passes, const std::string& checkpoint = "") {
    core::RenderRequest request;
    request.seed = 9;
    request.stop.passes = passes;
    request.checkpoint_path = checkpoint;
    request.content_hash = "0123456789abcdef";
    return request;
}

inline std::vector<std::byte> bits(const core::RenderResult& result) { return result.film.serialize(); }

}  // namespace mote::tests
