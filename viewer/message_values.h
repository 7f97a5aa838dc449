// Values of a message of the page.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/objects/error.h"

namespace mote::viewer {

/// A member of a message. Throws InputError where it is missing or of another type.
template <typename T>
T member(const nlohmann::json& message, const char* name) {
    const auto found = message.find(name);
    if (found == message.end()) throw core::InputError(std::string("the message has no '") + name + "'");
    try {
        return found->get<T>();
    } catch (const nlohmann::json::exception&) {
        throw core::InputError(std::string("'") + name + "' of the message has the wrong type");
    }
}

}  // namespace mote::viewer
