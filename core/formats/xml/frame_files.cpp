#include "core/formats/xml/frame_files.h"

#include <fmt/format.h>

namespace mote::core {

std::string FramePlaceholder::with(long number) const {
    return before + fmt::format("{:0{}d}", number, digits) + after;
}

std::optional<FramePlaceholder> frame_placeholder(const std::string& name) {
    std::size_t at = 0, longest = 0;
    for (std::size_t i = 0; i < name.size();) {
        std::size_t end = i;
        while (end < name.size() && name[end] == '#') ++end;
        if (end - i > longest) at = i, longest = end - i;
        i = end == i ? i + 1 : end;
    }
    if (longest < 2) return std::nullopt;
    return FramePlaceholder{name.substr(0, at), name.substr(at + longest), longest};
}

void number_files(Element& element, int number) {
    for (Element& child : element.children) {
        if (child.tag == "string" && child.get("name") == "filename")
            if (const auto file = frame_placeholder(child.get("value")))
                child.set("value", file->with(number));
        number_files(child, number);
    }
}

}  // namespace mote::core
