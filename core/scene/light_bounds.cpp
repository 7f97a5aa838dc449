#include "core/scene/light_bounds.h"

namespace mote::core {
namespace {

/// Normals that differ by less are taken for one [radians].
constexpr float parallel = 1e-4f;

/// LightBounds::back of a part, seen from the centre of the whole.
float back_of(const LightBounds& part, const LightBounds& whole) {
    return glm::dot(whole.normals.axis, whole.box.center() - part.box.center()) + part.back;
}

}  // namespace

LightBounds united(const LightBounds& a, const LightBounds& b) {
    if (a.box.empty()) return b;
    if (b.box.empty()) return a;
    LightBounds both{.box = a.box,
                     .normals = united(a.normals, b.normals),
                     .reach = std::max(a.reach, b.reach),
                     .intensity = a.intensity + b.intensity};
    both.box.extend(b.box);
    if (both.normals.angle <= parallel)
        both.back = std::max(back_of(a, both), back_of(b, both)) + 2.0f * parallel * both.box.radius();
    return both;
}

}  // namespace mote::core
