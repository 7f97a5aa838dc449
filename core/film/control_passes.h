// Control passes: samples at a few pixels of a picture, besides its own, that show its error
// (core/metrics/control_error.h).
//
// The pixels are chosen by chance when a filter has worked on the first passes: the more often, the larger
// the error that is expected there. The image of a control pass has one of them a column, and rows for
// ControlPasses::share samples for each pixel of the picture. Its random numbers are not those of the
// picture, and those of one row are independent of another's: rows show the variance of their mean, which
// passes do not, whose points are a sequence.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/film/film.h"
#include "core/film/pixel_columns.h"

namespace mote::core {

class ControlPasses {
  public:
    /// Samples of a control pass for each one of a pass of the picture.
    static constexpr double share = 0.5;
    /// Memory of them, and of an image of a control pass, for a film of this size [B].
    static double memory(int width, int height, std::span<const Layer> layers);

    ControlPasses() : sums_(1, 1, {}) {}  ///< none, now and later
    /// For a film that keeps halves: none before choose().
    explicit ControlPasses(const Film& film);

    /// True where choose() is to be called.
    bool can_choose() const { return count_ > 0 && columns_.empty(); }
    /// Chooses pixels of the film, which Estimator::finish() has worked on, by `seed`.
    void choose(const Film& film, std::uint64_t seed);
    bool empty() const { return columns_.empty(); }           ///< there are no pixels
    const PixelColumns& columns() const { return columns_; }  ///< the pixels
    /// Index of the control pass of a part that comes next.
    std::uint32_t next_pass(std::size_t part) const { return sums_.next_pass(part); }
    /// Adds that pass. `light`: the beauty of the part in one layer, of the columns' size.
    void add_pass(const PassImage& light, std::size_t part);
    /// The control pixels as they are by now, for Film::error() of the same film; of parts without control
    /// passes, as the film's own passes have them. Empty where no part has any. Valid until this object
    /// changes.
    ControlPixels pixels(const Film& film) const;
    std::uint64_t non_finite() const { return sums_.non_finite(); }  ///< as of Film

    std::vector<std::byte> serialize() const;  ///< for checkpoints; not where there are none
    /// Throws InputError for bytes of another film's, or damaged ones.
    void deserialize(std::span<const std::byte> bytes);

  private:
    void add_own_samples(std::vector<ControlPixel>& controls, std::size_t part) const;
    void set_pixels(std::span<const std::uint32_t> indices, std::vector<float> represented);
    std::uint32_t index_of(std::size_t i) const;  ///< of a control pixel in the film
    int width_ = 0, height_ = 0;                  ///< of the film
    std::size_t count_ = 0;                       ///< of pixels, once they are chosen
    std::vector<float> represented_;              ///< of each pixel of the film: ControlPixels::represented
    PixelColumns columns_;
    Film sums_;  ///< of the control passes; one layer a part
};

/// How much each pixel of a film is likely to add to what is not known of its error, relative to the mean
/// over pixels; nowhere below a quarter: where noise is left or was removed, and at edges, which a filter
/// blurs. The film keeps halves.
std::vector<double> importance_for_error(const Film& film);

}  // namespace mote::core
