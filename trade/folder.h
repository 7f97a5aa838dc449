// The folder that a trade writes into: what was measured with which inputs, so that it can be continued, and
// plotted again.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trade/methods_file.h"
#include "trade/record.h"

namespace mote::trade {

/// trade.json. `inputs` is compared key by key before a trade is continued; each value is short.
struct Identity {
    nlohmann::json inputs = nlohmann::json::object();
    nlohmann::json facts = nlohmann::json::object();  ///< for the page: scene, reference, methods, commands
};

class Folder {
  public:
    /// Makes the folder. Throws InputError when that cannot be, and where something that mote did not write
    /// has one of file_names(). `fresh`: removes what an earlier trade wrote here.
    Folder(std::string path, const std::vector<Method>& methods, bool fresh);
    /// For drawing alone. Throws InputError when there is no trade here, or none with records.
    static Folder existing(const std::string& path);
    /// Names of the files that a trade of these methods writes, without checkpoints.
    static std::vector<std::string> file_names(const std::vector<Method>& methods);

    std::string file(const std::string& name) const;
    std::string checkpoint(const std::string& slug, std::uint64_t seed) const;
    bool has(const std::string& name) const;
    /// Takes up what the folder holds when its inputs are these, or starts anew. Throws InputError that names
    /// what differs.
    void open(const Identity& identity);
    /// Removes the folder of checkpoints, unless something is in it.
    void remove_checkpoints() const;

    const nlohmann::json& facts() const { return facts_; }
    const std::vector<Record>& records() const { return records_; }
    /// Adds a record and writes trade.csv; once this returns, the record survives a crash.
    void add(const Record& record);
    /// Removes the records of a method and seed after so many passes: they will be measured again.
    void drop_after(const std::string& method, std::uint64_t seed, std::uint32_t passes);
    bool is_complete(const std::string& method, std::uint64_t seed) const;
    /// Records of the files *.peer.csv. Throws InputError when one names a method that is here already.
    std::vector<Record> peer_records() const;

    void write(const std::string& name, const std::string& text) const;
    std::string read(const std::string& name) const;

  private:
    explicit Folder(std::string path) : path_(std::move(path)) {}
    std::vector<std::string> own_slugs() const;
    void remove_earlier(const std::vector<std::string>& slugs) const;
    void load();
    void write_records() const;

    std::string path_;
    nlohmann::json inputs_, facts_;
    std::vector<Record> records_;
};

}  // namespace mote::trade
