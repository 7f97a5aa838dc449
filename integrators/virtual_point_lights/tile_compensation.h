// Bias compensation for the receivers of a tile: from the primary lights once a receiver, and from the VPLs
// by the chosen strategy (compensation/).
#pragma once

#include "compensation/light_compensation.h"
#include "compensation/vpl_compensation.h"
#include "core/render/cpu_clock.h"
#include "core/scene/lit_scene.h"

namespace mote::integrators {

/// Cost of compensation, summed per tile.
struct CompensationCost {
    std::uint64_t vertices = 0;
    double seconds = 0.0;  ///< of processor time, all threads
};

template <bool Media>
class TileCompensation {
  public:
    /// `transport` null: compensation is off, and nothing here does anything.
    TileCompensation(const core::LitScene& scene, const compensation::CompensationSettings& settings,
                     const compensation::ResidualTransport* transport, const lights::VplSet& vpls,
                     lights::GatherScratch& gather_scratch, core::WalkContext& walk)
        : scene_(scene),
          settings_(settings),
          transport_(transport),
          vpls_(vpls),
          gather_scratch_(gather_scratch),
          walk_(walk) {}

    /// Makes a vertex of an eye path a receiver. `throughput` is the weight of the eye path.
    void add(int lane, const core::ScatteringVertex& vertex, const core::Rgb& throughput,
             const core::MediumState& state, std::int32_t max_vpl_depth) {
        if (!transport_ || !(vertex.on_surface() ? settings_.surfaces : settings_.media)) return;
        compensation::CompensatedReceiver& r = receivers_[std::size_t(lane)];
        r.rng = core::Rng(walk_.rng.next_u32());
        r.path = transport_->start(vertex, state, throughput, r.rng);
        r.max_vpl_depth = max_vpl_depth;
        any_ = true;
    }

    /// The light of all receivers since the last call, those of VPLs in `range` times `vpl_scale`.
    lights::TileLight run(const lights::VplRange& range, float vpl_scale) {
        lights::TileLight sum{};
        if (!any_) return sum;
        const double begin = core::thread_cpu_seconds();
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = from_lights(receivers_[i]);
        const compensation::VplCompensation request{*transport_, settings_.strategy, settings_.depth, vpls_,
                                                    range};
        const auto light = compensation::compensation_from_vpls<Media>(
            request, receivers_, scratch_,
            {scene_, gather_scratch_, walk_.rays, walk_.tracking, walk_.cancelled}, walk_);
        for (std::size_t i = 0; i < sum.size(); ++i) {
            sum[i] += vpl_scale * light[i];
            receivers_[i].max_vpl_depth = 0;
        }
        any_ = false;
        cost_.seconds += core::thread_cpu_seconds() - begin;
        return sum;
    }

    CompensationCost cost() const { return {cost_.vertices + scratch_.vertices, cost_.seconds}; }

  private:
    core::Rgb from_lights(compensation::CompensatedReceiver& r) {
        if (r.max_vpl_depth < 1) return core::Rgb(0.0f);
        const int steps = settings_.depth < 0 ? r.max_vpl_depth : std::min(settings_.depth, r.max_vpl_depth);
        walk_.rng = r.rng;
        const core::Rgb light = compensation::compensation_from_lights<Media>(scene_, *transport_, r.path,
                                                                              steps, walk_, cost_.vertices);
        r.rng = walk_.rng;
        return light;
    }

    const core::LitScene& scene_;
    const compensation::CompensationSettings& settings_;
    const compensation::ResidualTransport* transport_;
    const lights::VplSet& vpls_;
    lights::GatherScratch& gather_scratch_;
    core::WalkContext& walk_;
    compensation::CompensatedTile receivers_;
    compensation::VplCompensationScratch scratch_;
    CompensationCost cost_;
    bool any_ = false;
};

}  // namespace mote::integrators
