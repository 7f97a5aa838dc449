// Resampled importance sampling of virtual point lights: many candidates that are looked at without shadow
// rays, and few that are chosen among them (Talbot et al. 2005; Bitterli et al. 2020; in media Lin et al.
// 2021).
//
// A tile of sixteen receivers shares its candidates, so that all lanes look at one light at once; each lane
// chooses its own, and shadow rays are packets of sixteen towards different lights. With several points along
// each eye ray candidates are pairs of a light and a point: the points come from sampling distances by the
// transmittance, whose weight is in their throughput. What is chosen gets a shadow ray and an unbiased
// estimate of the transmittance.
#pragma once

#include "lights/selection/resampling_target.h"
#include "lights/selection/spatial_reuse.h"
#include "lights/selection/systematic_choice.h"

namespace mote::lights {

struct ResamplingCounters {
    std::uint64_t candidates = 0;  ///< pairs of a light and a tile that were looked at
    std::uint64_t chosen = 0;      ///< by receivers, each once, however often it was chosen
    std::uint64_t reused = 0;      ///< of them those of the tile before

    void add(const ResamplingCounters& other) {
        candidates += other.candidates, chosen += other.chosen, reused += other.reused;
    }
};

class Resampling {
  public:
    static constexpr int width = ReceiverLanes::width;

    /// `samples`: chosen for each receiver, or for all points of a ray. `bound`: b of the geometry term.
    Resampling(const VplSet& vpls, float bound, std::uint32_t samples, SpatialReuse reuse)
        : vpls_(vpls), bound_(bound), samples_(samples), shares_{reuse} {}

    /// What was found out about a candidate: the sum of its targets, times its weight, over points and lanes,
    /// and of rays to it the sum of the squares of what they let through, over what the target guessed.
    struct Found {
        double light = 0.0;
        float rays = 0.0f, ray_squares = 0.0f;
    };
    /// The light of all at the points, whose sum a lane is. `candidates` are right in the mean: 1 / (M p).
    /// `seen`: factors of their targets, above 0; none: 1.
    TileLight gather(const GatherContext& context, std::span<KeptReceivers* const> points,
                     std::span<const WeightedVpl> candidates, core::Rng& rng,
                     std::span<const float> seen = {});
    /// Of the last gather(), by candidate.
    std::span<const Found> found() const { return found_; }
    /// The share of a point in the last light.
    TileLight light_of(std::size_t point) const;
    /// The same at one tile, with what the tile before has chosen; then this is the tile before.
    TileLight gather_reusing(const GatherContext& context, KeptReceivers& tile,
                             std::span<const WeightedVpl> candidates, core::Rng& rng);
    const ResamplingCounters& counters() const { return counters_; }

  private:
    using Weights = CandidateWeights<width>;
    struct Pair {
        std::uint32_t light, point, candidate;
        float weight;  ///< of the candidate; 0: of the tile before, where it differs from lane to lane
    };
    /// What a lane has chosen, with its shadow ray in a packet.
    struct Sample {
        core::Rgb light;      ///< what arrives if nothing is in the way
        double weight;        ///< W
        float share;          ///< m_own, as it was chosen
        float target, value;  ///< scaled, and not
        std::uint32_t index, point, candidate;
        bool active, own;
    };
    using Samples = std::array<Sample, width>;

    void look(const GatherContext& context, std::span<const WeightedVpl> candidates,
              std::span<const float> seen);
    void share_with_neighbours(const GatherContext& context);
    void add_reused();
    TileLight connect(const GatherContext& context, std::span<KeptReceivers* const> points, core::Rng& rng);
    void fill(std::size_t round, core::ShadowPacket& packet, Samples& samples);
    void look_back(const GatherContext& context, std::size_t rounds);
    void remember(std::size_t rounds);

    const VplSet& vpls_;
    float bound_;
    std::uint32_t samples_;
    ReuseShares shares_;
    ResamplingCounters counters_;

    std::vector<ResamplingTarget> targets_;  ///< of the points
    std::vector<Pair> pairs_;
    std::vector<Found> found_;
    std::span<const float> seen_;
    std::vector<float> extinctions_;                    ///< at candidates
    std::vector<std::array<core::Vec3d, width>> sums_;  ///< by point
    std::vector<Weights> weights_, shares_of_pairs_;    ///< by pair; the second only where tiles are reused
    SystematicChoice<width> choice_;
    std::array<Samples, GatherScratch::batch> batch_;
    bool reusing_ = false;
    ReusedTile before_;
    std::optional<ResamplingTarget> target_before_;
    std::array<std::vector<ReusedSample>, width> kept_;
};

}  // namespace mote::lights
