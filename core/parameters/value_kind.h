// How values of one C++ type are read from a scene file, checked, and shown.
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

template <typename T>
struct KindOf;

/// A file, looked up in the folders of the scene.
struct FileName {
    std::string written;  ///< as the scene file gives it
    std::string path;     ///< where it was found
};

template <>
struct KindOf<bool> {
    static const ValueKind& kind();
};
template <>
struct KindOf<int> {
    static const ValueKind& kind();
};
template <>
struct KindOf<std::uint32_t> {
    static const ValueKind& kind();
};
template <>
struct KindOf<std::int64_t> {
    static const ValueKind& kind();
};
template <>
struct KindOf<std::size_t> {
    static const ValueKind& kind();
};
template <>
struct KindOf<float> {
    static const ValueKind& kind();
};
template <>
struct KindOf<double> {
    static const ValueKind& kind();
};
template <>
struct KindOf<std::string> {
    static const ValueKind& kind();
};
template <>
struct KindOf<FileName> {
    static const ValueKind& kind();
};
template <>
struct KindOf<Rgb> {
    static const ValueKind& kind();
};
template <>
struct KindOf<Vec3d> {
    static const ValueKind& kind();
};
template <>
struct KindOf<Transform> {
    static const ValueKind& kind();
};

/// Words for the values of an enum (or of another integer type) of this size.
const ValueKind& choice_kind(std::size_t size);

template <typename T>
requires std::is_enum_v<T>
struct KindOf<T> {
    static const ValueKind& kind() { return choice_kind(sizeof(T)); }
};

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
struct KindOf<std::optional<T>> {
    static const ValueKind& kind() {
        static const OptionalKind<T> kind(KindOf<T>::kind());
        return kind;
    }
};

/// The number, colour or other value of `row` in a scene file, checked against its range. Throws InputError.
double read_number(const Properties& properties, const Row& row);
Rgb read_rgb(const Properties& properties, const Row& row);
std::string read_string(const Properties& properties, const Row& row);
/// "0.5" for grey, else "0.2, 0.4, 0.8".
std::string rgb_text(const Rgb& value);

}  // namespace mote::core
