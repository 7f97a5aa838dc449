// Points for one sample of one pixel (or one light path), keyed by (seed, pass, pixel, dimension).
//
// Independent numbers, or Owen-scrambled Sobol points. The latter follow Burley 2020 ("Practical
// hash-based Owen scrambling"): pairs of dimensions are padded, each with its own shuffle of the pass index
// and its own nested uniform scramble, so that the passes of one pixel form a (0,2)-sequence in every pair.
// In halves, passes of even and of odd index have two scrambles, so that their means are independent of each
// other (core/film/film.h); in groups each of eight has its own.
//
// Eight pairs are made at once, in vector instructions, when the first of them is wanted.
#pragma once

#include <cstdint>

#include "core/math/random.h"

namespace mote::core {

/// Independent numbers, Owen-scrambled Sobol points, or those in halves, or in groups.
enum class SamplerKind : std::uint8_t { independent, sobol, sobol_halves, sobol_groups };

/// Groups of passes: pass i is of group i modulo their number.
inline constexpr std::uint32_t pass_group_count = 8;

class Sampler {
  public:
    /// `item` is a pixel index or a light path's index; `stream` keeps unrelated uses of one item apart.
    Sampler(SamplerKind kind, std::uint64_t seed, std::uint32_t pass, std::uint64_t item,
            std::uint32_t stream = 0)
        : kind_(kind), pass_(pass), key_(hash_keys(seed, item, stream)) {
        if (kind == SamplerKind::sobol_halves) split(2);
        if (kind == SamplerKind::sobol_groups) split(pass_group_count);
    }

    /// The next number in [0, 1); takes a pair of dimensions.
    float next_1d() { return next_2d().x; }
    /// The next point in [0, 1)^2.
    Vec2 next_2d() {
        const std::uint32_t d = dimension_++;
        if (kind_ == SamplerKind::independent) return independent(d);
        if (d % block == 0) make_sobol(d);
        return {x_[d % block], y_[d % block]};
    }
    /// A generator for an unbounded number of numbers (tracking), independent of the dimensions used before.
    Rng make_rng() const { return Rng(hash_keys(key_, pass_, 0x7261636bull, dimension_)); }

  private:
    void split(std::uint32_t groups) { key_ = hash_keys(key_, pass_ % groups), pass_ /= groups; }
    Vec2 independent(std::uint32_t dimension) const {
        const std::uint64_t h = hash_keys(key_, pass_, dimension);
        return {to_unit_float(std::uint32_t(h)), to_unit_float(std::uint32_t(h >> 32))};
    }
    /// Fills the points of the dimensions from `first` on.
    void make_sobol(std::uint32_t first);

    static constexpr std::uint32_t block = 8;  ///< points that are made at once
    SamplerKind kind_;
    std::uint32_t pass_;
    std::uint32_t dimension_ = 0;
    std::uint64_t key_;
    float x_[block] = {}, y_[block] = {};  ///< of the dimensions around dimension_, once the first was wanted
};

}  // namespace mote::core
