// Messages between the viewer's page and the program, whatever carries them: a WebSocket, or the channel of a
// notebook's widget.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace mote::viewer {

/// Text is JSON. Binary is a length in four bytes, little-endian, JSON of that length, and the payload.
struct Message {
    bool binary = false;
    std::string bytes;
};
using SharedMessage = std::shared_ptr<const Message>;

SharedMessage text_message(const nlohmann::json& content);
/// The header is padded by spaces so that the payload starts at a multiple of four bytes.
SharedMessage binary_message(const nlohmann::json& header, std::string_view payload);

}  // namespace mote::viewer
