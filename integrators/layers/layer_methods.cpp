#include "integrators/layers/layer_methods.h"

#include <algorithm>
#include <array>
#include <map>

#include "core/scene/scene.h"
#include "integrators/register_parts.h"
#include "integrators/single_scattering/single_scattering_estimator.h"

namespace mote::integrators {

using namespace core;

namespace {

/// The halves of single scattering, each of which a method may fill.
const std::array<std::string, 2> halves{positional_scattering, other_scattering};

template <typename Names>
bool contains(const Names& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string> cells_that_it_can(const Scene& scene, const Integrator& integrator) {
    std::vector<std::string> cells;
    for (const Layer& layer : integrator.layers(scene))
        if (!layer.auxiliary && !contains(cells, layer.transport())) cells.push_back(layer.transport());
    return cells;
}

void check_name(const LayerMethod& method, const std::string& cell,
                const std::vector<std::string>& possible) {
    std::vector<std::string> all = transport_cells(true);
    all.insert(all.end(), halves.begin(), halves.end());
    if (!contains(all, cell))
        throw InputError("'" + printable(cell) + "' is no cell of the transport" + suggestion(cell, all),
                         method.where);
    if (!contains(possible, cell))
        throw InputError(method.integrator->type() + " cannot fill '" + cell + "' here", method.where);
}

/// More lights than this, marched one after the other, take longer than one that is drawn.
constexpr std::size_t most_marched_lights = 16;

/// Light at collisions close to a lamp has no finite variance: the density of collisions knows nothing of
/// 1/d^2.
bool lamps_in_media(const Scene& scene) {
    const auto lights = positional_lights(scene);
    return std::any_of(lights.begin(), lights.end(), [&](const Emitter* light) {
        const Medium* medium = scene.emitter_medium_state(*light, {}).current();
        return medium && medium->traits().scattering;
    });
}

/// The cells that are filled where `cell` is: itself, and its halves or the whole.
std::vector<std::string> overlapping(const std::string& cell) {
    const std::string& whole = transport_name(Transport::single_scattering);
    if (cell == whole) return {whole, halves[0], halves[1]};
    if (contains(halves, cell)) return {cell, whole};
    return {cell};
}

}  // namespace

std::vector<std::string> transport_cells(bool media) {
    std::vector<std::string> cells;
    for (std::size_t i = 0; i < transport_layer_count(media); ++i)
        cells.push_back(transport_name(Transport(i)));
    return cells;
}

std::vector<LayerMethod> choose_layer_methods(const Scene& scene, const Requirements& r,
                                              const EyePathLimits& limits, FarLight far_light) {
    const bool by_lights = far_light == FarLight::lights;
    const std::string reason =
        by_lights ? "virtual point lights, drawn for pixels that lie apart: less noise than paths, and what "
                    "the bound takes is missing"
                  : "paths of pixels err independently of each other, which the filter takes";
    const bool equiangular = r.media_scattering && lamps_in_media(scene);
    const auto far = [&] {
        if (by_lights) return make_drawn_vpls(limits);
        return r.any_media() ? make_volpath(limits, equiangular) : make_path(limits);
    };
    if (!r.any_media())
        return {{make_path(limits), {"emission", "direct"}, "one scattering: light and BSDF sampling"},
                {far(), {"indirect"}, reason}};
    const std::size_t lights = positional_lights(scene).size();
    const bool marched = r.media_scattering && lights > 0 && lights <= most_marched_lights &&
                         (limits.max_depth < 0 || limits.max_depth > 1);
    const std::string surfaces = "surfaces behind media whose transmittance is marched";
    if (!marched) {
        const std::string why =
            lights > 0 ? "; too many lights to march each of them" : "; no light has a position to march to";
        const LayerMethod near{make_single_scattering(limits), {"emission", "direct"}, surfaces};
        const std::string single = "single_scattering";
        if (!by_lights) return {near, {far(), {"indirect", single, "multiple_scattering"}, reason + why}};
        const LayerMethod others{far(), {"indirect", "multiple_scattering"}, reason};
        if (lights > 0) return {near, {make_volpath(limits, equiangular), {single}, "paths" + why}, others};
        return {{make_all_single_scattering(limits), {"emission", "direct", single}, surfaces}, others};
    }
    // Lines end at the border of the picture: as many as there are pixels along half of it.
    const int lines = std::clamp(scene.film().width + scene.film().height, 16, 1024);
    // Refinement starts from the evenly spread samples: a gap in the smoke between two of them is not seen.
    const int samples = r.media_heterogeneous > 0 ? 64 : 16;
    return {{make_single_scattering(limits),
             {"emission", "direct", other_scattering},
             surfaces + "; one distance a ray for lights without a position"},
            {make_epipolar(limits, lines, samples),
             {positional_scattering},
             "lights with a position, marched along epipolar lines: nothing is left to chance"},
            {far(), {"indirect", "multiple_scattering"}, reason}};
}

std::vector<LayerMethod> with_cells(const Scene& scene, std::vector<LayerMethod> methods) {
    std::map<std::string, const LayerMethod*> filled;
    for (LayerMethod& method : methods) {
        const std::vector<std::string> possible = cells_that_it_can(scene, *method.integrator);
        for (const std::string& cell : method.cells) check_name(method, cell, possible);
        if (method.cells.empty()) method.cells = possible;
        for (const std::string& cell : method.cells)
            for (const std::string& same : overlapping(cell))
                if (const auto other = filled.find(same); other != filled.end())
                    throw InputError("two methods fill '" + cell + "': " + other->second->integrator->type() +
                                         " and " + method.integrator->type() +
                                         "; name the cells of each, such as name=\"direct, indirect\"",
                                     method.where);
        for (const std::string& cell : method.cells) filled.emplace(cell, &method);
    }
    return methods;
}

std::vector<std::string> unfilled_cells(bool media, const std::vector<LayerMethod>& methods) {
    std::vector<std::string> filled;
    for (const LayerMethod& method : methods)
        filled.insert(filled.end(), method.cells.begin(), method.cells.end());
    std::vector<std::string> gaps = transport_cells(media);
    std::erase_if(gaps, [&](const std::string& cell) {
        return contains(filled, cell) || (cell == transport_name(Transport::single_scattering) &&
                                          contains(filled, halves[0]) && contains(filled, halves[1]));
    });
    return gaps;
}

std::vector<std::size_t> kept_layers(const Scene& scene, const LayerMethod& method) {
    const std::vector<Layer> layers = method.integrator->layers(scene);
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < layers.size(); ++i)
        if (!layers[i].auxiliary && contains(method.cells, layers[i].transport())) kept.push_back(i);
    return kept;
}

}  // namespace mote::integrators
