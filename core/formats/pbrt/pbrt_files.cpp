// Finding, copying and naming files.
#include "core/formats/pbrt/pbrt_files.h"

#include "core/files/whole_file.h"

namespace mote::core {

namespace fs = std::filesystem;

std::string PbrtFiles::find(const std::string& name, const SourceLocation& where) {
    const fs::path path = fs::path(path_).parent_path() / name;
    std::error_code error;
    if (!fs::is_regular_file(path, error))
        throw InputError("there is no file '" + printable(name) + "' beside the scene", where);
    auto& files = scene_.files;
    if (std::find(files.begin(), files.end(), path.string()) == files.end()) files.push_back(path.string());
    return path.string();
}

std::string PbrtFiles::use(const std::string& name, const SourceLocation& where) {
    const std::string path = find(name, where);
    if (!options_.copy_files) return fs::absolute(path).string();
    std::string& copy = used_[path];
    if (copy.empty()) {
        copy = new_name(fs::path(name).stem().string(), fs::path(name).extension().string());
        write(copy, read_whole_file(path));
    }
    return in_xml(copy);
}

std::string PbrtFiles::new_name(const std::string& stem, const std::string& extension) {
    return stem + "_" + std::to_string(count_++) + extension;
}

}  // namespace mote::core
