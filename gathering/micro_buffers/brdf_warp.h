// A square over the hemisphere whose texels are small where a BSDF reflects much (Engelhardt 2013,
// Sec. 8.1.3).
//
// The BSDF for one direction to the viewer, times the cosine, is tabulated over the cosine square
// (hemisphere_texels.h, whose area is projected solid angle over pi: a diffuse BSDF is constant there). Its
// marginal distribution by u and its conditional ones by v, both linear within cells, map the cosine square
// (u, v) to the warped one (x, y) and back.
#pragma once

#include <vector>

#include "gathering/micro_buffers/disc_raster.h"
#include "gathering/micro_buffers/hemisphere_texels.h"

namespace mote::gathering {

class BrdfWarp {
  public:
    /// f(wi) is the BSDF [1/sr] for local directions wi with wi.z > 0, without the cosine: finite, not
    /// negative. The table has cells x cells cells, with the mean of four values each. Throws InputError for
    /// 0 or more than 256 cells.
    template <typename F>
    BrdfWarp(std::uint32_t cells, const F& f) : BrdfWarp(cells) {
        const float size = 1.0f / float(cells);
        for (std::uint32_t u = 0; u < cells; ++u)
            for (std::uint32_t v = 0; v < cells; ++v) {
                core::Rgb sum(0.0f);
                for (int k = 0; k < 4; ++k)
                    sum += f(square_to_hemisphere(size * core::Vec2(float(u) + 0.25f + 0.5f * float(k % 2),
                                                                    float(v) + 0.25f + 0.5f * float(k / 2))));
                values_[u * cells + v] = 0.25f * sum;
            }
        integrate();
    }

    std::uint32_t cells() const { return cells_; }  ///< along each side of the table
    /// Directional albedo: f times the cosine over the hemisphere, by the table.
    core::Rgb integral() const { return integral_; }
    bool black() const { return !(total_ > 0.0); }  ///< reflects nothing: there is no warp

    /// From the warped square to the cosine square and back. Both grow with each coordinate. In columns and
    /// cells where nothing is reflected the first is not onto.
    core::Vec2 to_cosine_square(const core::Vec2& warped) const;
    core::Vec2 to_warped_square(const core::Vec2& cosine) const;
    /// Bounding box of the image of the box [lower, upper] of the cosine square.
    void warp_box(const core::Vec2& lower, const core::Vec2& upper, core::Vec2& warped_lower,
                  core::Vec2& warped_upper) const;

    /// Directions of one place in [0, 1)^2 of each of side x side texels; black warps leave those of the
    /// cosine square.
    void fill_directions(std::uint32_t side, const core::Vec2& place, RayDirections& rays) const;
    /// Weight of each texel: the sum of weight times radiance is reflected radiance. The weights sum to
    /// integral() in luminance, in other channels as far as texels are smaller than cells.
    void fill_weights(std::uint32_t side, std::span<core::Rgb> weights) const;

  private:
    explicit BrdfWarp(std::uint32_t cells);
    void integrate();
    std::uint32_t column_of(float x) const;  ///< of the warped square
    std::uint32_t cell_of(std::uint32_t column, float y) const;
    float conditional(std::uint32_t column, float v) const;

    std::uint32_t cells_;
    std::vector<core::Rgb> values_;  ///< mean of f a cell, column by column [1/sr]
    /// Distribution functions at the borders of cells: cells + 1 by u, and as many for each column by v.
    std::vector<float> marginal_, conditional_;
    core::Rgb integral_{0.0f};
    double total_ = 0.0;
};

}  // namespace mote::gathering
