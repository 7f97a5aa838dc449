// Resampled importance sampling of virtual point lights: many candidates that are evaluated without shadow
// rays, and few that are chosen among them (Talbot et al. 2005; in media Lin et al. 2021).
//
// A tile of sixteen receivers shares its candidates, so that one VPL is evaluated for all lanes at once; each
// lane chooses its own, and shadow rays are packets of sixteen towards different VPLs. With several points
// along each eye ray candidates are pairs of a VPL and a point: the points come from sampling distances by
// the transmittance, whose weight is in their throughput. A chosen pair gets a shadow ray and an unbiased
// estimate of the transmittance.
#pragma once

#include "lights/selection/resampling/recorded_receivers.h"
#include "lights/selection/resampling/resampling_target.h"
#include "lights/selection/resampling/systematic_choice.h"
#include "lights/selection/selection.h"

namespace mote::lights {

struct ResamplingCounters {
    std::uint64_t candidates = 0;  ///< pairs of a VPL and a tile that were evaluated
    std::uint64_t chosen = 0;      ///< by receivers, each once, however often it was chosen
};

class Resampling {
  public:
    static constexpr int width = ReceiverLanes::width;

    /// `samples`: chosen for all points of a ray. `bound`: b of the geometry term [1/m^2].
    Resampling(const VplSet& vpls, float bound, std::uint32_t samples)
        : vpls_(vpls), bound_(bound), samples_(samples) {}

    /// Findings about a candidate: the sum of its targets, times its weight, over points and lanes;
    /// and of rays to it the sum of the squares of their transmittance over the guess of the target.
    struct Found {
        double light = 0.0;
        float rays = 0.0f, ray_squares = 0.0f;
    };
    /// Light of all VPLs at the points; a lane is the sum over its points. `candidates` are unbiased: weights
    /// 1 / (M p). `visibilities`: positive factors of their targets; none: 1.
    TileLight gather(const GatherContext& context, std::span<RecordedReceivers* const> points,
                     std::span<const WeightedVpl> candidates, core::Rng& rng,
                     std::span<const float> visibilities = {});
    /// Findings of the last gather(), by candidate.
    std::span<const Found> found() const { return found_; }
    /// Light of the last gather() at one of its points.
    TileLight light_of(std::size_t point) const;
    /// VPLs that a lane chose in the last gather().
    std::vector<ChosenVpl> chosen(int lane) const;
    const ResamplingCounters& counters() const { return counters_; }

  private:
    struct Pair {
        std::uint32_t light, point, candidate;
        float weight;  ///< of the candidate
    };
    /// A lane's choice, with its shadow ray in a packet.
    struct Sample {
        core::Rgb light;  ///< unoccluded
        double weight;    ///< W
        float value;      ///< target without the weight of the candidate
        std::uint32_t point, candidate;
        bool active;
    };
    using Samples = std::array<Sample, width>;

    void evaluate(const GatherContext& context, std::span<const WeightedVpl> candidates);
    TileLight connect(const GatherContext& context, std::span<RecordedReceivers* const> points,
                      core::Rng& rng);
    void fill(std::size_t round, core::ShadowPacket& packet, Samples& samples);

    const VplSet& vpls_;
    float bound_;
    std::uint32_t samples_;
    ResamplingCounters counters_;

    std::vector<ResamplingTarget> targets_;  ///< of the points
    std::vector<Pair> pairs_;
    std::vector<Found> found_;
    std::span<const float> visibilities_;
    std::vector<float> extinctions_;                    ///< at candidates
    std::vector<std::array<core::Vec3d, width>> sums_;  ///< by point
    std::vector<core::Lanes> weights_;                  ///< by pair
    SystematicChoice choice_;
    std::vector<Samples> rounds_;  ///< of choices, one a lane each
};

}  // namespace mote::lights
