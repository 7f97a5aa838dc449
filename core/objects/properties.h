// One element of a scene file as its factory sees it: typed values by name, nested objects, and where it
// stands.
//
// The loader has checked already that every name is in the type's manual page. A getter that finds a value of
// another kind, or a number that is not finite, throws InputError with file and line.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/math/transform.h"
#include "core/math/vec.h"
#include "core/objects/error.h"
#include "core/objects/object.h"

namespace mote::core {

/// A `<spectrum>` whose wavelengths have been converted, or an `<rgb>`, or a grey `<float>`, are all stored
/// as Rgb.
using PropertyValue = std::variant<bool, std::int64_t, double, std::string, Rgb, Vec3d, Transform>;

class Properties {
  public:
    struct Value {
        PropertyValue value;
        SourceLocation where;
    };
    struct Child {
        std::string name;  ///< the `name` attribute, or "" when it has none
        Category category;
        std::shared_ptr<Object> object;
        SourceLocation where;
    };

    Category category{};
    std::string type, id;
    SourceLocation where;
    // The two sinks live as long as the call of the factory.
    std::vector<std::string> search_paths;         ///< folders that relative file names are looked up in
    std::vector<std::string>* warnings = nullptr;  ///< sink for warnings; may be null
    std::vector<std::string>* files = nullptr;     ///< sink for the paths find_file() found; may be null

    std::map<std::string, Value> values;
    std::vector<Child> children;

    bool has(const std::string& name) const;
    bool get_bool(const std::string& name, bool default_value) const;
    std::int64_t get_int(const std::string& name, std::int64_t default_value) const;
    double get_float(const std::string& name, double default_value) const;
    /// Required: throws InputError naming the missing parameter.
    double require_float(const std::string& name) const;
    std::string get_string(const std::string& name, const std::string& default_value) const;
    std::string require_string(const std::string& name) const;
    /// One of a fixed set of words; an unknown word is an error with the nearest one.
    std::string get_choice(const std::string& name, const std::string& default_value,
                           const std::vector<std::string>& choices) const;
    /// Like get_float, and throws InputError when the value lies outside [lower, upper].
    double get_float_in(const std::string& name, double default_value, double lower, double upper) const;
    /// Like get_int, and throws InputError when the value lies outside [lower, upper].
    std::int64_t get_int_in(const std::string& name, std::int64_t default_value, std::int64_t lower,
                            std::int64_t upper) const;

    /// The file's full path: relative names are looked up in search_paths. Throws InputError when it is not
    /// there.
    std::string find_file(const std::string& name) const;

    /// The nested object of type T called `name`, or null. Throws when the name holds an object of another
    /// kind.
    template <typename T>
    std::shared_ptr<T> child(const std::string& name) const {
        for (const Child& c : children)
            if (c.name == name) return checked<T>(c);
        return nullptr;
    }
    /// The nested object of category c whatever its name, or null; throws InputError when there are several.
    template <typename T>
    std::shared_ptr<T> child_of(Category c) const {
        std::shared_ptr<T> found;
        for (const Child& candidate : children) {
            if (candidate.category != c) continue;
            if (found) throw InputError("more than one nested " + kind_of(c), candidate.where);
            found = checked<T>(candidate);
        }
        return found;
    }
    SourceLocation where_of(const std::string& name) const;
    void warn(const std::string& message) const;

  private:
    template <typename T>
    std::shared_ptr<T> checked(const Child& c) const {
        auto typed = std::dynamic_pointer_cast<T>(c.object);
        if (!typed) throw InputError("'" + c.name + "' is an object of the wrong kind", c.where);
        return typed;
    }
    static std::string kind_of(Category c);
};

}  // namespace mote::core
