#include "screenspace/ssbc/ssbc_steps.h"

#include <algorithm>

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

}  // namespace

std::size_t begin_of_side(const SsbcSurfaces& visible, std::size_t hidden, std::size_t side) {
    return std::size_t(side_layout(visible.height, hidden).pitch) * std::size_t(visible.width) * side;
}

SsbcSteps::SsbcSteps(const SsbcSurfaces& visible, const std::vector<const SsbcSurfaces*>& hidden,
                     std::span<const std::uint8_t> dark, const SsbcSettings& settings)
    : surfaces_(in_one_picture(visible, hidden)),
      settings_(settings),
      in_picture_(visible.pixel_count()),
      patches_(pixel_patches(surfaces_, side_layout(visible.height, hidden.size()),
                             settings.discontinuity_angle)) {
    // Not before there are patches.
    for (std::size_t i = 0; i < dark.size(); ++i)
        if (dark[i]) patches_[i] = {}, surfaces_.area[i] = 0.0f;
    pyramid_.emplace(surfaces_.width, surfaces_.height,
                     sending(patches_, surfaces_.facing, settings.grazing_angle),
                     settings.discontinuity_angle);
    light_.emplace(*pyramid_);
    all_ = gathering(settings.half_resolution ? half_resolution_pixels(surfaces_) : all_pixels(), false);
    if (!hidden.empty()) seen_ = gathering(all_.pixels, true);
}

std::vector<Rgb> SsbcSteps::irradiance(std::span<const Rgb> reflected, bool of_all, SsbcResult& result) {
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

std::vector<std::uint32_t> SsbcSteps::all_pixels() const {
    return cells_along_z_curve(surfaces_.width, surfaces_.height, [this](int x, int y) {
        return surfaces_.area[std::size_t(y) * std::size_t(surfaces_.width) + std::size_t(x)] > 0.0f;
    });
}

SsbcSteps::Gathering SsbcSteps::gathering(std::vector<std::uint32_t> pixels, bool in_picture_alone) const {
    if (in_picture_alone) std::erase_if(pixels, [this](std::uint32_t p) { return p >= in_picture_; });
    auto receivers = receivers_at(patches_, pixels);
    return {std::move(pixels), std::move(receivers)};
}

void SsbcSteps::gather(const Gathering& at, std::span<Rgb> irradiance, SsbcResult& result) const {
    const ResidualSum sum{*pyramid_, *light_, settings_.bound};
    std::vector<Rgb> gathered(at.pixels.size());
    result.counts += settings_.hierarchical ? sum.hierarchical(settings_.refinement, at.receivers, gathered)
                                            : sum.flat(settings_.refinement, at.receivers, gathered);
    for (std::size_t i = 0; i < gathered.size(); ++i) irradiance[at.pixels[i]] = gathered[i];
}

}  // namespace mote::screenspace
