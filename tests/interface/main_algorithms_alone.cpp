// Gathering, shadow maps and compensation for a renderer that brings a scene of its own (see CMakeLists.txt
// for what it is linked with). Ends with 1 when the light is not that of the closed form.
#include <cstdio>

#include "compensation/vpl_compensation.h"
#include "tests/support/analytic_scene.h"

using namespace mote;
using tests::AnalyticScene, tests::FloorUnderLight;

namespace {

/// The light that a bound leaves out of a wall-less floor: nothing is near enough to scatter it back.
bool compensation_is_dark(const AnalyticScene& scene, FloorUnderLight& at) {
    const compensation::ResidualTransport transport(scene, 100.0f, {});
    core::WalkContext walk;
    compensation::CompensatedTile receivers;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        receivers[i].path = transport.start(at.vertices[i], {}, core::Rgb(1.0f), receivers[i].rng);
        receivers[i].max_vpl_depth = 3;
    }
    const auto scratch = std::make_unique<compensation::VplCompensationScratch>();
    const auto gather_scratch = std::make_unique<lights::GatherScratch>();
    const lights::TileLight light = compensation::compensation_from_vpls<true>(
        {transport, compensation::Strategy::one_to_n, 2, at.vpls, {}}, receivers, *scratch,
        {scene, *gather_scratch, walk.rays, walk.tracking}, walk);
    for (const core::Rgb& l : light)
        if (!core::is_black(l)) return false;
    return walk.rays.closest > 0;
}

}  // namespace

int main() {
    const AnalyticScene scene(core::Rgb(0.3f, 0.6f, 1.2f));
    FloorUnderLight at(scene);
    const float by_rays = FloorUnderLight::largest_error(scene, tests::traced_light(scene, at));
    const float by_maps = FloorUnderLight::largest_error(scene, tests::mapped_light(scene, at, 256));
    const bool dark = compensation_is_dark(scene, at);
    std::printf("largest error by rays %.2g, by maps %.2g; compensation is dark: %s\n", double(by_rays),
                double(by_maps), dark ? "yes" : "no");
    return by_rays < 1e-5f && by_maps < 1e-3f && dark ? 0 : 1;
}
