// Hands every selection of virtual point lights to the registry.
#pragma once

#include "core/parameters/add_type.h"
#include "lights/selection/selection.h"

namespace mote::lights {

/// all, uniform, lightcuts, multidimensional_lightcuts, stochastic_lightcuts, light_tree, resampling, matrix.
void register_selection(core::Registry& registry);

void register_uniform_selection(core::Registry& registry);     ///< uniform
void register_lightcuts(core::Registry& registry);             ///< lightcuts, multidimensional_lightcuts
void register_stochastic_selection(core::Registry& registry);  ///< stochastic_lightcuts, light_tree
void register_resampling_selection(core::Registry& registry);  ///< resampling
void register_matrix_selection(core::Registry& registry);      ///< matrix

/// A type of selection: a T of the settings and `more`.
template <typename T, typename S, typename... More>
void add_selection(core::Registry& registry, const std::string& type, std::string summary,
                   const core::ParameterList<S>& parameters, More... more) {
    core::add_type(registry, core::Category::selection, type, std::move(summary), parameters,
                   "<selection type=\"" + type + "\"/>",
                   [more...](const S& settings, const core::Properties& properties) {
                       const auto selection = std::make_shared<T>(settings, more...);
                       selection->where = properties.where;
                       return selection;
                   });
}

}  // namespace mote::lights
