// Rows of the matrix of light, whole: what every virtual point light sends to a few receivers (Hasan et al.
// 2007). Column j of what they leave is the reduced column of light j, and its norm is what light j is
// expected to send to receivers like these.
//
// Two things keep a chance for every light that can send light. A light that no row sees has the column that
// it would have if nothing stood between, times hidden_share, and its weight is that column's norm; a light
// that would send nothing to any row even then has a weight by its energy alone. Lights whose weight is small
// for their energy are raised to energy_share of the mean.
#pragma once

#include "lights/selection/column_clusters.h"
#include "lights/selection/row_visibility.h"

namespace mote::lights {

/// A receiver whose row may be computed; keeps what its lane needs.
struct MatrixReceiver {
    core::ScatteringVertex vertex;
    core::Rgb throughput{1.0f};  ///< of the eye path up to there
    core::MediumState state;
    std::int32_t max_vpl_depth = 0;
};

enum class LightClass : std::uint8_t {
    lit,     ///< a row sees it
    hidden,  ///< no row sees it, and something would arrive if nothing stood between
    away,    ///< nothing would arrive at any row
    none     ///< without energy
};

struct ReducedMatrix {
    std::size_t rows = 0;
    std::vector<float> values;   ///< columns, averages of the channels; rows have about the same light
    std::vector<float> weights;  ///< of lights: drawn in proportion to it
    std::vector<LightClass> classes;

    Columns columns() const { return {values, rows}; }
};

/// Share of its column unhidden that a hidden light has, and that the weight of each light has besides.
inline constexpr float hidden_share = 0.05f;
/// Least weight of a light by its energy, in units of the mean.
inline constexpr float energy_share = 0.02f;

/// What a light could send: the average of its energy (LightNode::energy), without a BSDF's albedo.
float energy_of(const VplSet& vpls, std::size_t light);

/// What rows are computed with.
struct RowContext {
    const core::RayQueries& scene;
    const VplSet& vpls;
    float bound;  ///< on G* [1/m^2]
    RowVisibilitySettings visibility;
    const SurfacePoints* points;  ///< of imperfect maps, else null
    core::RayCounters& rays;      ///< counted up
    core::TrackingCounters& tracking;
    core::CancelToken cancelled = {};
};

/// The rows of these receivers. `key` determines the bits, whatever the number of threads. Throws
/// core::Cancelled.
ReducedMatrix reduced_matrix(const RowContext& context, std::span<const MatrixReceiver> receivers,
                             std::uint64_t key);

}  // namespace mote::lights
