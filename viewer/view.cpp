#include "viewer/view.h"

#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/formats/gltf/scratch_folder.h"
#include "core/formats/pictures/image_file.h"
#include "core/objects/error.h"
#include "session/layers.h"
#include "session/output_files.h"
#include "session/render_report.h"
#include "viewer/frame.h"
#include "viewer/pixel_light.h"
#include "viewer/scene_knobs.h"
#include "viewer/wish_changes.h"

namespace mote::viewer {

namespace {

using core::InputError;
using nlohmann::json;

/// The names of renders.
const std::string first = "A", second = "B";
constexpr std::size_t max_tasks = 16;

json number_or_null(double value) { return std::isfinite(value) ? json(value) : json(); }

/// A member of a message. Throws InputError where it is missing or of another type.
template <typename T>
T member(const json& message, const char* name) {
    const auto found = message.find(name);
    if (found == message.end()) throw InputError(std::string("the message has no '") + name + "'");
    try {
        return found->get<T>();
    } catch (const json::exception&) {
        throw InputError(std::string("'") + name + "' of the message has the wrong type");
    }
}

json changes_json(const Wish& wish) {
    json defines = json::object();
    for (const auto& [path, value] : wish.changes.defines) defines[path] = value;
    return {{"integrator", wish.changes.integrator},
            {"defines", defines},
            {"seed", wish.seed},
            {"passes", wish.passes}};
}

}  // namespace

View::View(Send send) : send_(std::move(send)), worker_([this] { work(); }) {}

View::~View() {
    {
        const std::lock_guard lock(mutex_);
        quit_ = true;
    }
    task_added_.notify_all();
    worker_.join();
    renders_.clear();
}

void View::show_scene(const session::LoadedScene& scene, const ViewSettings& settings) {
    const session::SceneChanges plain = outside_integrator(settings.changes);
    scene_ = scene.changes().integrator.empty() && scene.changes().defines == plain.defines
                 ? scene
                 : scene.reloaded(plain);
    Wish wish{settings.changes, settings.seed, settings.passes, settings.threads, false};
    {
        const std::lock_guard lock(mutex_);
        pictures_[first].wish = wish;
        order_.insert(order_.begin(), first);
    }
    renders_[first] = std::make_unique<LiveRender>(*scene_, reports_of(first));
    renders_[first]->render(wish);
}

void View::show_picture(const std::string& name, const core::ImageChannels& image) {
    auto picture = std::make_shared<LivePicture>();
    picture->image = image, picture->finished = true, picture->noise = core::infinity;
    const std::lock_guard lock(mutex_);
    if (!pictures_.contains(name)) order_.push_back(name);
    pictures_[name] = {std::nullopt, std::move(picture), 1, nullptr};
}

void View::set_reference(const std::string& name, const core::ImageChannels& image) {
    Reference reference{image.rgb(""), {}, image.width, image.height};
    if (reference.pixels.empty() ||
        !std::ranges::all_of(reference.pixels, [](const core::Rgb& c) { return core::is_finite(c); }))
        throw InputError("a reference has finite R, G and B", {name, 0});
    reference.weights = core::relative_weights(reference.pixels);
    reference_ = std::move(reference);
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
    SharedMessage frame;
    if (watching_ > 0) frame = encode_frame(picture->image, frame_header(name, *picture));
    std::vector<int> clients;
    {
        const std::lock_guard lock(mutex_);
        const auto shown = pictures_.find(name);
        if (shown == pictures_.end()) return;
        shown->second.picture = picture, shown->second.frame = frame;
        ++shown->second.version;
        for (const auto& [client, state] : clients_) clients.push_back(client);
    }
    for (const int client : clients) send_frames(client);
}

json View::frame_header(const std::string& name, const LivePicture& p) const {
    json header = {{"type", "frame"},    {"picture", name},       {"change", p.change},
                   {"passes", p.passes}, {"seconds", p.seconds},  {"noise", number_or_null(p.noise)},
                   {"coarse", p.coarse}, {"finished", p.finished}};
    if (const auto stated = session::stated_error(p.image.metadata))
        header["stated"] = {stated->low, stated->high};
    if (reference_ && !p.coarse && p.image.width == reference_->width &&
        p.image.height == reference_->height) {
        const std::vector<core::Rgb> pixels = p.image.rgb("");
        if (!pixels.empty()) {
            const core::RelativeError e =
                core::relative_error(pixels, reference_->pixels, reference_->weights);
            header["error"] = number_or_null(e.error), header["bias"] = number_or_null(e.bias);
        }
    }
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
                shown.frame = encode_frame(shown.picture->image, frame_header(name, *shown.picture));
            state.sent[name] = shown.version;
            ready.push_back(shown.frame);
        }
    }
    for (const SharedMessage& frame : ready) send_(client, frame);
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

/// The page changes nothing else: no file can be named by it. Throws InputError.
void View::require_knob(const std::string& path, const Wish& wish) const {
    if (path == "film.width" || path == "film.height") return;
    for (const json& group : scene_knobs(elements_of(wish), scene_->registry()))
        for (const json& knob : group["knobs"])
            if (knob["path"] == path) return;
    throw InputError("'" + core::printable(path, 60) + "' is no knob");
}

core::Element View::elements_of(const Wish& wish) const { return changed_elements(*scene_, wish.changes); }

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
    if (type == "reproduce") return answer_reproduce(client, message);
    if (type == "save") return answer_save(client, message);
    throw InputError("there is no message '" + core::printable(type, 40) + "'");
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

/// Parameters of the integrator are those of one picture, all others belong to the scene of both.
void View::set_values(const json& message) {
    const auto name = message.contains("picture") ? member<std::string>(message, "picture") : first;
    const json defines = message.value("define", json::object());
    if (!defines.is_object()) throw InputError("'define' is no object");
    {
        const std::lock_guard lock(mutex_);
        if (!find(name).wish) throw InputError("'" + core::printable(name, 40) + "' is no render");
        std::map<std::string, Wish> wishes;  // changed together or not at all
        for (const auto& [other, shown] : pictures_)
            if (shown.wish) wishes[other] = *shown.wish;
        if (message.contains("integrator"))
            set_integrator(wishes.at(name).changes, member<std::string>(message, "integrator"));
        for (const auto& [path, value] : defines.items()) {
            if (!value.is_null()) require_knob(path, wishes.at(name));
            for (auto& [other, wish] : wishes)
                if (other == name || !is_of_integrator(path)) set_define(wish.changes, path, value);
        }
        for (auto& [other, wish] : wishes) {
            if (message.contains("seed")) wish.seed = member<std::uint64_t>(message, "seed");
            if (message.contains("passes")) wish.passes = member<std::uint32_t>(message, "passes");
            wish.moving = false;
            pictures_.at(other).wish = wish;
        }
    }
    start_all();
    broadcast(scene_message());
}

void View::move_camera(const json& message) {
    const auto view = member<std::vector<double>>(message, "view");
    if (view.size() != 9 || !std::ranges::all_of(view, [](double v) { return std::isfinite(v); }))
        throw InputError("'view' is no list of nine numbers: origin, target, up");
    std::string text;
    for (const double v : view) text += (text.empty() ? "" : " ") + fmt::format("{:.9g}", v);
    const bool moving = message.value("moving", json(false)) == true;
    {
        const std::lock_guard lock(mutex_);
        for (auto& [name, shown] : pictures_) {
            if (!shown.wish) continue;
            set_define(shown.wish->changes, "sensor.to_world", text);
            shown.wish->moving = moving;
        }
    }
    start_all();
}

/// A second method beside the first one, each on half of the threads; null: no more.
void View::set_second(const json& message) {
    const bool off = !message.contains("integrator") || message["integrator"].is_null();
    if (off) {
        std::unique_ptr<LiveRender> ended;
        {
            const std::lock_guard lock(mutex_);
            pictures_.erase(second);
            std::erase(order_, second);
            if (const auto found = renders_.find(second); found != renders_.end())
                ended = std::move(found->second), renders_.erase(found);
        }
    } else {
        const auto type = member<std::string>(message, "integrator");
        const std::lock_guard lock(mutex_);
        Wish wish = *pictures_.at(first).wish;
        set_integrator(wish.changes, type);
        if (!pictures_.contains(second)) order_.insert(order_.begin() + 1, second);
        pictures_[second].wish = wish;
        if (!renders_.contains(second))
            renders_[second] = std::make_unique<LiveRender>(*scene_, reports_of(second));
    }
    start_all();
    broadcast(scene_message());
}

void View::stop_all() {
    const std::lock_guard lock(mutex_);
    for (const auto& [name, render] : renders_) render->stop();
}

void View::start_all() {
    const std::lock_guard lock(mutex_);
    for (const auto& [name, render] : renders_) {
        Wish wish = *pictures_.at(name).wish;
        const int threads = wish.threads > 0 ? wish.threads : tbb::info::default_concurrency();
        if (renders_.size() > 1) wish.threads = std::max(1, threads / 2);
        render->render(wish);
    }
}

const View::Shown& View::find(const std::string& name) const {
    const auto found = pictures_.find(name);
    if (found == pictures_.end()) throw InputError("there is no picture '" + core::printable(name, 40) + "'");
    return found->second;
}

void View::answer_pixel(int client, const json& message) {
    const auto name = member<std::string>(message, "picture");
    const int x = member<int>(message, "x"), y = member<int>(message, "y");
    Shown shown;
    LiveRender* render = nullptr;
    {
        const std::lock_guard lock(mutex_);
        shown = find(name);
        if (shown.wish) render = renders_.at(first).get();
    }
    later(client, [this, client, name, x, y, shown, render] {
        json answer = {{"type", "pixel"}, {"picture", name}, {"x", x}, {"y", y}, {"values", json::array()}};
        if (shown.picture && !shown.picture->coarse) {
            const core::ImageChannels& image = shown.picture->image;
            if (x < 0 || y < 0 || x >= image.width || y >= image.height)
                throw InputError("the pixel is outside of the image");
            const std::size_t p = std::size_t(y) * std::size_t(image.width) + std::size_t(x);
            for (const session::LayerChannels& layer : session::layers_of(image)) {
                json values = json::array();
                for (const std::size_t plane : layer.planes)
                    values.push_back(number_or_null(double(image.channels[plane][p])));
                answer["values"].push_back(
                    {{"layer", layer.name}, {"channels", layer.channels}, {"values", values}});
            }
        }
        if (shown.wish) {
            const session::LoadedScene scene = render->scene_for(shown.wish->changes);
            answer["light"] = pixel_light(scene.scene(), elements_of(*shown.wish), x, y, shown.wish->seed);
        }
        send_(client, text_message(answer));
    });
}

std::vector<std::string> View::command_of(const Wish& wish, std::uint32_t passes) const {
    std::vector<std::string> words = {"mote", "render", scene_->scene().parts().file};
    if (!wish.changes.integrator.empty())
        words.insert(words.end(), {"--integrator", wish.changes.integrator});
    for (const std::string& define : session::define_texts(wish.changes))
        words.insert(words.end(), {"-D", define});
    if (wish.changes.lenient) words.emplace_back("--lenient");
    words.insert(words.end(),
                 {"--seed", std::to_string(wish.seed), "--passes", std::to_string(passes), "-o", "view.exr"});
    return words;
}

void View::answer_reproduce(int client, const json& message) {
    const auto name = member<std::string>(message, "picture");
    Shown shown;
    {
        const std::lock_guard lock(mutex_);
        shown = find(name);
    }
    if (!shown.wish || !shown.picture || shown.picture->coarse || shown.picture->passes == 0)
        throw InputError("there is no picture of a whole pass yet");
    send_(client,
          text_message({{"type", "reproduce"},
                        {"picture", name},
                        {"command", session::quoted(command_of(shown.picture->wish, shown.picture->passes))},
                        {"xml", scene_xml(elements_of(shown.picture->wish))}}));
}

void View::answer_save(int client, const json& message) {
    const auto name = member<std::string>(message, "picture");
    SharedPicture picture;
    {
        const std::lock_guard lock(mutex_);
        picture = find(name).picture;
    }
    if (!picture || picture->coarse) throw InputError("there is no picture of a whole pass yet");
    later(client, [this, client, name, picture] {
        core::ImageChannels image = picture->image;
        image.metadata["seed"] = std::to_string(picture->wish.seed);
        image.metadata["passes"] = std::to_string(picture->passes);
        image.metadata["software"] = std::string("mote ") + MOTE_VERSION;
        image.metadata["commandLine"] = session::quoted(command_of(picture->wish, picture->passes));
        const core::ScratchFolder folder;
        const std::string file = folder.path() + "/view.exr";
        core::write_exr(file, image);
        send_(client, binary_message({{"type", "file"}, {"name", "view.exr"}, {"picture", name}},
                                     session::read_text(file)));
    });
}

/// Work that takes a while, in a thread of its own. Throws InputError where too much of it waits.
void View::later(int client, std::function<void()> task) {
    {
        const std::lock_guard lock(mutex_);
        if (tasks_.size() >= max_tasks) throw InputError("too many questions at once");
        tasks_.push_back([this, client, task = std::move(task)] {
            try {
                task();
            } catch (const std::exception& error) {
                send_(client,
                      text_message({{"type", "refused"}, {"text", core::printable(error.what(), 300)}}));
            }
        });
    }
    task_added_.notify_one();
}

void View::work() {
    for (;;) {
        std::function<void()> task;
        {
            std::unique_lock lock(mutex_);
            task_added_.wait(lock, [&] { return quit_ || !tasks_.empty(); });
            if (quit_) return;
            task = std::move(tasks_.front());
            tasks_.pop_front();
        }
        task();
    }
}

}  // namespace mote::viewer
