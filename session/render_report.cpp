// Metadata and statistics.
#include "session/render_report.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/film/film_image.h"
#include "git_hash.h"
#include "session/auxiliary_channels.h"
#include "session/in_scattered_feature.h"
#include "session/number_or_null.h"
#include "session/reference_metadata.h"

namespace mote::session {

namespace {

using nlohmann::json;

json entries_json(const std::vector<core::PlanEntry>& entries) {
    json list = json::array();
    for (const core::PlanEntry& e : entries)
        list.push_back({{"topic", e.topic}, {"choice", e.choice}, {"reason", e.reason}, {"cure", e.cure}});
    return list;
}

json error_json(const RenderReport& r) {
    if (const auto& e = r.result.error; e && std::isfinite(e->high))
        return {{"relative_rmse", e->error}, {"low", e->low}, {"high", e->high}, {"confidence", 0.95}};
    if (!r.plan.error_is_known()) return {{"unknown", r.plan.no_error_because()}};
    return {{"unknown", r.scene.film().interval ? "too few passes" : "film.interval is not set"}};
}

/// Steps that follow one another; every other entry is a part of one of them.
double total_seconds(const core::Statistics& statistics) {
    double total = 0.0;
    for (const char* step : {"load", "build", "render", "finish", "denoise"})
        if (const auto found = statistics.seconds.find(step); found != statistics.seconds.end())
            total += found->second;
    return total;
}

}  // namespace

std::string quoted(const std::vector<std::string>& command_line) {
    static const std::string plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
    std::string text;
    for (const std::string& word : command_line) {
        if (!text.empty()) text += ' ';
        if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) {
            text += word;
            continue;
        }
        text += '\'';
        for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
        text += '\'';
    }
    return text;
}

std::size_t peak_memory_bytes() {
    // getrusage() also counts the program that started this one.
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (std::size_t kilobytes = 0; word == "VmHWM:" && status >> kilobytes) return 1024 * kilobytes;
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return std::size_t(usage.ru_maxrss) * 1024;
}

double finished_fraction(std::span<const std::uint8_t> pixels) {
    return pixels.empty() ? 1.0 : double(std::count(pixels.begin(), pixels.end(), 1)) / double(pixels.size());
}

std::string git_hash() { return MOTE_GIT_HASH; }

/// As the driver found them, for it takes a while in large pictures; a picture of a trade has no driver.
static core::Film::GainAndNoise gain_and_noise(const core::RenderResult& result) {
    const auto& values = result.statistics.values;
    const auto gain = values.find("varianceGain"), noise = values.find("noise");
    if (gain == values.end() || noise == values.end()) return result.film.gain_and_noise();
    return {gain->second, noise->second};
}

core::ImageChannels make_picture(const RenderReport& report, const core::Registry& registry,
                                 const PictureExtras& extras) {
    core::ImageChannels image = core::film_image(report.result.film);
    image.metadata = picture_metadata(report);
    if (extras.auxiliary) add_center_channels(image, report.scene), add_ids(image, report.scene);
    if (extras.in_scattered && !report.result.interrupted) add_in_scattered(image, report.scene, registry);
    const std::span<const std::uint8_t> finished = report.result.finished_pixels;
    if (!finished.empty())  // those that no pass reached are transparent
        image.add("A", std::vector<float>(finished.begin(), finished.end()));
    return image;
}

void add_error(std::map<std::string, std::string>& metadata, const std::optional<core::PictureError>& error) {
    if (!error || !std::isfinite(error->high)) return;
    metadata["error"] = fmt::format("{:.6g}", error->error);
    metadata["errorInterval"] = fmt::format("{:.6g} {:.6g}", error->low, error->high);
}

std::optional<core::PictureError> stated_error(const std::map<std::string, std::string>& metadata) {
    const auto interval = metadata.find("errorInterval"), error = metadata.find("error");
    if (interval == metadata.end() || error == metadata.end()) return std::nullopt;
    core::PictureError stated;
    std::istringstream ends(interval->second), middle(error->second);
    if (!(ends >> stated.low >> stated.high) || !(middle >> stated.error)) return std::nullopt;
    return stated;
}

std::map<std::string, std::string> picture_metadata(const RenderReport& r) {
    std::map<std::string, std::string> metadata = {
        {"software", std::string("mote ") + MOTE_VERSION},
        {"integrator", r.plan.integrator},
        {"seed", std::to_string(r.seed)},
        {"passes", std::to_string(r.result.film.pass_count())},
        {"seconds", fmt::format("{:.3f}", total_seconds(r.result.statistics))},
        {"gitHash", git_hash()},
        {"sceneHash", r.scene_hash},
        {"sceneContent", r.scene_content},
        {"commandLine", quoted(r.command_line)},
        {"worldToCamera", world_to_camera(r.scene.camera())}};
    const auto [gain, noise] = gain_and_noise(r.result);
    if (r.result.film.pass_count() >= 2) metadata[variance_gain_key] = fmt::format("{:.6g}", gain);
    if (!r.result.finished_pixels.empty()) {
        metadata["passes"] = "0";
        metadata["partOfFirstPass"] = fmt::format("{:.6f} of the pixels; those that are missing have A = 0",
                                                  finished_fraction(r.result.finished_pixels));
    }
    if (r.result.finished_for)
        metadata["postProcessed"] =
            fmt::format("after {} passes, of {}", *r.result.finished_for, r.result.film.pass_count());
    const auto& values = r.result.statistics.values;
    if (const auto bound = values.find("bound"); bound != values.end())
        metadata["bound"] = fmt::format("{:.9g}", bound->second);  // for mote ssbc
    if (std::isfinite(noise)) metadata["noise"] = fmt::format("{:.6g}", noise);
    add_error(metadata, r.result.error);
    for (const core::PlanEntry& e : r.plan.runs)
        if (e.topic == "filter") metadata["filter"] = e.choice;  // with the version of a library
    for (const core::PlanEntry& e : r.plan.missing)
        metadata["leavesOut"] += (metadata["leavesOut"].empty() ? "" : ", ") + e.topic;
    for (const std::string& text : r.approximations)
        metadata["approximations"] += (metadata["approximations"].empty() ? "" : "\n") + text;
    return metadata;
}

std::string statistics_json(const RenderReport& r) {
    const core::Statistics& s = r.result.statistics;
    json values = json::object();
    for (const auto& [name, value] : s.values)
        if (name != "noise" && name != "varianceGain" && name != "vpls") values[name] = number_or_null(value);
    json warnings = json::array();
    for (const std::string& w : r.scene.parts().warnings) warnings.push_back(w);
    for (const std::string& w : s.warnings) warnings.push_back(w);

    json j;
    j["mote"] = MOTE_VERSION;
    j["git_hash"] = git_hash();
    j["scene"] = r.scene.parts().file;
    j["scene_hash"] = r.scene_hash;
    j["command_line"] = r.command_line;
    j["integrator"] = r.plan.integrator;
    j["plan"] = {{"runs", entries_json(r.plan.runs)},
                 {"left_out", entries_json(r.plan.left_out)},
                 {"missing", entries_json(r.plan.missing)},
                 {"costly", r.plan.costly}};
    j["width"] = r.result.film.width();
    j["height"] = r.result.film.height();
    j["seed"] = r.seed;
    j["threads"] = r.threads;
    j["passes"] = r.result.finished_pixels.empty() ? r.result.film.pass_count() : 0;
    if (!r.result.finished_pixels.empty())
        j["part_of_first_pass"] = finished_fraction(r.result.finished_pixels);
    for (std::size_t part = 0; part < r.result.film.parts() && r.result.film.parts() > 1; ++part) {
        const core::Film& film = r.result.film;
        json layers = json::array();
        for (const std::size_t i : film.layers_of(part)) layers.push_back(film.layers()[i].name);
        j["parts"].push_back(
            {{"layers", layers}, {"passes", film.pass_count(part)}, {"work", film.work(part)}});
    }
    j["resumed_at"] = r.result.resumed_at;
    j["interrupted"] = r.result.interrupted;
    if (r.result.finished_for) j["post_processed_after_passes"] = *r.result.finished_for;
    j["seconds"] = s.seconds;
    j["seconds"]["total"] = total_seconds(s);
    j["rays"] = s.rays;
    j["lookups"] = s.lookups;
    if (const auto vpls = s.values.find("vpls"); vpls != s.values.end()) j["vpls"] = vpls->second;
    j["values"] = values;
    j["peak_memory_bytes"] = peak_memory_bytes();
    j["noise"] = number_or_null(gain_and_noise(r.result).noise);
    j["error"] = error_json(r);
    j["warnings"] = warnings;
    j["approximations"] = r.approximations;
    j["non_finite_samples"] = s.non_finite_samples;
    j["clamped_samples"] = s.clamped_samples;
    // File names need not be UTF-8.
    return j.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace mote::session
