// The parameter list of a directive: "type name" and its values.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/formats/pbrt/pbrt_text.h"
#include "core/math/vec.h"

namespace mote::core {

struct PbrtParameter {
    std::string type, name;
    std::vector<double> numbers;       ///< true and false as 1 and 0
    std::vector<std::string> strings;  ///< or names of textures and spectra
    SourceLocation where;
    std::string color_space;    ///< of rgb: "srgb" and others, see pbrt_spectra.h
    bool of_attribute = false;  ///< set by an Attribute directive: need not fit the object
    mutable bool used = false;
};

/// An object of a scene: what it is, its parameters, and where it stands. Getters throw InputError for a
/// value of the wrong type or number; a parameter that none of them requested is unknown.
class PbrtObject {
  public:
    std::string type;
    SourceLocation where;
    std::vector<PbrtParameter> parameters;

    /// Null where it is not given.
    const PbrtParameter* find(const std::string& name) const;
    double number(const std::string& name, double default_value) const;
    int integer(const std::string& name, int default_value) const;
    bool flag(const std::string& name, bool default_value) const;
    std::string text(const std::string& name, const std::string& default_value) const;
    Vec3d point(const std::string& name, const Vec3d& default_value) const;
    /// Empty where it is not given.
    std::vector<double> numbers(const std::string& name) const;
    /// Vectors of N components. Throws InputError where numbers are left over.
    template <typename V>
    std::vector<V> vectors(const std::string& name) const;
    /// Known parameters without a meaning here.
    void ignore(std::initializer_list<const char*> names) const;
    /// The parameters that nothing requested, each as an error with the nearest known name.
    std::vector<InputError> unknown() const;

  private:
    mutable std::vector<std::string> known_;
};

/// Reads the parameters up to the next word.
std::vector<PbrtParameter> read_pbrt_parameters(PbrtText& text, const std::string& color_space);

template <typename V>
std::vector<V> PbrtObject::vectors(const std::string& name) const {
    constexpr std::size_t n = V::length();
    const std::vector<double> all = numbers(name);
    if (all.size() % n != 0)
        throw InputError("'" + printable(name) + "' has " + std::to_string(all.size()) +
                             " numbers, no multiple of " + std::to_string(n),
                         find(name)->where);
    std::vector<V> list(all.size() / n);
    for (std::size_t i = 0; i < all.size(); ++i) list[i / n][int(i % n)] = typename V::value_type(all[i]);
    return list;
}

}  // namespace mote::core
