// A volumetric shadow map of a density that is a function of one's own: a puff of smoke around a lamp. The
// map says how much of the lamp's light arrives at any point; the integral along the segment says so too.
#include <mote/core/scene/callback_scene.h>
#include <mote/lights/shadow_maps/shadow_map_view.h>
#include <mote/lights/shadow_maps/volumetric_shadow_map.h>
#include <mote/media/sampled_medium.h>

#include <cmath>
#include <cstdio>

using namespace mote;
using core::Vec3;

int main() {
    const auto extinction = [](const Vec3& p) { return 3.0f * std::exp(-4.0f * glm::dot(p, p)); };  // [1/m]
    const core::Bounds3 box{Vec3(-1.5f), Vec3(1.5f)};
    const core::CallbackScene scene({.medium = media::sampled_medium(extinction, box, 64), .bounds = box});

    const Vec3 lamp{-0.7f, 0.1f, 0.2f};
    lights::VolumetricShadowMap map;
    map.build(scene, lights::ShadowMapView::of_point(lamp, 128), scene.medium_state(), {});

    core::Rng rng(1);
    float worst = 0.0f;
    for (int i = 0; i < 1000; ++i) {
        const Vec3 p = 2.0f * Vec3(rng.next_float(), rng.next_float(), rng.next_float()) - 1.0f;
        float depth = 0.0f;
        const int steps = 200;
        for (int k = 0; k < steps; ++k)
            depth += extinction(lamp + (float(k) + 0.5f) / float(steps) * (p - lamp)) *
                     glm::distance(p, lamp) / float(steps);
        worst = std::fmax(worst, std::fabs(map.transmittance(p).x - std::exp(-depth)));
    }
    std::printf("a map of %zu kB; the largest error of the transmittance at 1000 points is %.4f\n",
                map.memory_bytes() / 1024, double(worst));
    return worst < 0.02f ? 0 : 1;
}
