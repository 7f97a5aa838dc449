// One value of a glTF document, and where it stands there: "materials[3].emissiveFactor".
//
// A value that is not of the requested kind is an InputError with that place. A value that is not there
// is a value too: it has no members, is an empty list, and gives the defaults.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mote::core {

class GltfValue {
  public:
    /// `json` may be null; it must live as long as this. `file` is its name in messages.
    GltfValue(const nlohmann::json* json, std::string place, const std::string& file)
        : json_(json), place_(std::move(place)), file_(&file) {}

    bool present() const { return json_ != nullptr; }
    GltfValue operator[](std::string_view key) const;
    std::size_t size() const;
    GltfValue at(std::size_t i) const;
    std::vector<std::string> keys() const;

    /// Finite, and as a float too.
    double number(double default_value) const;
    double number_in(double default_value, double lower, double upper) const;
    /// Exactly as many numbers as `default_value` has.
    std::vector<double> numbers(std::vector<double> default_value) const;
    std::string text(const std::string& default_value = "") const;
    bool flag(bool default_value) const;
    std::uint64_t whole(std::uint64_t default_value) const;
    /// A number of something of which there are `count`; nothing where none is given.
    std::optional<std::size_t> index_below(std::size_t count) const;

    const std::string& place() const { return place_; }
    /// The place, and its name where it has one: "materials[3] 'Glass'".
    std::string title() const;
    [[noreturn]] void refuse(const std::string& message) const;

  private:
    const nlohmann::json* json_;
    std::string place_;
    const std::string* file_;
};

}  // namespace mote::core
