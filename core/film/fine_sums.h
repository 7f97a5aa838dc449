// Light at twice the resolution of a picture: samples by the quarter of a pixel that they fell into.
//
// A pixel's mean belongs to its filter: no detail is left of what its samples saw apart. Their places are
// known, and filters of several pixels overlap, so that a quarter has samples of its neighbours too. Each
// counts there alike: the quarter's mean is that of a box. It is for denoisers, which resolve edges of half a
// pixel where the features of quarters show them; a picture is put together from quarters by its own filter
// (screenspace/layer_filter/fine_pixels.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/film/exact_sums.h"
#include "core/film/pass_image.h"

namespace mote::core {

class FineSums {
  public:
    /// For a picture of this size; 0 x 0: keeps nothing.
    explicit FineSums(int width = 0, int height = 0);
    bool empty() const { return counts_.empty(); }
    /// Adds a layer of a pass, where that says the places of its samples (PassImage::place). What is not
    /// finite is left out.
    void add(const PassImage& image, std::size_t layer);
    /// To the same bits, in any order.
    void add(const FineSums& more);
    /// True where any sample had light.
    bool has_light() const { return light_.any(); }
    /// Mean over the samples of each quarter, 2 width x 2 height of them, row by row. A quarter without
    /// samples has that of its pixel's others; a pixel without any is zero.
    std::vector<Rgb> mean() const;

    /// All that there is to write and to read again: body(numbers) for each array.
    template <typename Sums, typename Body>
    static void for_each_array(Sums& sums, const Body& body) {
        if (sums.empty()) return;
        ExactSums::for_each_array(sums.light_, body), body(sums.counts_);
    }
    const ExactSums& light() const { return light_; }          ///< three channels a quarter
    std::span<const float> counts() const { return counts_; }  ///< samples of each quarter

  private:
    void add_rows(const PassImage& image, std::size_t layer, int begin, int end);
    std::size_t quarter(int x, int y) const {
        return std::size_t(y) * std::size_t(2 * width_) + std::size_t(x);
    }

    int width_, height_;
    ExactSums light_;
    std::vector<float> counts_;  ///< whole numbers
};

}  // namespace mote::core
