#include "viewer/message.h"

#include <nlohmann/json.hpp>

namespace mote::viewer {

namespace {

std::string dumped(const nlohmann::json& content) {  // file names need not be UTF-8
    return content.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

SharedMessage text_message(const nlohmann::json& content) {
    return std::make_shared<const Message>(Message{false, dumped(content)});
}

SharedMessage binary_message(const nlohmann::json& header, std::string_view payload) {
    std::string text = dumped(header);
    text.append((4 - text.size() % 4) % 4, ' ');
    std::string bytes;
    bytes.reserve(4 + text.size() + payload.size());
    for (int i = 0; i < 4; ++i) bytes += char((text.size() >> (8 * i)) & 0xff);
    bytes += text;
    bytes += payload;
    return std::make_shared<const Message>(Message{true, std::move(bytes)});
}

}  // namespace mote::viewer
