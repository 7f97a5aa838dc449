// Reading, checking and printing of values of one C++ type in scene files.
//
// KindOf<T>::kind() is the one object that does so for members of type T. A folder above adds a type of its
// own (a texture, a volume) by a specialisation.
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/math/transform.h"
#include "core/objects/parameter.h"
#include "core/objects/properties.h"

namespace mote::core {

class ValueKind;

/// One declared parameter: its row of the page, and the member that it sets.
struct Row {
    Parameter parameter;                     ///< default_value is set by the list
    const ValueKind* kind = nullptr;         ///< of the member's type
    std::size_t offset = 0;                  ///< of the member in its settings [bytes]
    std::vector<std::int64_t> choices{};     ///< values of parameter.choices, in their order
    std::optional<std::string> when_absent;  ///< shown as the default instead of the member's value
};

class ValueKind {
  public:
    virtual ~ValueKind() = default;
    /// Its word in the column "type" of a manual page.
    virtual std::string type(const Row& row) const = 0;
    /// True where the scene file gives the parameter.
    virtual bool given(const Properties& properties, const Row& row) const {
        return properties.has(row.parameter.name);
    }
    /// Sets the member at `member` to what the scene file gives. Called only where it gives something. Throws
    /// InputError.
    virtual void read(const Properties& properties, const Row& row, void* member) const = 0;
    /// A member's value as a page shows it.
    virtual std::string text(const Row& row, const void* member) const = 0;
};

/// Names a type, to overload functions by it.
template <typename T>
struct Type {};

/// A file, looked up in the folders of the scene.
struct FileName {
    std::string written;  ///< as the scene file gives it
    std::string path;     ///< where it was found
};

/// The kinds of members. A folder above overloads kind_of() for a type of its own, in that type's namespace.
const ValueKind& kind_of(Type<bool>);
const ValueKind& kind_of(Type<int>);
const ValueKind& kind_of(Type<std::uint32_t>);
const ValueKind& kind_of(Type<std::int64_t>);
const ValueKind& kind_of(Type<std::size_t>);
const ValueKind& kind_of(Type<float>);
const ValueKind& kind_of(Type<double>);
const ValueKind& kind_of(Type<std::string>);
const ValueKind& kind_of(Type<FileName>);
const ValueKind& kind_of(Type<Rgb>);
const ValueKind& kind_of(Type<Vec3d>);
const ValueKind& kind_of(Type<Transform>);

/// Words for the values of an enum (or of another integer type) of this size.
const ValueKind& choice_kind(std::size_t size);

template <typename T>
requires std::is_enum_v<T>
const ValueKind& kind_of(Type<T>) { return choice_kind(sizeof(T)); }

/// Nothing where the scene file gives nothing.
template <typename T>
class OptionalKind final : public ValueKind {
  public:
    explicit OptionalKind(const ValueKind& value) : value_(value) {}
    std::string type(const Row& row) const override { return value_.type(row); }
    void read(const Properties& properties, const Row& row, void* member) const override {
        value_.read(properties, row, &static_cast<std::optional<T>*>(member)->emplace());
    }
    std::string text(const Row& row, const void* member) const override {
        const auto& value = *static_cast<const std::optional<T>*>(member);
        return value ? value_.text(row, &*value) : "automatic";
    }

  private:
    const ValueKind& value_;
};

template <typename T>
const ValueKind& kind_of(Type<std::optional<T>>) {
    static const OptionalKind<T> kind(kind_of(Type<T>()));
    return kind;
}

/// The number, colour or other value of `row` in a scene file, checked against its range. Throws InputError.
double read_number(const Properties& properties, const Row& row);
Rgb read_rgb(const Properties& properties, const Row& row);
std::string read_string(const Properties& properties, const Row& row);
/// "0.5" for grey, else "0.2, 0.4, 0.8".
std::string rgb_text(const Rgb& value);

}  // namespace mote::core
