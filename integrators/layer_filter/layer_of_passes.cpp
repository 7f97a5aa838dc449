#include "integrators/layer_filter/layer_of_passes.h"

#include <cmath>

#include "screenspace/denoising/local_gain.h"

namespace mote::integrators {

using namespace core;

LayerOfPasses layer_of_passes(Film& film, std::size_t layer, std::uint32_t fewest, PassVariance from) {
    film.set_mean(layer, {});
    LayerOfPasses result{film.mean(layer), std::vector<Rgb>(film.pixels(), Rgb(infinity))};
    const std::uint32_t passes = film.pass_count(film.layers()[layer].part);
    if (passes < fewest) return result;
    result.variance = film.layer_variance_of_mean(layer);
    const Film::BlockDifference block = film.block_difference(layer);
    if (from == PassVariance::independent || block.squares.empty()) return result;
    // A - B of independent passes has the variance of as many as the block has.
    const float of_block = std::exp2(float(block.level)) * float(passes);
    std::vector<float> expected(film.pixels());
    for (std::size_t p = 0; p < expected.size(); ++p)
        expected[p] = of_block * result.variance[p][film.block_channel(p)];
    const std::vector<float> gain = screenspace::local_gain(film.width(), film.height(), result.mean,
                                                            {block.squares, expected}, block.level);
    for (std::size_t p = 0; p < gain.size(); ++p) result.variance[p] *= gain[p];
    return result;
}

}  // namespace mote::integrators
