// JSON with the line of every key and element, for messages that say where.
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/objects/error.h"

namespace mote::trade {

/// Every value costs a walk down to it, and many functions of the library call themselves for each level.
inline constexpr std::size_t max_json_depth = 64;

class JsonLines {
  public:
    /// Throws InputError with file and line for text that is not JSON, for a key that is given twice, and for
    /// lists or objects that are nested deeper than max_json_depth.
    JsonLines(const std::string& text, std::string path);
    const nlohmann::json& root() const { return root_; }
    /// Where the value behind a JSON pointer such as "/methods/0/name" stands (its key, or the element).
    core::SourceLocation where(const std::string& pointer) const;

  private:
    std::string path_;
    nlohmann::json root_;
    std::map<std::string, int> lines_;
};

}  // namespace mote::trade
