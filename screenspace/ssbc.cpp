#include "screenspace/ssbc.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <stdexcept>

#include "screenspace/ssbc_blur.h"
#include "screenspace/ssbc_receivers.h"

namespace mote::screenspace {

using namespace core;

namespace {

/// Patches as senders: smaller for pixels that are seen at a slant (Engelhardt 2013, Sec. 11.2.3).
std::vector<PixelPatch> sending(std::vector<PixelPatch> patches, std::span<const float> facing,
                                float grazing_angle) {
    for (std::size_t i = 0; i < patches.size(); ++i) {
        const float left = 0.5f * pi - std::acos(std::min(1.0f, facing[i]));  // to a right angle
        if (left < 0.5f * pi - grazing_angle) patches[i].area *= sqr(left / (0.5f * pi - grazing_angle));
    }
    return patches;
}

/// E = T_r L / reflectance at all pixels, step after step.
class Steps {
  public:
    Steps(const SsbcSurfaces& surfaces, const SsbcSettings& settings)
        : surfaces_(surfaces),
          settings_(settings),
          patches_(pixel_patches(surfaces, settings.discontinuity_angle)),
          pyramid_(surfaces.width, surfaces.height,
                   sending(patches_, surfaces.facing, settings.grazing_angle), settings.discontinuity_angle),
          light_(pyramid_),
          pixels_(settings.half_resolution ? half_resolution_pixels(surfaces) : all_pixels()),
          receivers_(receivers_at(patches_, pixels_)) {}

    std::vector<Rgb> irradiance(std::span<const Rgb> reflected, SsbcResult& result) {
        light_.fill(pyramid_, reflected);
        std::vector<Rgb> irradiance(surfaces_.pixel_count(), Rgb(0.0f));
        gather(pixels_, receivers_, irradiance, result);
        if (!settings_.half_resolution) return irradiance;
        const auto defective = upsample(surfaces_, pixels_, settings_.upsampling, irradiance);
        gather(defective, receivers_at(patches_, defective), irradiance, result);
        result.defective += defective.size();
        return irradiance;
    }

  private:
    std::vector<std::uint32_t> all_pixels() const {
        return cells_along_z_curve(surfaces_.width, surfaces_.height, [this](int x, int y) {
            return surfaces_.area[std::size_t(y) * std::size_t(surfaces_.width) + std::size_t(x)] > 0.0f;
        });
    }
    void gather(std::span<const std::uint32_t> pixels, std::span<const SsbcReceiver> receivers,
                std::span<Rgb> irradiance, SsbcResult& result) const {
        const ResidualSum sum{pyramid_, light_, settings_.bound};
        std::vector<Rgb> gathered(pixels.size());
        result.counts += settings_.hierarchical ? sum.hierarchical(settings_.refinement, receivers, gathered)
                                                : sum.flat(settings_.refinement, receivers, gathered);
        for (std::size_t i = 0; i < pixels.size(); ++i) irradiance[pixels[i]] = gathered[i];
    }

    const SsbcSurfaces& surfaces_;
    const SsbcSettings& settings_;
    std::vector<PixelPatch> patches_;
    SurfacePyramid pyramid_;
    LightPyramid light_;
    std::vector<std::uint32_t> pixels_;
    std::vector<SsbcReceiver> receivers_;
};

void require(bool fine, const char* message) {
    if (!fine) throw std::invalid_argument(message);
}

}  // namespace

void SsbcSettings::check() const {
    require(std::isfinite(bound) && bound >= 0.0f, "the bound must be finite and not negative");
    require(steps >= 1, "at least one step is needed");
    require(refinement.levels >= 1, "at least one level is needed");
    require(refinement.projected_angle >= 0.0f && refinement.discontinuity_projected_angle >= 0.0f,
            "thresholds of projected solid angles must not be negative");
    require(discontinuity_angle > 0.0f && discontinuity_angle <= 0.5f * pi,
            "the angle of discontinuities must lie above 0 and at most at a right angle");
    require(grazing_angle >= 0.0f && grazing_angle <= 0.5f * pi,
            "the grazing angle must be at most a right angle");
    require(upsampling.angle > 0.0f && upsampling.angle <= 0.5f * pi,
            "the angle of upsampling must lie above 0 and at most at a right angle");
    require(std::isfinite(blur) && blur >= 0.0f, "the blur must be finite and not negative");
}

SsbcResult compensate(const SsbcSurfaces& surfaces, std::span<const Rgb> reflected,
                      const SsbcSettings& settings) {
    settings.check(), surfaces.check();
    require(reflected.size() == surfaces.pixel_count(), "light must have one entry a pixel");

    SsbcResult result;
    std::vector<Rgb> light(reflected.begin(), reflected.end()), total(light.size(), Rgb(0.0f));
    for (std::size_t i = 0; i < light.size(); ++i)
        if (!is_finite(light[i])) light[i] = Rgb(0.0f), ++result.non_finite;

    Steps steps(surfaces, settings);
    for (int step = 0; step < settings.steps; ++step) {
        const std::vector<Rgb> irradiance = steps.irradiance(light, result);
        for (std::size_t i = 0; i < light.size(); ++i)
            total[i] += irradiance[i], light[i] = surfaces.reflectance[i] * irradiance[i];
    }
    if (settings.blur > 0.0f) total = blurred(surfaces, total, settings.blur, settings.upsampling.angle);
    result.compensation.resize(total.size());
    for (std::size_t i = 0; i < total.size(); ++i)
        result.compensation[i] = surfaces.reflectance[i] * total[i];
    return result;
}

}  // namespace mote::screenspace
