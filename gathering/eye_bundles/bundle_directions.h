// The directions of a pass: lines that serve both ways (Tokuyoshi & Ogaki 2012, Sec. 3.3).
//
// Uniform lines have p_r = 1 / (2 pi). With a light at infinity they can be sampled half by its light:
//   p_r(w) = q(w) + q(-w),   q = 1 / (8 pi) + p_sky / 2,
// which is Eq. 2 with an offset L_o that makes both parts equal (as printed its integral over all directions
// is 2, as it must be where a line counts twice).
#pragma once

#include "core/math/sampler.h"
#include "core/scene/emitter.h"
#include "gathering/ray_bundles/ray_bundle.h"

namespace mote::gathering {

struct BundleDirection {
    core::Vec3 direction;             ///< unit; the line runs along it and against it
    float pdf_line;                   ///< p_r [1/sr], the same for both ways
    const RayBundle* kept = nullptr;  ///< where its links are looked up; null: they are traced
};

/// p_r of a direction; `sky` is the light that half of the lines are sampled by, or null.
inline float line_pdf(const core::Emitter* sky, const core::Vec3& w) {
    if (!sky) return core::inv_two_pi;
    const core::Vec3 anywhere(0.0f);
    return 0.5f * (core::inv_two_pi + sky->pdf_direct(anywhere, w, nullptr) +
                   sky->pdf_direct(anywhere, -w, nullptr));
}

/// Line `index` of a set whose consecutive numbers are low-discrepancy points: the passes of a render share
/// one set. `set` distinguishes the sets of interleaved pixels.
BundleDirection bundle_direction(const core::Emitter* sky, core::SamplerKind kind, std::uint64_t seed,
                                 std::uint32_t set, std::uint32_t index);

}  // namespace mote::gathering
