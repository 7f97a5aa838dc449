// Gathering along lines: the light of ray lights and of VPLs on surfaces for sixteen eye rays, and of ray
// lights for sixteen points.
//
// Shadow rays go in packets of sixteen, a batch at a time, as those of VPLs do (virtual_lights/vpl_gather.h).
// Lights that a lane connects to are sampled by importance (line_candidates.h). Points on the
// lines follow a sequence that fills the square evenly as the lights go by, from a start of the lane's own.
#pragma once

#include "lights/ray_lights/line_candidates.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::lights {

/// Counters of a gather.
struct LineCounters {
    std::uint64_t pairs = 0;      ///< of a receiver and a light
    std::uint64_t connected = 0;  ///< shadow rays among them
    /// Adds what another task counted.
    void add(const LineCounters& o) { pairs += o.pairs, connected += o.connected; }
};

/// Gathers for one task; keeps references.
class LineGather {
  public:
    /// `candidates`: number of ray lights, and of VPLs, whose importance a tile evaluates; 0: all.
    LineGather(const GatherContext& context, const RayLightSet& set, std::size_t candidates)
        : context_(context), set_(set), candidates_(candidates) {}

    /// Samples the candidates of the following calls, for `receivers` active lanes; fewer lanes have fewer.
    void sample_candidates(core::Rng& rng, int receivers);
    /// Appends the candidates with their importance for eye rays, or points.
    void evaluate(const EyeLines& eyes, LineCandidates& candidates) const;
    void evaluate(const PointReceivers& points, LineCandidates& candidates) const;

    /// Radiance that eye rays gather along their segments, by lane. `steps`: light that one connection
    /// carries, such as candidates.total() over the number of connections; 0: all lights are connected.
    /// States and generators of `tile` are written to; generators that it has must be the lanes' own.
    TileLight to_eyes(const EyeLines& eyes, const LineCandidates& candidates, const core::Lanes& steps,
                      ReceiverTile& tile);
    /// Radiance that points reflect or scatter, by lane, with min(G*, bound) [1/m^2].
    TileLight to_points(const LineCandidates& candidates, const core::Lanes& steps, float bound,
                        ReceiverTile& tile);
    const LineCounters& counters() const { return counters_; }  ///< of all gathers so far

  private:
    using Found = std::optional<LineConnection>;
    template <typename Receivers>
    void evaluate_at(const Receivers& receivers, LineCandidates& candidates) const;
    template <typename Active>
    void choose(const LineCandidates& candidates, const core::Lanes& steps, ReceiverTile& tile,
                const Active& active);
    template <typename Connect>
    TileLight gather(ReceiverTile& tile, const Connect& connect_lane);

    GatherContext context_;
    const RayLightSet& set_;
    std::size_t candidates_;
    LineCounters counters_;
    std::vector<WeightedVpl> candidate_rays_, candidate_vpls_;
    LineChoices choices_;
};

}  // namespace mote::lights
