// Sorting lights into clusters, for a hierarchy over them.
//
// Top down: each cluster is cut where the orientation-aware surface heuristic costs least (Estevez and
// Kulla 2018, Eq. 1 and 2), between buckets of the lights' centres along each axis. The measure of a
// cluster's place is the square of its diagonal where the paper takes its surface area, which is zero for all
// clusters of lights in a row.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/light_bounds.h"

namespace mote::core {

/// Neighbours in the order of a LightClustering.
struct LightRun {
    std::uint32_t begin, end;
    LightBounds bounds;
    std::uint32_t size() const { return end - begin; }
};

class LightClustering {
  public:
    explicit LightClustering(std::span<const LightBounds> lights);

    LightRun all() const { return run(0, std::uint32_t(order_.size())); }
    /// At most `count` runs that are the given one together: where it pays most, a run is cut in two. One
    /// light is not cut.
    std::vector<LightRun> cut_into(const LightRun& run, std::size_t count);
    /// The only light of a run.
    std::uint32_t light(const LightRun& run) const { return order_[run.begin]; }

  private:
    struct Cut {
        int axis = -1, bucket = 0;
    };
    LightRun run(std::uint32_t begin, std::uint32_t end) const;
    std::uint32_t middle(const LightRun& run);
    Cut cheapest(const LightRun& run, const Bounds3& centers) const;
    Vec3 center(std::uint32_t i) const { return lights_[order_[i]].box.center(); }

    std::span<const LightBounds> lights_;
    std::vector<std::uint32_t> order_;
};

}  // namespace mote::core
