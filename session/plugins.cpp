#include "session/plugins.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "core/files/checksum.h"
#include "core/files/whole_file.h"
#include "core/objects/error.h"
#include "core/objects/plugin.h"

namespace mote::session {

using core::InputError;

namespace {

template <typename Function>
Function* find(void* library, const char* name, const std::string& file) {
    auto* const function = reinterpret_cast<Function*>(::dlsym(library, name));
    if (!function)
        throw InputError(fmt::format("is no plugin of mote: it has no function '{}', which MOTE_PLUGIN() "
                                     "defines",
                                     name),
                         {file, 0});
    return function;
}

}  // namespace

std::vector<std::string> plugin_files(std::span<const std::string> files) {
    std::vector<std::string> all;
    const char* const named = std::getenv("MOTE_PLUGINS");
    std::string text = named ? named : "";
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find(':', begin), text.size());
        if (end > begin) all.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    all.insert(all.end(), files.begin(), files.end());
    return all;
}

void load_plugin(core::Registry& registry, const std::string& file) {
    std::error_code error;
    // A name without a slash would be looked up in the folders of the system.
    const std::string path = std::filesystem::absolute(file, error).string();
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError("there is no such plugin", {file, 0});
    void* const library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        const char* const text = ::dlerror();
        throw InputError("cannot be loaded as a plugin: " + core::printable(text ? text : "", 300),
                         {file, 0});
    }
    auto* const interface = find<core::PluginInterface>(library, core::plugin_interface_name, file);
    auto* const add_types = find<core::PluginRegister>(library, core::plugin_register_name, file);
    if (const std::string built = interface(); built != MOTE_INTERFACE)
        throw InputError(fmt::format("this plugin was compiled for {}, and this is {}: compile it again",
                                     core::printable(built), MOTE_INTERFACE),
                         {file, 0});
    try {
        add_types(&registry);
    } catch (const std::exception& failure) {
        throw InputError("this plugin's types cannot be added: " + core::printable(failure.what(), 300),
                         {file, 0});
    }
}

std::vector<std::string> plugin_settings(std::span<const std::string> files) {
    std::vector<std::string> settings;
    for (const std::string& file : plugin_files(files)) {
        const std::vector<std::byte> bytes = core::read_whole_file(file);
        settings.push_back(fmt::format("plugin {:016x}", core::checksum(bytes)));
    }
    return settings;
}

}  // namespace mote::session
