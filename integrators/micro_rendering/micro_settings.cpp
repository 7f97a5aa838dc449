#include "integrators/micro_rendering/micro_settings.h"

#include <algorithm>

#include "core/objects/error.h"
#include "integrators/eye_path/eye_path_parameters.h"

namespace mote::integrators {

using namespace core;
using gathering::StoredLight;

namespace {

StoredLight read_light(const Properties& p) {
    const std::string word = p.get_choice("light", "radiosity", {"direct", "vpls", "radiosity", "photons"});
    return word == "direct"    ? StoredLight::direct
           : word == "vpls"    ? StoredLight::vpls
           : word == "photons" ? StoredLight::photons
                               : StoredLight::radiosity;
}

void read_points(const Properties& p, MicroSettings& s) {
    gathering::LitPointSettings& points = s.points;
    points.points = std::uint32_t(p.get_int_in("points", 65536, 1, gathering::PointHierarchy::largest_count));
    points.light = read_light(p);
    if (s.max_bounces() >= 0) points.bounces = std::min(points.bounces, s.max_bounces());
    const bool photons = points.light == StoredLight::photons;
    points.paths.paths =
        std::uint32_t(p.get_int_in("paths", photons ? 100000 : 256, photons ? 1 : 0, std::int64_t(1) << 26));
    points.paths.rr_depth = s.eye.rr_depth;
    // A virtual point light is one bounce before the place, a photon arrives there.
    if (s.max_bounces() >= 0) points.paths.max_vertices = std::max(0, s.max_bounces() - (photons ? 0 : 1));
}

}  // namespace

MicroSettings read_micro_settings(const Properties& p) {
    MicroSettings s;
    s.eye = read_eye_path_limits(p);
    s.eye.max_scatterings = 1;  // points take over from there
    read_points(p, s);
    s.buffers.side = std::uint32_t(p.get_int_in("micro_buffer", 16, 1, 256));
    s.buffers.cut = float(p.get_float_in("cut", 0.25, 1e-3, 1e6));
    s.buffers.cast_leaves = p.get_bool("ray_casting", true);
    if (p.has("bound")) s.bound = float(p.get_float_in("bound", 0.0, 0.0, 1e30));
    s.upsampling = int(p.get_int_in("upsampling", 1, 1, 16));
    s.glossy_upsampling = p.get_bool("glossy_upsampling", false);
    return s;
}

void MicroSettings::check(bool media) const {
    if (media)
        throw InputError(
            "mote_micro_rendering renders surfaces only, and the scene has media; volpath and mote_vpl "
            "render "
            "them");
    gathering::LitPoints::check_memory(points);
}

std::vector<Parameter> micro_parameters() {
    std::vector<Parameter> parameters = eye_path_parameters();
    const std::vector<Parameter> own = {
        {"points", "integer", "65536",
         "points on all surfaces together, drawn anew in every pass; four times as many halve the bias and "
         "take nearly four times as long to light"},
        {"micro_buffer", "integer", "16",
         "texels along a side of the buffers that receivers gather with; noise falls with their number, time "
         "grows with it"},
        {"cut", "float", "0.25",
         "a node of points is gathered as one where it covers less than this share of a texel; larger is "
         "faster, and brighter at edges"},
        {"ray_casting", "boolean", "true",
         "points that are larger than a texel fill all texels whose rays meet them; false: the one that they "
         "fall on, a little faster, with holes that darken edges"},
        {"light", "string", "radiosity",
         "light of the points, besides that of lights: 'direct': none, 'vpls': virtual point lights, "
         "'radiosity': six reflections between points at most, 'photons': a photon map"},
        {"paths", "integer", "automatic",
         "vpls and photons: light paths of a pass. Automatic: 256 of virtual point lights, 100000 of "
         "photons"},
        {"bound", "float", "automatic",
         "vpls: bound on the geometry term between them and points [1/m^2]; 0: none. Automatic: "
         "paths / (radius of the scene)^2"},
        {"upsampling", "integer", "1",
         "n: receivers at one pixel of n x n, whose light neighbours share that see the same surface; others "
         "are rendered again. Up to n^2 times as fast"},
        {"glossy_upsampling", "boolean", "false",
         "upsampling: glossy surfaces share their light, too, as in the thesis: faster, with more error; "
         "false: they are rendered again"}};
    parameters.insert(parameters.end(), own.begin(), own.end());
    return parameters;
}

}  // namespace mote::integrators
