// Files are distinguished by device and inode, as the system does; names prove nothing where there are links.
#include "session/output_files.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <utility>

#include "core/files/atomic_file.h"
#include "core/files/whole_file.h"
#include "core/formats/pictures/image_file.h"
#include "core/objects/error.h"
#include "core/render/partial_film.h"
#include "session/preview.h"

namespace mote::session {

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
    constexpr int max_links = 40;  // as the system itself
    for (int i = 0; i < max_links && fs::is_symlink(fs::symlink_status(path, ignored)); ++i)
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

// Writing to a device or a pipe replaces nothing.
bool can_be_replaced(const std::string& path) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    return !fs::exists(status) || fs::is_regular_file(status);
}

/// The first bytes, in which a PNG has its texts.
std::string beginning_of(const std::string& path) {
    std::string bytes(4096, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(bytes.data(), std::streamsize(bytes.size()));
    bytes.resize(std::size_t(file.gcount()));
    return bytes;
}

bool is_exr_of_mote(const std::string& path) {
    try {
        const auto metadata = core::read_exr_metadata(path);
        const auto software = metadata.find("software");
        return software != metadata.end() && software->second.starts_with("mote ");
    } catch (const core::InputError&) {
        return false;
    }
}

}  // namespace

bool written_by_mote(const std::string& path) {
    const std::string bytes = beginning_of(path);
    if (bytes.starts_with("\x89PNG"))
        return bytes.find(std::string("tEXt") + exposure_key + '\0') != bytes.npos;
    return bytes.starts_with("\x76\x2f\x31\x01") ? is_exr_of_mote(path) : core::is_partial_film(path);
}

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
        if (!output.named && identity.name.empty() && !written_by_mote(output.path))
            throw core::InputError("was not written by mote, and " + output.what +
                                       " does not replace it: move it or choose another name",
                                   {output.path, 0});
        if (const auto [other, fresh] = written.emplace(identity, output); !fresh)
            throw core::InputError(
                "cannot be written twice: as " + other->second.what + " and as " + output.what,
                {output.path, 0});
    }
}

std::string extension_of(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    return extension;
}

void require_exr_name(const std::string& path) {
    if (extension_of(path) != ".exr")
        throw core::InputError("does not end in .exr: a picture with its layers is an OpenEXR file",
                               {path, 0});
}

void check_companions(std::span<const NamedFile> outputs, const std::string& marker) {
    std::error_code ignored;
    if (fs::exists(marker, ignored)) return;
    for (const NamedFile& output : outputs)
        if (fs::exists(output.path, ignored))
            throw core::InputError("is there already without '" + marker + "', and " + output.what +
                                       " does not replace it: move it or choose another name",
                                   {output.path, 0});
}

void check_writable(const std::string& path) {
    const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored))
        throw core::InputError("cannot be written: there is no folder '" + folder.string() + "'", {path, 0});
    if (fs::is_directory(path, ignored))
        throw core::InputError("cannot be written: it is a folder", {path, 0});
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        throw core::InputError(std::string("cannot be written: ") + std::strerror(errno), {path, 0});
}

void write_text(const std::string& path, const std::string& text) {
    core::write_file_atomically(path, std::as_bytes(std::span(text.data(), text.size())));
}

std::string read_text(const std::string& path) {
    try {
        const std::vector<std::byte> bytes = core::read_whole_file(path);
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    } catch (const core::InputError& error) {
        throw core::InputError(error.what(), {path, 0});
    }
}

std::vector<NamedFile> scene_inputs(std::span<const std::string> files) {
    std::vector<NamedFile> inputs;
    for (const std::string& file : files) inputs.push_back({"a file that the scene is read from,", file});
    return inputs;
}

}  // namespace mote::session
