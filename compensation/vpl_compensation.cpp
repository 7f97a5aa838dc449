#include "compensation/vpl_compensation.h"

namespace mote::compensation {

using namespace core;
using lights::GatherContext, lights::TileLight, lights::VplRange, lights::WeightedVpl;

namespace detail {

constexpr std::size_t width = lights::ReceiverLanes::width;
using Lanes = std::array<bool, width>;

/// The walks of some lanes of a tile from their receivers, with the light of VPLs at every vertex.
template <bool Media>
class TileWalk {
  public:
    TileWalk(const VplCompensation& request, CompensatedTile& receivers, VplCompensationScratch& scratch,
             const GatherContext& gather, WalkContext& context)
        : request_(request), receivers_(receivers), scratch_(scratch), gather_(gather), context_(context) {}

    /// Adds the light of the VPLs in `range` to `sum`.
    void run(const Lanes& lanes, const VplRange& range, TileLight& sum) {
        Lanes alive = lanes;
        for (std::size_t i = 0; i < width; ++i)
            if (alive[i]) scratch_.paths[i] = receivers_[i].path;
        const lights::BoundedGeometry bounded{request_.transport.bound()};
        for (int step = 1; request_.steps < 0 || step <= request_.steps; ++step) {
            if (!move_on(step, alive)) return;
            // L_b of Eq. 10.12 at z, which Eq. 10.11 takes back to the receiver (Engelhardt 2013).
            const TileLight light = lights::gather(gather_, request_.vpls, range, bounded, scratch_.tile);
            for (std::size_t i = 0; i < width; ++i) sum[i] += light[i];
        }
    }

  private:
    /// Moves every lane's path on by a step and makes its vertex a receiver. Returns whether one is left.
    bool move_on(int step, Lanes& alive) {
        scratch_.tile.clear();
        for (std::size_t i = 0; i < width; ++i) {
            if (!alive[i]) continue;
            // Every step is an edge of the path; a VPL with max_vpl_depth edges behind it must stay within
            // reach.
            const std::int32_t max_depth = receivers_[i].max_vpl_depth - step;
            ResidualPath& path = scratch_.paths[i];
            context_.rng = receivers_[i].rng;
            alive[i] = max_depth > 0 && request_.transport.step<Media>(path, context_);
            if (alive[i]) {
                scratch_.tile.set(int(i), path.vertex, path.throughput(), path.state,
                                  Rng(context_.rng.next_u32()), max_depth);
                ++scratch_.vertices;
            }
            receivers_[i].rng = context_.rng;
        }
        return scratch_.tile.any_active;
    }

    const VplCompensation& request_;
    CompensatedTile& receivers_;
    VplCompensationScratch& scratch_;
    const GatherContext& gather_;
    WalkContext& context_;
};

}  // namespace detail

template <bool Media>
TileLight compensation_from_vpls(const VplCompensation& request, CompensatedTile& receivers,
                                 VplCompensationScratch& scratch, const GatherContext& gather,
                                 WalkContext& context) {
    TileLight sum{};
    detail::Lanes to_all{}, to_one{};
    bool any_to_one = false;
    for (std::size_t i = 0; i < detail::width; ++i) {
        const CompensatedReceiver& r = receivers[i];
        const bool all = request.strategy == Strategy::one_to_n || r.path.vertex.on_surface();
        to_all[i] = all && r.max_vpl_depth > 1, to_one[i] = !all && r.max_vpl_depth > 1;
        any_to_one |= to_one[i];
    }
    detail::TileWalk<Media> walk(request, receivers, scratch, gather, context);
    walk.run(to_all, request.range, sum);
    if (!any_to_one) return sum;
    request.range.for_each(request.vpls.lights.size(), [&](const WeightedVpl& light) {
        walk.run(to_one, VplRange::one(light.index), sum);
    });
    return sum;
}

template TileLight compensation_from_vpls<true>(const VplCompensation&, CompensatedTile&,
                                                VplCompensationScratch&, const GatherContext&, WalkContext&);
template TileLight compensation_from_vpls<false>(const VplCompensation&, CompensatedTile&,
                                                 VplCompensationScratch&, const GatherContext&, WalkContext&);

}  // namespace mote::compensation
