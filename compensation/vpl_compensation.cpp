#include "compensation/vpl_compensation.h"

#include <algorithm>

namespace mote::compensation {

using namespace core;
using lights::GatherScratch, lights::ReceiverTile, lights::VplRange, lights::VplSet;

namespace {

constexpr int width = ReceiverTile::width;

/// Moves every lane's path on by a step and makes its vertex a receiver. Returns whether one is left.
template <bool Media>
bool step_lanes(const ResidualTransport& transport, int step, CompensatedTile& receivers,
                std::array<bool, width>& alive, VplCompensationScratch& scratch, WalkContext& context) {
    scratch.tile.clear();
    for (std::size_t i = 0; i < width; ++i) {
        if (!alive[i]) continue;
        // Every step is an edge of the path; a VPL with max_vpl_depth edges behind it must stay within reach.
        const std::int32_t max_depth = receivers[i].max_vpl_depth - step;
        ResidualPath& path = scratch.paths[i];
        context.rng = receivers[i].rng;
        alive[i] = max_depth > 0 && transport.step<Media>(path, context);
        if (alive[i]) {
            scratch.tile.set(int(i), path.vertex, path.throughput(), path.state, Rng(context.rng.next_u32()),
                             max_depth);
            ++scratch.vertices;
        }
        receivers[i].rng = context.rng;
    }
    return scratch.tile.any_active;
}

using Lanes = std::array<bool, width>;

/// The walk of some lanes from their receivers, with the light of `range` at each vertex.
template <bool Media>
void walk_lanes(const Lanes& lanes, const Scene& scene, const ResidualTransport& transport, int steps,
                const VplSet& vpls, const VplRange& range, CompensatedTile& receivers,
                VplCompensationScratch& scratch, GatherScratch& gather_scratch, WalkContext& context,
                std::array<Rgb, width>& sum) {
    Lanes alive = lanes;
    for (std::size_t i = 0; i < width; ++i)
        if (alive[i]) scratch.paths[i] = receivers[i].path;
    for (int step = 1; steps < 0 || step <= steps; ++step) {
        if (!step_lanes<Media>(transport, step, receivers, alive, scratch, context)) return;
        // L_b of Eq. 10.12 at z, which Eq. 10.11 takes back to the receiver (Engelhardt 2013).
        const auto light = lights::gather(scene, vpls, range, transport.bound(), scratch.tile, gather_scratch,
                                          context.rays, context.tracking);
        for (std::size_t i = 0; i < width; ++i) sum[i] += light[i];
    }
}

}  // namespace

template <bool Media>
std::array<Rgb, width> compensation_from_vpls(const Scene& scene, const ResidualTransport& transport,
                                              Strategy strategy, int steps, const VplSet& vpls,
                                              const VplRange& range, CompensatedTile& receivers,
                                              VplCompensationScratch& scratch, GatherScratch& gather_scratch,
                                              WalkContext& context) {
    std::array<Rgb, width> sum{};
    Lanes to_all{}, to_one{};
    bool any_to_one = false;
    for (std::size_t i = 0; i < width; ++i) {
        const CompensatedReceiver& r = receivers[i];
        const bool all = strategy == Strategy::one_to_n || r.path.vertex.on_surface();
        to_all[i] = all && r.max_vpl_depth > 1, to_one[i] = !all && r.max_vpl_depth > 1;
        any_to_one |= to_one[i];
    }
    walk_lanes<Media>(to_all, scene, transport, steps, vpls, range, receivers, scratch, gather_scratch,
                      context, sum);
    if (!any_to_one) return sum;
    for (std::size_t j = range.first; j < std::min(range.end, vpls.lights.size()); j += range.stride)
        walk_lanes<Media>(to_one, scene, transport, steps, vpls, VplRange::one(j), receivers, scratch,
                          gather_scratch, context, sum);
    return sum;
}

template std::array<Rgb, width> compensation_from_vpls<true>(const Scene&, const ResidualTransport&, Strategy,
                                                             int, const VplSet&, const VplRange&,
                                                             CompensatedTile&, VplCompensationScratch&,
                                                             GatherScratch&, WalkContext&);
template std::array<Rgb, width> compensation_from_vpls<false>(const Scene&, const ResidualTransport&,
                                                              Strategy, int, const VplSet&, const VplRange&,
                                                              CompensatedTile&, VplCompensationScratch&,
                                                              GatherScratch&, WalkContext&);

}  // namespace mote::compensation
