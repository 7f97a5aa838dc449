// Rows of the lighting matrix: the light of every VPL at a few receivers (Hasan et al. 2007). Column j of
// them is the reduced column of VPL j, and its norm the importance of VPL j for receivers like these.
//
// Every VPL that can send light keeps a positive probability. One that no row sees has its unoccluded column
// times hidden_factor, and that column's norm as weight; one without unoccluded light at any row has a weight
// by its energy alone. Weights that are small for the energy are raised to energy_fraction of the mean.
#pragma once

#include "lights/selection/matrix/column_clusters.h"
#include "lights/selection/matrix/row_visibility.h"
#include "lights/selection/selection.h"

namespace mote::lights {

enum class LightClass : std::uint8_t {
    lit,     ///< a row sees it
    hidden,  ///< no row sees it, and it has unoccluded light
    away,    ///< it has no unoccluded light at any row
    none     ///< without energy
};

struct ReducedMatrix {
    std::size_t rows = 0;
    std::vector<float> values;   ///< columns, averages of the channels; rows have about the same light
    std::vector<float> weights;  ///< of VPLs: their probabilities are in proportion to it
    std::vector<LightClass> classes;

    Columns columns() const { return {values, rows}; }
};

/// Factor of the unoccluded column of a hidden VPL, and of the term that every weight has besides.
inline constexpr float hidden_factor = 0.05f;
/// Smallest weight of a VPL by its energy, in units of the mean.
inline constexpr float energy_fraction = 0.02f;

/// Average energy of a VPL (LightNode::energy), without a BSDF's albedo.
float energy_of(const VplSet& vpls, std::size_t light);

/// Inputs of rows.
struct RowContext {
    const core::RayQueries& scene;
    const VplSet& vpls;
    float bound;  ///< on G* [1/m^2]
    RowVisibilitySettings visibility;
    core::RayCounters& rays;  ///< counted up
    core::TrackingCounters& tracking;
    core::CancelToken cancelled = {};
};

/// Rows of these receivers. `key` determines the bits, whatever the number of threads. Throws
/// core::Cancelled.
ReducedMatrix reduced_matrix(const RowContext& context, std::span<const PathReceiver> receivers,
                             std::uint64_t key);

}  // namespace mote::lights
