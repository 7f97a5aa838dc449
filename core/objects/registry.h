// The registry: which types exist in each category, how each is made, and its manual page.
//
// Built once at start by calling register_core(), register_media(), ... (static registration gets lost in
// static libraries). The scene loader depends on the registry alone; docs/scene-format.md is generated from
// it.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/objects/error.h"
#include "core/objects/object.h"
#include "core/objects/parameter.h"

namespace mote::core {

class Properties;

/// The manual page and the factory of one type.
struct Manual {
    Category category;                  ///< what it is
    std::string type, summary;          ///< its name, and a sentence
    std::vector<Parameter> parameters;  ///< rows of the page
    std::string example;                ///< one XML element, parsed by a test
};

/// Makes an object of its parameters; throws InputError.
using Factory = std::function<std::shared_ptr<Object>(const Properties&)>;

/// The least that an object made of the file "filename" takes [B], as far as the file's header shows it; of the
/// parameters it has those that are text. Throws InputError.
using FileMemory = std::function<double(const Properties&)>;

/// The types of all categories, by name.
class Registry {
  public:
    /// Throws std::logic_error when (category, type) is there already.
    void add(Manual manual, Factory factory);
    /// Returns null when unknown.
    const Manual* find(Category category, const std::string& type) const;
    /// Throws std::out_of_range when unknown.
    const Factory& factory(Category category, const std::string& type) const;
    /// Makes what `properties` describe, for programs without a scene file: throws InputError for a type or a
    /// setting that does not exist, with the nearest name, and for a value that the factory refuses.
    std::shared_ptr<Object> make(const Properties& properties) const;
    /// For types with a parameter "filename". Throws std::out_of_range when the type is unknown.
    void set_file_memory(Category category, const std::string& type, FileMemory memory);
    /// Null where it is not known.
    const FileMemory* file_memory(Category category, const std::string& type) const;
    /// Names in alphabetical order.
    std::vector<std::string> types(Category category) const;
    std::vector<const Manual*> manuals() const;

  private:
    struct Entry {
        Manual manual;
        Factory factory;
        FileMemory file_memory = {};
    };
    std::map<std::pair<Category, std::string>, Entry> entries_;
};

/// The row called `name`; throws InputError with the nearest name where there is none.
const Parameter& require_parameter(const Manual& manual, const std::string& name,
                                   const SourceLocation& where);

/// Registers everything in core/: calls the three below, and adds film, samplers and filters.
void register_core(Registry& registry);
/// BSDFs and textures: core/materials/register_materials.cpp.
void register_materials(Registry& registry);  // core/materials/register_materials.cpp
/// Shapes: core/geometry/register_geometry.cpp.
void register_geometry(Registry& registry);  // core/geometry/register_geometry.cpp
/// Cameras: core/cameras/register_sensors.cpp.
void register_sensors(Registry& registry);  // core/cameras/register_sensors.cpp

/// "bsdf", "texture", ... and back; nothing for an unknown word.
const std::string& category_name(Category category);
/// The category of a word; nothing for an unknown one.
std::optional<Category> find_category(std::string_view name);

}  // namespace mote::core
