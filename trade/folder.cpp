// trade.json, trade.csv and the checkpoints below.
#include "trade/folder.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

#include "core/objects/error.h"
#include "session/output_files.h"
#include "trade/json_lines.h"

namespace mote::trade {

namespace {

namespace fs = std::filesystem;
using core::InputError;
using nlohmann::json;

bool is_peer_file(const fs::path& path) {
    const std::string name = path.filename().string();
    const std::string ending = ".peer.csv";
    return name.size() > ending.size() && name.ends_with(ending);
}

std::vector<std::string> names_of(const std::vector<std::string>& slugs) {
    std::vector<std::string> names = {"trade.json",   "trade.csv",     "trade.svg", "trade.html",
                                      "summary.json", "reference.exr", "trade.txt"};
    for (const std::string& slug : slugs) names.push_back(slug + ".exr"), names.push_back(slug + ".json");
    return names;
}

/// True for the names of a method's checkpoints, "SLUG.seed1.film" and "SLUG.seed1.json".
bool is_checkpoint(const std::string& name, const std::string& slug) {
    const std::string before = slug + ".seed";
    return name.starts_with(before) && name.size() > before.size() && std::isdigit(name[before.size()]) &&
           (name.ends_with(".film") || name.ends_with(".json"));
}

}  // namespace

std::vector<std::string> Folder::file_names(const std::vector<Method>& methods) {
    std::vector<std::string> slugs;
    for (const Method& m : methods) slugs.push_back(m.slug);
    return names_of(slugs);
}

Folder::Folder(std::string path, const std::vector<Method>& methods, bool fresh) : Folder(std::move(path)) {
    std::error_code error;
    fs::create_directories(fs::path(path_), error);
    if (!fs::is_directory(path_, error))
        throw InputError("cannot be used as a folder" + (error ? ": " + error.message() : ""), {path_, 0});
    const std::vector<std::string> slugs = own_slugs();
    if (fresh) remove_earlier(slugs);
    std::vector<std::string> own;
    if (!slugs.empty()) own = names_of(slugs);
    for (const std::string& name : file_names(methods))
        if (has(name) && std::ranges::find(own, name) == own.end())
            throw InputError(
                "was not written by a trade of this folder, and is not replaced: move it or choose another "
                "folder",
                {file(name), 0});
}

Folder Folder::existing(const std::string& path) {
    Folder folder(path);
    if (!folder.has("trade.json"))
        throw InputError("there is no trade in this folder (no trade.json)", {path, 0});
    folder.load();
    if (folder.records_.empty()) throw InputError("this trade has no records yet", {path, 0});
    return folder;
}

std::string Folder::file(const std::string& name) const { return (fs::path(path_) / name).string(); }
bool Folder::has(const std::string& name) const { return fs::exists(file(name)); }
std::string Folder::checkpoint(const std::string& slug, std::uint64_t seed) const {
    return file("checkpoints/" + slug + ".seed" + std::to_string(seed));
}

void Folder::write(const std::string& name, const std::string& text) const {
    session::write_text(file(name), text);
}

std::string Folder::read(const std::string& name) const { return session::read_text(file(name)); }

void Folder::load() {
    const std::string text = read("trade.json");
    const auto damaged = [&] { return InputError("damaged: --fresh starts anew", {file("trade.json"), 0}); };
    try {
        const JsonLines parsed(text, file("trade.json"));
        inputs_ = parsed.root().at("inputs"), facts_ = parsed.root().at("facts");
    } catch (const json::exception&) {
        throw damaged();
    } catch (const InputError&) {
        throw damaged();
    }
    if (has("trade.csv")) records_ = records_from_csv(read("trade.csv"), file("trade.csv"));
}

void Folder::open(const Identity& identity) {
    if (has("trade.json")) {
        load();
        for (const auto& [key, value] : identity.inputs.items())
            if (!inputs_.contains(key) || inputs_[key] != value)
                throw InputError("holds a trade with other inputs (" + key +
                                     "): choose another folder, or start anew here with --fresh",
                                 {path_, 0});
    }
    inputs_ = identity.inputs, facts_ = identity.facts;
    const json all = {{"inputs", inputs_}, {"facts", facts_}};
    std::error_code error;
    fs::create_directories(file("checkpoints"), error);
    // Names need not be UTF-8.
    write("trade.json", all.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
}

/// Slugs of the methods that trade.json names; none where that is no file of a trade.
std::vector<std::string> Folder::own_slugs() const {
    std::vector<std::string> slugs;
    if (!has("trade.json")) return slugs;
    const json all = json::parse(
        read("trade.json"), [](int depth, json::parse_event_t, json&) { return depth < int(max_json_depth); },
        false);
    if (!all.is_object() || !all.contains("/inputs/mote"_json_pointer)) return slugs;
    for (const json& m : all.value("/facts/methods"_json_pointer, json::array()))
        if (m.is_object() && m.contains("slug") && m["slug"].is_string()) slugs.push_back(m["slug"]);
    return slugs;
}

void Folder::remove_earlier(const std::vector<std::string>& slugs) const {
    if (slugs.empty()) return;
    std::error_code ignored;
    for (const std::string& name : names_of(slugs)) fs::remove(file(name), ignored);
    for (const auto& entry : fs::directory_iterator(file("checkpoints"), ignored)) {
        const std::string name = entry.path().filename().string();
        if (std::ranges::any_of(slugs, [&](const auto& slug) { return is_checkpoint(name, slug); }))
            fs::remove(entry.path(), ignored);
    }
    remove_checkpoints();
}

void Folder::remove_checkpoints() const {
    std::error_code ignored;
    fs::remove(file("checkpoints"), ignored);
}

void Folder::add(const Record& record) {
    records_.push_back(record);
    write_records();
}

void Folder::write_records() const { write("trade.csv", to_csv(records_)); }

void Folder::drop_after(const std::string& method, std::uint64_t seed, std::uint32_t passes) {
    const auto dropped = std::erase_if(
        records_, [&](const Record& r) { return r.method == method && r.seed == seed && r.passes > passes; });
    if (dropped > 0) write_records();
}

bool Folder::is_complete(const std::string& method, std::uint64_t seed) const {
    return std::any_of(records_.begin(), records_.end(),
                       [&](const Record& r) { return r.method == method && r.seed == seed && r.final; });
}

std::vector<Record> Folder::peer_records() const {
    std::set<std::string> names;
    for (const Record& r : records_) names.insert(r.method);
    std::vector<std::string> files;
    for (const auto& entry : fs::directory_iterator(path_))
        if (is_peer_file(entry.path())) files.push_back(entry.path().filename().string());
    std::sort(files.begin(), files.end());
    std::vector<Record> peers;
    for (const std::string& name : files) {
        std::set<std::string> here;
        for (Record& r : records_from_csv(read(name), file(name))) {
            if (names.count(r.method))
                throw InputError("the method '" + core::printable(r.method) + "' is in this trade already",
                                 {file(name), 0});
            here.insert(r.method);
            peers.push_back(std::move(r));
        }
        names.insert(here.begin(), here.end());
    }
    return peers;
}

}  // namespace mote::trade
