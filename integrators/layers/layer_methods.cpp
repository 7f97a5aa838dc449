#include "integrators/layers/layer_methods.h"

#include <algorithm>

#include "core/scene/scene.h"
#include "integrators/eye_path/plan_coarse_voxels.h"
#include "integrators/path_tracing/equiangular.h"
#include "integrators/register_parts.h"
#include "integrators/single_scattering/single_scattering_estimator.h"

namespace mote::integrators {

using namespace core;

namespace {

/// More lights than this, marched one after the other, take longer than one that is sampled.
constexpr std::size_t max_marched_lights = 16;

/// Everything but what is left to chance without need: the light of a few lights with a position, scattered
/// once in media, is marched.
struct Marching {
    bool pays = false;
    std::string why;  ///< it does not
};

Marching marching_of(const Scene& scene, const Requirements& r, const EyePathLimits& limits) {
    const std::size_t lights = positional_lights(scene).size();
    if (depth_of_marching_step(scene, 1.0f) > thick_step)
        return {false, "voxels are too dense to be marched"};
    if (lights > max_marched_lights) return {false, "too many lights to march each of them"};
    if (lights == 0) return {false, "no light has a position to march to"};
    if (has_lamps_in_media(scene)) return {false, "equi-angular sampling lights every segment of a path"};
    return {r.media_scattering && (limits.max_depth < 0 || limits.max_depth > 1),
            "nothing scatters in media"};
}

LayerMethod marched_lights(const Scene& scene, const Requirements& r, const EyePathLimits& limits,
                           ScatteringLights which) {
    // Lines end at the border of the picture: as many as there are pixels along half of it.
    const int lines = std::clamp(scene.film().width + scene.film().height, 16, 1024);
    // Refinement starts from the evenly spread samples: a gap in the smoke between two of them is not seen.
    const int samples = r.media_heterogeneous > 0 ? 64 : 16;
    return {make_epipolar(limits, which, lines, samples), scattering_cell(which),
            "lights with a position, marched along epipolar lines: nothing is left to chance"};
}

constexpr TransportSet near = Transport::emission | Transport::direct,
                       twice = Transport::indirect | Transport::multiple_scattering,
                       single = Transport::single_scattering;

/// A path has the light of its first vertices for nothing: methods of their own for it cost more than they
/// save, in time and in noise, with the denoiser as well as without (docs/methods/layers.md).
std::vector<LayerMethod> choose_paths(const Scene& scene, const Requirements& r,
                                      const EyePathLimits& limits) {
    const std::string reason =
        "one path has the light of all its vertices, and errs independently of those of other pixels";
    if (!r.any_media()) return {{make_path(limits), near | Transport::indirect, reason}};
    const auto paths = make_volpath(limits);
    const Marching marching = marching_of(scene, r, limits);
    if (!marching.pays) return {{paths, near | single | twice, reason + "; " + marching.why}};
    if (!has_other_lights(scene))
        return {{paths, near | twice, reason}, marched_lights(scene, r, limits, ScatteringLights::all)};
    return {{paths, near | twice, reason},
            {make_single_scattering(limits), TransportSet::other_scattering(),
             "one distance a ray for lights without a position"},
            marched_lights(scene, r, limits, ScatteringLights::positional)};
}

std::vector<LayerMethod> choose_lights(const Scene& scene, const Requirements& r,
                                       const EyePathLimits& limits) {
    const std::string reason =
        "virtual point lights, sampled for pixels that lie apart: less noise than paths, and what "
        "the bound takes is missing";
    const LayerMethod far{make_sampled_vpls(limits),
                          r.any_media() ? twice : TransportSet(Transport::indirect), reason};
    if (!r.any_media()) return {{make_path(limits), near, "one scattering: light and BSDF sampling"}, far};
    const Marching marching = marching_of(scene, r, limits);
    if (!marching.pays) {
        const auto paths = make_volpath(limits);
        return {{paths, near | single, "paths; " + marching.why}, far};
    }
    return {{make_single_scattering(limits), near | TransportSet::other_scattering(),
             "surfaces behind media whose transmittance is marched; one distance a ray for lights without a "
             "position"},
            marched_lights(scene, r, limits, ScatteringLights::positional),
            far};
}

}  // namespace

std::vector<LayerMethod> choose_layer_methods(const Scene& scene, const Requirements& requirements,
                                              const EyePathLimits& limits, FarLight far_light) {
    return far_light == FarLight::paths ? choose_paths(scene, requirements, limits)
                                        : choose_lights(scene, requirements, limits);
}

LayerChoice fill_layers(const Scene& scene, std::vector<LayerMethod> methods) {
    LayerChoice choice;
    for (LayerMethod& method : methods) {
        method.layers = method.integrator->layers(scene);
        TransportSet filled;
        for (std::size_t i = 0; i < method.layers.size(); ++i) {
            const Layer& layer = method.layers[i];
            if (layer.auxiliary || layer.transport.empty()) continue;
            if (!method.cells.empty() && !method.cells.contains(layer.transport)) continue;
            filled = filled | layer.transport;
            method.kept.push_back(i);
            choice.layers.push_back(layer);
            choice.layers.back().part = choice.methods.size();
        }
        const std::string type = method.integrator->type();
        if (const TransportSet impossible = method.cells - filled; !impossible.empty())
            throw InputError(type + " cannot fill '" + transport_name(impossible) + "' here", method.where);
        method.cells = filled;
        for (const LayerMethod& other : choice.methods)
            if (const TransportSet both = other.cells & filled; !both.empty())
                throw InputError("two methods fill '" + transport_name(both) +
                                     "': " + other.integrator->type() + " and " + type +
                                     "; name the cells of each, such as name=\"direct, indirect\"",
                                 method.where);
        choice.methods.push_back(std::move(method));
    }
    return choice;
}

void keep_fine_light(LayerChoice& choice) {
    constexpr TransportSet of_surfaces = Transport::direct | Transport::indirect;
    for (Layer& layer : choice.layers)
        layer.fine = !layer.transport.empty() && of_surfaces.contains(layer.transport) &&
                     choice.methods[layer.part].integrator->renders_columns();
}

TransportSet LayerChoice::unfilled(bool media) const {
    TransportSet cells = TransportSet::all(media);
    for (const LayerMethod& method : methods) cells = cells - method.cells;
    return cells;
}

}  // namespace mote::integrators
