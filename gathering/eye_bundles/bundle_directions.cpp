#include "gathering/eye_bundles/bundle_directions.h"

#include "core/math/warp.h"

namespace mote::gathering {

using namespace core;

BundleDirection bundle_direction(const Emitter* sky, SamplerKind kind, std::uint64_t seed, std::uint32_t set,
                                 std::uint32_t index) {
    constexpr std::uint32_t stream = 0x6c696e65u;  // keeps lines apart from pixels of the same number
    Sampler sampler(kind, seed, index, set, stream);
    const Vec2 u = sampler.next_2d();
    Vec3 w = square_to_sphere(u);
    if (sky && sampler.next_1d() < 0.5f)
        if (const auto light = sky->sample_direct(Vec3(0.0f), u)) w = light->wi;
    return {w, line_pdf(sky, w)};
}

}  // namespace mote::gathering
