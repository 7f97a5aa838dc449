#include "lights/selection/matrix/matrix_selection.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/parameters/add_type.h"
#include "lights/selection/hierarchy/build_statistics.h"
#include "lights/selection/sampling_selector.h"

namespace mote::lights {

using namespace core;

namespace {

class TileMatrix final : public SamplingSelector {
  public:
    TileMatrix(const VplSet& vpls, const MatrixClusters& clusters, float bound)
        : SamplingSelector(vpls, bound), clusters_(clusters) {}

  protected:
    std::span<const WeightedVpl> sample(const ReceiverLanes& receivers, Rng& rng) override {
        return clusters_.sample(receivers, rng, samples_);
    }

  private:
    const MatrixClusters& clusters_;
    std::vector<WeightedVpl> samples_;
};

class MatrixSelector final : public VplSelector {
  public:
    MatrixSelector(const SelectionPass& pass, const MatrixSettings& settings)
        : vpls_(pass.vpls), bound_(pass.bound) {
        const BuildStatistics timer(pass.statistics, "matrix");
        clusters_ = MatrixClusters(
            {pass.scene, vpls_, bound_, settings.visibility, pass.rays, pass.tracking, pass.cancelled},
            pass.receivers, settings, pass.key);
        timer.built(clusters_.memory_bytes());
        pass.statistics.values["matrix_slices"] = double(clusters_.slices());
        pass.statistics.values["matrix_receivers"] += double(pass.receivers.size());
    }
    std::unique_ptr<TileSelector> for_task() const override {
        return std::make_unique<TileMatrix>(vpls_, clusters_, bound_);
    }

  private:
    const VplSet& vpls_;
    float bound_;
    MatrixClusters clusters_;
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

}  // namespace

/// Every stratum of a slice has several receivers to choose from.
std::size_t MatrixSelection::receiver_paths() const {
    return std::max<std::size_t>(2048, 4 * settings_.slices * settings_.rows_a_slice());
}

std::unique_ptr<VplSelector> MatrixSelection::prepare(const SelectionPass& pass) const {
    check_memory(pass);
    return std::make_unique<MatrixSelector>(pass, settings_);
}

void MatrixSelection::plan(Plan& plan, const SelectionSize& size) const {
    plan.run("selection",
             fmt::format("matrix row-column sampling, {} rows, {} columns for each of {} slices of receivers",
                         settings_.rows_a_slice() * settings_.slices, settings_.columns, settings_.slices),
             "unbiased; the same VPLs for a tile of 4 x 4");
    plan_memory(plan, "memory of the matrix", size);
    const double rows = double(settings_.rows_a_slice() * settings_.slices);
    plan.run(
        "rows of the matrix",
        settings_.visibility.kind == RowKind::rays ? "by rays" : "by shadow maps of receivers",
        fmt::format(
            "{:.2g} pairs a pass, of receivers on surfaces and in media; the gather of an image has {:.2g}",
            rows * size.vpls, size.pairs * double(settings_.columns)));
}

void register_matrix_selection(Registry& registry) {
    add_type(registry, Category::selection, "matrix",
             "Matrix row-column sampling (Hasan et al. 2007): clusters of VPLs that send alike to a few "
             "receivers, for each slice of the image, and one VPL sampled from each for each tile: unbiased.",
             parameters, R"(<selection type="matrix"/>)",
             [](const MatrixSettings& settings, const Properties& properties) {
                 const auto selection = std::make_shared<MatrixSelection>(settings);
                 selection->where = properties.where;
                 return selection;
             });
}

}  // namespace mote::lights
