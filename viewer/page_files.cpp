#include "viewer/page_files.h"

#include <algorithm>

namespace mote::viewer {

namespace {

constexpr PageFile page_files[] = {
#include "viewer_page_files.inc"  // of the build, from viewer/page/
};

bool is_module(const PageFile& file) { return file.name.ends_with(".js") && file.name != "main.js"; }

}  // namespace

const PageFile* find_page_file(std::string_view name) {
    const auto found = std::ranges::find(page_files, name, &PageFile::name);
    return found == std::end(page_files) ? nullptr : found;
}

std::string page_script() {
    std::string script;
    for (const PageFile& file : page_files) {
        if (!is_module(file)) continue;
        std::string_view text = file.text;
        while (!text.empty()) {
            std::string_view line = text.substr(0, text.find('\n'));
            text.remove_prefix(std::min(text.size(), line.size() + 1));
            constexpr std::string_view shared = "export ";
            if (line.starts_with("import ")) continue;
            if (line.starts_with(shared)) line.remove_prefix(shared.size());
            script += line, script += '\n';
        }
    }
    return script;
}

}  // namespace mote::viewer
