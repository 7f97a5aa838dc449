// File descriptor 2 is exchanged for a file in memory, and put back.
#include "core/formats/pictures/quiet_stderr.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>

#include "core/objects/error.h"

namespace mote::core {

namespace {

// A file descriptor belongs to the whole process, so its lock does, too.
std::mutex& process_wide() {
    static std::mutex mutex;
    return mutex;
}

}  // namespace

QuietStderr::QuietStderr() : lock_(process_wide()) {
    std::fflush(stderr);
    memory_ = ::memfd_create("stderr", MFD_CLOEXEC);
    kept_ = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
    if (memory_ >= 0 && kept_ >= 0) ::dup2(memory_, STDERR_FILENO);
}

QuietStderr::~QuietStderr() {
    std::fflush(stderr);
    if (memory_ >= 0 && kept_ >= 0) ::dup2(kept_, STDERR_FILENO);
    if (kept_ >= 0) ::close(kept_);
    if (memory_ >= 0) ::close(memory_);
}

std::string QuietStderr::last_line() const {
    std::fflush(stderr);
    if (memory_ < 0) return "";
    const off_t end = ::lseek(memory_, 0, SEEK_END);
    char text[512];
    const ssize_t size =
        ::pread(memory_, text, sizeof(text), end > off_t(sizeof(text)) ? end - off_t(sizeof(text)) : 0);
    std::string last(text, std::size_t(size > 0 ? size : 0));
    while (!last.empty() && last.back() == '\n') last.pop_back();
    if (const auto line = last.rfind('\n'); line != std::string::npos) last.erase(0, line + 1);
    return printable(last, 200);
}

}  // namespace mote::core
