// Answers that take a while, each to the client that wants it.
#include <nlohmann/json.hpp>

#include "core/formats/conversion/scratch_folder.h"
#include "core/formats/pictures/image_file.h"
#include "core/objects/error.h"
#include "session/layers.h"
#include "session/number_or_null.h"
#include "session/output_files.h"
#include "session/render_report.h"
#include "viewer/message_values.h"
#include "viewer/pixel_light.h"
#include "viewer/scene_knobs.h"
#include "viewer/view.h"

namespace mote::viewer {

using core::InputError;
using nlohmann::json;

namespace {

/// Values of every layer at a pixel. Throws InputError outside of the image.
json values_at(const core::ImageChannels& image, int x, int y) {
    if (x < 0 || y < 0 || x >= image.width || y >= image.height)
        throw InputError("the pixel is outside of the image");
    const std::size_t p = std::size_t(y) * std::size_t(image.width) + std::size_t(x);
    json list = json::array();
    for (const session::LayerChannels& layer : session::layers_of(image)) {
        json values = json::array();
        for (const std::size_t plane : layer.planes)
            values.push_back(session::number_or_null(double(image.channels[plane][p])));
        list.push_back({{"layer", layer.name}, {"channels", layer.channels}, {"values", values}});
    }
    return list;
}

}  // namespace

/// Work in a thread of its own. Throws InputError where too much of it waits.
void View::later(int client, std::function<void()> task) {
    tasks_.add([this, client, task = std::move(task)] {
        try {
            task();
        } catch (const std::exception& error) {
            send_(client, text_message({{"type", "refused"}, {"text", core::printable(error.what(), 300)}}));
        }
    });
}

View::Shown View::shown(const std::string& name) const {
    const std::lock_guard lock(mutex_);
    return find(name);
}

/// The scene as a render shows it. Throws InputError where the picture is from a file.
session::LoadedScene View::scene_of(const Shown& shown) const {
    if (!shown.wish) throw InputError("a picture from a file has no scene");
    LiveRender* render = nullptr;  // stays until the view's end
    {
        const std::lock_guard lock(mutex_);
        render = renders_.at(first_render).get();
    }
    return render->scene_for(shown.wish->changes);
}

void View::answer_pixel(int client, const json& message) {
    const auto name = member<std::string>(message, "picture");
    const int x = member<int>(message, "x"), y = member<int>(message, "y");
    later(client, [this, client, name, x, y, shown = shown(name)] {
        json answer = {{"type", "pixel"}, {"picture", name}, {"x", x}, {"y", y}, {"values", json::array()}};
        if (shown.picture && !shown.picture->coarse) answer["values"] = values_at(shown.picture->image, x, y);
        if (shown.wish) answer["light"] = pixel_light(scene_of(shown), x, y, shown.wish->seed);
        send_(client, text_message(answer));
    });
}

void View::answer_lights(int client, const json& message) {
    const auto name = member<std::string>(message, "picture");
    later(client, [this, client, name, shown = shown(name)] {
        json answer = {{"type", "lights"}, {"picture", name}};
        answer.update(light_points(scene_of(shown), shown.wish->seed));
        send_(client, text_message(answer));
    });
}

std::vector<std::string> View::command_of(const Wish& wish, std::optional<std::uint32_t> passes) const {
    std::vector<std::string> words = {"mote", "render", scene_->scene().parts().file};
    for (std::string& option : session::command_options(wish.changes)) words.push_back(std::move(option));
    words.insert(words.end(), {"--seed", std::to_string(wish.seed)});
    if (passes) words.insert(words.end(), {"--passes", std::to_string(*passes), "-o", "view.exr"});
    return words;
}

void View::answer_reproduce(int client, const json& message) {
    const auto name = member<std::string>(message, "picture");
    const Shown shown = this->shown(name);
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
    const Shown shown = this->shown(name);
    if (!shown.wish) throw InputError("a picture from a file is saved already");
    const SharedPicture picture = shown.picture;
    if (!picture || picture->coarse) throw InputError("there is no picture of a whole pass yet");
    later(client, [this, client, name, picture] {
        send_(client, binary_message({{"type", "file"}, {"name", "view.exr"}, {"picture", name}},
                                     exr_bytes(*picture)));
    });
}

std::string View::exr_bytes(const LivePicture& picture) const {
    core::ImageChannels image = picture.image;
    image.metadata["seed"] = std::to_string(picture.wish.seed);
    image.metadata["passes"] = std::to_string(picture.passes);
    image.metadata["software"] = std::string("mote ") + MOTE_VERSION;
    image.metadata["commandLine"] = session::quoted(command_of(picture.wish, picture.passes));
    const core::ScratchFolder folder;
    const std::string file = folder.path() + "/view.exr";
    core::write_exr(file, image);
    return session::read_text(file);
}

/// The page of all live pictures against the reference, and its data.
void View::answer_compare(int client) {
    if (!reference_) throw InputError("a comparison needs --reference");
    Comparison comparison{scene_->scene().parts().file, *reference_, {}, 1};
    {
        const std::lock_guard lock(mutex_);
        for (const std::string& name : order_) {
            const Shown& shown = pictures_.at(name);
            if (!shown.wish || !shown.picture || shown.errors.empty()) continue;
            std::string type = shown.wish->changes.integrator;
            if (type.empty()) type = scene_->integrator().type();
            comparison.methods.push_back(
                {name, type, shown.picture, shown.errors, command_of(*shown.wish, std::nullopt)});
            comparison.threads = threads_of(*shown.wish);
        }
    }
    if (comparison.methods.empty()) throw InputError("there is no picture of the reference's size yet");
    later(client, [this, client, comparison] {
        for (const auto& [name, text] : page_->files(comparison))
            send_(client, binary_message({{"type", "file"}, {"name", name}}, text));
    });
}

}  // namespace mote::viewer
