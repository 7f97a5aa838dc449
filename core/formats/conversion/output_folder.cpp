// Writing side files.
#include "core/formats/conversion/output_folder.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/objects/error.h"

namespace mote::core {

void OutputFolder::write(const std::string& name, std::span<const std::byte> bytes) {
    const std::string path = path_of(name);
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    file.close();
    if (!file) throw InputError(std::string("cannot be written: ") + std::strerror(errno), {path, 0});
}

}  // namespace mote::core
