// Matrix row-column sampling (Hasan et al. 2007) with the slices of LightSlice (Ou and Pellacini 2011): a few
// virtual point lights for a tile of receivers.
//
// Receivers of the image, on surfaces and in media, are split into slices of like position and normal. Rows
// of a slice are receivers sampled from strata of it; all lights send to them (matrix_rows.h), and are
// clustered by what they send (light_clusters.h). A tile samples one VPL
// from each cluster of its slice anew.
//
// Differs from the papers in what makes it unbiased and in two more things: representatives are sampled anew
// for every tile of sixteen receivers, so that their error is noise and not a pattern over the slice; and a
// slice has its own rows instead of one, so it needs none of its neighbours.
#pragma once

#include "lights/selection/matrix/column_sampler.h"
#include "lights/selection/matrix/matrix_rows.h"
#include "lights/selection/matrix/slice_tree.h"

namespace mote::lights {

struct MatrixSettings {
    std::uint32_t rows = 256;     ///< of all slices; each has the same number, a multiple of 16
    std::uint32_t columns = 256;  ///< clusters of a slice
    std::uint32_t slices = 4;
    RowVisibilitySettings visibility;

    std::size_t rows_a_slice() const {
        const std::size_t each = (rows + slices - 1) / std::max(slices, 1u);
        return (std::max<std::size_t>(each, 1) + 15) / 16 * 16;
    }
    /// Largest size while so many VPLs are clustered, one slice after the other.
    std::size_t bytes(std::size_t lights) const;
};

class MatrixClusters {
  public:
    MatrixClusters() = default;
    /// `receivers`: a sample of all, from which rows are sampled. `key` determines the bits, whatever the
    /// number of threads. Throws core::Cancelled.
    MatrixClusters(const RowContext& context, std::span<const PathReceiver> receivers,
                   const MatrixSettings& settings, std::uint64_t key);

    std::size_t slices() const { return samplers_.size(); }
    /// Slice of a tile. Precondition: a lane is not idle.
    std::size_t slice_of(const ReceiverLanes& receivers) const;
    const ColumnSampler& slice(std::size_t s) const { return samplers_[s]; }
    /// VPLs for a tile, until the next call; weights 1 / p.
    std::span<const WeightedVpl> sample(const ReceiverLanes& receivers, core::Rng& rng,
                                        std::vector<WeightedVpl>& sampled) const;
    std::size_t memory_bytes() const;

  private:
    void make_slice(const RowContext& context, std::span<const PathReceiver> receivers,
                    std::span<const SlicePoint> points, std::size_t slice, const MatrixSettings& settings,
                    std::uint64_t key);

    SliceTree tree_;
    std::vector<ColumnSampler> samplers_;  ///< of slices; one of all lights where nothing is clustered
};

}  // namespace mote::lights
