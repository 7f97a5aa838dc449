// The running sum of every layer of a picture.
//
// Sums are exact to the digits that they keep (exact_sums.h), so that the bits of the result depend on which
// passes it holds alone: not on interruptions, nor on which machine rendered which of them. A film may begin
// with a later pass than the first, and films of passes that follow each other are added up (add()).
//
// A picture may have several parts (Layer::part), each with passes of its own, as many as it needs: the mean
// of a layer is its sum over the passes of its part, and the variance of the beauty the sum over its parts,
// which are independent of each other.
//
// The passes of a part are two independent halves, those of even and those of odd index: their Sobol points
// are of different scrambles (core/render/camera_ray.h). What a filter makes of one half can be held against
// the other (core/metrics/halves_error.h). Or they are eight independent groups, whose spread shows noise
// that pixels share (core/metrics/group_error.h).
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/film/exact_sums.h"
#include "core/film/fine_sums.h"
#include "core/film/pass_blocks.h"
#include "core/film/pass_split.h"
#include "core/math/sampler.h"
#include "core/metrics/control_error.h"
#include "core/objects/memory_budget.h"

namespace mote::core {

struct PassGroup;

/// Sums that a film keeps besides those of its layers.
struct KeptSums {
    bool all_squares = false;            ///< squares of every layer
    PassSplit split = PassSplit::whole;  ///< sums over parts of the passes
    /// Number that files hold.
    std::uint32_t bits() const { return (all_squares ? 1u : 0u) | std::uint32_t(split) << 1; }
    /// Inverse of bits(). Throws std::invalid_argument for others.
    static KeptSums from_bits(std::uint32_t bits);
};

/// Sums over passes, pixel by pixel and layer by layer: the picture is their mean.
class Film {
  public:
    static constexpr std::uint32_t max_passes = ExactSums::max_terms;  ///< of a part

    /// `all_squares`: keep the sum of squares of every layer, not only of the beauty and of those that
    /// require it. `split`: keep sums over parts of the passes besides; then its error() is known. Halves:
    /// over the passes of odd index, of the beauty and of layers of the beauty with squares. Groups: of the
    /// beauty over each group, and over the passes of odd index of layers of missing light. Throws
    /// std::invalid_argument when two layers have one name, a Layer::where names none or one of another part,
    /// a part has no layer, or there are several in groups.
    Film(int width, int height, std::vector<Layer> layers, bool all_squares = false,
         PassSplit split = PassSplit::whole);

    int width() const { return width_; }                                               ///< [pixels]
    int height() const { return height_; }                                             ///< [pixels]
    std::size_t pixels() const { return std::size_t(width_) * std::size_t(height_); }  ///< width times height
    std::span<const Layer> layers() const { return layers_; }  ///< all of them, in order
    std::size_t parts() const { return parts_.size(); }        ///< how many
    KeptSums kept() const { return {all_squares_, split_}; }   ///< of the constructor
    std::uint32_t pass_count() const;                          ///< of all parts together
    std::uint32_t pass_count(std::size_t part) const { return parts_.at(part).passes; }  ///< of one part
    /// Index of the first pass of a part that the film holds, or will hold.
    std::uint32_t first_pass(std::size_t part) const { return parts_.at(part).first; }
    /// Index of the pass after the last one.
    std::uint32_t next_pass(std::size_t part) const { return parts_[part].first + pass_count(part); }
    /// Number of the first pass over all parts: 0 for a film that holds all passes so far.
    std::uint32_t first_pass() const;
    /// Lets a part of a film without passes begin with this pass.
    void begin_at(std::size_t part, std::uint32_t first);
    /// True where every part has so many passes. A picture is complete with one.
    bool has_passes(std::uint32_t passes) const;
    /// Names of the layers whose parts have no pass.
    std::vector<std::string> layers_without_passes() const;
    /// The layers of a part, in order: those of the images of its passes.
    std::span<const std::size_t> layers_of(std::size_t part) const { return parts_.at(part).layers; }
    /// Work of all passes of a part (add_pass).
    double work(std::size_t part) const { return parts_.at(part).work; }
    /// Pixels of passes that held a NaN or an infinity in some layer. Such a pixel adds zero to every layer;
    /// anything but 0 is a defect.
    std::uint64_t non_finite() const { return non_finite_; }

    /// Adds the next pass of a part. Must be called in index order. `work` is what it cost, in any unit: the
    /// film keeps the sum. Undoes set_mean(). Throws InputError beyond max_passes.
    void add_pass(const PassImage& image, std::size_t part = 0, double work = 0.0);
    /// Adds the passes that follow, of a film with the same size and layers: to the same bits as if they had
    /// been added here one by one. Throws std::invalid_argument where the parts of `next` do not begin where
    /// these end. Undoes set_mean().
    void add(const Film& next);

    /// Mean over passes of one layer, as float. Over the passes of Layer::where, zero where there are none.
    std::vector<Rgb> mean(std::size_t layer) const;
    /// The beauty: the float sum of the float means of all layers that are not auxiliary, in order, so that
    /// adding up the layers of a written file gives the same bits.
    std::vector<Rgb> beauty() const;
    /// Variance of the beauty's mean per pixel and channel: (sum of squares / n - mean^2) / (n - 1), added up
    /// over parts. Zero for n < 2.
    /// `unit`: of light, in which its square is a float; a power of two.
    std::vector<Rgb> beauty_variance_of_mean(double unit = 1.0) const;
    /// The share of a part in that.
    std::vector<Rgb> part_variance_of_mean(std::size_t part, double unit = 1.0) const;
    /// True where the film keeps the variance of a layer.
    bool has_squares(std::size_t layer) const { return !layer_squares_.at(layer).empty(); }
    /// Variance of a layer's mean, over the passes of Layer::where; needs has_squares(layer).
    std::vector<Rgb> layer_variance_of_mean(std::size_t layer, double unit = 1.0) const;
    /// How the passes of a layer depend on each other, as points of one sequence.
    struct BlockDifference {
        std::uint32_t level = 0;         ///< of its largest block, 2^level passes
        std::span<const float> squares;  ///< of the difference of the sums over its halves; empty: not known
    };
    /// In one channel of each pixel, block_channel(): of a film of whole passes, for layers that require
    /// squares.
    BlockDifference block_difference(std::size_t layer) const {
        return {layer_blocks_.at(layer).largest_level(), layer_blocks_[layer].largest_difference()};
    }
    /// All three in turn, pixel by pixel.
    int block_channel(std::size_t pixel) const { return int((pixel + pixel / std::size_t(width_)) % 3); }
    /// A layer at twice the resolution; empty where the film does not keep it.
    const FineSums& fine_sums(std::size_t layer) const { return fine_sums_.at(layer); }
    /// True where the film keeps the halves of a layer.
    bool has_halves(std::size_t layer) const { return !odd_sums_.at(layer).empty(); }
    /// Number of passes of a half of a part: 0, of even index, or 1, of odd index.
    std::uint32_t half_passes(std::size_t part, int half) const;
    /// Mean over the passes of a half of a layer; needs has_halves(layer).
    std::vector<Rgb> half_mean(std::size_t layer, int half) const;
    /// Variance of that mean.
    std::vector<Rgb> half_variance_of_mean(std::size_t layer, int half) const;
    /// The beauty of a part over a half of its passes, and the variance of that mean.
    struct PartHalf {
        std::vector<Rgb> mean, variance;  ///< by pixel
    };
    PartHalf part_half(std::size_t part, int half) const;  ///< needs PassSplit::halves
    /// The beauty of a half of the passes, and what set_mean() has made of it.
    struct HalfBeauty {
        std::vector<Rgb> passes, shown, variance;  ///< of `passes`, as of independent ones
    };
    HalfBeauty half_beauty(int half) const;  ///< 0 or 1, as of half_passes()
    /// Replaces what mean() returns for a layer, for post-processes (Estimator::finish). The sums, and with
    /// them all variances and the serialised film, stay those of the passes.
    /// Without values it is the mean of the passes again. `variance`: what the process leaves of the
    /// variance of the layer's mean, averaged over channels, for noise(); needs has_squares(layer). Without
    /// it the layer counts there with the noise of its passes.
    void set_mean(std::size_t layer, std::span<const Rgb> values, std::span<const float> variance = {});
    /// set_mean() for a process that works on each half of the passes by itself: the mean becomes that of
    /// both results, weighted by their passes, and its variance what they differ by. Needs has_halves(layer).
    void set_halves(std::size_t layer, std::array<std::vector<Rgb>, 2> values);
    /// Mean that set_mean() has put in place of the passes'; empty where it has not.
    struct Replacement {
        std::vector<Rgb> mean;                        ///< by pixel; empty: that of the passes
        std::vector<float> variance;                  ///< of that mean, by pixel; empty: not known
        std::array<std::vector<Rgb>, 2> halves = {};  ///< of set_halves(); empty: of one mean
    };
    using Replacements = std::vector<Replacement>;  ///< [layer]
    /// Puts others there, or none, and returns what was there.
    Replacements exchange_replaced(Replacements replaced = {});
    /// The noise of the beauty, Eq. (4) of core/metrics/relative_error.h: the error that the passes so far
    /// are expected to have left, but for the bias of post-processes. Infinity for n < 2.
    double noise() const { return gain_and_noise().noise; }
    /// Noise of the picture as its passes show it.
    struct GainAndNoise {
        /// Passes are Sobol points: how much smaller the variance of the mean is, over the whole picture,
        /// than beauty_variance_of_mean() says, which takes them for independent. 1 for n < 2.
        double gain = 1.0;
        double noise = std::numeric_limits<double>::infinity();
    };
    GainAndNoise gain_and_noise() const;  ///< noise() and what it is computed with
    /// The error of the beauty with the bias of post-processes, from the two halves of the passes
    /// (core/metrics/halves_error.h): for passes without bias whose noise is independent from pixel to pixel;
    /// or from their groups and the light that is missing (core/metrics/group_error.h), without post-process.
    /// Nothing where the film keeps neither, a half of a part has fewer than two passes, a group none, or a
    /// post-process has not worked on the halves.
    /// Weights of errors are those of the passes' mean. That of groups is less certain, and the interval
    /// holds what several kinds of weights make of it.
    /// `controls`: pixels with samples of their own (control_passes.h), which make the interval of halves
    /// shorter; may be empty.
    std::optional<PictureError> error(const ControlPixels& controls = {}) const;

    /// The bits of the film, for checkpoints: sums, counts, open blocks, and a checksum. Throws OutOfMemory
    /// where the budget has no room for them.
    std::vector<std::byte> serialize(const MemoryBudget& memory = {}) const;
    /// Throws InputError when the bytes are damaged or do not fit this film's size and layers; the film is
    /// unchanged then.
    void deserialize(std::span<const std::byte> bytes);

  private:
    struct Part {
        std::uint32_t first = 0, passes = 0;
        double work = 0.0;
        ExactSums beauty_squares;                ///< three channels
        ExactSums odd_beauty, odd_squares;       ///< of the passes of odd index
        std::vector<ExactSums> groups;           ///< of the beauty: three channels
        PassBlocks blocks;                       ///< of the mean of the beauty's channels
        std::vector<std::size_t> layers;         ///< in order
        std::vector<std::size_t> beauty_layers;  ///< those that are not auxiliary, in order
        Part(std::size_t pixels, PassSplit split)
            : beauty_squares(3 * pixels),
              odd_beauty(split == PassSplit::halves ? 3 * pixels : 0),
              odd_squares(split == PassSplit::halves ? 3 * pixels : 0),
              groups(split == PassSplit::groups ? pass_group_count : 0, ExactSums(3 * pixels)),
              blocks(pixels) {}
        /// True if the next pass has an odd index.
        bool odd_is_next() const { return (first + passes) % 2 == 1; }
        std::uint32_t next_group() const { return (first + passes) % pass_group_count; }
        PassBlocks::Range range() const { return {first, passes}; }
    };
    void find_parts();
    void find_where();
    float add_pixel(const PassImage& image, Part& part, std::size_t pixel);
    /// Mean over a half, from the sums over all passes and over those of odd index.
    std::vector<Rgb> half_of(std::span<const std::size_t> layers, const ExactSums& odd, int half) const;
    /// Variance of that mean.
    std::vector<Rgb> half_variance(std::span<const std::size_t> layers, const ExactSums& squares,
                                   const ExactSums& odd, const ExactSums& odd_squares, int half) const;
    void check_room(const Part& part, std::uint32_t more) const;
    std::vector<Rgb> mean_of_passes() const;  ///< of the beauty, whatever set_mean() says
    bool has_replaced_variance() const;
    std::optional<PictureError> error_of_halves(const ControlPixels& controls) const;
    std::optional<PictureError> error_of_groups() const;
    std::vector<PassGroup> groups_of_passes() const;
    /// sum w v of a part as it is shown, with the gain of its passes, where that of its passes is `of_passes`
    /// without it.
    double shown_sum(const Part& part, double of_passes, double gain, std::span<const double> weights,
                     double unit) const;
    std::vector<Rgb> variance_of_mean(std::span<const std::size_t> layers, const ExactSums& squares,
                                      double unit) const;
    /// Number of passes that the mean of a layer is over, for a pixel.
    double passes_of(std::size_t layer, std::size_t pixel) const;
    template <typename AnyFilm, typename Body>
    static void for_each_array(AnyFilm& film, const Body& body);

    int width_, height_;
    std::vector<Layer> layers_;
    bool all_squares_;
    PassSplit split_;
    std::uint64_t non_finite_ = 0;
    std::vector<Part> parts_;
    std::vector<ExactSums> sums_;                    ///< one per layer: [3 pixel + channel]
    std::vector<ExactSums> layer_squares_;           ///< one per layer, empty where not kept
    std::vector<ExactSums> odd_sums_, odd_squares_;  ///< of passes of odd index; of layers of the beauty
    std::vector<PassBlocks> layer_blocks_;           ///< one per layer; empty where not kept
    std::vector<FineSums> fine_sums_;                ///< one per layer; empty where not kept
    std::vector<std::size_t> where_;                 ///< index of Layer::where, or that of no layer
    Replacements replaced_;
};

}  // namespace mote::core
