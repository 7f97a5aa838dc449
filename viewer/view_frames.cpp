// Images of the view on their way from renders to clients.
#include <nlohmann/json.hpp>

#include "session/number_or_null.h"
#include "session/render_report.h"
#include "viewer/frame.h"
#include "viewer/message_values.h"
#include "viewer/view.h"

namespace mote::viewer {

using nlohmann::json;
using session::number_or_null;

LiveRender::Reports View::reports_of(const std::string& name) {
    return {[this, name](const SharedPicture& picture) { take(name, picture); },
            [this, name](std::uint64_t change, const core::RenderProgress& p) {
                broadcast({{"type", "progress"},
                           {"picture", name},
                           {"change", change},
                           {"passes", p.passes},
                           {"passes_wanted", p.passes_wanted ? json(*p.passes_wanted) : json()},
                           {"seconds", p.seconds},
                           {"seconds_left", p.seconds_left < 0.0 ? json() : json(p.seconds_left)},
                           {"noise", number_or_null(p.noise)}});
            },
            [this, name](std::uint64_t change, const std::string& why) {
                broadcast({{"type", "problem"}, {"picture", name}, {"change", change}, {"text", why}});
            },
            [this] { return watching_ > 0; }};
}

/// A new picture of a render, in the render's thread.
void View::take(const std::string& name, const SharedPicture& picture) {
    std::optional<ErrorPoint> point;
    if (reference_ && !picture->coarse && reference_->fits(picture->image))
        point = {picture->passes, picture->seconds, reference_->error_of(picture->image)};
    SharedMessage frame;
    if (watching_ > 0) frame = encode_frame(picture->image, frame_header(name, *picture, point));
    std::vector<int> clients;
    {
        const std::lock_guard lock(mutex_);
        const auto shown = pictures_.find(name);
        if (shown == pictures_.end()) return;
        std::vector<ErrorPoint>& errors = shown->second.errors;
        if (shown->second.picture && shown->second.picture->change != picture->change) errors.clear();
        if (point && point->passes > 0) errors.push_back(*point);
        shown->second.picture = picture, shown->second.frame = frame;
        ++shown->second.version;
        for (const auto& [client, state] : clients_) clients.push_back(client);
    }
    for (const int client : clients) send_frames(client);
}

json View::frame_header(const std::string& name, const LivePicture& p,
                        const std::optional<ErrorPoint>& point) const {
    json header = {{"type", "frame"},    {"picture", name},       {"change", p.change},
                   {"passes", p.passes}, {"seconds", p.seconds},  {"noise", number_or_null(p.noise)},
                   {"coarse", p.coarse}, {"finished", p.finished}};
    if (const auto stated = session::stated_error(p.image.metadata))
        header["stated"] = {stated->low, stated->high};
    if (point)
        header["error"] = number_or_null(point->error.error),
        header["bias"] = number_or_null(point->error.bias);
    return header;
}

/// The frames that a client has not seen and is ready for.
void View::send_frames(int client) {
    std::vector<SharedMessage> ready;
    {
        const std::lock_guard lock(mutex_);
        const auto found = clients_.find(client);
        if (found == clients_.end()) return;
        Client& state = found->second;
        for (auto& [name, shown] : pictures_) {
            if (!shown.picture || state.sent[name] == shown.version ||
                state.confirmed[name] != state.sent[name])
                continue;
            if (!shown.frame)
                shown.frame =
                    encode_frame(shown.picture->image, frame_header(name, *shown.picture, shown.error()));
            state.sent[name] = shown.version;
            ready.push_back(shown.frame);
        }
    }
    for (const SharedMessage& frame : ready) send_(client, frame);
}

void View::confirm(int client, const json& message) {
    const auto name = member<std::string>(message, "picture");
    {
        const std::lock_guard lock(mutex_);
        const auto found = clients_.find(client);
        if (found == clients_.end() || !pictures_.contains(name)) return;
        found->second.confirmed[name] = found->second.sent[name];
    }
    send_frames(client);
}

void View::broadcast(const json& message) {
    std::vector<int> clients;
    {
        const std::lock_guard lock(mutex_);
        for (const auto& [client, state] : clients_) clients.push_back(client);
    }
    if (clients.empty()) return;
    const SharedMessage shared = text_message(message);
    for (const int client : clients) send_(client, shared);
}

}  // namespace mote::viewer
