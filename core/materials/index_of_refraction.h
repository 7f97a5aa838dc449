// Indices of refraction by name: dielectrics (Hecht, Optics; around 589 nm) and conductors (RGB
// eta + i k).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/math/vec.h"
#include "core/parameters/parameter_list.h"

namespace mote::core {

/// Index of a named dielectric ("bk7", "water", ...; case is ignored), or nothing when the name is unknown.
std::optional<float> dielectric_index(std::string_view name);

struct ComplexIndex {
    Rgb eta{0.0f}, k{1.0f};  ///< the default reflects everything
};

/// Index of a named conductor ("Cu", "a-C", ...; "none" is the perfect mirror), or nothing.
std::optional<ComplexIndex> conductor_index(std::string_view name);

/// Index of refraction of a dielectric: a number, or the name of a material ("bk7", "water", ...).
class IndexOfRefraction {
  public:
    IndexOfRefraction(float value) : value_(value) {}  // NOLINT: a number is an index
    /// The name must be known: for defaults in code.
    IndexOfRefraction(const char* name) : value_(dielectric_index(name).value()), name_(name) {}  // NOLINT
    operator float() const { return value_; }                                                     // NOLINT
    /// "" where it was given as a number.
    const std::string& name() const { return name_; }

  private:
    float value_;
    std::string name_;
};

const ValueKind& kind_of(Type<IndexOfRefraction>);

/// `material`, or `eta` and `k`.
struct ConductorIndexSettings {
    std::string material = "none";  ///< name of a conductor
    std::optional<Rgb> eta, k;      ///< real and imaginary part of the index
};
const ParameterList<ConductorIndexSettings>& conductor_index_rows();
/// Throws InputError for unknown names, and where both are given.
ComplexIndex conductor_index_of(const ConductorIndexSettings& settings, const Properties& properties);

}  // namespace mote::core
