// The folder that a converted scene's meshes and pictures are written into.
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace mote::core {

class OutputFolder {
  public:
    explicit OutputFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Throws InputError with the system's reason.
    void write(const std::string& name, std::span<const std::byte> bytes);
    std::string path_of(const std::string& name) const { return (folder_ / name).string(); }

  private:
    std::filesystem::path folder_;
};

}  // namespace mote::core
