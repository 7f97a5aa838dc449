// Changes to what is rendered, as messages of a page wish them.
#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/objects/error.h"
#include "viewer/message_values.h"
#include "viewer/scene_knobs.h"
#include "viewer/view.h"
#include "viewer/wish_changes.h"

namespace mote::viewer {

using core::InputError;
using nlohmann::json;

/// The page changes nothing else: no file can be named by it. Throws InputError.
void View::require_knob(const std::string& path, const Wish& wish) const {
    if (path == "film.width" || path == "film.height") return;
    for (const json& group : scene_knobs(elements_of(wish), scene_->registry()))
        for (const json& knob : group["knobs"])
            if (knob["path"] == path) return;
    throw InputError("'" + core::printable(path, 60) + "' is no knob");
}

core::Element View::elements_of(const Wish& wish) const { return changed_elements(*scene_, wish.changes); }

/// Parameters of the integrator are those of one picture, all others belong to the scene of both.
void View::set_values(const json& message) {
    const auto name = message.contains("picture") ? member<std::string>(message, "picture") : first_render;
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
            pictures_.erase(second_render);
            std::erase(order_, second_render);
            if (const auto found = renders_.find(second_render); found != renders_.end())
                ended = std::move(found->second), renders_.erase(found);
        }
    } else {
        const auto type = member<std::string>(message, "integrator");
        const std::lock_guard lock(mutex_);
        Wish wish = *pictures_.at(first_render).wish;
        set_integrator(wish.changes, type);
        if (!pictures_.contains(second_render)) order_.insert(order_.begin() + 1, second_render);
        pictures_[second_render].wish = wish;
        if (!renders_.contains(second_render))
            renders_[second_render] = std::make_unique<LiveRender>(*scene_, reports_of(second_render));
    }
    start_all();
    broadcast(scene_message());
}

void View::stop_all() {
    const std::lock_guard lock(mutex_);
    for (const auto& [name, render] : renders_) render->stop();
}

int View::threads_of(const Wish& wish) const {
    const int threads = wish.threads > 0 ? wish.threads : tbb::info::default_concurrency();
    return renders_.size() > 1 ? std::max(1, threads / 2) : threads;
}

void View::start_all() {
    const std::lock_guard lock(mutex_);
    for (const auto& [name, render] : renders_) {
        Wish wish = *pictures_.at(name).wish;
        if (renders_.size() > 1) wish.threads = threads_of(wish);
        render->render(wish);
    }
}

}  // namespace mote::viewer
