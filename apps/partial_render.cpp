// The text of a partial film is JSON, so that the cluster's front end can look at it as well.
#include "apps/partial_render.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "core/objects/error.h"
#include "core/render/partial_film.h"
#include "session/render_report.h"

namespace mote::apps {

namespace {

using nlohmann::json;

json statistics_of(const core::Statistics& s) {
    json values = json::object();
    for (const auto& [name, value] : s.values)
        if (std::isfinite(value)) values[name] = value;
    return {{"rays", s.rays},
            {"lookups", s.lookups},
            {"seconds", s.seconds},
            {"values", values},
            {"warnings", s.warnings},
            {"non_finite_samples", s.non_finite_samples},
            {"clamped", s.clamped_samples}};
}

core::Statistics read_statistics(const json& j) {
    core::Statistics s;
    j.at("rays").get_to(s.rays), j.at("lookups").get_to(s.lookups), j.at("seconds").get_to(s.seconds);
    j.at("values").get_to(s.values), j.at("warnings").get_to(s.warnings);
    j.at("non_finite_samples").get_to(s.non_finite_samples), j.at("clamped").get_to(s.clamped_samples);
    return s;
}

json about(const MergedFilm& m) {
    const RenderArguments& a = m.render;
    return {{"mote", MOTE_VERSION},
            {"commit", git_hash()},
            {"scene", a.scene.scene},
            {"asked_integrator", a.scene.integrator},
            {"defines", a.scene.defines},
            {"lenient", a.scene.lenient},
            {"auxiliary", a.auxiliary},
            {"denoise", a.denoise},
            {"half", a.half},
            {"seed", a.seed},
            {"integrator", m.integrator},
            {"content", m.content_hash},
            {"passes", {m.first, m.end}},
            {"statistics", statistics_of(m.statistics)}};
}

/// What must be alike in all of them, and how it is called, in the order in which it is looked at: what is
/// more likely the reason comes first.
const std::pair<const char*, const char*> alike[] = {
    {"mote", "versions of mote"},
    {"commit", "builds of mote"},
    {"seed", "seeds"},
    {"integrator", "integrators"},
    {"defines", "definitions (-D)"},
    {"lenient", "settings of --lenient"},
    {"auxiliary", "settings of --auxiliary"},
    {"denoise", "settings of --denoise"},
    {"content", "contents of the scene or of a file that it names"}};

struct Read {
    std::string path;
    json text;
    MergedFilm merged;
};

Read read(const std::string& path) {
    core::PartialFilm partial = core::read_partial_film(path);
    try {
        const json j = json::parse(partial.about);
        RenderArguments a;
        j.at("scene").get_to(a.scene.scene), j.at("asked_integrator").get_to(a.scene.integrator);
        j.at("defines").get_to(a.scene.defines), j.at("lenient").get_to(a.scene.lenient);
        j.at("auxiliary").get_to(a.auxiliary), j.at("denoise").get_to(a.denoise), j.at("half").get_to(a.half);
        j.at("seed").get_to(a.seed);
        MergedFilm merged{std::move(partial.film),
                          a,
                          j.at("integrator"),
                          j.at("content"),
                          read_statistics(j.at("statistics")),
                          j.at("passes").at(0),
                          j.at("passes").at(1)};
        if (merged.film.first_pass() != merged.first || merged.film.pass_count() != merged.end - merged.first)
            throw core::InputError("this file is damaged: it holds other passes than it says", {path, 0});
        return {path, j, std::move(merged)};
    } catch (const json::exception&) {
        throw core::InputError("this file is damaged: what it says of its render cannot be read", {path, 0});
    }
}

std::string short_text(const json& value) {
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    return "'" + core::printable(text, 60) + "'";
}

void check_same_render(const Read& a, const Read& b) {
    for (const auto& [key, name] : alike)
        if (a.text.value(key, json()) != b.text.value(key, json()))
            throw core::InputError(
                fmt::format("of another render than '{}': {} differ, {} and {}", core::printable(a.path, 300),
                            name, short_text(b.text.value(key, json())),
                            short_text(a.text.value(key, json()))),
                {b.path, 0});
}

std::string passes_text(std::uint32_t first, std::uint32_t end) {
    return end == first + 1 ? fmt::format("pass {}", first) : fmt::format("passes {} to {}", first, end - 1);
}

void check_order(const Read& a, const Read& b) {
    const std::uint32_t end = a.merged.end, first = b.merged.first;
    if (first > end)
        throw core::InputError(fmt::format("before {} of '{}' {} {} missing: '{}' ends there",
                                           passes_text(first, b.merged.end), core::printable(b.path, 300),
                                           passes_text(end, first), first == end + 1 ? "is" : "are",
                                           core::printable(a.path, 300)));
    if (first < end) {
        const std::uint32_t last = std::min(end, b.merged.end);
        throw core::InputError(fmt::format("'{}' and '{}' both hold {}", core::printable(a.path, 300),
                                           core::printable(b.path, 300), passes_text(first, last)));
    }
}

bool ends_with(const std::string& text, const std::string& end) {
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Is a value of the statistics a count, or a time, that grows with every pass?
bool adds_up(const std::string& name) {
    static const std::set<std::string> fixed = {
        "bound", "texels", "texels_per_metre", "charts", "points", "sphere_radius_mean", "shadow_maps"};
    return !fixed.contains(name) && !ends_with(name, "_bytes") && !ends_with(name, "_peak");
}

}  // namespace

void add_statistics(core::Statistics& sum, const core::Statistics& more) {
    for (const auto& [name, count] : more.rays) sum.rays[name] += count;
    for (const auto& [name, count] : more.lookups) sum.lookups[name] += count;
    for (const auto& [name, seconds] : more.seconds) sum.seconds[name] += seconds;
    for (const auto& [name, value] : more.values) {
        if (name == "noise" || name == "varianceGain") continue;  // of the sum, which its film knows
        if (adds_up(name))
            sum.values[name] += value;
        else  // settings are the same everywhere; of what memory takes, the most
            sum.values[name] = std::max(sum.values.contains(name) ? sum.values[name] : value, value);
    }
    for (const std::string& warning : more.warnings)
        if (std::ranges::find(sum.warnings, warning) == sum.warnings.end()) sum.warnings.push_back(warning);
    sum.non_finite_samples += more.non_finite_samples;
    sum.clamped_samples += more.clamped_samples;
}

std::string identity_json(const RenderArguments& render, const core::Scene& scene,
                          const core::Integrator& integrator, const std::string& content_hash) {
    std::size_t parts = 1;
    for (const core::Layer& layer : integrator.layers(scene)) parts = std::max(parts, layer.part + 1);
    const json j = {{"mote", MOTE_VERSION},
                    {"commit", git_hash()},
                    {"seed", render.seed},
                    {"integrator", integrator.type()},
                    {"content", content_hash},
                    {"parts", parts},
                    {"sample_count", scene.film().sample_count}};
    return j.dump() + "\n";
}

void write_partial(const std::string& path, const MergedFilm& partial) {
    // File names need not be UTF-8.
    core::write_partial_film(
        path, {about(partial).dump(-1, ' ', false, json::error_handler_t::replace), partial.film});
}

MergedFilm merge_partials(const std::vector<std::string>& paths) {
    // One film after the other is read whole: heads alone would do for the order, but a film that fits into
    // memory once fits twice.
    std::vector<std::pair<std::uint32_t, std::string>> order;
    std::optional<Read> first;
    for (const std::string& path : paths) {
        Read one = read(path);
        if (first) check_same_render(*first, one);
        order.emplace_back(one.merged.first, path);
        if (!first) first = std::move(one);
    }
    std::ranges::stable_sort(order, {}, &std::pair<std::uint32_t, std::string>::first);
    Read sum = order.front().second == first->path ? std::move(*first) : read(order.front().second);
    for (std::size_t i = 1; i < order.size(); ++i) {
        Read next = read(order[i].second);
        check_order(sum, next);
        sum.merged.film.add(next.merged.film);
        add_statistics(sum.merged.statistics, next.merged.statistics);
        sum.merged.end = next.merged.end;
        sum.path = next.path;
    }
    return std::move(sum.merged);
}

}  // namespace mote::apps
