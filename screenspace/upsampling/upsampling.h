// Light that is found at a fraction of the pixels, and between them from neighbours that see the same
// (bilateral upsampling).
//
// The pixels of a lattice are shaded. Any other pixel p takes the light of the four lattice points q around
// it, as far as they see its surface, or its depth of a medium (same_surface.h):
//   y_p = m_p sum_q k_q w_pq y_q / sum_q k_q w_pq m_q,                        (1)
// with k the bilinear weights and m what is known of every pixel without noise, such as transmittance times
// albedo: a ratio of sums per channel, so that texture stays sharp and a channel without light has none.
// Where what fits has less than a sixteenth of the bilinear weights, the pixel is to be shaded again, by
// itself. It does not depend on where light comes from. Biased by what light does between lattice points:
// contact shadows, mostly.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"
#include "screenspace/layer_filter/layer_filter.h"

namespace mote::screenspace {

/// First surface or medium along the ray of a pixel.
struct UpsamplingPoint {
    core::Vec3 position{0.0f};                      ///< [m]
    core::Vec3 normal{0.0f}, shading_normal{0.0f};  ///< unit, towards the viewer
    float footprint = 0.0f;                         ///< of a pixel there, across the ray [m]
    float distance = FilterFeatures::far;           ///< of the surface along the ray [m]; of volumes alone
    float transmittance = 1.0f;                     ///< to there, mean over channels; of volumes alone
    core::Rgb modulation{0.0f};                     ///< m; black: no light, whatever the neighbours have
    bool shared = true;  ///< false: its light is not shared, such as on glossy surfaces and behind mirrors
};

/// Every `spacing`-th pixel in both directions, from (column, row) on.
struct ShadedLattice {
    int spacing = 1, column = 0, row = 0;  ///< [pixels]
    /// True for a pixel of the lattice.
    bool holds(int x, int y) const { return (x - column) % spacing == 0 && (y - row) % spacing == 0; }
};

/// Weights of the neighbours of every pixel.
class Upsampling {
  public:
    /// Points row by row from the top; they are kept by reference. Throws std::invalid_argument unless sizes
    /// fit, the spacing is positive and the first lattice point lies in the first `spacing` columns and rows.
    Upsampling(int width, int height, const ShadedLattice& lattice, LayerKind kind,
               std::span<const UpsamplingPoint> points);

    /// Pixels that must be shaded besides those of the lattice, in ascending order: those that have light but
    /// have no neighbour to take it from.
    std::span<const std::uint32_t> again() const { return again_; }
    /// Sets the light of all pixels that are neither of the lattice nor among again(), from that of the
    /// lattice.
    void fill(std::span<core::Rgb> light) const;

  private:
    struct Neighbour {
        std::size_t pixel;
        float weight;
    };
    struct Neighbours {
        Neighbour of[4];
        int count = 0;
        float fits = 0.0f, all = 0.0f;  ///< sums of the weights, and of the bilinear part alone
    };
    Neighbours neighbours(int x, int y) const;
    core::Rgb modulation_of(const Neighbours& neighbours) const;  ///< sum of k_q w_pq m_q
    bool fit(std::size_t pixel, const Neighbours& neighbours) const;
    float alike(const UpsamplingPoint& a, const UpsamplingPoint& b) const;

    int width_, height_;
    ShadedLattice lattice_;
    LayerKind kind_;
    std::span<const UpsamplingPoint> points_;
    std::vector<std::uint32_t> again_;
};

}  // namespace mote::screenspace
