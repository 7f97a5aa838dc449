// Every element, attribute and parameter of a scene against the registry's manual pages.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/formats/xml/faults.h"
#include "core/formats/xml/scene_element.h"
#include "core/objects/registry.h"

namespace mote::core {

/// The manual page of an object element. Throws InputError for an unknown type, with the nearest one.
const Manual& require_manual(const Element& element, const Registry& registry);

/// Checks tags, attributes, types, parameter names and the kinds of values in the whole scene, and takes up
/// what reading found. Parameters that are known but have no effect here are removed with a warning.
void check_elements(Element& scene, const Registry& registry, std::vector<std::string>& warnings,
                    Faults& faults);
/// One value, reference or object below an element with this manual page. Throws InputError.
void check_child(const Element& child, const Manual& manual);

/// The elements with an id, <alias> included. Pointers into `scene`.
using IdTable = std::map<std::string, const Element*>;
/// An id that is given twice is a fault; the first holds.
IdTable collect_ids(const Element& scene, Faults& faults);
/// The table; throws InputError for an id that is given twice.
IdTable collect_ids(const Element& scene);
/// The element of a nested object: itself, or what a <ref> names. Throws InputError for an unknown id, with
/// the nearest one.
const Element& resolve(const Element& child, const IdTable& ids);

/// Checks that nested objects and references are of a category that their parent takes.
void check_references(const Element& scene, const IdTable& ids, const Registry& registry, Faults& faults);

/// Objects that every type of a category takes besides those of its manual page (a shape: bsdf, emitter,
/// medium).
const std::vector<Category>& common_children(Category category);
/// True if a type with this manual page has a place for `child`, a value or a nested object.
bool has_place_for(const Manual& manual, const Element& child);
/// The name under which a nested object of category `child` reaches the factory: its own, or, when it has
/// none or another, that of the only parameter of its category.
std::string parameter_for_child(const Manual& manual, Category child, const std::string& name);

}  // namespace mote::core
