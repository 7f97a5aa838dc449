// Reading whole files.
#include "core/files/whole_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/objects/error.h"

namespace mote::core {

void require_file(const std::string& path) {
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(path, ignored);
    if (std::filesystem::is_directory(status)) throw InputError("is a folder");
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        throw InputError("is a pipe or a device, not a file");
}

std::uint64_t size_of_file(const std::string& path) {
    require_file(path);
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error) throw InputError("cannot be opened: " + error.message());
    return size;
}

std::vector<std::byte> read_whole_file(const std::string& path, const MemoryBudget& memory) {
    require_file(path);
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) throw InputError(std::string("cannot be opened: ") + std::strerror(errno));
    const std::streamoff size = file.tellg();
    if (size < 0) throw InputError("cannot be read");
    memory.require(2.0 * double(size), "the file '" + printable(path, 300) + "' and what is made of it");
    std::vector<std::byte> bytes(std::size_t(size), std::byte(0));
    file.seekg(0);
    file.read(reinterpret_cast<char*>(bytes.data()), size);
    if (!file) throw InputError("cannot be read");
    return bytes;
}

}  // namespace mote::core
