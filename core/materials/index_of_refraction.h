// Indices of refraction by name: dielectrics (Hecht, Optics; around 589 nm) and conductors (RGB
// eta + i k).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/math/vec.h"

namespace mote::core {

class Properties;

/// Index of a named dielectric ("bk7", "water", ...; case is ignored), or nothing when the name is unknown.
std::optional<float> dielectric_index(std::string_view name);

struct ComplexIndex {
    Rgb eta{0.0f}, k{1.0f};  ///< the default reflects everything
};

/// Index of a named conductor ("Cu", "a-C", ...; "none" is the perfect mirror), or nothing.
std::optional<ComplexIndex> conductor_index(std::string_view name);

/// The parameter `name` as a number or as the name of a dielectric. Throws InputError for unknown names and
/// for numbers outside [0.01, 100].
float dielectric_index_parameter(const Properties& properties, const std::string& name,
                                 const std::string& default_name);

/// `material`, or `eta` and `k` (rgb or float). Throws InputError when both are given.
ComplexIndex conductor_parameters(const Properties& properties);

}  // namespace mote::core
