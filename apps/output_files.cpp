// Files are told apart by device and inode, as the system does; names prove nothing where there are links.
#include "apps/output_files.h"

#include <sys/stat.h>

#include <filesystem>
#include <map>
#include <utility>

#include "core/objects/error.h"

namespace mote::apps {

namespace {

namespace fs = std::filesystem;

// Device and inode of a file that is there, else the name that it will have.
struct Identity {
    std::pair<dev_t, ino_t> file{0, 0};
    std::string name;
    bool operator<(const Identity& o) const { return file != o.file ? file < o.file : name < o.name; }
};

// Where a link leads that leads to no file yet.
fs::path followed(fs::path path) {
    std::error_code ignored;
    constexpr int most_links = 40;  // as the system itself
    for (int i = 0; i < most_links && fs::is_symlink(fs::symlink_status(path, ignored)); ++i)
        path = path.parent_path() / fs::read_symlink(path, ignored);
    return path;
}

Identity identity_of(const std::string& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) == 0) return {{status.st_dev, status.st_ino}, ""};
    std::error_code ignored;
    const fs::path whole = fs::weakly_canonical(fs::absolute(followed(path), ignored), ignored);
    return {{0, 0}, whole.empty() ? path : whole.string()};
}

// What is written to a device or a pipe replaces nothing.
bool can_be_replaced(const std::string& path) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    return !fs::exists(status) || fs::is_regular_file(status);
}

}  // namespace

bool same_file(const std::string& a, const std::string& b) {
    if (!can_be_replaced(a) || !can_be_replaced(b)) return false;
    const Identity first = identity_of(a), second = identity_of(b);
    return !(first < second) && !(second < first);
}

void check_outputs(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs) {
    std::map<Identity, NamedFile> taken;
    for (const NamedFile& input : inputs)
        if (!input.path.empty() && can_be_replaced(input.path)) taken.emplace(identity_of(input.path), input);
    std::map<Identity, NamedFile> written;
    for (const NamedFile& output : outputs) {
        if (output.path.empty() || !can_be_replaced(output.path)) continue;
        const Identity identity = identity_of(output.path);
        if (const auto input = taken.find(identity); input != taken.end())
            throw core::InputError("cannot be written: " + output.what + " would replace " +
                                       input->second.what + " '" + core::printable(input->second.path, 300) +
                                       "'",
                                   {output.path, 0});
        if (const auto [other, fresh] = written.emplace(identity, output); !fresh)
            throw core::InputError(
                "cannot be written twice: as " + other->second.what + " and as " + output.what,
                {output.path, 0});
    }
}

std::vector<NamedFile> scene_inputs(std::span<const std::string> files) {
    std::vector<NamedFile> inputs;
    for (const std::string& file : files) inputs.push_back({"a file that the scene is read from,", file});
    return inputs;
}

}  // namespace mote::apps
