// A pipe without data: reading from it returns when no process has its other end open any more.
#include "core/formats/conversion/scratch_folder.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <stdexcept>

namespace mote::core {
namespace {

namespace fs = std::filesystem;

void remove_folder(const std::string& path) {
    std::error_code ignored;
    fs::remove_all(path, ignored);
}

/// Holds nothing open but the pipe: a reader that waits for the end of our output must not wait for this.
void close_all_but(int kept) {
    ::dup2(kept, 0);
    if (::close_range(1, ~0u, 0) == 0) return;
    for (int i = 1; i < 1024; ++i) ::close(i);  // Linux before 5.9
}

[[noreturn]] void wait_and_remove(int pipe, const std::string& path) {
    ::setsid();  // Ctrl-C is for the others
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) ::signal(number, SIG_IGN);
    ::alarm(0);
    close_all_but(pipe);
    char nothing = 0;
    while (::read(0, &nothing, 1) < 0 && errno == EINTR) continue;
    remove_folder(path);
    ::_exit(0);
}

}  // namespace

ScratchFolder::ScratchFolder() {
    path_ = (fs::temp_directory_path() / "mote-XXXXXX").string();
    if (!::mkdtemp(path_.data())) throw std::runtime_error("no temporary folder can be made");
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) == 0) {
        remover_ = ::fork();
        if (remover_ == 0) ::close(ends[1]), wait_and_remove(ends[0], path_);
        ::close(ends[0]);
        alive_ = ends[1];
    }
    if (remover_ > 0) return;
    if (alive_ >= 0) ::close(alive_);
    remove_folder(path_);
    throw std::runtime_error("no process to remove temporary files with");
}

ScratchFolder::~ScratchFolder() {
    ::close(alive_);
    while (::waitpid(remover_, nullptr, 0) < 0 && errno == EINTR) continue;
}

}  // namespace mote::core
