// Clusters of the lights of one pass or frame, for the lights of others.
//
// A light of another set joins the clusters of the light that stands most like it, in place and normal, and
// has its weight by energy. So rows are computed once for several frames. Representatives are drawn anew from
// the lights that there are, each of which has a chance: that is unbiased, however much has moved; what has
// moved far is only noisier.
#pragma once

#include "lights/selection/matrix_selection.h"

namespace mote::lights {

class SharedColumns {
  public:
    SharedColumns() = default;
    /// `found` for these lights.
    SharedColumns(const VplSet& vpls, MatrixSelection found);

    const MatrixSelection& found() const { return found_; }  ///< for its own lights
    /// For others. On the threads of TBB; the same for any number of them.
    MatrixSelection for_lights(const VplSet& vpls) const;
    std::size_t memory_bytes() const;
    /// At most, with those of others and while they are found.
    static constexpr std::size_t bytes(std::size_t lights, std::size_t slices) {
        constexpr std::size_t a_slice = sizeof(std::uint32_t) + sizeof(double);  // found, and of others
        constexpr std::size_t at_work = sizeof(std::uint32_t) + 2 * sizeof(float);
        constexpr std::size_t in_tree = sizeof(Place) + 5 * sizeof(std::uint32_t);
        return lights * (slices * (2 * a_slice + at_work) + in_tree + 3 * sizeof(float));
    }

  private:
    std::size_t nearest(const Place& place) const;
    ColumnDraws slice_for(const VplSet& vpls, std::span<const std::uint32_t> like, std::size_t slice) const;

    MatrixSelection found_;
    PlaceTree tree_;
    std::vector<Place> places_;          ///< of lights with energy
    std::vector<std::uint32_t> lights_;  ///< their indices
    std::vector<float> energies_;        ///< of all lights
};

}  // namespace mote::lights
