// `mote_layers`: each cell of the transport by the method that does it best.
//
// A picture is the sum of its layers, so each may come from a method of its own, with as many passes as it
// needs. Nested integrators fill the cells that their names list; without any the scene's requirements
// choose.
#include <fmt/format.h>

#include <charconv>

#include "core/objects/number_text.h"
#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/layers/layers_estimator.h"
#include "integrators/register_parts.h"

namespace mote::integrators {

using namespace core;

namespace {

/// Kind of filter for a layer; nothing for one that stays as it is. Indirect light is smooth but where
/// surfaces and media are not, which features show; so is light of large lights scattered in media, and
/// shafts of others show as soon as noise is below them.
std::optional<screenspace::LayerKind> filtered_kind(const Layer& layer) {
    if (layer.auxiliary) return std::nullopt;
    if (layer.transport == Transport::indirect) return screenspace::LayerKind::surface;
    if (layer.transport == Transport::multiple_scattering ||
        layer.transport == Transport::single_scattering ||
        layer.transport == TransportSet::other_scattering())
        return screenspace::LayerKind::volume;
    return std::nullopt;
}

/// The parameters of a scene file.
struct LayersSettings {
    EyePathLimits limits;
    LayerFilterParameters filter;
    bool filters = true;
    FarLight far_light = FarLight::paths;
    std::string shares;
    std::vector<Nested<const Integrator>> integrators;
};

class MoteLayers final : public Integrator {
  public:
    MoteLayers(const LayersSettings& s, const Properties& properties)
        : limits_(s.limits), filter_(s.filter), filters_(s.filters), far_light_(s.far_light) {
        read_shares(s.shares);
        for (const auto& [name, integrator, where] : s.integrators) {
            if (integrator->works_on_mean())
                throw InputError(
                    integrator->type() +
                        " works on the mean of its whole picture here, and cannot fill a part of another",
                    where);
            const bool named = name != "integrator";  // the name of the parameter is as good as none
            nested_.push_back({integrator, read_transport(named ? name : "", where), "requested", where});
        }
        if (nested_.empty()) return;
        for (const std::string name : {"max_depth", "rr_depth", "hide_emitters", "far_light"})
            if (properties.has(name))
                properties.warn(name + " has no effect: every nested integrator has its own");
    }

    std::string type() const override { return "mote_layers"; }
    bool works_on_mean() const override { return true; }
    std::vector<Layer> layers(const Scene& scene) const override { return choose(scene).layers; }
    Plan plan(const Scene& scene, const Requirements& requirements) const override;
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        const LayerChoice choice = choose(scene);
        std::vector<LayerFilter::Choice> filtered;
        for (std::size_t i = 0; i < choice.layers.size(); ++i)
            if (choice.layers[i].squares) filtered.push_back({i, *filtered_kind(choice.layers[i])});
        if (!shares_.empty() && shares_.size() != choice.methods.size())
            throw InputError(
                fmt::format("mote_layers: shares has {} numbers, and there are {} methods (see 'mote plan')",
                            shares_.size(), choice.methods.size()));
        return make_layers_estimator(scene, options, choice, filter_, std::move(filtered), shares_);
    }

  private:
    void read_shares(const std::string& text) {
        constexpr std::uint32_t most = 1000;
        for (const std::string& word : split_words(text)) {
            std::uint32_t share = 0;
            const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), share);
            if (error != std::errc() || end != word.data() + word.size() || share < 1 || share > most)
                throw InputError("shares '" + printable(text) +
                                 "': expected whole numbers from 1 to 1000, such as '3, 1'");
            shares_.push_back(share);
        }
    }
    /// Methods and layers for this scene; those that are filtered keep their squares.
    LayerChoice choose(const Scene& scene) const {
        LayerChoice choice = fill_layers(
            scene, nested_.empty()
                       ? choose_layer_methods(scene, find_requirements(scene), limits_, far_light_)
                       : nested_);
        for (Layer& layer : choice.layers) layer.squares = filters_ && filtered_kind(layer);
        return choice;
    }
    EyePathLimits limits_;
    LayerFilterParameters filter_;
    bool filters_;
    FarLight far_light_;
    std::vector<std::uint32_t> shares_;  ///< of passes, one a method; empty: as many as each needs
    std::vector<LayerMethod> nested_;
};

void add_entries(std::vector<PlanEntry>& all, const std::vector<PlanEntry>& more, const std::string& type) {
    for (PlanEntry entry : more) {
        entry.topic = type + ": " + entry.topic;
        all.push_back(std::move(entry));
    }
}

Plan MoteLayers::plan(const Scene& scene, const Requirements& requirements) const {
    Plan plan;
    plan.integrator = type();
    const LayerChoice choice = choose(scene);
    for (const LayerMethod& method : choice.methods)
        plan.run(transport_name(method.cells), method.integrator->type(), method.reason);
    plan.run("passes", fmt::format("shared out among {} methods", choice.methods.size()),
             shares_.empty() ? "to the one whose next pass takes the most error for its rays and lookups"
                             : "shares says how many each has in a round");
    std::string filtered;
    for (const Layer& layer : choice.layers)
        if (layer.squares) filtered += (filtered.empty() ? "" : ", ") + layer.name;
    if (!filtered.empty())
        plan.run("filter", filtered + " in image space",
                 "biased by what it smoothes, less with every pass; filter=false leaves the noise. The noise "
                 "that is stated, and --noise, are what the filter leaves, without that bias");
    for (const std::string& cell : transport_names(choice.unfilled(requirements.any_media())))
        plan.miss(cell, "no method fills it", "none of the nested integrators has it in its name");
    for (const LayerMethod& method : choice.methods) {
        Requirements wanted = requirements;
        wanted.cells = method.cells;
        const Plan own = method.integrator->plan(scene, wanted);
        add_entries(plan.runs, own.runs, method.integrator->type());
        add_entries(plan.missing, own.missing, method.integrator->type());
        if (plan.noise_unknown.empty()) plan.noise_unknown = own.noise_unknown;
        plan.costly.insert(plan.costly.end(), own.costly.begin(), own.costly.end());
    }
    return plan;
}

}  // namespace

void register_mote_layers(Registry& registry) {
    using S = LayersSettings;
    add_type<S>(
        registry, Category::integrator, "mote_layers",
        "Each layer of the picture by the method that does it best, with as many passes as it needs: the "
        "default where a scene names no integrator.",
        {within(&S::limits, eye_path_rows()),
         row("filter", &S::filters,
             "Smooth indirect light and multiple scattering in image space, as far as noise explains their "
             "detail."),
         within(&S::filter, layer_filter_rows()),
         row("far_light", &S::far_light, {{"paths", FarLight::paths}, {"lights", FarLight::lights}},
             "Indirect light and multiple scattering where the scene chooses: by paths, unbiased, or by "
             "virtual point lights, resampled, with less noise and without what their bound takes."),
         row("shares", &S::shares,
             "Passes of each method in a round, such as '3, 1' (docs/cluster.md): passes are known "
             "beforehand, which several machines need.")
             .when_absent("as many as reduce the error fastest"),
         nested("integrator", &S::integrators, Category::integrator, "chosen by the scene",
                "Any number: each fills the cells that its name lists, of emission, direct, indirect, "
                "single_scattering and multiple_scattering; without a name all that it can.")},
        R"(<integrator type="mote_layers">
    <integrator type="mote_epipolar" name="emission, direct, single_scattering"/>
    <integrator type="volpath" name="indirect, multiple_scattering"/>
</integrator>)",
        [](const S& s, const Properties& p) { return std::make_shared<MoteLayers>(s, p); });
}

}  // namespace mote::integrators
