// Matrix row-column sampling (Hasan et al. 2007) with the slices of LightSlice (Ou and Pellacini 2011): a few
// virtual point lights for a tile of receivers.
//
// Receivers of the picture, on surfaces and in media, are parted into slices of like place and normal. Rows
// of a slice are receivers drawn from strata of it; all lights send to them (matrix_rows.h), and are
// clustered by what they send (light_clusters.h). A tile asks the slice in which it lies, and draws one light
// from each cluster anew.
//
// Differs from the papers in what makes it unbiased and in two more things: representatives are drawn anew
// for every tile of sixteen receivers, so that their error is noise and not a pattern over the slice; and a
// slice has its own rows instead of one, so it needs none of its neighbours.
#pragma once

#include "lights/selection/column_draws.h"
#include "lights/selection/matrix_rows.h"
#include "lights/selection/place_tree.h"

namespace mote::lights {

struct MatrixSettings {
    std::uint32_t rows = 256;     ///< of all slices; each has the same number, a multiple of 16
    std::uint32_t columns = 256;  ///< clusters of a slice
    std::uint32_t slices = 4;
    RowVisibilitySettings visibility;
    std::size_t max_bytes = std::size_t(4) << 30;

    std::size_t rows_a_slice() const {
        const std::size_t each = (rows + slices - 1) / std::max(slices, 1u);
        return (std::max<std::size_t>(each, 1) + 15) / 16 * 16;
    }
    /// While `lights` are clustered on `threads` threads.
    std::size_t bytes(std::size_t lights, std::size_t threads) const;
};

class MatrixSelection {
  public:
    MatrixSelection() = default;
    /// `receivers`: a sample of all, from which rows are drawn. `key` determines the bits, whatever the
    /// number of threads. Throws core::InputError where memory does not suffice, and core::Cancelled.
    MatrixSelection(const RowContext& context, std::span<const MatrixReceiver> receivers,
                    const MatrixSettings& settings, std::uint64_t key);

    /// Of slices that are known.
    MatrixSelection(PlaceTree tree, std::vector<ColumnDraws> draws)
        : tree_(std::move(tree)), draws_(std::move(draws)) {}

    const PlaceTree& tree() const { return tree_; }  ///< of receivers
    std::size_t slices() const { return draws_.size(); }
    /// The slice in which a tile lies. Precondition: a lane is not idle.
    std::size_t slice_of(const ReceiverLanes& receivers) const;
    const ColumnDraws& slice(std::size_t s) const { return draws_[s]; }
    /// Lights for a tile, until the next call; weights 1 / p.
    std::span<const WeightedVpl> draw(const ReceiverLanes& receivers, core::Rng& rng,
                                      std::vector<WeightedVpl>& drawn) const;
    std::size_t memory_bytes() const;

  private:
    void make_slice(const RowContext& context, std::span<const MatrixReceiver> receivers,
                    std::span<const Place> places, std::size_t slice, const MatrixSettings& settings,
                    std::uint64_t key);

    PlaceTree tree_;
    std::vector<ColumnDraws> draws_;  ///< of slices; one of all lights where nothing is clustered
};

}  // namespace mote::lights
