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
    points.candidates = std::uint32_t(p.get_int_in("candidates", 8, 0, 1024));
    points.light = read_light(p);
    points.light_samples = int(p.get_int_in("light_samples", 4, 1, 4096));
    points.bounces = int(p.get_int_in("bounces", 6, 1, 1000));
    if (s.most_bounces() >= 0) points.bounces = std::min(points.bounces, s.most_bounces());
    points.level = std::uint32_t(p.get_int_in("radiosity_level", 6, 0, 24));
    const bool photons = points.light == StoredLight::photons;
    points.paths.paths =
        std::uint32_t(photons ? p.get_int_in("photon_paths", 100000, 1, std::int64_t(1) << 26)
                              : p.get_int_in("paths", 256, 0, std::int64_t(1) << 26));
    points.paths.rr_depth = s.eye.rr_depth;
    // A virtual point light is one bounce before the place, a photon arrives there.
    if (s.most_bounces() >= 0) points.paths.max_vertices = std::max(0, s.most_bounces() - (photons ? 0 : 1));
    points.neighbours = std::size_t(p.get_int_in("neighbours", 50, 2, 1 << 16));
}

}  // namespace

MicroSettings read_micro_settings(const Properties& p) {
    MicroSettings s;
    s.eye = read_eye_path_limits(p);
    s.eye.max_scatterings = 1;  // from then on points take over
    read_points(p, s);
    s.buffers.side = std::uint32_t(p.get_int_in("micro_buffer", 16, 1, 256));
    s.buffers.cut = float(p.get_float_in("cut", 0.25, 1e-3, 1e6));
    s.buffers.cast_leaves = p.get_bool("ray_casting", true);
    s.points.volume.points =
        std::uint32_t(p.get_int_in("volume_points", 16384, 0, gathering::PointHierarchy::largest_count));
    s.points.volume.cut = float(p.get_float_in("volume_cut", 4.0, 1e-3, 1e6));
    s.points.volume.level = std::uint32_t(p.get_int_in("volume_level", 4, 0, 24));
    s.warped = p.get_bool("brdf_warp", true);
    if (p.has("bound")) s.bound = float(p.get_float_in("bound", 0.0, 0.0, 1e30));
    s.upsampling = int(p.get_int_in("upsampling", 1, 1, 16));
    s.glossy_upsampling = p.get_bool("glossy_upsampling", false);
    return s;
}

void MicroSettings::check(bool media) const {
    if (media && upsampling > 1)
        throw InputError("'upsampling' of mote_micro_rendering is for scenes without media");
    if (media && (points.light == StoredLight::vpls || points.light == StoredLight::photons))
        throw InputError(
            "'light' of mote_micro_rendering is 'direct' or 'radiosity' in a scene with media: points in "
            "media "
            "store no light of virtual point lights or photons");
    gathering::LitPoints::check_memory(points, media);
}

std::vector<Parameter> micro_parameters() {
    std::vector<Parameter> parameters = eye_path_parameters();
    const std::vector<Parameter> own = {
        {"points", "integer", "65536", "points on all surfaces together, drawn anew in every pass"},
        {"candidates", "integer", "8",
         "for each point: more make points more even; 0: stratified by area alone, which is quick"},
        {"micro_buffer", "integer", "16", "texels along a side of the buffers that receivers gather with"},
        {"cut", "float", "0.25",
         "a group of points is taken as one where it covers less than this share of a texel"},
        {"ray_casting", "boolean", "true",
         "points that are larger than a texel fill all texels whose rays meet them; false: the one that they "
         "fall on, which leaves holes"},
        {"brdf_warp", "boolean", "true",
         "texels of glossy receivers are small where they reflect much; false: the same for all receivers"},
        {"light", "string", "radiosity",
         "light of the points, besides that of lights: 'direct': none, 'vpls': virtual point lights, "
         "'radiosity': other points, 'photons': a photon map"},
        {"light_samples", "integer", "4", "lights, and directions, drawn for every point"},
        {"bounces", "integer", "6", "radiosity: reflections between surfaces that are followed"},
        {"radiosity_level", "integer", "6",
         "radiosity: one point of 2^level gathers for all of them that face its way"},
        {"volume_points", "integer", "16384", "points in all media together, drawn anew in every pass"},
        {"volume_cut", "float", "4",
         "a group of points in media is taken as one where it covers less than so many texels"},
        {"volume_level", "integer", "4", "radiosity: one point of 2^level in media gathers for all of them"},
        {"paths", "integer", "256", "vpls: light paths of a pass"},
        {"bound", "float", "automatic",
         "vpls: bound on the geometry term between them and points [1/m^2]; 0: none. Automatic: "
         "paths / (radius of the scene)^2"},
        {"photon_paths", "integer", "100000", "photons: light paths of a pass"},
        {"neighbours", "integer", "50", "photons: how many an estimate holds"},
        {"upsampling", "integer", "1",
         "n: receivers at one pixel of n x n, whose light neighbours share that see the same surface; others "
         "are rendered again"},
        {"glossy_upsampling", "boolean", "false",
         "upsampling: glossy surfaces share their light, too, as in the thesis; false: they are rendered "
         "again"}};
    parameters.insert(parameters.end(), own.begin(), own.end());
    return parameters;
}

}  // namespace mote::integrators
