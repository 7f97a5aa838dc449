#include "screenspace/ssbc.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>
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

using Sides = std::vector<const SsbcSurfaces*>;

/// Pixels that light is gathered at.
struct Gathering {
    std::vector<std::uint32_t> pixels;
    std::vector<SsbcReceiver> receivers;
};

/// E = T_r L / reflectance at all pixels, step after step. Hidden sides lie below the picture.
class Steps {
  public:
    /// `dark`: pixels of the tall picture that take no part; none where it is empty.
    Steps(const SsbcSurfaces& visible, const Sides& hidden, std::span<const std::uint8_t> dark,
          const SsbcSettings& settings)
        : surfaces_(in_one_picture(visible, hidden)),
          settings_(settings),
          in_picture_(visible.pixel_count()),
          patches_(pixel_patches(surfaces_, side_layout(visible.height, hidden.size()),
                                 settings.discontinuity_angle)) {
        for (std::size_t i = 0; i < dark.size();
             ++i)  // not before: dark surfaces bound the patches of others
            if (dark[i]) patches_[i] = {}, surfaces_.area[i] = 0.0f;
        pyramid_.emplace(surfaces_.width, surfaces_.height,
                         sending(patches_, surfaces_.facing, settings.grazing_angle),
                         settings.discontinuity_angle);
        light_.emplace(*pyramid_);
        all_ = gathering(settings.half_resolution ? half_resolution_pixels(surfaces_) : all_pixels(), false);
        if (!hidden.empty()) seen_ = gathering(all_.pixels, true);
    }

    const SsbcSurfaces& surfaces() const { return surfaces_; }

    /// `of_all`: at hidden pixels as well, and not just at those of the picture.
    std::vector<Rgb> irradiance(std::span<const Rgb> reflected, bool of_all, SsbcResult& result) {
        light_->fill(*pyramid_, reflected);
        std::vector<Rgb> irradiance(surfaces_.pixel_count(), Rgb(0.0f));
        const bool hidden = surfaces_.pixel_count() > in_picture_;
        const Gathering& at = of_all || !hidden ? all_ : seen_;
        gather(at, irradiance, result);
        if (!settings_.half_resolution) return irradiance;
        const Gathering defective =
            gathering(upsample(surfaces_, at.pixels, settings_.upsampling, irradiance), hidden && !of_all);
        gather(defective, irradiance, result);
        result.defective += defective.pixels.size();
        return irradiance;
    }

  private:
    std::vector<std::uint32_t> all_pixels() const {
        return cells_along_z_curve(surfaces_.width, surfaces_.height, [this](int x, int y) {
            return surfaces_.area[std::size_t(y) * std::size_t(surfaces_.width) + std::size_t(x)] > 0.0f;
        });
    }
    Gathering gathering(std::vector<std::uint32_t> pixels, bool in_picture_alone) const {
        if (in_picture_alone) std::erase_if(pixels, [this](std::uint32_t p) { return p >= in_picture_; });
        auto receivers = receivers_at(patches_, pixels);
        return {std::move(pixels), std::move(receivers)};
    }
    void gather(const Gathering& at, std::span<Rgb> irradiance, SsbcResult& result) const {
        const ResidualSum sum{*pyramid_, *light_, settings_.bound, settings_.visibility};
        std::vector<Rgb> gathered(at.pixels.size());
        result.counts += settings_.hierarchical
                             ? sum.hierarchical(settings_.refinement, at.receivers, gathered)
                             : sum.flat(settings_.refinement, at.receivers, gathered);
        for (std::size_t i = 0; i < gathered.size(); ++i) irradiance[at.pixels[i]] = gathered[i];
    }

    SsbcSurfaces surfaces_;
    const SsbcSettings& settings_;
    std::size_t in_picture_;
    std::vector<PixelPatch> patches_;
    std::optional<SurfacePyramid> pyramid_;
    std::optional<LightPyramid> light_;
    Gathering all_, seen_;  ///< the latter where there are hidden sides
};

/// Where each side begins in the tall picture.
std::size_t begin_of(const SsbcSurfaces& visible, std::size_t hidden, std::size_t side) {
    return std::size_t(side_layout(visible.height, hidden).pitch) * std::size_t(visible.width) * side;
}

/// Light of the picture and of hidden sides below it; and which hidden pixels have none.
std::vector<Rgb> all_light(const SsbcSurfaces& visible, std::span<const Rgb> reflected,
                           std::span<const HiddenSide> hidden, std::vector<std::uint8_t>& dark,
                           SsbcResult& result) {
    std::vector<Rgb> light(begin_of(visible, hidden.size(), hidden.size()) + visible.pixel_count(),
                           Rgb(0.0f));
    std::copy(reflected.begin(), reflected.end(), light.begin());
    for (std::size_t s = 0; s < hidden.size(); ++s)
        std::copy(hidden[s].reflected.begin(), hidden[s].reflected.end(),
                  light.begin() + std::ptrdiff_t(begin_of(visible, hidden.size(), s + 1)));
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
    Sides sides;
    for (const HiddenSide& side : hidden) {
        side.surfaces.check(), sides.push_back(&side.surfaces);
        require(side.reflected.size() == surfaces.pixel_count(), "light must have one entry a pixel");
    }

    SsbcResult result;
    std::vector<std::uint8_t> dark;
    std::vector<Rgb> light = all_light(surfaces, reflected, hidden, dark, result);
    Steps steps(surfaces, sides, dark, settings);
    std::vector<Rgb> total(surfaces.pixel_count(), Rgb(0.0f));
    for (int step = 0; step < settings.steps; ++step) {
        const bool last = step + 1 == settings.steps;
        const std::vector<Rgb> irradiance = steps.irradiance(light, !last, result);
        for (std::size_t i = 0; i < light.size(); ++i)
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
    s.half_resolution = false, s.visibility = nullptr;
    s.check(), surfaces.check();
    Sides sides;
    for (const SsbcSurfaces& side : hidden) side.check(), sides.push_back(&side);
    Steps steps(surfaces, sides, {}, s);
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
        const std::size_t begin = begin_of(surfaces, hidden.size(), side + 1);
        matter.emplace_back(surfaces.pixel_count());
        for (std::size_t i = 0; i < surfaces.pixel_count(); ++i) matter.back()[i] = light[begin + i].x > 0.0f;
    }
    return matter;
}

}  // namespace mote::screenspace
