// Partial films, read and added up. The contents of such a file are not trusted.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/partial_render.h"
#include "core/objects/error.h"
#include "core/render/partial_film.h"

namespace mote::apps {

namespace {

using nlohmann::json;

/// A whole number from 0 on, of which JSON has more kinds than conversions are defined for.
template <typename T>
T whole(const json& j) {
    if (!j.is_number_unsigned() || j.get<std::uint64_t>() > std::numeric_limits<T>::max())
        throw core::InputError("no whole number");
    return j.get<T>();
}

std::map<std::string, std::uint64_t> counts(const json& j) {
    std::map<std::string, std::uint64_t> values;
    for (const auto& [name, value] : j.get_ref<const json::object_t&>())
        values[name] = whole<std::uint64_t>(value);
    return values;
}

core::Statistics read_statistics(const json& j) {
    core::Statistics s;
    s.rays = counts(j.at("rays")), s.lookups = counts(j.at("lookups"));
    j.at("seconds").get_to(s.seconds), j.at("values").get_to(s.values), j.at("warnings").get_to(s.warnings);
    s.non_finite_samples = whole<std::uint64_t>(j.at("non_finite_samples"));
    s.clamped_samples = whole<std::uint64_t>(j.at("clamped"));
    return s;
}

/// Properties that must be alike in all of them, and their names, in the order in which they are compared:
/// what is more likely the reason comes first.
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
        json j = json::parse(partial.about);
        RenderArguments a;
        j.at("scene").get_to(a.scene.scene), j.at("requested_integrator").get_to(a.scene.integrator);
        j.at("defines").get_to(a.scene.defines), j.at("lenient").get_to(a.scene.lenient);
        a.scene.plugins = j.value("plugins", std::vector<std::string>());
        j.at("auxiliary").get_to(a.auxiliary), j.at("denoise").get_to(a.denoise), j.at("half").get_to(a.half);
        a.seed = whole<std::uint64_t>(j.at("seed"));
        for (const char* name : {"mote", "commit"}) j.at(name).get_ref<const std::string&>();
        MergedFilm merged{std::make_shared<core::Film>(std::move(partial.film)),
                          a,
                          j.at("integrator").get<std::string>(),
                          j.at("content").get<std::string>(),
                          read_statistics(j.at("statistics")),
                          whole<std::uint32_t>(j.at("passes").at(0)),
                          whole<std::uint32_t>(j.at("passes").at(1))};
        if (merged.end < merged.first || merged.film->first_pass() != merged.first ||
            merged.film->pass_count() != merged.end - merged.first)
            throw core::InputError("it holds other passes than it says");
        return {path, std::move(j), std::move(merged)};  // copying would go as deep as it is nested
    } catch (const json::exception&) {
        throw core::InputError("this file is damaged: what it says of its render cannot be read", {path, 0});
    } catch (const core::InputError& error) {
        throw core::InputError(std::string("this file is damaged: ") + error.what(), {path, 0});
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

}  // namespace

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
        try {
            sum.merged.film->add(*next.merged.film);
        } catch (const std::invalid_argument&) {
            throw core::InputError(
                fmt::format("this file is damaged: its film does not continue where that of '{}' ends",
                            core::printable(sum.path, 300)),
                {order[i].second, 0});
        }
        add_statistics(sum.merged.statistics, next.merged.statistics);
        sum.merged.end = next.merged.end;
        sum.path = next.path;
    }
    return std::move(sum.merged);
}

}  // namespace mote::apps
