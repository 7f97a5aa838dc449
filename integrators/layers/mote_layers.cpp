// `mote_layers`: each cell of the transport by the method that does it best.
//
// A picture is the sum of its layers, so each may come from a method of its own, with as many passes as it
// needs. Nested integrators fill the cells that their names list; without any the scene's requirements
// choose.
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <charconv>
#include <cstdlib>
#include <mutex>
#include <tuple>

#include "core/objects/number_text.h"
#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/layers/layers_estimator.h"
#include "integrators/register_parts.h"

namespace mote::integrators {

using namespace core;

namespace {

screenspace::LayerKind kind_of(const Layer& layer) {
    constexpr TransportSet of_surfaces = Transport::emission | Transport::direct | Transport::indirect;
    return (layer.transport & of_surfaces).empty() ? screenspace::LayerKind::volume
                                                   : screenspace::LayerKind::surface;
}

/// Larger pictures are denoised as they are: twice the resolution takes 440 bytes a pixel.
constexpr std::int64_t max_fine_pixels = 1 << 21;

/// True for the layers that our own filter smooths. Indirect light is smooth but where surfaces and media are
/// not, which features show; so is light of large lights scattered in media, and shafts of others show as
/// soon as noise is below them.
bool is_smooth(const Layer& layer) {
    return layer.transport == Transport::indirect || layer.transport == Transport::multiple_scattering ||
           layer.transport == Transport::single_scattering ||
           layer.transport == TransportSet::other_scattering();
}

enum class FilterChoice : std::uint8_t { automatic, oidn, own, none };

/// OpenImageDenoise for the integrators of a registry. It is looked for on first use, which may start a
/// Python, and again where another one is meant.
class FilterLibrary {
  public:
    /// Nothing where the filter is another. Throws InputError where the library was requested by name and is
    /// not installed.
    std::shared_ptr<const screenspace::OidnLibrary> get(FilterChoice choice) {
        if (choice == FilterChoice::own || choice == FilterChoice::none) return nullptr;
        const std::lock_guard lock(mutex_);
        Wanted wanted{variable("MOTE_OIDN"), variable("MOTE_PYTHON"),
                      tbb::this_task_arena::max_concurrency()};
        if (wanted != found_for_) look(std::move(wanted));
        if (!library_ && choice == FilterChoice::oidn) throw InputError(problem_);
        return library_;
    }

  private:
    using Wanted = std::tuple<std::string, std::string, int>;  ///< library, Python, threads
    static std::string variable(const char* name) {
        const char* const value = std::getenv(name);
        return value ? value : "";
    }
    void look(Wanted wanted) {
        library_.reset();
        try {
            library_ = std::make_shared<const screenspace::OidnLibrary>(std::get<int>(wanted));
        } catch (const InputError& error) {
            problem_ = error.what();
        }
        found_for_ = std::move(wanted);
    }
    std::mutex mutex_;
    Wanted found_for_{"", "", 0};  ///< no number of threads is 0
    std::shared_ptr<const screenspace::OidnLibrary> library_;
    std::string problem_;
};

/// The parameters of a scene file.
struct LayersSettings {
    EyePathLimits limits;
    LayerFilterParameters filter;
    FilterChoice filters = FilterChoice::automatic;
    FarLight far_light = FarLight::paths;
    std::string shares;
    std::vector<Nested<const Integrator>> integrators;
};

class MoteLayers final : public Integrator {
  public:
    MoteLayers(const LayersSettings& s, const Properties& properties, std::shared_ptr<FilterLibrary> library)
        : limits_(s.limits),
          filter_(s.filter),
          filters_(s.filters),
          library_(std::move(library)),
          far_light_(s.far_light) {
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
        for (const std::size_t i : filtered_layers(choice))
            filtered.push_back({i, kind_of(choice.layers[i])});
        if (!shares_.empty() && shares_.size() != choice.methods.size())
            throw InputError(
                fmt::format("mote_layers: shares has {} numbers, and there are {} methods (see 'mote plan')",
                            shares_.size(), choice.methods.size()));
        return make_layers_estimator(scene, options, choice, make_filter(scene, options, std::move(filtered)),
                                     shares_);
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
        // With and without the library the film is the same, so that machines can share a render.
        for (Layer& layer : choice.layers)
            layer.squares =
                !layer.auxiliary &&
                (filters_ == FilterChoice::own ? is_smooth(layer) : filters_ != FilterChoice::none);
        const bool by_library = filters_ == FilterChoice::automatic || filters_ == FilterChoice::oidn;
        const FilmSettings& film = scene.film();
        if (by_library && std::int64_t(film.width) * film.height <= max_fine_pixels) keep_fine_light(choice);
        return choice;
    }
    /// The library takes all layers, our own filter the smooth ones.
    std::vector<std::size_t> filtered_layers(const LayerChoice& choice) const {
        std::vector<std::size_t> filtered;
        for (std::size_t i = 0; i < choice.layers.size(); ++i)
            if (choice.layers[i].squares && (is_smooth(choice.layers[i]) || library_->get(filters_)))
                filtered.push_back(i);
        return filtered;
    }
    LayerFilter make_filter(const Scene& scene, const RenderOptions& options,
                            std::vector<LayerFilter::Choice> layers) const {
        if (const auto& library = library_->get(filters_))
            return {scene, options, filter_.features, library, std::move(layers)};
        return {scene, options, filter_, std::move(layers)};
    }
    void plan_filter(const LayerChoice& choice, Plan& plan) const;
    EyePathLimits limits_;
    LayerFilterParameters filter_;
    FilterChoice filters_;
    std::shared_ptr<FilterLibrary> library_;
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

void MoteLayers::plan_filter(const LayerChoice& choice, Plan& plan) const {
    std::string names;
    for (const std::size_t i : filtered_layers(choice))
        names += (names.empty() ? "" : ", ") + choice.layers[i].name;
    if (names.empty()) return;
    if (const auto& library = library_->get(filters_)) {
        plan.run("filter", "OpenImageDenoise " + library->version() + " on " + names,
                 "biased by what it smoothes, less with every pass; filter=none leaves the noise. The noise "
                 "that is stated, and --noise, are those of the passes, before the denoiser; with "
                 "film.interval what it leaves, without that bias, which the stated error contains");
        return;
    }
    plan.run("filter", "our own on " + names,
             std::string(filters_ == FilterChoice::automatic ? "OpenImageDenoise is not installed; " : "") +
                 "biased by what it smoothes, less with every pass; filter=none leaves the noise. The noise "
                 "that is stated, and --noise, are what the filter leaves, without that bias");
}

Plan MoteLayers::plan(const Scene& scene, const Requirements& requirements) const {
    Plan plan;
    plan.integrator = type();
    plan.error_unknown.clear();
    const LayerChoice choice = choose(scene);
    for (const LayerMethod& method : choice.methods)
        plan.run(transport_name(method.cells), method.integrator->type(), method.reason);
    plan.run("passes", fmt::format("shared out among {} methods", choice.methods.size()),
             shares_.empty() ? "to the one whose next pass takes the most error for its rays and lookups"
                             : "shares says how many each has in a round");
    plan_filter(choice, plan);
    for (const std::string& cell : transport_names(choice.unfilled(requirements.any_media())))
        plan.miss(cell, "no method fills it", "none of the nested integrators has it in its name");
    for (const LayerMethod& method : choice.methods) {
        Requirements wanted = requirements;
        wanted.cells = method.cells;
        const Plan own = method.integrator->plan(scene, wanted);
        add_entries(plan.runs, own.runs, method.integrator->type());
        add_entries(plan.missing, own.missing, method.integrator->type());
        if (plan.noise_unknown.empty()) plan.noise_unknown = own.noise_unknown;
        if (plan.error_unknown.empty() && !own.error_unknown.empty())
            plan.error_unknown = method.integrator->type() + ": " + own.error_unknown;
        if (plan.error_unknown.empty() && own.error_by_groups)
            plan.error_unknown = method.integrator->type() + ": pixels of a pass share its noise";
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
             {{"automatic", FilterChoice::automatic},
              {"oidn", FilterChoice::oidn},
              {"own", FilterChoice::own},
              {"none", FilterChoice::none}},
             "What denoises the layers: OpenImageDenoise, all of them, guided by noise-free features; our "
             "own "
             "filter, indirect light and scattering in media; automatic: the former where it is installed."),
         within(&S::filter, layer_filter_rows()),
         row("far_light", &S::far_light, {{"paths", FarLight::paths}, {"lights", FarLight::lights}},
             "Indirect light and multiple scattering where the scene chooses: by paths, unbiased, or by "
             "virtual point lights, resampled, with less noise and without what their bound takes."),
         row("shares", &S::shares,
             "Passes of each method in a round, such as '3, 1' (docs/howto/cluster.md): passes are known "
             "beforehand, which several machines need.")
             .when_absent("as many as reduce the error fastest"),
         nested("integrator", &S::integrators, Category::integrator, "chosen by the scene",
                "Any number: each fills the cells that its name lists, of emission, direct, indirect, "
                "single_scattering and multiple_scattering; without a name all that it can.")},
        R"(<integrator type="mote_layers">
    <integrator type="mote_epipolar" name="emission, direct, single_scattering"/>
    <integrator type="volpath" name="indirect, multiple_scattering"/>
</integrator>)",
        [library = std::make_shared<FilterLibrary>()](const S& s, const Properties& p) {
            return std::make_shared<MoteLayers>(s, p, library);
        });
}

}  // namespace mote::integrators
