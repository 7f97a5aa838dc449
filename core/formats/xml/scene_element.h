// One element of a scene file as text: tag, attributes, children, and where it stands.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/objects/error.h"

namespace mote::core {

struct Element {
    std::string tag;
    std::vector<std::pair<std::string, std::string>> attributes;
    std::vector<Element> children;
    SourceLocation where;
    std::string folder;                       ///< of the file it stands in
    bool legacy = false;                      ///< from a file of version < 2: camelCase names, old spellings
    std::shared_ptr<const InputError> fault;  ///< found by reading; reported later (faults.h)

    /// Runs f; the InputError that it may throw becomes the element's fault, unless it has one already.
    template <typename F>
    bool guard(F&& f) {
        try {
            f();
            return true;
        } catch (const InputError& error) {
            if (!fault) fault = std::make_shared<const InputError>(error);
            return false;
        }
    }
    /// The value of an attribute, or null.
    const std::string* find(std::string_view name) const;
    /// The value of an attribute, or "".
    std::string get(std::string_view name) const;
    void set(std::string_view name, std::string value);
    void erase(std::string_view name);
    /// The child whose `name` attribute is `name`, or null.
    Element* child(std::string_view name);
    /// The first child with this tag, or null.
    Element* child_with_tag(std::string_view tag_name);
    /// A value element such as <float name="..." value="..."/>, standing where this element stands.
    Element make_value(std::string_view value_tag, std::string_view name, std::string value) const;
    /// Throws InputError for an attribute that is not in `known`.
    void check_attributes(const std::vector<std::string>& known) const;
    /// Throws InputError when the attribute is missing.
    const std::string& require(std::string_view name) const;
};

}  // namespace mote::core
