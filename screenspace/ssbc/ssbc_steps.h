// The residual operator at all pixels of a picture and of the sides it hides, once or several times.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "screenspace/ssbc/ssbc.h"
#include "screenspace/ssbc/ssbc_receivers.h"

namespace mote::screenspace {

/// Where a side begins among all pixels: 0 is the picture, then the hidden ones.
std::size_t begin_of_side(const SsbcSurfaces& visible, std::size_t hidden, std::size_t side);

class SsbcSteps {
  public:
    /// `dark`: pixels of the tall picture (ssbc_layers.h) that take no part; none where it is empty. They
    /// still bound the patches of others. Keeps a reference to the settings.
    SsbcSteps(const SsbcSurfaces& visible, const std::vector<const SsbcSurfaces*>& hidden,
              std::span<const std::uint8_t> dark, const SsbcSettings& settings);

    /// Surfaces of all sides.
    const SsbcSurfaces& surfaces() const { return surfaces_; }

    /// E = T_r L / reflectance, from the light of all sides. `of_all`: at hidden pixels as well, and not just
    /// at those of the picture.
    std::vector<core::Rgb> irradiance(std::span<const core::Rgb> reflected, bool of_all, SsbcResult& result);

  private:
    /// Pixels that light is gathered at.
    struct Gathering {
        std::vector<std::uint32_t> pixels;
        std::vector<SsbcReceiver> receivers;
    };
    std::vector<std::uint32_t> all_pixels() const;
    Gathering gathering(std::vector<std::uint32_t> pixels, bool in_picture_alone) const;
    void gather(const Gathering& at, std::span<core::Rgb> irradiance, SsbcResult& result) const;

    SsbcSurfaces surfaces_;
    const SsbcSettings& settings_;
    std::size_t in_picture_;
    std::vector<PixelPatch> patches_;
    std::optional<SurfacePyramid> pyramid_;
    std::optional<LightPyramid> light_;
    Gathering all_, seen_;  ///< the latter where there are hidden sides
};

}  // namespace mote::screenspace
