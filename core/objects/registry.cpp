// The table of types: one entry per (category, type) with its manual page and factory.
#include "core/objects/registry.h"

#include <array>
#include <stdexcept>

#include "core/objects/properties.h"

namespace mote::core {
namespace {

const std::array<std::string, category_count>& category_names() {
    static const std::array<std::string, category_count> names = {
        "bsdf",   "texture", "shape",  "emitter",    "sensor",       "film",       "rfilter",  "sampler",
        "medium", "phase",   "volume", "integrator", "compensation", "visibility", "selection"};
    return names;
}

}  // namespace

const std::string& category_name(Category category) {
    return category_names().at(static_cast<std::size_t>(category));
}

std::optional<Category> find_category(std::string_view name) {
    for (std::size_t i = 0; i < category_names().size(); ++i)
        if (category_names()[i] == name) return static_cast<Category>(i);
    return std::nullopt;
}

void Registry::add(Manual manual, Factory factory) {
    const auto key = std::make_pair(manual.category, manual.type);
    if (!factory) throw std::logic_error("type '" + manual.type + "' has no factory");
    if (!entries_.emplace(key, Entry{std::move(manual), std::move(factory), {}}).second)
        throw std::logic_error(category_name(key.first) + " '" + key.second + "' is registered twice");
}

const Manual* Registry::find(Category category, const std::string& type) const {
    const auto it = entries_.find({category, type});
    return it == entries_.end() ? nullptr : &it->second.manual;
}

const Factory& Registry::factory(Category category, const std::string& type) const {
    const auto it = entries_.find({category, type});
    if (it == entries_.end())
        throw std::out_of_range("no " + category_name(category) + " of type '" + type + "'");
    return it->second.factory;
}

void Registry::set_file_memory(Category category, const std::string& type, FileMemory memory) {
    entries_.at({category, type}).file_memory = std::move(memory);
}

const FileMemory* Registry::file_memory(Category category, const std::string& type) const {
    const auto it = entries_.find({category, type});
    return it != entries_.end() && it->second.file_memory ? &it->second.file_memory : nullptr;
}

std::shared_ptr<Object> Registry::make(const Properties& properties) const {
    const Manual* manual = find(properties.category, properties.type);
    if (!manual)
        throw InputError("unknown " + category_name(properties.category) + " type '" +
                             printable(properties.type) + "'" +
                             suggestion(properties.type, types(properties.category)),
                         properties.where);
    for (const auto& [name, value] : properties.values) require_parameter(*manual, name, value.where);
    return factory(properties.category, properties.type)(properties);
}

const Parameter& require_parameter(const Manual& manual, const std::string& name,
                                   const SourceLocation& where) {
    std::vector<std::string> known;
    for (const Parameter& p : manual.parameters) {
        if (p.name == name) return p;
        known.push_back(p.name);
    }
    throw InputError(category_name(manual.category) + " '" + manual.type + "' has no parameter '" +
                         printable(name) + "'" + suggestion(name, known),
                     where);
}

std::vector<std::string> Registry::types(Category category) const {
    std::vector<std::string> result;
    for (const auto& [key, entry] : entries_)
        if (key.first == category) result.push_back(key.second);
    return result;
}

std::vector<const Manual*> Registry::manuals() const {
    std::vector<const Manual*> result;
    for (const auto& [key, entry] : entries_) result.push_back(&entry.manual);
    return result;
}

}  // namespace mote::core
