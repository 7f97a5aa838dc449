// Matrix row-column sampling (Hasan et al. 2007) with slices (Ou and Pellacini 2011) as a selection.
#include <fmt/format.h>

#include <algorithm>

#include "lights/selection/hierarchy/build_statistics.h"
#include "lights/selection/matrix/matrix_clusters.h"
#include "lights/selection/register_selection.h"
#include "lights/selection/sampling_selector.h"

namespace mote::lights {

using namespace core;

namespace {

class TileMatrix final : public SamplingSelector {
  public:
    TileMatrix(const VplSet& vpls, std::shared_ptr<const MatrixClusters> clusters, float bound)
        : SamplingSelector(vpls, bound), clusters_(std::move(clusters)) {}

  protected:
    std::span<const WeightedVpl> sample(const ReceiverLanes& receivers, Rng& rng) override {
        return clusters_->sample(receivers, rng, samples_);
    }

  private:
    std::shared_ptr<const MatrixClusters> clusters_;
    std::vector<WeightedVpl> samples_;
};

using RowKind = RowVisibilitySettings::Kind;

const ParameterList<MatrixSettings> parameters{
    row("rows", &MatrixSettings::rows, between(1, 1 << 16),
        "Receivers that all VPLs are evaluated at, of all slices, rounded up to 16 for each: better "
        "clusters, for time in proportion to the VPLs."),
    row("columns", &MatrixSettings::columns, between(1, 1 << 20),
        "Clusters of a slice; one VPL of each lights a tile of 4 x 4 pixels: time is in proportion to it."),
    row("slices", &MatrixSettings::slices, between(1, 1 << 12),
        "Clusters of receivers of like position and normal, each with its own rows and columns."),
    within(&MatrixSettings::visibility,
           row("row_visibility", &RowVisibilitySettings::kind,
               {{"shadow_map", RowKind::shadow_maps}, {"rays", RowKind::rays}},
               "Between rows and VPLs, volumetric shadow maps of a receiver's "
               "view, faster in media, or rays: only the probabilities of VPLs depend on it.")),
};

class MatrixSelection final : public Selection {
  public:
    explicit MatrixSelection(const MatrixSettings& settings) : settings_(settings) {}
    bool is_unbiased() const override { return true; }
    VplSelector prepare(const SelectionPass& pass) const override {
        check_memory(pass);
        const BuildStatistics timer(pass.statistics, "matrix");
        const auto clusters = std::make_shared<const MatrixClusters>(
            RowContext{pass.scene, pass.vpls, pass.bound, settings_.visibility, pass.rays, pass.tracking,
                       pass.cancelled},
            pass.receivers, settings_, pass.key);
        timer.built(clusters->memory_bytes());
        pass.statistics.values["matrix_slices"] = double(clusters->slices());
        pass.statistics.values["matrix_receivers"] += double(pass.receivers.size());
        return [clusters, &vpls = pass.vpls, bound = pass.bound] {
            return std::make_unique<TileMatrix>(vpls, clusters, bound);
        };
    }
    /// Every stratum of a slice has several receivers to choose from.
    std::size_t receiver_paths() const override {
        return std::max<std::size_t>(2048, 4 * settings_.slices * settings_.rows_a_slice());
    }
    std::size_t memory_bytes(std::size_t vpls) const override { return settings_.bytes(vpls); }
    void plan(Plan& plan, const SelectionSize& size) const override {
        plan.run(
            "selection",
            fmt::format("matrix row-column sampling, {} rows, {} columns for each of {} slices of receivers",
                        settings_.rows_a_slice() * settings_.slices, settings_.columns, settings_.slices),
            "unbiased; the same VPLs for a tile of 4 x 4");
        plan_memory(plan, "memory of the matrix", size);
        const double rows = double(settings_.rows_a_slice() * settings_.slices);
        plan.run("rows of the matrix",
                 settings_.visibility.kind == RowKind::rays ? "by rays" : "by shadow maps of receivers",
                 fmt::format("{:.2g} pairs a pass, of receivers on surfaces and in media; the gather of an "
                             "image has {:.2g}",
                             rows * size.vpls, size.pairs * double(settings_.columns)));
    }

  private:
    MatrixSettings settings_;
};

}  // namespace

void register_matrix_selection(Registry& registry) {
    add_selection<MatrixSelection>(
        registry, "matrix",
        "Matrix row-column sampling (Hasan et al. 2007): clusters of VPLs that send alike to a few "
        "receivers, for each slice of the image, and one VPL sampled from each for each tile: unbiased.",
        parameters);
}

}  // namespace mote::lights
