#include "core/formats/xml/element_content.h"

#include <fmt/format.h>

namespace mote::core {
namespace {

/// Quoted with its length, so that no two lists of words read alike.
void add_word(std::string& text, std::string_view word) { text += fmt::format("{}:{}", word.size(), word); }

void add_element(std::string& text, const Element& element, const IdTable& ids, bool nested) {
    if (element.tag == "ref") {
        add_word(text, element.get("name"));
        text += fmt::format("&{}", static_cast<const void*>(&resolve(element, ids)));
        return;
    }
    text += '<';
    add_word(text, element.tag);
    add_word(text, element.folder);  // files are found from there
    for (const auto& [name, value] : element.attributes) {
        if (name == "id" || (name == "name" && !nested)) continue;
        add_word(text, name), add_word(text, value);
    }
    for (const Element& child : element.children) add_element(text, child, ids, true);
    text += '>';
}

}  // namespace

std::string content_of(const Element& element, const IdTable& ids) {
    std::string text;
    add_element(text, element, ids, false);
    return text;
}

}  // namespace mote::core
