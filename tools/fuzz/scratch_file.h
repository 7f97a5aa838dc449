// A file in the temporary folder, gone with this: for writers that want a path.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

#include "tools/fuzz/seeds.h"

namespace mote::fuzz {

class ScratchFile {
  public:
    explicit ScratchFile(const std::string& extension)
        : path_((std::filesystem::temp_directory_path() /
                 ("mote_fuzz_seed_" + std::to_string(::getpid()) + extension))
                    .string()) {}
    ~ScratchFile() {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
    const std::string& path() const { return path_; }
    Bytes bytes() const { return bytes_of_file(path_); }

  private:
    std::string path_;
};

}  // namespace mote::fuzz
