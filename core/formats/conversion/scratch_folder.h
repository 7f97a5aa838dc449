// A folder for temporary files.
#pragma once

#include <sys/types.h>

#include <string>

namespace mote::core {

/// It is removed when this goes out of scope, and also when the program ends in any other way: by a signal,
/// for lack of memory, or by _exit() while a scene is loaded. A process of its own waits for that and does
/// nothing else.
class ScratchFolder {
  public:
    /// In the system's folder for such files. Throws std::runtime_error.
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    const std::string& path() const { return path_; }

  private:
    std::string path_;
    int alive_ = -1;  ///< the end of a pipe whose other end the process reads
    pid_t remover_ = -1;
};

}  // namespace mote::core
