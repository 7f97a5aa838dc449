#include "compensation/residual.h"

#include "compensation/plan_compensation.h"

namespace mote::compensation {

using namespace core;

void Residual::plan(Plan& plan, const Scene& scene, const Requirements&, float bound) const {
    if (!std::isfinite(bound)) return;
    plan.miss("short distances", "light between points closer than the bound's radius is darkened",
              "the bound removes it; <compensation> brings it back");
    plan_expected_loss(plan, scene, 0, bound);
}

std::vector<Layer> Residual::compensation_layers(bool media) {
    std::vector<Layer> layers{
        {"compensation_surface", "what the bound took from light first scattered by a surface"}};
    layers.back().transport = Transport::indirect;
    if (!media) return layers;
    layers.push_back({"compensation_volume", "what the bound took from light first scattered in a medium"});
    layers.back().transport = Transport::multiple_scattering;
    return layers;
}

}  // namespace mote::compensation
