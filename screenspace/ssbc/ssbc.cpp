#include "screenspace/ssbc/ssbc.h"

#include <algorithm>
#include <stdexcept>

#include "screenspace/ssbc/ssbc_blur.h"
#include "screenspace/ssbc/ssbc_steps.h"

namespace mote::screenspace {

using namespace core;

namespace {

/// Light of the picture and of hidden sides below it; and which hidden pixels have none.
std::vector<Rgb> all_light(const SsbcSurfaces& visible, std::span<const Rgb> reflected,
                           std::span<const HiddenSide> hidden, std::vector<std::uint8_t>& dark,
                           SsbcResult& result) {
    std::vector<Rgb> light(begin_of_side(visible, hidden.size(), hidden.size()) + visible.pixel_count(),
                           Rgb(0.0f));
    std::copy(reflected.begin(), reflected.end(), light.begin());
    for (std::size_t s = 0; s < hidden.size(); ++s)
        std::copy(hidden[s].reflected.begin(), hidden[s].reflected.end(),
                  light.begin() + std::ptrdiff_t(begin_of_side(visible, hidden.size(), s + 1)));
    for (Rgb& l : light)
        if (!is_finite(l)) l = Rgb(0.0f), ++result.non_finite;
    if (hidden.empty()) return light;
    dark.assign(light.size(), 0);
    for (std::size_t i = visible.pixel_count(); i < light.size(); ++i) dark[i] = is_black(light[i]);
    return light;
}

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
    return compensate(surfaces, reflected, {}, settings);
}

SsbcResult compensate(const SsbcSurfaces& surfaces, std::span<const Rgb> reflected,
                      std::span<const HiddenSide> hidden, const SsbcSettings& settings) {
    settings.check(), surfaces.check();
    require(reflected.size() == surfaces.pixel_count(), "light must have one entry a pixel");
    std::vector<const SsbcSurfaces*> sides;
    for (const HiddenSide& side : hidden) {
        side.surfaces.check(), sides.push_back(&side.surfaces);
        require(side.reflected.size() == surfaces.pixel_count(), "light must have one entry a pixel");
    }

    SsbcResult result;
    std::vector<std::uint8_t> dark;
    std::vector<Rgb> light = all_light(surfaces, reflected, hidden, dark, result);
    SsbcSteps steps(surfaces, sides, dark, settings);
    std::vector<Rgb> total(surfaces.pixel_count(), Rgb(0.0f));
    for (int step = 0; step < settings.steps; ++step) {
        const bool last = step + 1 == settings.steps;
        const std::vector<Rgb> irradiance = steps.irradiance(light, !last, result);
        for (std::size_t i = 0; i < light.size(); ++i)  // T_r^n R_0, a term of Eq. 11.3
            light[i] = steps.surfaces().reflectance[i] * irradiance[i];
        for (std::size_t i = 0; i < total.size(); ++i) total[i] += irradiance[i];
    }
    if (settings.blur > 0.0f) total = blurred(surfaces, total, settings.blur, settings.upsampling.angle);
    result.compensation.resize(total.size());
    for (std::size_t i = 0; i < total.size(); ++i)
        result.compensation[i] = surfaces.reflectance[i] * total[i];
    return result;
}

std::vector<std::vector<std::uint8_t>> sides_that_matter(const SsbcSurfaces& surfaces,
                                                         std::span<const SsbcSurfaces> hidden,
                                                         const SsbcSettings& settings) {
    // G is the same both ways: what the picture would light up is what lights the picture.
    SsbcSettings s = settings;
    s.half_resolution = false;
    s.check(), surfaces.check();
    std::vector<const SsbcSurfaces*> sides;
    for (const SsbcSurfaces& side : hidden) side.check(), sides.push_back(&side);
    SsbcSteps steps(surfaces, sides, {}, s);
    std::vector<Rgb> light(steps.surfaces().pixel_count(), Rgb(0.0f));
    std::fill_n(light.begin(), surfaces.pixel_count(), Rgb(1.0f));
    SsbcResult counts;
    for (int step = 0; step < s.steps; ++step) {
        const std::vector<Rgb> irradiance = steps.irradiance(light, true, counts);
        for (std::size_t i = surfaces.pixel_count(); i < light.size(); ++i)
            if (irradiance[i].x > 0.0f) light[i] = Rgb(1.0f);
    }
    std::vector<std::vector<std::uint8_t>> matter;
    for (std::size_t side = 0; side < hidden.size(); ++side) {
        const std::size_t begin = begin_of_side(surfaces, hidden.size(), side + 1);
        matter.emplace_back(surfaces.pixel_count());
        for (std::size_t i = 0; i < surfaces.pixel_count(); ++i) matter.back()[i] = light[begin + i].x > 0.0f;
    }
    return matter;
}

}  // namespace mote::screenspace
