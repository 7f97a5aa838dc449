// `mote_layers`: each cell of the transport by the method that does it best.
//
// A picture is the sum of its layers, so each may come from a method of its own, with as many passes as it
// needs. Nested integrators fill the cells that their names list; without any the scene's requirements
// choose.
#include <fmt/format.h>

#include <charconv>

#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/layers/layers_estimator.h"
#include "integrators/register_parts.h"
#include "integrators/single_scattering/single_scattering_estimator.h"

namespace mote::integrators {

using namespace core;

namespace {

/// "direct, indirect" -> {"direct", "indirect"}
std::vector<std::string> split_names(const std::string& text) {
    std::vector<std::string> names;
    std::string name;
    for (const char c : text + ",") {
        if (c != ',' && c != ' ')
            name += c;
        else if (!name.empty())
            names.push_back(std::exchange(name, ""));
    }
    return names;
}

std::string joined(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

/// Light that has come a long way is smooth but where surfaces and media are not, which the filter knows; so
/// is light of large lights scattered in media, and shafts of others show as soon as noise is below them.
std::optional<screenspace::LayerKind> filtered_kind(const Layer& layer) {
    if (layer.auxiliary) return std::nullopt;
    const std::string& cell = layer.transport();
    if (cell == transport_name(Transport::indirect)) return screenspace::LayerKind::surface;
    if (cell == transport_name(Transport::multiple_scattering) || cell == other_scattering ||
        cell == transport_name(Transport::single_scattering))
        return screenspace::LayerKind::volume;
    return std::nullopt;
}

class MoteLayers final : public Integrator {
  public:
    explicit MoteLayers(const Properties& properties)
        : limits_(read_eye_path_limits(properties)), filter_(read_layer_filter(properties)) {
        filters_ = properties.get_bool("filter", true);
        if (properties.get_choice("far_light", "paths", {"paths", "lights"}) == "lights")
            far_light_ = FarLight::lights;
        read_shares(properties);
        for (const Properties::Child& child : properties.children) {
            const auto integrator = std::dynamic_pointer_cast<const Integrator>(child.object);
            if (!integrator) continue;
            if (integrator->works_on_mean())
                throw InputError(integrator->type() +
                                     " works on the mean of its whole picture here, and cannot "
                                     "fill a part of another",
                                 child.where);
            const bool named = child.name != "integrator";  // the name of the parameter is as good as none
            asked_for_.push_back(
                {integrator, split_names(named ? child.name : ""), "asked for", child.where});
        }
        if (asked_for_.empty()) return;
        for (const std::string name : {"max_depth", "rr_depth", "hide_emitters", "far_light"})
            if (properties.has(name))
                properties.warn(name + " has no effect: every nested integrator has its own");
    }

    std::string type() const override { return "mote_layers"; }
    bool works_on_mean() const override { return true; }
    std::vector<Layer> layers(const Scene& scene) const override { return layers_of(scene, methods(scene)); }
    Plan plan(const Scene& scene, const Requirements& requirements) const override;
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        const std::vector<LayerMethod> chosen = methods(scene);
        FilterPlan filter{filter_, {}};
        const std::vector<Layer> all = layers_of(scene, chosen);
        for (std::size_t i = 0; filters_ && i < all.size(); ++i)
            if (const auto kind = filtered_kind(all[i])) filter.layers.push_back({i, *kind});
        if (!shares_.empty() && shares_.size() != chosen.size())
            throw InputError(
                fmt::format("mote_layers: shares has {} numbers, and there are {} methods (see 'mote plan')",
                            shares_.size(), chosen.size()));
        return make_layers_estimator(scene, options, chosen, filter, shares_);
    }

  private:
    void read_shares(const Properties& properties) {
        const std::string text = properties.get_string("shares", "");
        constexpr std::uint32_t most = 1000;
        for (const std::string& word : split_names(text)) {
            std::uint32_t share = 0;
            const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), share);
            if (error != std::errc() || end != word.data() + word.size() || share < 1 || share > most)
                throw InputError("shares '" + printable(text) +
                                 "': expected whole numbers from 1 to 1000, such as '3, 1'");
            shares_.push_back(share);
        }
    }
    /// The kept layers of every method, each a part.
    std::vector<Layer> layers_of(const Scene& scene, const std::vector<LayerMethod>& chosen) const {
        std::vector<Layer> layers;
        for (std::size_t part = 0; part < chosen.size(); ++part) {
            const std::vector<Layer> own = chosen[part].integrator->layers(scene);
            for (const std::size_t i : kept_layers(scene, chosen[part])) {
                layers.push_back(own[i]);
                layers.back().part = part;
                if (filters_ && filtered_kind(layers.back())) layers.back().squares = true;
            }
        }
        return layers;
    }
    std::vector<LayerMethod> methods(const Scene& scene) const {
        return with_cells(scene, asked_for_.empty() ? choose_layer_methods(scene, find_requirements(scene),
                                                                           limits_, far_light_)
                                                    : asked_for_);
    }
    EyePathLimits limits_;
    LayerFilterParameters filter_;
    bool filters_ = true;
    FarLight far_light_ = FarLight::paths;
    std::vector<std::uint32_t> shares_;  ///< of passes, one a method; empty: as many as each needs
    std::vector<LayerMethod> asked_for_;
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
    const std::vector<LayerMethod> chosen = methods(scene);
    for (const LayerMethod& method : chosen)
        plan.run(joined(method.cells), method.integrator->type(), method.reason);
    plan.run("passes", fmt::format("shared out among {} methods", chosen.size()),
             shares_.empty() ? "to the one whose next pass takes the most error for its rays and lookups"
                             : "shares says how many each has in a round");
    std::vector<std::string> filtered;
    for (const Layer& layer : layers_of(scene, chosen))
        if (filters_ && filtered_kind(layer)) filtered.push_back(layer.name);
    if (!filtered.empty())
        plan.run("filter", joined(filtered) + " in image space",
                 "biased by what it smoothes, less with every pass; filter=false leaves the noise. The noise "
                 "that is stated, and --noise, are what the filter leaves, without that bias");
    for (const std::string& cell : unfilled_cells(requirements.any_media(), chosen))
        plan.miss(cell, "no method fills it", "none of the nested integrators has it in its name");
    for (const LayerMethod& method : chosen) {
        Requirements wanted = requirements;
        wanted.cells = method.cells;
        const Plan own = method.integrator->plan(scene, wanted);
        add_entries(plan.runs, own.runs, method.integrator->type());
        add_entries(plan.missing, own.missing, method.integrator->type());
    }
    return plan;
}

}  // namespace

void register_mote_layers(Registry& registry) {
    auto parameters = eye_path_parameters();
    parameters.push_back(
        {"filter", "boolean", "true",
         "smooth indirect light and multiple scattering in image space, as far as noise explains "
         "their detail"});
    for (Parameter& p : layer_filter_parameters()) parameters.push_back(std::move(p));
    parameters.push_back(
        {"far_light", "string", "paths",
         "indirect light and multiple scattering where the scene chooses: 'paths', unbiased, or 'lights', "
         "virtual point lights, resampled, with less noise and without what their bound "
         "takes"});
    parameters.push_back(
        {"shares", "string", "as many as reduce the error fastest",
         "passes of each method in a round, such as '3, 1' (docs/cluster.md): passes are known "
         "beforehand, which several machines need"});
    parameters.push_back(
        {"integrator", "integrator", "chosen by the scene",
         "any number: each fills the cells that its name lists, of emission, direct, indirect, "
         "single_scattering and multiple_scattering; without a name all that it can"});
    registry.add(
        {Category::integrator, "mote_layers",
         "Each layer of the picture by the method that does it best, with as many passes as it needs: the "
         "default where a scene names no integrator.",
         parameters,
         R"(<integrator type="mote_layers">
    <integrator type="mote_epipolar" name="emission, direct, single_scattering"/>
    <integrator type="volpath" name="indirect, multiple_scattering"/>
</integrator>)"},
        [](const Properties& p) { return std::make_shared<MoteLayers>(p); });
}

}  // namespace mote::integrators
