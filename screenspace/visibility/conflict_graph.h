// Items that cannot share a colour channel, and a channel for as many as possible (Engelhardt 2013,
// Sec. 6.1.2).
//
// Two items are in conflict where their rectangles overlap. The graph is coloured as registers are allocated
// by Chaitin and Briggs: the vertex with the fewest edges left is taken away until none is left; then they
// come back in the opposite order, each in a channel that none of its neighbours has. One that finds none is
// a conflict item, and its neighbours need not mind it. Both steps are linear in the number of edges.
#pragma once

#include <vector>

#include "screenspace/visibility/id_picture.h"

namespace mote::screenspace {

class ConflictGraph {
  public:
    /// Empty rectangles overlap none. Runs on the threads of TBB.
    explicit ConflictGraph(std::span<const PixelRectangle> rectangles);

    std::size_t size() const { return first_.size() - 1; }
    std::size_t edges() const { return neighbours_.size() / 2; }
    /// Each once, in no particular order, which does not depend on threads.
    std::span<const std::uint32_t> neighbours(std::size_t i) const {
        return std::span(neighbours_).subspan(first_[i], first_[i + 1] - first_[i]);
    }

  private:
    std::vector<std::size_t> first_;
    std::vector<std::uint32_t> neighbours_;
};

inline constexpr std::int8_t conflict = -1;

/// A channel in [0, channels) for each vertex, or `conflict`; channels must lie in [1, 64].
std::vector<std::int8_t> colour(const ConflictGraph& graph, int channels);

}  // namespace mote::screenspace
