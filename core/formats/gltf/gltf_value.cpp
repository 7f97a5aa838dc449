// Checks of kind and range.
#include "core/formats/gltf/gltf_value.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/objects/error.h"

namespace mote::core {

void GltfValue::refuse(const std::string& message) const {
    throw InputError((place_.empty() ? "" : place_ + ": ") + message, {*file_, 0});
}

GltfValue GltfValue::operator[](std::string_view key) const {
    const std::string place = place_.empty() ? std::string(key) : place_ + "." + std::string(key);
    if (!json_) return {nullptr, place, *file_};
    if (!json_->is_object()) refuse("is no object");
    const auto it = json_->find(key);
    return {it == json_->end() || it->is_null() ? nullptr : &*it, place, *file_};
}

std::size_t GltfValue::size() const {
    if (!json_) return 0;
    if (!json_->is_array()) refuse("is no list");
    return json_->size();
}

GltfValue GltfValue::at(std::size_t i) const {
    if (i >= size()) refuse("has no element " + std::to_string(i));
    return {&(*json_)[i], place_ + "[" + std::to_string(i) + "]", *file_};
}

std::vector<std::string> GltfValue::keys() const {
    std::vector<std::string> names;
    if (!json_) return names;
    if (!json_->is_object()) refuse("is no object");
    for (const auto& [key, value] : json_->items()) names.push_back(key);
    return names;
}

double GltfValue::number(double default_value) const {
    if (!json_) return default_value;
    if (!json_->is_number()) refuse("is no number");
    const double value = json_->get<double>();
    if (!(std::fabs(value) <= double(std::numeric_limits<float>::max()))) refuse("is too large for a number");
    return value;
}

double GltfValue::number_in(double default_value, double lower, double upper) const {
    const double value = number(default_value);
    if (value < lower || value > upper) {
        char text[120];
        std::snprintf(text, sizeof(text), "is %g but must lie between %g and %g", value, lower, upper);
        refuse(text);
    }
    return value;
}

std::vector<double> GltfValue::numbers(std::vector<double> default_value) const {
    if (!json_) return default_value;
    if (size() != default_value.size())
        refuse("must be " + std::to_string(default_value.size()) + " numbers");
    for (std::size_t i = 0; i < default_value.size(); ++i) default_value[i] = at(i).number(0.0);
    return default_value;
}

std::string GltfValue::text(const std::string& default_value) const {
    if (!json_) return default_value;
    if (!json_->is_string()) refuse("is no text");
    return json_->get<std::string>();
}

bool GltfValue::flag(bool default_value) const {
    if (!json_) return default_value;
    if (!json_->is_boolean()) refuse("is neither true nor false");
    return json_->get<bool>();
}

std::uint64_t GltfValue::whole(std::uint64_t default_value) const {
    if (!json_) return default_value;
    if (!json_->is_number_unsigned()) refuse("is no whole number");
    return json_->get<std::uint64_t>();
}

std::optional<std::size_t> GltfValue::index_below(std::size_t count) const {
    if (!json_) return std::nullopt;
    const std::uint64_t index = whole(0);
    if (index >= count) refuse("is " + std::to_string(index) + ", but there are " + std::to_string(count));
    return std::size_t(index);
}

std::string GltfValue::title() const {
    const GltfValue name = (*this)["name"];
    return name.present() ? place_ + " '" + printable(name.text(), 60) + "'" : place_;
}

}  // namespace mote::core
