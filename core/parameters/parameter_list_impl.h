// The part that is compiled for each type of settings; the work is in parameter_list.cpp.
#pragma once

#include "core/parameters/parameter_list.h"

namespace mote::core {

/// A row without range and choices. A settings' member lies `offset` bytes after its begin.
Row make_row(std::string name, std::string sentence, const ValueKind& kind, std::size_t offset);
/// Reads all parameters that are given. Throws InputError where one fails or a required one is missing.
void read_rows(const std::vector<Row>& rows, const Properties& properties, void* settings);
std::vector<Parameter> parameters_of(const std::vector<Row>& rows, const void* defaults);
std::vector<Row> moved_rows(std::vector<Row> rows, std::size_t offset);
/// Throws std::logic_error where a name is no row's.
void remove_rows(std::vector<Row>& rows, std::initializer_list<const char*> names);

/// Where a member lies in its struct [bytes], measured in an object that lives as long as the program.
template <typename S, typename T>
std::size_t offset_of(T S::*member) {
    static const S object{};
    return std::size_t(reinterpret_cast<const std::byte*>(&(object.*member)) -
                       reinterpret_cast<const std::byte*>(&object));
}

template <typename S>
Rows<S>::Rows(std::initializer_list<Rows> parts) {
    for (const Rows& part : parts) rows_.insert(rows_.end(), part.rows_.begin(), part.rows_.end());
}

template <typename S>
template <typename Base>
requires(std::derived_from<S, Base> && !std::same_as<S, Base>) Rows<S>::Rows(const Rows<Base>& base) {
    static const S object{};
    rows_ = moved_rows(base.rows(),
                       std::size_t(reinterpret_cast<const std::byte*>(static_cast<const Base*>(&object)) -
                                   reinterpret_cast<const std::byte*>(&object)));
}

template <typename S>
Rows<S> Rows<S>::required() && {
    for (Row& row : rows_) row.parameter.required = true;
    return std::move(*this);
}

template <typename S>
Rows<S> Rows<S>::when_absent(std::string word) && {
    for (Row& row : rows_) row.when_absent = word;
    return std::move(*this);
}

template <typename S>
void Rows<S>::remove(std::initializer_list<const char*> names) {
    remove_rows(rows_, names);
}

template <typename S, typename T>
Rows<S> row(std::string name, T S::*member, std::string sentence) {
    return Rows<S>(make_row(std::move(name), std::move(sentence), kind_of(Type<T>()), offset_of(member)));
}

template <typename S, typename T>
Rows<S> row(std::string name, T S::*member, Range range, std::string sentence) {
    Row made = make_row(std::move(name), std::move(sentence), kind_of(Type<T>()), offset_of(member));
    made.parameter.range = std::move(range);
    return Rows<S>(std::move(made));
}

template <typename S, typename T>
Rows<S> row(std::string name, T S::*member, std::type_identity_t<Choices<T>> choices, std::string sentence) {
    Row made = make_row(std::move(name), std::move(sentence), kind_of(Type<T>()), offset_of(member));
    for (const auto& [word, value] : choices.all) {
        made.parameter.choices.emplace_back(word);
        if constexpr (std::is_enum_v<T> || std::is_integral_v<T>) made.choices.push_back(std::int64_t(value));
    }
    return Rows<S>(std::move(made));
}

template <typename S>
Rows<S> point_row(std::string name, Vec3d S::*member, std::string unit, std::string sentence) {
    Row made = make_row(std::move(name), std::move(sentence), kind_of(Type<Vec3d>()), offset_of(member));
    made.parameter.type = "point", made.parameter.range = any(std::move(unit));
    return Rows<S>(std::move(made));
}

template <typename S, typename T, typename... More>
Rows<S> within(T S::*member, const Rows<std::type_identity_t<T>>& first, const More&... more) {
    return Rows<S>(moved_rows(Rows<T>({first, Rows<T>(more)...}).rows(), offset_of(member)));
}

template <typename S>
ParameterList<S>::ParameterList(S defaults, std::initializer_list<Rows<S>> rows)
    : Rows<S>(rows), defaults_(std::move(defaults)) {}

template <typename S>
S ParameterList<S>::read(const Properties& properties) const {
    S settings = defaults_;
    read_rows(this->rows(), properties, &settings);
    return settings;
}

template <typename S>
std::vector<Parameter> ParameterList<S>::parameters() const {
    return parameters_of(this->rows(), &defaults_);
}

template <typename S>
ParameterList<S> ParameterList<S>::without(std::initializer_list<const char*> names) const {
    ParameterList result = *this;
    result.remove(names);
    return result;
}

}  // namespace mote::core
