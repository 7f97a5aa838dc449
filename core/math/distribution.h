// Piecewise-constant distributions over 1D and 2D tables, sampled by inversion.
#pragma once

#include <span>
#include <vector>

#include "core/math/vec.h"

namespace mote::core {

/// Discrete choice among n weights, and the piecewise-constant density over [0,1) with n equal cells.
/// Weights are summed in double precision; entries of weight zero are never chosen.
class Distribution1D {
  public:
    Distribution1D() = default;
    /// Throws std::invalid_argument when a weight is negative or not finite. All-zero weights are allowed:
    /// total() is 0.
    explicit Distribution1D(std::span<const float> weights);

    std::size_t size() const { return weights_.size(); }               ///< number of entries
    double total() const { return cdf_.empty() ? 0.0 : cdf_.back(); }  ///< sum of the weights
    bool empty() const { return !(total() > 0.0); }                    ///< nothing can be sampled

    /// A sampled entry.
    struct Discrete {
        std::size_t index;  ///< of the entry
        float probability;  ///< of sampling it
        float remapped;     ///< u stretched back to [0,1) inside the chosen entry
    };
    /// Precondition: !empty().
    Discrete sample_discrete(float u) const;
    /// Probability of entry `index`; 0 for an empty distribution.
    float probability(std::size_t index) const;

    /// A sampled point of [0,1).
    struct Continuous {
        float x;    ///< in [0,1)
        float pdf;  ///< per unit length
    };
    /// Precondition: !empty().
    Continuous sample_continuous(float u) const;
    float pdf(float x) const;  ///< of sample_continuous(), per unit length

  private:
    std::vector<float> weights_;
    std::vector<double> cdf_;  ///< size n; cdf_[i] = sum of weights 0..i, not normalised
};

/// Piecewise-constant density over the unit square from a table of rows (y) times columns (x).
class Distribution2D {
  public:
    Distribution2D() = default;
    /// Row after row. Throws std::invalid_argument where the size is another, or a value is negative or not
    /// finite.
    Distribution2D(std::span<const float> values, std::size_t width, std::size_t height);

    /// A sampled point of the square.
    struct Sample {
        Vec2 uv;    ///< in [0,1)^2
        float pdf;  ///< per unit area of the square
    };
    bool empty() const { return marginal_.empty(); }    ///< nothing can be sampled
    double total() const { return marginal_.total(); }  ///< sum of the values
    /// Precondition: !empty().
    Sample sample(const Vec2& u) const;
    float pdf(const Vec2& uv) const;  ///< of sample(), per unit area of the square

  private:
    std::vector<Distribution1D> rows_;
    Distribution1D marginal_;
};

}  // namespace mote::core
