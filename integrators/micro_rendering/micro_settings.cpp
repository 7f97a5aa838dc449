#include "integrators/micro_rendering/micro_settings.h"

#include <algorithm>

#include "core/objects/error.h"
#include "integrators/eye_path/light_path_limits.h"

namespace mote::integrators {

using namespace core;
using gathering::StoredLight;

namespace {

MicroSettings defaults() {
    MicroSettings s;
    s.eye.max_scatterings = 1;  // points take over from there
    s.points.light = StoredLight::radiosity;
    s.buffers.cut = 0.25f;
    return s;
}

}  // namespace

void MicroSettings::limit_bounces() {
    const bool photons = points.light == StoredLight::photons;
    // A virtual point light is one bounce before the place, a photon arrives there.
    points.paths = light_path_settings(paths.value_or(photons ? 100000 : 256), eye, {}, photons ? 2 : 3);
    if (max_bounces() >= 0) points.bounces = std::min(points.bounces, max_bounces());
}

void MicroSettings::check(bool media) const {
    if (media)
        throw InputError(
            "mote_micro_rendering renders surfaces only, and the scene has media; volpath and mote_vpl "
            "render them");
    gathering::LitPoints::check_memory(points);
}

const ParameterList<MicroSettings>& micro_parameters() {
    using S = MicroSettings;
    using Points = gathering::LitPointSettings;
    using Buffers = gathering::MicroBufferSettings;
    static const ParameterList<S> list(
        defaults(),
        {within(&S::eye, eye_path_rows()),
         within(
             &S::points,
             row("points", &Points::points, between(1, gathering::PointHierarchy::largest_count),
                 "Points on all surfaces together, new ones in every pass. Four times as many halve the "
                 "bias and take nearly four times as long to light."),
             row("light", &Points::light,
                 {{"radiosity", StoredLight::radiosity},
                  {"direct", StoredLight::direct},
                  {"vpls", StoredLight::vpls},
                  {"photons", StoredLight::photons}},
                 "Light of the points: direct light alone, or besides it six reflections between points at "
                 "most (radiosity), virtual point lights, or a photon map.")),
         within(&S::buffers,
                row("micro_buffer", &Buffers::side, between(1, 256),
                    "Texels along a side of the buffers that receivers gather with: noise falls with their "
                    "number, time grows with it."),
                row("cut", &Buffers::cut, between(1e-3, 1e6),
                    "A node of points is gathered as one where it covers less than this fraction of a texel: "
                    "larger is faster, and brighter at edges."),
                row("ray_casting", &Buffers::cast_leaves,
                    "Points that are larger than a texel fill all texels whose rays meet them; if false, the "
                    "one that they fall on: a little faster, with holes that darken edges.")),
         row("paths", &S::paths, between(1, 1 << 26), "Light paths a pass of vpls and photons.")
             .when_absent("256 of vpls, 100000 of photons"),
         row("bound", &S::bound, between(0, 1e30, "1/m^2"),
             "Bound on the geometry term between vpls and points: darker where they are close; 0: none, with "
             "splotches.")
             .when_absent("paths / (radius of the scene)^2"),
         row("upsampling", &S::upsampling, between(1, 16),
             "n: receivers at one pixel of n x n, whose light is shared by neighbours on the same surface; "
             "others are rendered again. Up to n^2 times as fast."),
         row("glossy_upsampling", &S::glossy_upsampling,
             "Glossy surfaces share their light, too, as in the thesis: faster, with more error.")});
    return list;
}

}  // namespace mote::integrators
