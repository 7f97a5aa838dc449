// trade.json, trade.csv and the checkpoints below.
#include "apps/trade/folder.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "apps/trade/json_lines.h"
#include "core/files/atomic_file.h"
#include "core/files/whole_file.h"
#include "core/objects/error.h"

namespace mote::apps::trade {

namespace {

namespace fs = std::filesystem;
using core::InputError;
using nlohmann::json;

bool is_peer_file(const fs::path& path) {
    const std::string name = path.filename().string();
    const std::string ending = ".peer.csv";
    return name.size() > ending.size() && name.ends_with(ending);
}

}  // namespace

Folder::Folder(std::string path) : path_(std::move(path)) {
    std::error_code error;
    fs::create_directories(fs::path(path_), error);
    if (!fs::is_directory(path_, error))
        throw InputError("cannot be used as a folder" + (error ? ": " + error.message() : ""), {path_, 0});
}

std::string Folder::file(const std::string& name) const { return (fs::path(path_) / name).string(); }
bool Folder::has(const std::string& name) const { return fs::exists(file(name)); }
std::string Folder::checkpoint(const std::string& slug, std::uint64_t seed) const {
    return file("checkpoints/" + slug + ".seed" + std::to_string(seed));
}

void Folder::write(const std::string& name, const std::string& text) const {
    core::write_file_atomically(file(name), std::as_bytes(std::span(text.data(), text.size())));
}

std::string Folder::read(const std::string& name) const {
    try {
        const std::vector<std::byte> bytes = core::read_whole_file(file(name));
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    } catch (const InputError& error) {
        throw InputError(error.what(), {file(name), 0});
    }
}

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

void Folder::open(const Identity& identity, bool fresh) {
    if (fresh) remove_earlier();
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

void Folder::open_existing() {
    if (!has("trade.json")) throw InputError("there is no trade in this folder (no trade.json)", {path_, 0});
    load();
    if (records_.empty()) throw InputError("this trade has no records yet", {path_, 0});
}

void Folder::remove_earlier() {
    std::set<std::string> names = {"trade.json",   "trade.csv",     "trade.svg", "trade.html",
                                   "summary.json", "reference.exr", "trade.txt"};
    if (has("trade.json")) {
        const json all = json::parse(
            read("trade.json"),
            [](int depth, json::parse_event_t, json&) { return depth < int(max_json_depth); }, false);
        const json methods =
            all.is_object() ? all.value("/facts/methods"_json_pointer, json::array()) : json();
        for (const json& m : methods)
            if (m.is_object() && m.contains("slug") && m["slug"].is_string())
                for (const char* ending : {".exr", ".json"})
                    names.insert(m["slug"].get<std::string>() + ending);
    }
    std::error_code ignored;
    for (const std::string& name : names) fs::remove(file(name), ignored);
    fs::remove_all(file("checkpoints"), ignored);
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

}  // namespace mote::apps::trade
