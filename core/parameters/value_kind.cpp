// The kinds of values that scene files hold.
#include "core/parameters/value_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace mote::core {
namespace {

const Properties::Value& given(const Properties& properties, const std::string& name) {
    const auto it = properties.values.find(name);
    if (it != properties.values.end()) return it->second;
    throw InputError("'" + name + "' takes a value, not a nested object", properties.where_of(name));
}

[[noreturn]] void wrong_kind(const Row& row, const Properties::Value& v, const char* wanted) {
    static const char* const names[] = {"boolean", "integer", "float",    "string",
                                        "rgb",     "vector",  "transform"};
    throw InputError("'" + row.parameter.name + "' must be " + wanted + ", not a " + names[v.value.index()],
                     v.where);
}

template <typename T>
const T& typed(const Properties& properties, const Row& row, const char* wanted) {
    const Properties::Value& v = given(properties, row.parameter.name);
    if (const T* value = std::get_if<T>(&v.value)) return *value;
    wrong_kind(row, v, wanted);
}

void require_in(const Range& range, double value, const std::string& subject, const SourceLocation& where) {
    if (!range.contains(value))
        throw InputError(subject + " is " + short_number(value) + " but " + range.demand(), where);
}

double number_of(const Row& row, const Properties::Value& v, const char* wanted) {
    double result = 0.0;
    if (const auto* f = std::get_if<double>(&v.value))
        result = *f;
    else if (const auto* i = std::get_if<std::int64_t>(&v.value))
        result = double(*i);
    else
        wrong_kind(row, v, wanted);
    if (!std::isfinite(result))
        throw InputError("'" + row.parameter.name + "' is not a finite number", v.where);
    return result;
}

template <typename T>
class FloatKind final : public ValueKind {
    std::string type(const Row&) const override { return "float"; }
    void read(const Properties& p, const Row& row, void* member) const override {
        const T value = T(read_number(p, row));
        if (!std::isfinite(value))
            throw InputError("'" + row.parameter.name + "' is not a finite number",
                             p.where_of(row.parameter.name));
        *static_cast<T*>(member) = value;
    }
    std::string text(const Row&, const void* member) const override {
        const T value = *static_cast<const T*>(member);
        const std::string exact = fmt::format("{}", value);  // of this precision
        return exact.size() > 9 ? short_number(double(value)) : exact;
    }
};

template <typename T>
class IntegerKind final : public ValueKind {
    std::string type(const Row&) const override { return "integer"; }
    void read(const Properties& p, const Row& row, void* member) const override {
        const auto value = typed<std::int64_t>(p, row, "an integer");
        const std::string subject = "'" + row.parameter.name + "'";
        require_in(row.parameter.range, double(value), subject, p.where_of(row.parameter.name));
        if (!std::in_range<T>(value))
            require_in(between(double(std::numeric_limits<T>::min()), double(std::numeric_limits<T>::max())),
                       double(value), subject, p.where_of(row.parameter.name));
        *static_cast<T*>(member) = T(value);
    }
    std::string text(const Row&, const void* member) const override {
        return fmt::format("{}", *static_cast<const T*>(member));
    }
};

class BoolKind final : public ValueKind {
    std::string type(const Row& row) const override {
        return row.parameter.choices.empty() ? "boolean" : choice_kind(sizeof(bool)).type(row);
    }
    void read(const Properties& p, const Row& row, void* member) const override {
        if (!row.parameter.choices.empty()) return choice_kind(sizeof(bool)).read(p, row, member);
        *static_cast<bool*>(member) = typed<bool>(p, row, "a boolean");
    }
    std::string text(const Row& row, const void* member) const override {
        if (!row.parameter.choices.empty()) return choice_kind(sizeof(bool)).text(row, member);
        return *static_cast<const bool*>(member) ? "true" : "false";
    }
};

/// One of a fixed set of words.
std::size_t read_choice(const Properties& p, const Row& row) {
    const std::string& word = typed<std::string>(p, row, "a string");
    const std::vector<std::string>& words = row.parameter.choices;
    const auto it = std::find(words.begin(), words.end(), word);
    if (it == words.end())
        throw InputError(
            "'" + row.parameter.name + "' cannot be '" + printable(word) + "'" + suggestion(word, words),
            p.where_of(row.parameter.name));
    return std::size_t(it - words.begin());
}

template <typename T>
class ChoiceKind final : public ValueKind {
    std::string type(const Row&) const override { return "string"; }
    void read(const Properties& p, const Row& row, void* member) const override {
        const T value = T(row.choices[read_choice(p, row)]);
        std::memcpy(member, &value, sizeof value);  // an enum of this size
    }
    std::string text(const Row& row, const void* member) const override {
        T value{};
        std::memcpy(&value, member, sizeof value);
        const auto it = std::find(row.choices.begin(), row.choices.end(), std::int64_t(value));
        return it == row.choices.end() ? "" : row.parameter.choices[std::size_t(it - row.choices.begin())];
    }
};

class StringKind final : public ValueKind {
    std::string type(const Row&) const override { return "string"; }
    void read(const Properties& p, const Row& row, void* member) const override {
        *static_cast<std::string*>(member) = read_string(p, row);
    }
    std::string text(const Row&, const void* member) const override {
        return *static_cast<const std::string*>(member);
    }
};

class FileKind final : public ValueKind {
    std::string type(const Row&) const override { return "string"; }
    void read(const Properties& p, const Row& row, void* member) const override {
        auto& file = *static_cast<FileName*>(member);
        file.written = read_string(p, row);
        file.path = p.find_file(row.parameter.name);
    }
    std::string text(const Row&, const void* member) const override {
        return static_cast<const FileName*>(member)->written;
    }
};

class RgbKind final : public ValueKind {
    std::string type(const Row&) const override { return "rgb"; }
    void read(const Properties& p, const Row& row, void* member) const override {
        *static_cast<Rgb*>(member) = read_rgb(p, row);
    }
    std::string text(const Row&, const void* member) const override {
        return rgb_text(*static_cast<const Rgb*>(member));
    }
};

class VectorKind final : public ValueKind {
    std::string type(const Row& row) const override {
        return row.parameter.type.empty() ? "vector" : row.parameter.type;  // or "point"
    }
    void read(const Properties& p, const Row& row, void* member) const override {
        const Vec3d& v = typed<Vec3d>(p, row, "a point or a vector");
        if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
            throw InputError("'" + row.parameter.name + "' is not finite", p.where_of(row.parameter.name));
        *static_cast<Vec3d*>(member) = v;
    }
    std::string text(const Row&, const void* member) const override {
        const auto& v = *static_cast<const Vec3d*>(member);
        return fmt::format("{}, {}, {}", v.x, v.y, v.z);
    }
};

class TransformKind final : public ValueKind {
    std::string type(const Row&) const override { return "transform"; }
    void read(const Properties& p, const Row& row, void* member) const override {
        const auto& t = typed<Transform>(p, row, "a transform");
        if (!t.valid())
            throw InputError("'" + row.parameter.name + "' is singular or not finite",
                             p.where_of(row.parameter.name));
        *static_cast<Transform*>(member) = t;
    }
    std::string text(const Row&, const void* member) const override {
        return static_cast<const Transform*>(member)->matrix == glm::dmat4(1.0) ? "identity" : "built in";
    }
};

/// The one object of a kind.
template <typename K>
const ValueKind& only() {
    static const K kind;
    return kind;
}

}  // namespace

const ValueKind& kind_of(Type<bool>) { return only<BoolKind>(); }
const ValueKind& kind_of(Type<int>) { return only<IntegerKind<int>>(); }
const ValueKind& kind_of(Type<std::uint32_t>) { return only<IntegerKind<std::uint32_t>>(); }
const ValueKind& kind_of(Type<std::int64_t>) { return only<IntegerKind<std::int64_t>>(); }
const ValueKind& kind_of(Type<std::size_t>) { return only<IntegerKind<std::size_t>>(); }
const ValueKind& kind_of(Type<float>) { return only<FloatKind<float>>(); }
const ValueKind& kind_of(Type<double>) { return only<FloatKind<double>>(); }
const ValueKind& kind_of(Type<std::string>) { return only<StringKind>(); }
const ValueKind& kind_of(Type<FileName>) { return only<FileKind>(); }
const ValueKind& kind_of(Type<Rgb>) { return only<RgbKind>(); }
const ValueKind& kind_of(Type<Vec3d>) { return only<VectorKind>(); }
const ValueKind& kind_of(Type<Transform>) { return only<TransformKind>(); }

const ValueKind& choice_kind(std::size_t size) {
    return size == 1 ? only<ChoiceKind<std::uint8_t>>() : only<ChoiceKind<std::int32_t>>();
}

double read_number(const Properties& p, const Row& row) {
    const Properties::Value& v = given(p, row.parameter.name);
    const double value = number_of(row, v, "a float");
    require_in(row.parameter.range, value, "'" + row.parameter.name + "'", v.where);
    return value;
}

Rgb read_rgb(const Properties& p, const Row& row) {
    const Properties::Value& v = given(p, row.parameter.name);
    const auto* colour = std::get_if<Rgb>(&v.value);
    const Rgb value = colour ? *colour : Rgb(float(number_of(row, v, "an rgb or a float")));
    if (!is_finite(value)) throw InputError("'" + row.parameter.name + "' is not finite", v.where);
    Range range = row.parameter.range;  // a limit of single precision includes itself
    range.lower = float(range.lower), range.upper = float(range.upper);
    for (int c = 0; c < 3; ++c)
        require_in(range, double(value[c]), "a channel of '" + row.parameter.name + "'", v.where);
    return value;
}

std::string read_string(const Properties& p, const Row& row) {
    const std::string& word = typed<std::string>(p, row, "a string");
    if (!row.parameter.choices.empty()) (void)read_choice(p, row);
    return word;
}

std::string rgb_text(const Rgb& c) {
    return c.x == c.y && c.y == c.z ? fmt::format("{}", c.x) : fmt::format("{}, {}, {}", c.x, c.y, c.z);
}

}  // namespace mote::core
