// $parameters: exact names, the longest run of letters, digits and underscores after the dollar sign.
#include "core/formats/xml/scene_defines.h"

#include <cctype>

#include "core/formats/xml/faults.h"

namespace mote::core {
namespace {

// Parameters that hold parameters can grow without bound; no honest attribute is this long.
constexpr std::size_t max_attribute = std::size_t(1) << 22;

bool name_char(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

}  // namespace

SceneDefines::SceneDefines(const std::vector<std::pair<std::string, std::string>>& defines) {
    for (const auto& [name, value] : defines) {
        if (name.empty()) throw InputError("-D needs name=value, not '=" + printable(value) + "'");
        if (name.find('.') != std::string::npos)
            paths_.emplace_back(name, value);
        else
            parameters_[name] = {value, true, false};
    }
}

std::string SceneDefines::substitute(const std::string& text, const SourceLocation& where) {
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        if (text[i] != '$') {
            result += text[i++];
            continue;
        }
        std::size_t end = i + 1;
        while (end < text.size() && name_char(text[end])) ++end;
        const std::string name = text.substr(i + 1, end - i - 1);
        const auto it = parameters_.find(name);
        if (it == parameters_.end()) {
            std::vector<std::string> known;
            for (const auto& [key, entry] : parameters_) known.push_back(key);
            throw InputError(
                "$" + printable(name) + " is not defined (with <default> or -D)" + suggestion(name, known),
                where);
        }
        it->second.used = true;
        result += it->second.value;
        if (result.size() > max_attribute) throw InputError("an attribute is longer than 4 MB", where);
        i = end;
    }
    return result;
}

void SceneDefines::set_default(const std::string& name, const std::string& value) {
    parameters_.emplace(name, Entry{value, false, false});
}

void SceneDefines::check_all_used(Faults& faults) const {
    for (const auto& [name, entry] : parameters_) {
        if (!entry.from_command_line || entry.used) continue;
        std::vector<std::string> known;
        for (const auto& [key, other] : parameters_)
            if (!other.from_command_line || other.used) known.push_back(key);
        faults.add(nullptr, InputError("-D " + printable(name) + ": the scene does not use $" +
                                       printable(name) + suggestion(name, known)));
    }
}

}  // namespace mote::core
