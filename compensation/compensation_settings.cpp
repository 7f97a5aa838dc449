#include "compensation/compensation_settings.h"

#include "core/objects/properties.h"
#include "core/objects/registry.h"

namespace mote::compensation {

using namespace core;

namespace {

const std::vector<std::string> strategies = {"1-to-n", "n-to-1", "1-to-1", "1-to-1-homogeneous"};

void read_strategy(const Properties& p, CompensationSettings& s, const std::string& default_strategy) {
    const std::string word = p.get_choice("strategy", default_strategy, strategies);
    s.strategy = word == "1-to-n"   ? Strategy::one_to_n
                 : word == "n-to-1" ? Strategy::n_to_one
                                    : Strategy::one_to_one;
    s.placement = word == "1-to-1-homogeneous" ? Placement::in_region : Placement::free_path;
}

void read_receivers(const Properties& p, CompensationSettings& s) {
    const std::string word = p.get_choice("receivers", "all", {"all", "surfaces", "media"});
    s.surfaces = word != "media", s.media = word != "surfaces";
}

CompensationSettings read_exact(const Properties& p) {
    CompensationSettings s;
    s.enabled = true;
    read_strategy(p, s, "1-to-n");
    read_receivers(p, s);
    return s;
}

CompensationSettings read_approximate(const Properties& p) {
    CompensationSettings s;
    s.enabled = true;
    read_strategy(p, s, "1-to-1-homogeneous");
    read_receivers(p, s);
    const auto depth = p.get_int("depth", 1);
    if (depth < -1 || depth > 1000)
        throw InputError("depth must lie between 0 and 1000, or be -1 for no limit", p.where_of("depth"));
    s.depth = int(depth);
    s.local_visibility = p.get_bool("local_visibility", false);
    s.transmittance = p.get_choice("transmittance", "mean", {"mean", "exact"}) == "mean"
                          ? LocalTransmittance::mean
                          : LocalTransmittance::exact;
    return s;
}

std::vector<Parameter> common_parameters(const std::string& strategy) {
    return {
        {"strategy", "string", strategy,
         "1-to-n: a receiver makes one vertex, joined to all VPLs; n-to-1: one vertex for each VPL; 1-to-1: "
         "the same, and VPLs are shared out among the receivers along the eye ray; 1-to-1-homogeneous: the "
         "same with vertices always inside the bounding region"},
        {"receivers", "string", "all", "which light is compensated: all, surfaces or media"}};
}

std::shared_ptr<Object> make(const CompensationSettings& settings) {
    return std::make_shared<Compensation>(settings);
}

}  // namespace

std::string CompensationSettings::strategy_name() const {
    const bool homogeneous = placement == Placement::in_region;
    return strategies[strategy == Strategy::one_to_one && homogeneous ? 3 : std::size_t(strategy)];
}

void register_compensation(Registry& registry) {
    registry.add({Category::compensation,
                  "none",
                  "Nothing: the bound darkens light over short distances.",
                  {},
                  R"(<compensation type="none"/>)"},
                 [](const Properties&) { return make({}); });
    registry.add({Category::compensation, "exact",
                  "Brings back all light that the bound takes (Kollig and Keller 2006; Raab et al. 2008).",
                  common_parameters("1-to-n"), R"(<compensation type="exact"/>)"},
                 [](const Properties& p) { return make(read_exact(p)); });
    auto parameters = common_parameters("1-to-1-homogeneous");
    parameters.push_back({"depth", "integer", "1", "steps of the recursion; -1: no limit"});
    parameters.push_back({"local_visibility", "boolean", "false",
                          "rays from receivers in media look for surfaces and boundaries; from surfaces they "
                          "always do"});
    parameters.push_back({"transmittance", "string", "mean",
                          "inside the bounding region: from the mean extinction there, or exact"});
    registry.add(
        {Category::compensation, "approximate", "Approximate bias compensation (Engelhardt 2013, Sec. 10.2).",
         parameters, R"(<compensation type="approximate"><integer name="depth" value="2"/></compensation>)"},
        [](const Properties& p) { return make(read_approximate(p)); });
}

}  // namespace mote::compensation
