#include "viewer/view.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/objects/error.h"
#include "viewer/message_values.h"
#include "viewer/scene_knobs.h"
#include "viewer/wish_changes.h"

namespace mote::viewer {

using core::InputError;
using nlohmann::json;

namespace {

json changes_json(const Wish& wish) {
    json defines = json::object();
    for (const auto& [path, value] : wish.changes.defines) defines[path] = value;
    return {{"integrator", wish.changes.integrator},
            {"defines", defines},
            {"seed", wish.seed},
            {"passes", wish.passes}};
}

}  // namespace

View::View(Send send, std::unique_ptr<const ComparisonPage> page)
    : send_(std::move(send)), page_(std::move(page)) {}

View::~View() = default;

void View::show_scene(const session::LoadedScene& scene, const ViewSettings& settings) {
    const session::SceneChanges plain = outside_integrator(settings.changes);
    scene_ = scene.changes().integrator.empty() && scene.changes().defines == plain.defines
                 ? scene
                 : scene.reloaded(plain);
    Wish wish{settings.changes, settings.seed, settings.passes, settings.threads, false};
    {
        const std::lock_guard lock(mutex_);
        pictures_[first_render].wish = wish;
        order_.insert(order_.begin(), first_render);
    }
    renders_[first_render] = std::make_unique<LiveRender>(*scene_, reports_of(first_render));
    renders_[first_render]->render(wish);
}

void View::show_picture(const std::string& name, const core::ImageChannels& image) {
    auto picture = std::make_shared<LivePicture>();
    picture->image = image, picture->finished = true, picture->noise = core::infinity;
    const std::lock_guard lock(mutex_);
    if (!pictures_.contains(name)) order_.push_back(name);
    Shown& shown = pictures_[name];
    shown = {};
    shown.picture = std::move(picture), shown.version = 1;
}

void View::set_reference(const std::string& name, const core::ImageChannels& image) {
    reference_.emplace(name, image);
    show_picture(name, image);
}

/// A page that begins, perhaps again.
void View::greet(int client) {
    {
        const std::lock_guard lock(mutex_);
        clients_[client] = {};
        watching_ = int(clients_.size());
    }
    send_(client, text_message(scene_message()));
    send_frames(client);
}

void View::leave(int client) {
    const std::lock_guard lock(mutex_);
    clients_.erase(client);
    watching_ = int(clients_.size());
}

SharedPicture View::picture(const std::string& name) const {
    const std::lock_guard lock(mutex_);
    const auto found = pictures_.find(name);
    return found == pictures_.end() ? nullptr : found->second.picture;
}

json View::scene_message() const {
    json message = {{"type", "scene"},
                    {"version", MOTE_VERSION},
                    {"pictures", json::array()},
                    {"has_reference", reference_.has_value()}};
    std::map<std::string, Wish> wishes;
    {
        const std::lock_guard lock(mutex_);
        for (const std::string& name : order_) {
            const Shown& shown = pictures_.at(name);
            json entry = {{"name", name}, {"live", shown.wish.has_value()}};
            if (shown.wish) entry["changes"] = changes_json(*shown.wish), wishes[name] = *shown.wish;
            message["pictures"].push_back(std::move(entry));
        }
    }
    if (!scene_) return message;
    message["file"] = std::filesystem::path(scene_->scene().parts().file).filename().string();
    message["camera"] = camera_view(*scene_);
    message["sample_count"] = scene_->scene().film().sample_count;
    message["size"] = {scene_->scene().film().width, scene_->scene().film().height};
    for (const auto& [name, wish] : wishes)
        message["knobs"][name] = scene_knobs(elements_of(wish), scene_->registry());
    return message;
}

void View::receive(int client, std::string_view text) {
    std::string problem;
    try {
        const json message = json::parse(text);
        if (!message.is_object()) throw InputError("a message is a JSON object");
        handle(client, message);
        return;
    } catch (const json::exception&) {
        problem = "the message is no JSON";
    } catch (const std::exception& error) {
        problem = error.what();
    }
    send_(client, text_message({{"type", "refused"}, {"text", core::printable(problem, 300)}}));
}

void View::handle(int client, const json& message) {
    const auto type = member<std::string>(message, "type");
    if (type == "got") return confirm(client, message);
    if (type == "hello") return greet(client);
    if (type == "pixel") return answer_pixel(client, message);
    if (!scene_) throw InputError("pictures from files have nothing to change");
    if (type == "set") return set_values(message);
    if (type == "camera") return move_camera(message);
    if (type == "second") return set_second(message);
    if (type == "stop") return stop_all();
    if (type == "start") return start_all();
    if (type == "lights") return answer_lights(client, message);
    if (type == "reproduce") return answer_reproduce(client, message);
    if (type == "save") return answer_save(client, message);
    if (type == "compare") return answer_compare(client);
    throw InputError("there is no message '" + core::printable(type, 40) + "'");
}

const View::Shown& View::find(const std::string& name) const {
    const auto found = pictures_.find(name);
    if (found == pictures_.end()) throw InputError("there is no picture '" + core::printable(name, 40) + "'");
    return found->second;
}

}  // namespace mote::viewer
