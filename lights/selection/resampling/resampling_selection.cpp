// Resampled importance sampling (Talbot et al. 2005) as a selection: candidates from a cut, a few VPLs for
// each pixel.
#include <fmt/format.h>

#include <algorithm>
#include <deque>

#include "core/math/morton.h"
#include "lights/selection/register_selection.h"
#include "lights/selection/resampling/recorded_receivers.h"
#include "lights/selection/resampling/resampling.h"
#include "lights/selection/stochastic/light_sampler.h"
#include "lights/selection/tree_selection.h"

namespace mote::lights {

using namespace core;

namespace {

/// Candidates from each cluster of the cut. Each is evaluated, which costs less than a cluster and reveals
/// less.
constexpr std::uint32_t candidates_a_cluster = 2;

class TileResampling final : public TileSelector {
  public:
    TileResampling(const VplSet& vpls, std::shared_ptr<const WideLightTree> tree, float bound,
                   std::uint32_t candidates, std::uint32_t samples)
        : vpls_(vpls),
          tree_(std::move(tree)),
          bound_(bound),
          count_(candidates),
          resampling_(vpls, bound, samples) {}

    std::size_t max_points() const override { return std::size_t(-1); }
    TileLight gather(const GatherContext&, ReceiverTile& receivers, const VplRange&, BatchVisibility&,
                     Rng&) override {
        for (const ReceiverKind kind : {ReceiverKind::surface, ReceiverKind::medium}) {
            const ReceiverTile tile = lanes_of(receivers, kind);
            if (!tile.any_active) continue;
            Points& points = points_[std::size_t(kind)];
            if (points.used == points.tiles.size()) points.tiles.emplace_back();
            points.tiles[points.used++].copy(tile);
        }
        return {};
    }
    LightByKind gather_copied(const GatherContext& context, Rng& rng) override {
        Rng choices = choices_of(rng);
        LightByKind light{};
        all_.clear(), bounds_.clear();
        for (Points& points : points_)
            for (std::size_t p = 0; p < points.used; ++p) {
                all_.push_back(&points.tiles[p]);
                bounds_.emplace_back(points.tiles[p].tile);
            }
        if (!all_.empty()) {
            sample_candidates(choices);
            visibilities_.clear();
            for (const std::uint32_t c : order_) visibilities_.push_back(sampler_.visibility(c));
            resampling_.gather(context, all_, candidates_, choices, visibilities_);
            for (std::size_t p = 0; p < all_.size(); ++p) {
                const TileLight one = resampling_.light_of(p);
                TileLight& sum = light[p < points_[0].used ? 0 : 1];
                for (std::size_t i = 0; i < one.size(); ++i) sum[i] += one[i];
            }
            for (std::size_t c = 0; c < candidates_.size(); ++c) {
                const Resampling::Found& found = resampling_.found()[c];
                sampler_.learn(order_[c], found.light, found.rays, found.ray_squares);
            }
        }
        points_[0].used = points_[1].used = 0;
        return light;
    }
    std::vector<ChosenVpl> chosen(int lane) const override { return resampling_.chosen(lane); }
    void add_statistics(Statistics& statistics) const override {
        statistics.values["resampling_candidates"] += double(resampling_.counters().candidates);
        statistics.values["resampling_chosen"] += double(resampling_.counters().chosen);
    }

  private:
    struct Points {
        std::deque<RecordedReceivers> tiles;  ///< memory that is used again
        std::size_t used = 0;
    };

    /// One set of candidates for all points of all lanes, along a space-filling curve: systematic resampling
    /// then spreads its choices evenly over the VPLs.
    void sample_candidates(Rng& rng) {
        sampler_.learn_into(&learned_);
        const auto sampled =
            sampler_.from_clusters(*tree_, ReceiverClusters(bounds_, *tree_), bound_,
                                   std::max(count_ / candidates_a_cluster, 1u), candidates_a_cluster, rng);
        Bounds3 bounds;
        for (const WeightedVpl& c : sampled) bounds.extend(vpls_.lights[c.index].position);
        codes_.clear();
        for (std::size_t c = 0; c < sampled.size(); ++c)
            codes_.emplace_back(morton_code(vpls_.lights[sampled[c].index].position, bounds),
                                std::uint32_t(c));
        std::sort(codes_.begin(), codes_.end(), [&](const auto& a, const auto& b) {
            if (a.first != b.first) return a.first < b.first;
            return sampled[a.second].index < sampled[b.second].index;
        });
        order_.clear(), candidates_.clear();
        for (const auto& [code, c] : codes_) order_.push_back(c), candidates_.push_back(sampled[c]);
    }

    const VplSet& vpls_;
    std::shared_ptr<const WideLightTree> tree_;
    float bound_;
    std::uint32_t count_;
    std::array<Points, 2> points_;  ///< by ReceiverKind
    LightSampler sampler_;
    LearnedImportance learned_;
    std::vector<WeightedVpl> candidates_;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> codes_;
    std::vector<std::uint32_t> order_;  ///< of the candidates: indices among what was sampled
    std::vector<float> visibilities_;   ///< by candidate
    std::vector<RecordedReceivers*> all_;
    std::vector<ReceiverBounds> bounds_;
    Resampling resampling_;
};

struct ResamplingSettings {
    std::uint32_t candidates = 256, samples = 32;
};

const ParameterList<ResamplingSettings> parameters{
    row("candidates", &ResamplingSettings::candidates, between(1, 1 << 20),
        "VPLs that a tile of 4 x 4 pixels evaluates without shadow rays, on surfaces and along eye rays "
        "through media: more lower the variance of the choice, four to sixteen a sample pay."),
    row("samples", &ResamplingSettings::samples, between(1, 1 << 16),
        "VPLs of them that each pixel chooses: shadow rays, and most of the time."),
};

class ResamplingSelection final : public TreeSelection {
  public:
    explicit ResamplingSelection(const ResamplingSettings& settings) : settings_(settings) {}
    bool is_unbiased() const override { return true; }
    VplSelector prepare(const SelectionPass& pass) const override {
        return [tree = build_tree(pass), &vpls = pass.vpls, bound = pass.bound, s = settings_] {
            return std::make_unique<TileResampling>(vpls, tree, bound, s.candidates, s.samples);
        };
    }
    std::string excludes(const GatherOptions& options) const override {
        const std::string other = Selection::excludes(options);
        return other.empty() && options.imperfect_shadow_maps ? "imperfect shadow maps" : other;
    }
    void plan(Plan& plan, const SelectionSize& size) const override {
        plan.run("selection",
                 fmt::format("resampling, {} of {} candidates from a cut", settings_.samples,
                             settings_.candidates),
                 "unbiased; tiles of 4 x 4 share their candidates, each pixel chooses its own");
        plan_memory(plan, "memory of the light tree", size);
    }

  private:
    ResamplingSettings settings_;
};

}  // namespace

std::shared_ptr<Selection> resampled_vpls(std::uint32_t candidates, std::uint32_t samples) {
    return std::make_shared<ResamplingSelection>(ResamplingSettings{candidates, samples});
}

void register_resampling_selection(Registry& registry) {
    add_selection<ResamplingSelection>(
        registry, "resampling",
        "Resampled importance sampling (Talbot et al. 2005): a few VPLs for each pixel, chosen among many "
        "candidates from a cut by their unoccluded light: unbiased.",
        parameters);
}

}  // namespace mote::lights
