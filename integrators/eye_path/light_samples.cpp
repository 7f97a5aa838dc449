#include "integrators/eye_path/light_samples.h"

#include "core/scene/scene.h"

namespace mote::integrators {

using namespace core;

namespace {

/// x + shift without its whole part, below 1 after rounding as well.
float moved(float x, float shift) {
    const float sum = x + shift, rest = sum - std::floor(sum);
    return rest < 1.0f ? rest : 0.0f;
}

}  // namespace

LightSamples light_samples_for(const Scene& scene) {
    const auto lights = scene.emitters();
    const bool same = lights.empty() || (lights.size() == 1 && !lights.front()->traits().can_be_hit());
    if (same) return {};
    const bool looked_up =
        std::ranges::any_of(scene.media(), [](const auto& medium) { return !medium->traits().homogeneous; });
    return {2, looked_up ? 1 : 2};
}

LightNumbers numbers_of_light(const LightNumbers& first, int k, int n) {
    if (k == 0) return first;
    constexpr float plastic = 1.32471796f;  // x^3 = x + 1
    const float step = float(k);
    return {moved(first.choice, step / float(n)),
            {moved(first.point.x, step / plastic), moved(first.point.y, step / (plastic * plastic))}};
}

}  // namespace mote::integrators
