// Starting, watching and ending the helper program.
#include "media/grid_reader_process.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <thread>
#include <vector>

#include "core/objects/error.h"
#include "media/grid_reader_protocol.h"
#include "media/vdb_grid.h"

extern char** environ;  // NOLINT: declared by POSIX for posix_spawn

/// Defined in programs that link static libraries of the installed package (cmake/mote-config.cmake.in); else
/// null.
extern "C" __attribute__((weak)) const char* const mote_grid_reader_folder;

namespace mote::media {

namespace fs = std::filesystem;

namespace {

constexpr const char* helper_name = "mote_grid_reader";

class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    int get() const { return fd_; }

  private:
    int fd_;
};

[[noreturn]] void refuse(const std::string& path, const std::string& message) {
    throw core::InputError(message, {path, 0});
}

std::uint64_t memory_limit(const std::string& path, const VdbLoadOptions& options) {
    if (options.memory_limit > 0) return options.memory_limit;
    std::error_code error;
    const std::uint64_t size = fs::file_size(path, error);
    const std::uint64_t usual = (std::uint64_t(2) << 30) + 64 * (error ? 0 : size);
    // The least that the helper starts with; what it then lacks it says itself.
    return std::max(options.memory.at_most(usual), std::size_t(1) << 28);
}

/// File actions and attributes of one spawn: quiet, no inherited signal settings, and the memory file in
/// place.
class SpawnSettings {
  public:
    explicit SpawnSettings(int memory_file) {
        posix_spawn_file_actions_init(&actions_);
        for (const int fd : {0, 1, 2})
            posix_spawn_file_actions_addopen(&actions_, fd, "/dev/null", fd == 0 ? O_RDONLY : O_WRONLY, 0);
        posix_spawn_file_actions_adddup2(&actions_, memory_file, grid_reader_descriptor);
        posix_spawnattr_init(&attributes_);
        sigset_t none, all;
        sigemptyset(&none);
        sigfillset(&all);
        posix_spawnattr_setsigmask(&attributes_, &none);
        posix_spawnattr_setsigdefault(&attributes_, &all);
        posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    }
    SpawnSettings(const SpawnSettings&) = delete;
    SpawnSettings& operator=(const SpawnSettings&) = delete;
    ~SpawnSettings() {
        posix_spawn_file_actions_destroy(&actions_);
        posix_spawnattr_destroy(&attributes_);
    }
    /// The process id; throws InputError when the helper cannot be started.
    pid_t spawn(const std::string& path, std::vector<std::string> arguments) {
        std::vector<char*> argv;
        for (std::string& a : arguments) argv.push_back(a.data());
        argv.push_back(nullptr);
        pid_t pid = 0;
        const int error = posix_spawn(&pid, argv[0], &actions_, &attributes_, argv.data(), environ);
        if (error != 0) refuse(path, fmt::format("cannot start {}: {}", arguments[0], std::strerror(error)));
        return pid;
    }

  private:
    posix_spawn_file_actions_t actions_{};
    posix_spawnattr_t attributes_{};
};

/// Waits for the helper's end; kills it when the time is over. The wait status, or nothing after a kill.
std::optional<int> wait_for(pid_t pid, double seconds) {
    using clock = std::chrono::steady_clock;
    const auto deadline = clock::now() + std::chrono::duration<double>(seconds);
    auto pause = std::chrono::microseconds(500);
    for (;;) {
        int status = 0;
        const pid_t done = ::waitpid(pid, &status, WNOHANG);
        if (done == pid) return status;
        if (done < 0 && errno == ECHILD) return 0;  // a host that ignores SIGCHLD: the answer itself decides
        if (clock::now() > deadline) {
            ::kill(pid, SIGKILL);
            while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
            }
            return std::nullopt;
        }
        std::this_thread::sleep_for(pause);
        pause = std::min(pause * 2, std::chrono::microseconds(20000));
    }
}

bool read_at(int fd, void* to, std::size_t size, std::uint64_t offset) {
    auto* out = static_cast<char*>(to);
    while (size > 0) {
        const ssize_t n = ::pread(fd, out, size, off_t(offset));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        out += n, offset += std::uint64_t(n), size -= std::size_t(n);
    }
    return true;
}

/// Makes the file constant; false where a process may still write to it. The pages of a helper that
/// has ended may be held for a moment more by a process that reads its state, such as `top`.
bool seal(int fd) {
    for (int tries = 0; tries < 1000; ++tries) {
        if (::fcntl(fd, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE) == 0) return true;
        if (errno != EBUSY) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

/// Nothing when the helper left no complete answer.
std::optional<GridReaderAnswer> read_answer(int fd, const std::string& path,
                                            const core::MemoryBudget& memory) {
    struct stat info {};
    GridReaderHeader h;
    if (!seal(fd) || ::fstat(fd, &info) != 0 || !read_at(fd, &h, sizeof h, 0)) return std::nullopt;
    const auto size = std::uint64_t(info.st_size);
    if (h.magic != GridReaderHeader::expected_magic || h.text_size > grid_reader_max_text)
        return std::nullopt;
    if (h.text_offset > size || h.text_size > size - h.text_offset) return std::nullopt;
    if (h.grid_size > size || h.grid_offset > size - h.grid_size) return std::nullopt;
    GridReaderAnswer answer;
    answer.text.resize(h.text_size);
    if (!read_at(fd, answer.text.data(), h.text_size, h.text_offset)) return std::nullopt;
    if (h.grid_size > 0) {
        memory.require(double(h.grid_size), "the grid of '" + core::printable(path, 300) + "'");
        answer.buffer = AlignedBuffer::mapped(fd, h.grid_offset, h.grid_size);
        if (!answer.buffer.data()) return std::nullopt;
    }
    return answer;
}

std::string describe_death(int status) {
    if (!WIFSIGNALED(status)) return fmt::format("the reader ended with code {}", WEXITSTATUS(status));
    if (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL)
        return "the reader was ended by a limit on time or memory";
    return fmt::format("the reader crashed ({})", strsignal(WTERMSIG(status)));
}

}  // namespace

AlignedBuffer::AlignedBuffer(std::size_t size)
    : bytes_(static_cast<std::byte*>(::operator new(size, alignment))), size_(size) {}

AlignedBuffer AlignedBuffer::mapped(int file, std::uint64_t offset, std::size_t size) {
    AlignedBuffer buffer;
    void* pages = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE, file, off_t(offset));
    if (pages == MAP_FAILED) return buffer;
    buffer.bytes_ = {static_cast<std::byte*>(pages), Free(size)}, buffer.size_ = size;
    return buffer;
}

void AlignedBuffer::Free::operator()(std::byte* p) const {
    if (mapped > 0)
        ::munmap(p, mapped);
    else
        ::operator delete(p, alignment);
}

std::string grid_reader_path() {
    if (const char* named = std::getenv("MOTE_GRID_READER"); named && *named) return named;
    std::vector<fs::path> folders;
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    if (!error) folders.push_back(program.parent_path());
    Dl_info library{};
    if (::dladdr(reinterpret_cast<const void*>(&grid_reader_path), &library) != 0 && library.dli_fname)
        folders.push_back(fs::absolute(library.dli_fname, error).parent_path());
    const std::size_t count = folders.size();
    for (std::size_t i = 0; i < count; ++i)
        for (const char* up : {"../libexec/mote", "../../libexec/mote"}) folders.push_back(folders[i] / up);
    if (const char* const* installed = &mote_grid_reader_folder) folders.emplace_back(*installed);
#ifdef MOTE_GRID_READER_FOLDER
    folders.emplace_back(MOTE_GRID_READER_FOLDER);
#endif
    for (const fs::path& folder : folders)
        if (fs::is_regular_file(folder / helper_name, error)) return (folder / helper_name).string();
    throw core::InputError(fmt::format(
        "'{}', which reads VDB files, was not found beside this program; set MOTE_GRID_READER to its path",
        helper_name));
}

GridReaderAnswer run_grid_reader(const std::string& mode, const std::string& path,
                                 const std::string& grid_name, const VdbLoadOptions& options) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) refuse(path, "no such file");
    const std::string helper = grid_reader_path();
    const Descriptor memory(::memfd_create("mote_grid", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    if (memory.get() < 0) refuse(path, fmt::format("no memory file: {}", std::strerror(errno)));

    // large files may take their time: a second for every 10 MB
    const double seconds = options.time_limit + 1e-7 * double(fs::file_size(path, error));
    const pid_t pid = SpawnSettings(memory.get())
                          .spawn(path, {helper, mode, path, std::to_string(memory_limit(path, options)),
                                        std::to_string(long(std::ceil(seconds))),
                                        options.clamp_negative ? "1" : "0", grid_name});
    const std::optional<int> status = wait_for(pid, seconds);
    if (!status)
        refuse(path, fmt::format("cannot be read within {:.3g} seconds; the file may be damaged", seconds));
    auto answer = read_answer(memory.get(), path, options.memory);
    if (!WIFEXITED(*status) || WEXITSTATUS(*status) != 0 || !answer)
        refuse(path, describe_death(*status) + "; the file is damaged or too large");
    return std::move(*answer);
}

}  // namespace mote::media
