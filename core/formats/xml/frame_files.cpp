#include "core/formats/xml/frame_files.h"

#include <fmt/format.h>

namespace mote::core {

std::optional<std::string> with_frame_number(const std::string& name, int number) {
    std::size_t at = 0, longest = 0;
    for (std::size_t i = 0; i < name.size();) {
        std::size_t end = i;
        while (end < name.size() && name[end] == '#') ++end;
        if (end - i > longest) at = i, longest = end - i;
        i = end == i ? i + 1 : end;
    }
    if (longest < 2) return std::nullopt;
    return name.substr(0, at) + fmt::format("{:0{}d}", number, longest) + name.substr(at + longest);
}

void number_files(Element& element, int number) {
    for (Element& child : element.children) {
        if (child.tag == "string" && child.get("name") == "filename")
            if (const auto file = with_frame_number(child.get("value"), number)) child.set("value", *file);
        number_files(child, number);
    }
}

}  // namespace mote::core
