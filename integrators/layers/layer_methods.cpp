#include "integrators/layers/layer_methods.h"

#include <algorithm>

#include "core/scene/scene.h"
#include "integrators/eye_path/plan_coarse_voxels.h"
#include "integrators/register_parts.h"
#include "integrators/single_scattering/single_scattering_estimator.h"

namespace mote::integrators {

using namespace core;

namespace {

/// More lights than this, marched one after the other, take longer than one that is sampled.
constexpr std::size_t max_marched_lights = 16;

/// Light at collisions close to a lamp has no finite variance: the density of collisions does not follow
/// 1/d^2.
bool lamps_in_media(const Scene& scene) {
    const auto lights = positional_lights(scene);
    return std::any_of(lights.begin(), lights.end(), [&](const Emitter* light) {
        const Medium* medium = scene.emitter_medium_state(*light, {}).current();
        return medium && medium->traits().scattering;
    });
}

}  // namespace

std::vector<LayerMethod> choose_layer_methods(const Scene& scene, const Requirements& r,
                                              const EyePathLimits& limits, FarLight far_light) {
    const bool by_lights = far_light == FarLight::lights;
    const std::string reason =
        by_lights
            ? "virtual point lights, sampled for pixels that lie apart: less noise than paths, and what "
              "the bound takes is missing"
            : "paths of pixels err independently of each other, which the filter takes";
    const bool equiangular = r.media_scattering && lamps_in_media(scene);
    const auto far = [&] {
        if (by_lights) return make_sampled_vpls(limits);
        return r.any_media() ? make_volpath(limits, equiangular) : make_path(limits);
    };
    constexpr TransportSet near = Transport::emission | Transport::direct,
                           twice = Transport::indirect | Transport::multiple_scattering,
                           single = Transport::single_scattering;
    if (!r.any_media())
        return {{make_path(limits), near, "one scattering: light and BSDF sampling"},
                {far(), Transport::indirect, reason}};
    if (depth_of_marching_step(scene, 1.0f) > thick_step) {
        const std::string why = "; voxels are too dense to be marched";
        if (!by_lights) return {{far(), near | single | twice, reason + why}};
        return {{make_volpath(limits, equiangular), near | single, "paths" + why}, {far(), twice, reason}};
    }
    const std::size_t lights = positional_lights(scene).size();
    const bool marched = r.media_scattering && lights > 0 && lights <= max_marched_lights &&
                         (limits.max_depth < 0 || limits.max_depth > 1);
    const std::string surfaces = "surfaces behind media whose transmittance is marched";
    if (!marched) {
        const std::string why =
            lights > 0 ? "; too many lights to march each of them" : "; no light has a position to march to";
        const LayerMethod seen{make_single_scattering(limits), near, surfaces};
        if (!by_lights) return {seen, {far(), twice | single, reason + why}};
        const LayerMethod others{far(), twice, reason};
        if (lights > 0) return {seen, {make_volpath(limits, equiangular), single, "paths" + why}, others};
        return {{make_all_single_scattering(limits), near | single, surfaces}, others};
    }
    // Lines end at the border of the picture: as many as there are pixels along half of it.
    const int lines = std::clamp(scene.film().width + scene.film().height, 16, 1024);
    // Refinement starts from the evenly spread samples: a gap in the smoke between two of them is not seen.
    const int samples = r.media_heterogeneous > 0 ? 64 : 16;
    return {{make_single_scattering(limits), near | TransportSet::other_scattering(),
             surfaces + "; one distance a ray for lights without a position"},
            {make_epipolar(limits, lines, samples), TransportSet::positional_scattering(),
             "lights with a position, marched along epipolar lines: nothing is left to chance"},
            {far(), twice, reason}};
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
            if (const TransportSet twice = other.cells & filled; !twice.empty())
                throw InputError("two methods fill '" + transport_name(twice) +
                                     "': " + other.integrator->type() + " and " + type +
                                     "; name the cells of each, such as name=\"direct, indirect\"",
                                 method.where);
        choice.methods.push_back(std::move(method));
    }
    return choice;
}

TransportSet LayerChoice::unfilled(bool media) const {
    TransportSet cells = TransportSet::all(media);
    for (const LayerMethod& method : methods) cells = cells - method.cells;
    return cells;
}

}  // namespace mote::integrators
