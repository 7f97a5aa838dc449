// Columns of a matrix of light in clusters, each of which one column will represent (Hasan et al. 2007).
//
// Row i, column j: what light j sends to receiver i. Of a cluster k, one column is sampled with a probability
// in proportion to its norm and scaled by 1 / p. What that errs by, summed over rows, has the mean square
//   w_k = sum over pairs i < j of the cluster of ||x_i|| ||x_j|| ||x_i/||x_i|| - x_j/||x_j|| ||^2
//       = (sum ||x_j||)^2 - ||sum x_j||^2
// (the second form reads each column once). Clusters are made so that the sum of w_k is
// small: centres sampled in proportion to what each column costs with all others, columns to the nearest
// centre (clustering by sampling), and from two thirds of the clusters on the most expensive one is divided
// in two where it falls apart best along a line (splitting).
//
// Columns are sums over few rows, so clusters are found from what a light sends to a few receivers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/random.h"
#include "core/objects/cancellation.h"

namespace mote::lights {

/// A matrix, column after column.
struct Columns {
    std::span<const float> values;  ///< rows * size() of them
    std::size_t rows = 0;

    std::size_t size() const { return rows > 0 ? values.size() / rows : 0; }
    const float* column(std::size_t j) const { return values.data() + j * rows; }
};

/// Clusters of some of the columns: `members` of cluster k from first[k] to first[k + 1].
struct ColumnClusters {
    std::vector<std::uint32_t> members;
    std::vector<std::size_t> first{0};

    std::size_t size() const { return first.size() - 1; }
    std::span<const std::uint32_t> cluster(std::size_t k) const {
        return std::span(members).subspan(first[k], first[k + 1] - first[k]);
    }
};

/// w_k of these columns, at least 0.
double cluster_cost(const Columns& columns, std::span<const std::uint32_t> members);

/// At most `count` clusters of these columns, none of which is zero; none is empty. Fewer where more would
/// cost no less. On the threads of TBB; the same for any number of them. Throws core::Cancelled.
ColumnClusters cluster_columns(const Columns& columns, std::span<const std::uint32_t> members,
                               std::size_t count, core::Rng& rng, core::CancelToken cancelled = {});

}  // namespace mote::lights
