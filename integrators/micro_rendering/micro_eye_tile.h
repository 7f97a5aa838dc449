// The eye paths of sixteen pixels, advanced together to their connectable vertices, where each gathers the
// light of points with a micro-buffer.
#pragma once

#include <array>
#include <optional>

#include "gathering/stored_light/micro_receiver.h"
#include "integrators/eye_path/shared_pixels.h"
#include "integrators/micro_rendering/micro_settings.h"

namespace mote::integrators {

class MicroEyeTile {
  public:
    static constexpr int side = 4, width = side * side;

    MicroEyeTile(const core::Scene& scene, const MicroSettings& settings, const gathering::LitPoints& points,
                 core::WalkContext& walk)
        : scene_(scene),
          settings_(settings),
          points_(points),
          walk_(walk),
          texels_(std::size_t(width) * points.buffers().texels_each()),
          weights_(points.buffers().texels_each()) {}

    void start(int lane, const EyeRay& eye);
    void stop(int lane);
    /// If false, the following lanes only record their receivers; they gather no light.
    void gathers(bool yes) { gathers_ = yes; }
    /// Advances all eye paths to their ends and gathers at each of their vertices.
    void run();
    const TransportSum& sum(int lane) const { return lanes_[std::size_t(lane)].sum; }
    /// First vertex of the lane's eye path, after run().
    const SeenPixel& seen(int lane) const { return lanes_[std::size_t(lane)].seen; }
    std::uint64_t receivers() const { return receivers_; }  ///< so far

  private:
    struct Lane {
        std::optional<EyePath<false>> path;
        core::Rng rng;  ///< of the path, while other lanes advance
        TransportSum sum;
        SeenPixel seen;
        core::Vec2 film{0.0f};
        bool alive = false, receives = false;
    };

    bool advance(Lane& lane);
    using Receivers = std::vector<gathering::MicroReceiver>;
    void gather();
    void gather_diffuse(std::span<Lane* const> lanes);
    void gather_glossy(std::span<Lane* const> lanes);
    static gathering::MicroReceiver receiver_of(Lane& lane);

    const core::Scene& scene_;
    const MicroSettings& settings_;
    const gathering::LitPoints& points_;
    core::WalkContext& walk_;
    Receivers group_;  ///< receivers of the lanes that gather together
    std::vector<gathering::BrdfWarp> warps_;
    std::vector<gathering::MicroTexel> texels_;
    std::vector<core::Rgb> weights_;
    std::array<Lane, width> lanes_;
    bool gathers_ = true;
    std::uint64_t receivers_ = 0;
};

}  // namespace mote::integrators
