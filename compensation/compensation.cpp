// Bias compensation in the passes, exact or approximate, from the primary lights and from the VPLs
// (Kollig and Keller 2006; Raab et al. 2008; Engelhardt 2013, Sec. 10.2).
#include "compensation/residual.h"

#include <atomic>

#include "compensation/light_compensation.h"
#include "compensation/plan_compensation.h"
#include "compensation/vpl_compensation.h"
#include "core/parameters/add_type.h"
#include "core/render/cpu_clock.h"

namespace mote::compensation {

using namespace core;

namespace {

/// Cost of compensation, summed by tasks.
struct CompensationCost {
    std::atomic<std::uint64_t> vertices{0};
    std::atomic<double> seconds{0.0};  ///< of processor time, all threads
};

template <bool Media>
class TileCompensation final : public TileResidual {
  public:
    TileCompensation(const Scene& scene, const CompensationSettings& settings,
                     const ResidualTransport& transport, CompensationCost& cost, const lights::VplSet& vpls,
                     lights::GatherScratch& gather_scratch, WalkContext& walk)
        : scene_(scene),
          settings_(settings),
          transport_(transport),
          cost_(cost),
          vpls_(vpls),
          gather_scratch_(gather_scratch),
          walk_(walk) {}
    ~TileCompensation() override {
        cost_.vertices += vertices_ + scratch_.vertices, cost_.seconds += seconds_;
    }

    void add(int lane, const ScatteringVertex& vertex, const Rgb& throughput, const MediumState& state,
             std::int32_t max_vpl_depth) override {
        if (!(vertex.on_surface() ? settings_.surfaces : settings_.media)) return;
        CompensatedReceiver& r = receivers_[std::size_t(lane)];
        r.rng = Rng(walk_.rng.next_u32());
        r.path = transport_.start(vertex, state, throughput, r.rng);
        r.max_vpl_depth = max_vpl_depth;
        any_ = true;
    }

    lights::TileLight run(const lights::VplRange& range, float vpl_scale) override {
        lights::TileLight sum{};
        if (!any_) return sum;
        const double begin = thread_cpu_seconds();
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = from_lights(receivers_[i]);
        const VplCompensation request{transport_, settings_.strategy, settings_.depth, vpls_, range};
        const auto light = compensation_from_vpls<Media>(
            request, receivers_, scratch_,
            {scene_, gather_scratch_, walk_.rays, walk_.tracking, walk_.cancelled}, walk_);
        for (std::size_t i = 0; i < sum.size(); ++i) {
            sum[i] += vpl_scale * light[i];
            receivers_[i].max_vpl_depth = 0;
        }
        any_ = false;
        seconds_ += thread_cpu_seconds() - begin;
        return sum;
    }

  private:
    Rgb from_lights(CompensatedReceiver& r) {
        if (r.max_vpl_depth < 1) return Rgb(0.0f);
        const int steps = settings_.depth < 0 ? r.max_vpl_depth : std::min(settings_.depth, r.max_vpl_depth);
        walk_.rng = r.rng;
        const Rgb light =
            compensation_from_lights<Media>(scene_, transport_, r.path, steps, walk_, vertices_);
        r.rng = walk_.rng;
        return light;
    }

    const Scene& scene_;
    const CompensationSettings& settings_;
    const ResidualTransport& transport_;
    CompensationCost& cost_;
    const lights::VplSet& vpls_;
    lights::GatherScratch& gather_scratch_;
    WalkContext& walk_;
    CompensatedTile receivers_;
    VplCompensationScratch scratch_;
    std::uint64_t vertices_ = 0;
    double seconds_ = 0.0;  ///< of processor time
    bool any_ = false;
};

template <bool Media>
class PreparedCompensation final : public PreparedResidual {
  public:
    PreparedCompensation(const ResidualView& view, const CompensationSettings& settings)
        : scene_(view.scene), settings_(settings), transport_(view.scene, view.bound, settings) {}
    std::unique_ptr<TileResidual> for_task(const lights::VplSet& vpls, lights::GatherScratch& scratch,
                                           WalkContext& walk) override {
        return std::make_unique<TileCompensation<Media>>(scene_, settings_, transport_, cost_, vpls, scratch,
                                                         walk);
    }
    void add_statistics(Statistics& statistics) const override {
        statistics.values["compensation_vertices"] += double(cost_.vertices.load());
        statistics.values["compensation_thread_seconds"] += cost_.seconds.load();
        statistics.values["compensation_bytes"] = double(transport_.memory_bytes());
    }

  private:
    const Scene& scene_;
    CompensationSettings settings_;
    ResidualTransport transport_;
    CompensationCost cost_;
};

/// Strategy and placement together, as scene files name them.
enum class Joining : std::uint8_t { one_to_n, n_to_one, one_to_one, one_to_one_homogeneous };
enum class Receivers : std::uint8_t { all, surfaces, media };

const Choices<Joining> joinings{{"1-to-n", Joining::one_to_n},
                                {"n-to-1", Joining::n_to_one},
                                {"1-to-1", Joining::one_to_one},
                                {"1-to-1-homogeneous", Joining::one_to_one_homogeneous}};

/// The parameters of a scene file, and what they set.
struct CompensationFile {
    Joining joining = Joining::one_to_n;
    Receivers receivers = Receivers::all;
    CompensationSettings settings;
};

Rows<CompensationFile> common_rows() {
    using S = CompensationFile;
    return {row("strategy", &S::joining, joinings,
                "1-to-n: a receiver makes one vertex, joined to all VPLs; n-to-1: one vertex for each VPL; "
                "1-to-1: like n-to-1, and VPLs are shared out among the receivers along the eye ray; "
                "1-to-1-homogeneous: like 1-to-1, with vertices always inside the bounding region."),
            row("receivers", &S::receivers,
                {{"all", Receivers::all}, {"surfaces", Receivers::surfaces}, {"media", Receivers::media}},
                "Receivers whose light is compensated.")};
}

ParameterList<CompensationFile> approximate_rows() {
    using S = CompensationSettings;
    CompensationFile defaults;
    defaults.joining = Joining::one_to_one_homogeneous;
    defaults.settings.depth = 1, defaults.settings.local_visibility = false;
    defaults.settings.transmittance = LocalTransmittance::mean;
    return {
        defaults,
        {common_rows(),
         within(&CompensationFile::settings,
                row("depth", &S::depth, between(0, 1000).or_else(-1, "no limit"), "Steps of the recursion."),
                row("local_visibility", &S::local_visibility,
                    "Rays from receivers in media look for surfaces and boundaries; from surfaces they "
                    "always do."),
                row("transmittance", &S::transmittance,
                    {{"mean", LocalTransmittance::mean}, {"exact", LocalTransmittance::exact}},
                    "Inside the bounding region: from the mean extinction there, or exact."))}};
}

class Compensation final : public Residual {
  public:
    explicit Compensation(const CompensationSettings& settings) : settings_(settings) {}
    std::unique_ptr<PreparedResidual> prepare(const ResidualView& view) const override {
        if (!std::isfinite(view.bound)) return Residual::prepare(view);
        if (view.scene.has_media()) return std::make_unique<PreparedCompensation<true>>(view, settings_);
        return std::make_unique<PreparedCompensation<false>>(view, settings_);
    }
    std::shared_ptr<const Residual> for_media() const override {
        const auto media = std::make_shared<Compensation>(settings_);
        media->settings_.surfaces = false;
        return media;
    }
    std::vector<Layer> layers(bool media) const override { return compensation_layers(media); }
    bool in_passes(bool) const override { return true; }
    bool shares_vpls() const override { return settings_.strategy == Strategy::one_to_one; }
    int eye_samples() const override { return shares_vpls() ? 4 : 1; }
    void plan(Plan& plan, const Scene& scene, const Requirements& r, float bound) const override {
        plan_compensation(plan, scene, r, settings_, bound);
        plan_expected_loss(plan, scene, settings_.media ? settings_.depth : 0, bound);
    }

  private:
    CompensationSettings settings_;
};

std::shared_ptr<Compensation> make(const CompensationFile& file) {
    CompensationSettings s = file.settings;
    s.strategy = file.joining == Joining::one_to_n   ? Strategy::one_to_n
                 : file.joining == Joining::n_to_one ? Strategy::n_to_one
                                                     : Strategy::one_to_one;
    s.placement =
        file.joining == Joining::one_to_one_homogeneous ? Placement::in_region : Placement::free_path;
    s.surfaces = file.receivers != Receivers::media, s.media = file.receivers != Receivers::surfaces;
    return std::make_shared<Compensation>(s);
}

}  // namespace

std::string CompensationSettings::strategy_name() const {
    if (strategy == Strategy::one_to_one && placement == Placement::in_region)
        return joinings.word(Joining::one_to_one_homogeneous);
    return joinings.word(Joining(strategy));
}

void register_compensation(Registry& registry) {
    add_type(registry, Category::compensation, "none",
             "Nothing: the bound darkens light over short distances.", R"(<compensation type="none"/>)",
             [] { return std::make_shared<Residual>(); });
    add_type(registry, Category::compensation, "exact",
             "Brings back all light that the bound takes (Kollig and Keller 2006; Raab et al. 2008).",
             ParameterList<CompensationFile>{common_rows()}, R"(<compensation type="exact"/>)", make);
    add_type(registry, Category::compensation, "approximate",
             "Approximate bias compensation (Engelhardt 2013, Sec. 10.2).", approximate_rows(),
             R"(<compensation type="approximate"><integer name="depth" value="2"/></compensation>)", make);
}

}  // namespace mote::compensation
