// Gathering along lines: the light of ray lights and of VPLs on surfaces for sixteen eye rays, and of ray
// lights for sixteen points.
//
// Shadow rays go in packets of sixteen, a batch at a time, as those of VPLs do (virtual_lights/vpl_gather.h).
// Points on the lines follow a sequence that fills the square evenly as the lights go by, from a start of the
// lane's own.
#pragma once

#include "lights/ray_lights/line_connections.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::lights {

/// Sixteen eye rays' parts; null: an idle lane.
struct EyeLines {
    std::array<const EyeLine*, ReceiverLanes::width> of{};
};

/// What is counted.
struct LineCounters {
    std::uint64_t pairs = 0;      ///< of a receiver and a light
    std::uint64_t connected = 0;  ///< shadow rays among them
    /// Adds what another task counted.
    void add(const LineCounters& o) { pairs += o.pairs, connected += o.connected; }
};

/// Gathers for one task; keeps references.
class LineGather {
  public:
    /// `share`: so many ray lights, and so many VPLs, does a receiver look at, 0: all; `width` of beam lights
    /// [m].
    LineGather(const GatherContext& context, const RayLightSet& set, std::size_t share, float width)
        : context_(context),
          set_(set),
          rays_(set.ray_power, share),
          surface_(set.surface_power, share),
          width_(width) {}

    /// By lane. `tile` is written to: its states and generators are those of the lanes; generators it has
    /// must be the lanes' own.
    TileLight rays_to_eyes(const EyeLines& eyes, ReceiverTile& tile);
    TileLight vpls_to_eyes(const EyeLines& eyes, ReceiverTile& tile);
    /// The same of points, with min(G*, bound) [1/m^2].
    TileLight rays_to_points(ReceiverTile& tile, float bound);
    TileLight vpls_to_points(ReceiverTile& tile, float bound);
    const LineCounters& counters() const { return counters_; }

  private:
    template <typename Connect>
    TileLight gather(std::size_t count, ReceiverTile& tile, const Connect& connect_lane);
    WeightedVpl resample(const EyeLine& eye, const LightShare& offered, std::size_t first, std::size_t count,
                         float start, float u) const;
    void begin_eyes(const EyeLines& eyes, ReceiverTile& tile) const;

    GatherContext context_;
    const RayLightSet& set_;
    LightShare rays_, surface_;
    float width_;
    LineCounters counters_;
    std::vector<WeightedVpl> chosen_;
};

}  // namespace mote::lights
