// The files of the page, which are part of the program.
#pragma once

#include <string>
#include <string_view>

namespace mote::viewer {

struct PageFile {
    std::string_view name, type, text;  ///< "index.html", "text/html", and its content
};
/// Null where the page has no such file.
const PageFile* find_page_file(std::string_view name);
/// The page's modules as one script without imports and exports, which has start(root, transport).
std::string page_script();

}  // namespace mote::viewer
