// Nested objects as parameters.
#pragma once

#include <memory>

#include "core/objects/registry.h"
#include "core/parameters/parameter_list.h"

namespace mote::core {

/// An object that only holds settings, for a type whose work is done by the one that nests it.
template <typename S>
class SettingsObject final : public Object {
  public:
    explicit SettingsObject(S settings) : settings_(std::move(settings)) {}
    /// As they were read.
    const S& settings() const { return settings_; }

  private:
    S settings_;
};

/// One of any number of nested objects.
template <typename T>
struct Nested {
    std::string name;  ///< "" where the scene file gives none
    std::shared_ptr<T> object;
    SourceLocation where;
};

/// The objects nested as `row`. Throws InputError where there are several and `single`.
std::vector<Properties::Child> nested_children(const Properties& properties, const Row& row, bool single);
[[noreturn]] void wrong_object(const Properties::Child& child);

template <typename T>
std::shared_ptr<T> object_of(const Properties::Child& child) {
    auto object = std::dynamic_pointer_cast<T>(child.object);
    if (!object) wrong_object(child);
    return object;
}

/// Nested objects of members of type T: as settings; as the object itself; as any number of them.
template <typename T>
struct NestedMember {
    static constexpr bool single = true;
    static void set(T& member, const Properties::Child& child) {
        member = object_of<SettingsObject<T>>(child)->settings();
    }
};
template <typename T>
struct NestedMember<std::optional<T>> {
    static constexpr bool single = true;
    static void set(std::optional<T>& member, const Properties::Child& child) {
        NestedMember<T>::set(member.emplace(), child);
    }
};
template <typename T>
struct NestedMember<std::shared_ptr<T>> {
    static constexpr bool single = true;
    static void set(std::shared_ptr<T>& member, const Properties::Child& child) {
        member = object_of<T>(child);
    }
};
template <typename T>
struct NestedMember<std::vector<Nested<T>>> {
    static constexpr bool single = false;
    static void set(std::vector<Nested<T>>& member, const Properties::Child& child) {
        member.push_back({child.name, object_of<T>(child), child.where});
    }
};

template <typename T>
class NestedKind final : public ValueKind {
  public:
    std::string type(const Row& row) const override { return row.parameter.type; }
    bool given(const Properties& properties, const Row& row) const override {
        return !nested_children(properties, row, NestedMember<T>::single).empty();
    }
    void read(const Properties& properties, const Row& row, void* member) const override {
        for (const auto& child : nested_children(properties, row, NestedMember<T>::single))
            NestedMember<T>::set(*static_cast<T*>(member), child);
    }
    std::string text(const Row&, const void*) const override { return ""; }
};

/// A nested object. `when_absent` says what the page shows as the default, such as "isotropic".
template <typename S, typename T>
Rows<S> nested(std::string name, T S::*member, Category category, std::string when_absent,
               std::string sentence) {
    static const NestedKind<T> kind;
    Row made = make_row(std::move(name), std::move(sentence), kind, offset_of(member));
    made.parameter.type = category_name(category);
    made.when_absent = std::move(when_absent);
    return Rows<S>(std::move(made));
}

}  // namespace mote::core
