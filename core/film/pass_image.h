// A picture is the sum of named layers; a pass fills one value per pixel and layer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "core/film/transport.h"
#include "core/math/vec.h"

namespace mote::core {

struct Layer {
    std::string name;         ///< "direct", "indirect_bounded"
    std::string description;  ///< one line for docs and metadata
    bool auxiliary = false;   ///< not part of the beauty (Albedo, N, P, Depth)
    bool squares = false;     ///< the film keeps the sum of squares, and with it the variance
    std::string where = "";   ///< name of a layer of zeros and ones: the mean is that of the passes where it
                              ///< is one (a position where nothing was hit is no position); "": of all
    TransportSet transport = {};  ///< cell that it holds or adds to; empty: none
    std::size_t part = 0;         ///< of the picture: layers of one part have their passes together
    /// Light of the scene that the beauty leaves out, for Film::error(); auxiliary, with squares. One layer.
    bool missing = false;
    /// Films of whole passes keep it at twice the resolution besides (fine_sums.h).
    bool fine = false;
};

/// The picture of one pass: one value per pixel and layer, row by row from the top. Zero at the start.
class PassImage {
  public:
    PassImage(int width, int height, std::size_t layers);
    int width() const { return width_; }
    int height() const { return height_; }
    std::size_t layers() const { return planes_.size(); }
    std::span<Rgb> layer(std::size_t i) { return planes_[i]; }
    std::span<const Rgb> layer(std::size_t i) const { return planes_[i]; }
    Rgb& at(std::size_t layer, int x, int y) {
        return planes_[layer][std::size_t(y) * std::size_t(width_) + std::size_t(x)];
    }
    /// By a name that the integrator has for it.
    template <typename Name>
    requires std::is_enum_v<Name> Rgb& at(Name layer, int x, int y) { return at(std::size_t(layer), x, y); }
    void clear();
    /// Exchanges a layer with one of another image of the same size.
    void swap_layer(std::size_t i, PassImage& other, std::size_t j) {
        planes_.at(i).swap(other.planes_.at(j));
    }

    /// Pixels whose light is complete, one byte each, should the pass end early: a tile writes its own.
    void finish(int x, int y) {
        if (!finishes_late_) finished_[std::size_t(y) * std::size_t(width_) + std::size_t(x)] = 1;
    }
    /// No pixel is complete before all are: finish() has no effect until clear().
    void finish_late() { finishes_late_ = true; }
    std::span<const std::uint8_t> finished() const { return finished_; }

    /// The places of samples are kept from now on.
    void keep_places();
    bool has_places() const { return !places_.empty(); }
    static constexpr int max_reach = 7;  ///< a sample further from its pixel's middle has no place [pixels]
    /// Where the sample of a pixel fell, from which all its light is.
    void place(int x, int y, const Vec2& film);
    static constexpr std::uint32_t nowhere = ~0u;  ///< outside of the picture
    /// The quarter of a pixel that each sample fell into, by the pixel that it belongs to: numbered row by
    /// row in an image of twice the size, or `nowhere`.
    std::span<const std::uint32_t> places() const { return places_; }
    void swap_places(PassImage& other) { places_.swap(other.places_); }

  private:
    int width_, height_;
    bool finishes_late_ = false;
    std::vector<std::uint8_t> finished_;
    std::vector<std::uint32_t> places_;
    std::vector<std::vector<Rgb>> planes_;
};

}  // namespace mote::core
