// Features at the first hit of the scene behind near mirrors and glass: a reflected lamp has no edge in the
// positions and normals of the mirror itself, and denoisers would smear it.
//
// Lobes narrower than `narrow_lobe` are followed, up to `mirror_bounces` times, to the first surface that
// scatters widely. A feature is the mean over `mirror_samples` directions of the first lobe, stratified: a
// rough mirror blurs the feature as much as the picture, and it has little noise after one pass already. It
// costs as many rays in these pixels, and none in others.
#pragma once

#include <vector>

#include "core/render/first_hit_features.h"

namespace mote::core {

inline constexpr float narrow_lobe =
    0.04f;  ///< [sr], one over the density of directions: a roughness of 0.1, about
inline constexpr int mirror_bounces = 4, mirror_samples = 64;

/// Mirrored.Emission: radiance of lamps and of the sky that narrow lobes see [scene's units],
/// Mirrored.Albedo: of the surface behind, both as the mirrors on the way colour them, but for the first;
/// Mirrored.P [m] and Mirrored.Ns: its position and shading normal, in the world. Zero where the first hit
/// has no narrow lobe, and for lobes that meet nothing. None at all where no surface of the scene has a
/// narrow lobe seen from in front.
std::vector<HitFeature> mirrored_features(const Scene& scene);

}  // namespace mote::core
