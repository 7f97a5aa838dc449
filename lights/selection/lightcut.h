// Lightcuts (Walter et al. 2005) and multidimensional lightcuts (Walter et al. 2006): the light of all
// virtual point lights at all points of a tile's pixels, from a few pairs of groups.
//
// A pair of a group of points and a group of lights is estimated by one pair that stands for it, with shadow
// rays, and its error is at most what it could send at most (most_light()). The pair of the largest error,
// relative to the pixel, is parted, at its lights or at its points, until no error is above `threshold` times
// the sum of all estimates of its pixel, or the cut has `max_cut` pairs. One part inherits the estimate.
//
// The cut is one for the sixteen pixels of a tile, each of which must be content: so shadow rays stay
// packets. Pairs are parted in batches, the worst first. With a threshold of 0 the sum is that of all pairs.
#pragma once

#include <vector>

#include "lights/selection/cluster_bounds.h"
#include "lights/selection/gather_points.h"
#include "lights/selection/light_hierarchy.h"
#include "lights/selection/seen_clusters.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::lights {

struct LightcutSettings {
    float threshold = 0.02f;       ///< of the pixel's light that one pair's error may be
    std::uint32_t max_cut = 1000;  ///< pairs of a tile
    /// Parting ends where the error of a tile's pixels, root of the mean square, is estimated to be this
    /// share of their light: an estimate, no bound. 0: only where the threshold says so.
    float error = 0.0f;
    /// Receivers of a tile that a light sees within such an angle [rad] share a shadow ray, by GatherKind; 0:
    /// none do.
    std::array<float, 2> shared_angle{0.0f, 0.0f};
};

struct LightcutCounters {
    std::uint64_t cuts = 0, pairs = 0, evaluated = 0;  ///< pairs: of all cuts; evaluated: on the way to them
    std::uint64_t at_limit = 0;                        ///< cuts that max_cut ended
    double predicted_squares = 0.0;                    ///< of the estimated errors of all cuts

    void add(const LightcutCounters& other) {
        cuts += other.cuts, pairs += other.pairs, evaluated += other.evaluated, at_limit += other.at_limit;
        predicted_squares += other.predicted_squares;
    }
};

class Lightcut {
  public:
    Lightcut(const VplSet& vpls, const LightHierarchy& lights, float bound, const LightcutSettings& settings)
        : vpls_(vpls), lights_(lights), bound_{bound}, settings_(settings) {}

    using Light = std::array<TileLight, 2>;  ///< by GatherKind
    /// Shadow rays are traced, and the media between cross out light, with the generators of `points`.
    /// `rng` draws who stands for a group of lights.
    Light gather(const GatherContext& context, GatherPoints& points, const core::Rng& rng);
    const LightcutCounters& counters() const { return counters_; }

  private:
    static constexpr int width = ReceiverLanes::width;
    static constexpr std::uint32_t nobody = 0xffffffffu;
    struct Pair {
        std::uint32_t group;
        LightCluster lights;
        GatherKind kind;
        std::uint32_t place;  ///< in the order of lights: who stands for them, or nobody yet
        SeenCluster seen;     ///< of the lights
    };
    struct alignas(64) Estimate {
        float r[width], g[width], b[width];
    };

    void plan(GatherPoints& points, std::size_t size);
    void draw(std::span<const std::uint32_t> waiting);
    void saw(std::size_t index);
    void add_pair(GatherPoints& points, const Pair& pair);
    void evaluate(const GatherContext& context, GatherPoints& points);
    void resolve(const GatherContext& context, GatherPoints& points);
    void choose_rays(const GatherGroup& group, GatherKind kind, std::size_t in_batch, const LaneLight& light,
                     const core::ShadowPacket& packet);
    void trace(const GatherContext& context);
    void attenuate(const GatherContext& context, GatherPoints& points);
    void find_worst(std::size_t limit, bool estimated, std::size_t& count);
    void part_worst(GatherPoints& points, std::size_t count);
    void part(GatherPoints& points, std::size_t index);
    void part_lights(GatherPoints& points, std::size_t index);
    void part_points(GatherPoints& points, std::size_t index);
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
    std::vector<LaneValues> errors_, expected_;  ///< most_light() and expected_light()
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
    double share_ = 0.0;  ///< of a group's energy, up to whom stands for it
    struct Worst {
        float urgency;  ///< by which they are parted
        std::uint32_t pair;
    };
    std::vector<Worst> worst_;
    std::array<double, ReceiverLanes::width> total_{};  ///< averages of the channels
    double predicted_ = 0.0;                            ///< error, as settings say it

    // Of the tiles before, which lie beside this one.
    SeenClusters seen_;
    std::array<std::size_t, 4> planned_{};  ///< pairs, by kinds of points that there are
};

}  // namespace mote::lights
