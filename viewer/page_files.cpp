#include "viewer/page_files.h"

#include <algorithm>

#include "viewer_page_text.h"  // of the build, from viewer/page/

namespace mote::viewer {

const PageFile* find_page_file(std::string_view name) {
    static const PageFile files[] = {{"index.html", "text/html; charset=utf-8", page_index},
                                     {"main.js", "text/javascript; charset=utf-8", page_main},
                                     {"viewer.js", "text/javascript; charset=utf-8", page_viewer},
                                     {"image.js", "text/javascript; charset=utf-8", page_image},
                                     {"viewer.css", "text/css; charset=utf-8", page_style}};
    const auto found = std::ranges::find(files, name, &PageFile::name);
    return found == std::end(files) ? nullptr : found;
}

}  // namespace mote::viewer
