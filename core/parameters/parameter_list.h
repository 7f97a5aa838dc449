// Declared parameters: each is one row, beside the plain struct that holds the settings of a type.
//
//     struct FogSettings {
//         float density = 0.1f;
//         Falloff falloff = Falloff::linear;
//         EyePathLimits eye;
//     };
//     const ParameterList<FogSettings> fog_parameters{
//         row("density", &FogSettings::density, at_least(0, "1/m"), "Extinction at the ground."),
//         row("falloff", &FogSettings::falloff, {{"linear", Falloff::linear}, {"none", Falloff::none}},
//             "Change of the density with height."),
//         within(&FogSettings::eye, eye_path_parameters),
//     };
//
// The default of a parameter is that of a default-constructed struct. Reading, errors, manual page, Python's
// help and the values of tests follow from the rows. add_type() (add_type.h) hands a type with its list to
// the registry.
#pragma once

#include <initializer_list>
#include <utility>

#include "core/parameters/value_kind.h"

namespace mote::core {

/// Words of a scene file for the values of T.
template <typename T>
struct Choices {
    std::vector<std::pair<const char*, T>> all;
    Choices(std::initializer_list<std::pair<const char*, T>> choices) : all(choices) {}
    /// The word of a value, or "".
    std::string word(T value) const {
        for (const auto& [word, its_value] : all)
            if (its_value == value) return word;
        return "";
    }
};

/// Rows whose members lie in S, or in what S holds.
template <typename S>
class Rows {
  public:
    explicit Rows(Row row) : rows_{std::move(row)} {}
    explicit Rows(std::vector<Row> rows) : rows_(std::move(rows)) {}
    /// One after the other.
    Rows(std::initializer_list<Rows> parts);
    /// Those of a base of S.
    template <typename Base>
    requires(std::derived_from<S, Base> && !std::same_as<S, Base>) Rows(const Rows<Base>& base);
    const std::vector<Row>& rows() const { return rows_; }

    /// The parameter must be given.
    Rows required() &&;
    /// The page shows this word as the default.
    Rows when_absent(std::string word) &&;

  protected:
    void remove(std::initializer_list<const char*> names);

  private:
    std::vector<Row> rows_;
};

/// A parameter that takes every value of its type.
template <typename S, typename T>
Rows<S> row(std::string name, T S::*member, std::string sentence);
/// A number, or an rgb or a texture, whose values lie in a range.
template <typename S, typename T>
Rows<S> row(std::string name, T S::*member, Range range, std::string sentence);
/// One of some words: `{{"linear", Falloff::linear}, {"none", Falloff::none}}`.
template <typename S, typename T>
Rows<S> row(std::string name, T S::*member, std::type_identity_t<Choices<T>> choices, std::string sentence);
/// A point in space, where row() declares a vector.
template <typename S>
Rows<S> point_row(std::string name, Vec3d S::*member, std::string unit, std::string sentence);

/// Rows of a member of S: a list, or single rows of its type.
template <typename S, typename T, typename... More>
Rows<S> within(T S::*member, const Rows<std::type_identity_t<T>>& first, const More&... more);

/// All parameters of a type, and its defaults.
template <typename S>
class ParameterList : public Rows<S> {
  public:
    ParameterList(std::initializer_list<Rows<S>> rows) : ParameterList(S(), rows) {}
    /// With other defaults than those of a default-constructed S.
    ParameterList(S defaults, std::initializer_list<Rows<S>> rows);

    /// Checked. Throws InputError with file, line, and the range or the nearest word.
    S read(const Properties& properties) const;
    /// The rows of the manual page.
    std::vector<Parameter> parameters() const;
    /// The list without these parameters, which keep their defaults.
    ParameterList without(std::initializer_list<const char*> names) const;

  private:
    S defaults_;
};

}  // namespace mote::core

#include "core/parameters/parameter_list_impl.h"
