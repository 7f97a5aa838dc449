// Hands a type with its declared parameters to the registry.
#pragma once

#include "core/parameters/nested.h"

namespace mote::core {

/// A type of the scene language. `make` gets the settings that were read and, where it wants them, the
/// Properties (for warnings and the place of an error), and returns a shared pointer to the object.
template <typename S, typename Make>
void add_type(Registry& registry, Category category, std::string type, std::string summary,
              const ParameterList<S>& parameters, std::string example, Make make) {
    registry.add({category, std::move(type), std::move(summary), parameters.parameters(), std::move(example)},
                 [parameters, make](const Properties& properties) -> std::shared_ptr<Object> {
                     if constexpr (std::is_invocable_v<Make, S, const Properties&>)
                         return make(parameters.read(properties), properties);
                     else
                         return make(parameters.read(properties));
                 });
}

/// A type that only holds settings for the one that nests it: a SettingsObject<S>.
template <typename S>
void add_type(Registry& registry, Category category, std::string type, std::string summary,
              const ParameterList<S>& parameters, std::string example) {
    add_type(registry, category, std::move(type), std::move(summary), parameters, std::move(example),
             [](S settings) { return std::make_shared<SettingsObject<S>>(std::move(settings)); });
}

/// A type without parameters; `make` takes nothing.
template <typename Make>
requires std::is_invocable_v<Make>
void add_type(Registry& registry, Category category, std::string type, std::string summary,
              std::string example, Make make) {
    registry.add({category, std::move(type), std::move(summary), {}, std::move(example)},
                 [make](const Properties&) -> std::shared_ptr<Object> { return make(); });
}

}  // namespace mote::core
