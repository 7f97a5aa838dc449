// Lightcuts (Walter et al. 2005) and multidimensional lightcuts (Walter et al. 2006): the light of all
// virtual point lights at all points of a tile's pixels, from a few pairs of clusters.
//
// A pair of a cluster of points and a cluster of VPLs is estimated by its representatives, with shadow rays,
// and its error is at most upper_bound(). The pair of the largest error, relative to the pixel, is split, at
// its VPLs or at its points, until no error is above `threshold` times the sum of all estimates of its pixel,
// or the cut has `max_cut` pairs. One child inherits the estimate.
//
// The sixteen pixels of a tile share the cut, and each must be below its threshold: so shadow rays stay
// packets. Pairs are split in batches, those of the largest error first. With a threshold of 0 the sum is
// that of all pairs.
#pragma once

#include <vector>

#include "lights/selection/hierarchy/cluster_bounds.h"
#include "lights/selection/hierarchy/light_hierarchy.h"
#include "lights/selection/lightcuts/cluster_statistics.h"
#include "lights/selection/lightcuts/gather_points.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::lights {

struct LightcutSettings {
    float threshold = 0.02f;       ///< largest error of a pair, relative to the pixel's light
    std::uint32_t max_cut = 1000;  ///< pairs of a tile
    /// Refinement also ends where the estimated relative RMSE of a tile's pixels falls below this. 0: by the
    /// threshold alone.
    float error = 0.0f;
    /// Receivers of a tile that a VPL sees within such an angle [rad] share a shadow ray; 0: none do.
    float shared_angle = 0.0f;
};

struct LightcutCounters {
    std::uint64_t cuts = 0, pairs = 0, evaluated = 0;  ///< pairs of all cuts; estimates on the way to them
    std::uint64_t at_limit = 0;                        ///< cuts that max_cut ended
    double predicted_squares = 0.0;                    ///< sum of squared estimated errors
};

class Lightcut {
  public:
    Lightcut(const VplSet& vpls, const LightHierarchy& lights, float bound, const LightcutSettings& settings)
        : vpls_(vpls), lights_(lights), bound_{bound}, settings_(settings) {}

    /// Light at all points, by kind: traces shadow rays, and estimates transmittance with the generators of
    /// `points`. `rng` samples representatives.
    LightByKind gather(const GatherContext& context, GatherPoints& points, const core::Rng& rng);
    /// Representatives of the last cut, and their light at the points of a lane.
    std::vector<ChosenVpl> chosen(int lane) const;
    const LightcutCounters& counters() const { return counters_; }

  private:
    static constexpr int width = ReceiverLanes::width;
    static constexpr std::uint32_t no_representative = 0xffffffffu;
    struct Pair {
        std::uint32_t points;  ///< node of the points
        LightCluster lights;
        ReceiverKind kind;
        std::uint32_t representative;  ///< index in the order of VPLs, or no_representative yet
        ClusterStatistics statistics;  ///< of the VPLs
    };
    struct alignas(64) Estimate {
        float r[width], g[width], b[width];
    };

    void plan(GatherPoints& points, std::size_t size);
    void sample_representatives(std::span<const std::uint32_t> waiting);
    void record(std::size_t index);
    void add_pair(GatherPoints& points, const Pair& pair);
    void evaluate(const GatherContext& context, GatherPoints& points);
    void resolve(const GatherContext& context, GatherPoints& points);
    void choose_rays(const GatherNode& node, std::size_t in_batch, const LaneLight& light,
                     const core::ShadowPacket& packet);
    void trace(const GatherContext& context);
    void attenuate(const GatherContext& context, GatherPoints& points);
    void find_worst(std::size_t limit, bool estimated, std::size_t& count);
    void refine_worst(GatherPoints& points, std::size_t count);
    void split(GatherPoints& points, std::size_t index);
    void split_lights(GatherPoints& points, std::size_t index);
    void split_points(GatherPoints& points, std::size_t index);
    void set_pair(GatherPoints& points, std::size_t index, const Pair& pair);
    void scale_estimate(std::size_t index, float scale);
    void add_to_total(const Estimate& e, double sign);

    const VplSet& vpls_;
    const LightHierarchy& lights_;
    BoundedGeometry bound_;
    LightcutSettings settings_;
    LightcutCounters counters_;

    // The cut, by pair.
    std::vector<Pair> pairs_;
    std::vector<core::Lanes> errors_, expected_;  ///< upper_bound() and importance()
    std::vector<Estimate> estimates_;
    std::vector<std::uint32_t> waiting_;  ///< pairs without an estimate
    std::array<std::uint32_t, GatherScratch::batch> batch_{};
    std::size_t in_batch_ = 0;
    /// A shadow ray, of one lane of a pair of the batch, for all lanes of its set.
    struct SharedRay {
        std::uint8_t in_batch, lane;
        core::Rgb transmittance{0.0f};
    };
    std::vector<SharedRay> rays_;
    std::vector<core::ShadowPacket> packed_;  ///< rays_, sixteen each
    /// By pair of the batch and lane: which of rays_; no_ray where nothing arrives.
    std::array<std::array<std::uint16_t, width>, GatherScratch::batch> ray_of_{};
    static constexpr std::uint16_t no_ray = 0xffff;
    core::Rng rng_;
    double golden_ = 0.0;  ///< last number of the golden ratio's sequence
    struct Worst {
        float urgency;  ///< order of splits
        std::uint32_t pair;
    };
    std::vector<Worst> worst_;
    std::array<double, ReceiverLanes::width> total_{};  ///< averages of the channels
    double predicted_ = 0.0;                            ///< LightcutSettings::error of the cut

    // From previous tiles, which are neighbours.
    ClusterStatisticsTable statistics_;
    std::array<std::size_t, 4> planned_{};  ///< pairs, by kinds of points that there are
};

}  // namespace mote::lights
