// Files that are either complete or not there: written beside the final name, synced, renamed.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/files/atomic_file.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

namespace fs = std::filesystem;

// An open file that is removed again unless it was committed.
class OutputDescriptor {
  public:
    OutputDescriptor(std::string path, int flags, bool remove_on_failure)
        : path_(std::move(path)), remove_(remove_on_failure) {
        do {
            descriptor_ = ::open(path_.c_str(), flags, 0666);
        } while (descriptor_ < 0 && errno == EINTR);
    }
    ~OutputDescriptor() {
        if (descriptor_ >= 0) ::close(descriptor_);
        if (remove_) ::unlink(path_.c_str());
    }
    OutputDescriptor(const OutputDescriptor&) = delete;
    OutputDescriptor& operator=(const OutputDescriptor&) = delete;

    bool is_open() const { return descriptor_ >= 0; }
    bool write(std::span<const std::span<const std::byte>> pieces) {
        for (const auto& piece : pieces)
            if (!write_piece(piece)) return false;
        return true;
    }
    bool write_piece(std::span<const std::byte> bytes) {
        while (!bytes.empty()) {
            const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) return false;
            bytes = bytes.subspan(std::size_t(written));
        }
        return true;
    }
    /// Devices and pipes cannot be synced, and say so with EINVAL.
    bool sync() { return ::fsync(descriptor_) == 0 || errno == EINVAL || errno == EROFS; }
    bool close() {
        const int result = ::close(descriptor_);
        descriptor_ = -1;
        return result == 0;
    }
    void keep() { remove_ = false; }

  private:
    std::string path_;
    bool remove_;
    int descriptor_ = -1;
};

/// A name beside `target` that no file has: files of others, and those of killed processes, stay.
std::string unused_name(const std::string& target) {
    static std::atomic<unsigned> next{0};
    for (;;) {
        std::string name = target + "." + std::to_string(::getpid()) + "-" + std::to_string(next++) + ".part";
        struct stat status {};
        if (::lstat(name.c_str(), &status) != 0) return name;
    }
}

[[noreturn]] void fail(const std::string& path) {
    throw InputError(std::string("cannot be written: ") + std::strerror(errno), {path, 0});
}

// Makes the new name itself survive a power cut. Some file systems cannot; the file is complete all the same.
void sync_folder(const fs::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    ::fsync(descriptor);
    ::close(descriptor);
}

}  // namespace

void write_file_atomically(const std::string& path, std::span<const std::byte> bytes) {
    write_file_atomically(path, std::span(&bytes, 1));
}

void write_file_atomically(const std::string& path, std::span<const std::span<const std::byte>> pieces) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    if (fs::is_directory(status)) throw InputError("cannot be written: it is a folder", {path, 0});
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        // A device or a pipe: renaming a file over it would destroy it.
        OutputDescriptor device(path, O_WRONLY | O_CLOEXEC, false);
        if (!device.is_open() || !device.write(pieces) || !device.sync() || !device.close()) fail(path);
        return;
    }
    // Renaming over a link would replace the link, not what it points to.
    const std::string target = fs::is_symlink(fs::symlink_status(path, ignored))
                                   ? fs::weakly_canonical(path, ignored).string()
                                   : path;
    const std::string temporary = unused_name(target);
    OutputDescriptor file(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, true);
    if (!file.is_open()) {
        file.keep();
        fail(path);
    }
    if (!file.write(pieces) || !file.sync() || !file.close()) fail(path);
    if (::rename(temporary.c_str(), target.c_str()) != 0) fail(path);
    file.keep();
    const fs::path folder = fs::path(target).parent_path();
    sync_folder(folder.empty() ? fs::path(".") : folder);
}

}  // namespace mote::core
