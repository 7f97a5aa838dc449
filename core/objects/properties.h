// One element of a scene file as its factory receives it: values by name, nested objects, and its place in
// the file. Declared rows (core/parameters) read and check the values.
//
// The loader has checked already that every name is in the type's manual page.
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

/// Contents of an element of a scene file.
class Properties {
  public:
    /// A parameter.
    struct Value {
        PropertyValue value;   ///< converted
        SourceLocation where;  ///< in the file
    };
    /// A nested object.
    struct Child {
        std::string name;                ///< the `name` attribute, or "" when it has none
        Category category;               ///< of the object
        std::shared_ptr<Object> object;  ///< never null
        SourceLocation where;            ///< in the file
    };

    Category category{};   ///< of the element
    std::string type, id;  ///< its attributes
    SourceLocation where;  ///< in the file
    // The two sinks live as long as the call of the factory.
    std::vector<std::string> search_paths;         ///< folders that relative file names are looked up in
    std::vector<std::string>* warnings = nullptr;  ///< sink for warnings; may be null
    std::vector<std::string>* files = nullptr;     ///< sink for the paths find_file() found; may be null

    std::map<std::string, Value> values;  ///< by name
    std::vector<Child> children;          ///< nested objects, in order

    bool has(const std::string& name) const;  ///< is a parameter or an object of this name given?
    /// The file's full path: relative names are looked up in search_paths. Throws InputError when it is not
    /// there.
    std::string find_file(const std::string& name) const;

    /// The nested object of type T called `name`, or null. Throws when the name holds an object of another
    /// kind.
    template <typename T>
    std::shared_ptr<T> child(const std::string& name) const {
        for (const Child& c : children) {
            if (c.name != name) continue;
            if (auto typed = std::dynamic_pointer_cast<T>(c.object)) return typed;
            throw InputError("'" + name + "' is an object of the wrong kind", c.where);
        }
        return nullptr;
    }
    SourceLocation where_of(const std::string& name) const;  ///< the parameter's place, or the element's
    /// Adds to `warnings`, with the element's place.
    void warn(const std::string& message) const;
};

}  // namespace mote::core
