// From JSON to integrators. Settings go through the checks of a scene file
// (core/formats/xml/integrator_maker.h).
#include "trade/methods_file.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/files/whole_file.h"
#include "core/formats/xml/integrator_maker.h"
#include "core/formats/xml/scene_values.h"
#include "trade/json_lines.h"

namespace mote::trade {

namespace {

using core::InputError;
using core::printable;
using nlohmann::json;

std::string read_text(const std::string& path) {
    try {
        const std::vector<std::byte> bytes = core::read_whole_file(path);
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    } catch (const InputError& error) {
        throw InputError(error.what(), {path, 0});
    }
}

std::string value_text(const json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) return core::number_to_text(value.get<double>());
    if (!value.is_array()) return value.dump();
    std::string text;
    for (const json& v : value) text += (text.empty() ? "" : " ") + value_text(v);
    return text;
}

// A number as people write it, for names and commands.
std::string short_text(const json& value) { return value.is_number() ? value.dump() : value_text(value); }

class Reader {
  public:
    Reader(const JsonLines& file, const core::Registry& registry, const core::Scene& scene,
           std::vector<std::string>& warnings)
        : file_(file), registry_(registry), scene_(scene), warnings_(warnings) {}

    MethodsFile read() {
        const json& root = object("");
        check_keys("", {"time", "passes", "seeds", "methods"});
        MethodsFile result;
        if (root.contains("time")) result.seconds = seconds("/time");
        if (root.contains("passes")) result.passes = count("/passes", 1u << 30);
        if (root.contains("seeds")) result.seeds = count("/seeds", 10000);
        if (!root.contains("methods")) fail("", "there are no 'methods'");
        const json& methods = root["methods"];
        if (!methods.is_array() || methods.empty())
            fail("/methods", "'methods' must be a list of at least one method");
        for (std::size_t i = 0; i < methods.size(); ++i)
            result.methods.push_back(method("/methods/" + std::to_string(i)));
        return result;
    }

  private:
    [[noreturn]] void fail(const std::string& pointer, const std::string& message) const {
        throw InputError(message, file_.where(pointer));
    }
    const json& at(const std::string& pointer) const { return file_.root().at(json::json_pointer(pointer)); }
    const json& object(const std::string& pointer) const {
        if (!at(pointer).is_object()) fail(pointer, "expected { ... }");
        return at(pointer);
    }
    void check_keys(const std::string& pointer, const std::vector<std::string>& known) const {
        for (const auto& [key, value] : at(pointer).items())
            if (std::find(known.begin(), known.end(), key) == known.end())
                fail(pointer + "/" + key,
                     "unknown key '" + printable(key) + "'" + core::suggestion(key, known));
    }
    double seconds(const std::string& pointer) const {
        const json& v = at(pointer);
        if (!v.is_number() || !(v.get<double>() > 0.0)) fail(pointer, "'time' must be a number above 0");
        return v.get<double>();
    }
    std::uint32_t count(const std::string& pointer, std::uint32_t largest) const {
        const json& v = at(pointer);
        if (!v.is_number_unsigned() || v.get<std::uint64_t>() < 1 || v.get<std::uint64_t>() > largest)
            fail(pointer,
                 "'" + pointer.substr(1) + "' must be a whole number from 1 to " + std::to_string(largest));
        return v.get<std::uint32_t>();
    }
    std::string text(const std::string& pointer, const char* key) const {
        const json& parent = at(pointer);
        if (!parent.contains(key)) fail(pointer, std::string("a method needs '") + key + "'");
        if (!parent[key].is_string() || parent[key].get<std::string>().empty())
            fail(pointer + "/" + key, std::string("'") + key + "' must be a word");
        return parent[key].get<std::string>();
    }

    Method method(const std::string& pointer) {
        const json& source = object(pointer);
        check_keys(pointer, {"name", "integrator", "settings"});
        Method m;
        m.name = text(pointer, "name"), m.type = text(pointer, "integrator");
        name_file(m, pointer);
        std::vector<core::IntegratorSetting> settings;
        if (source.contains("settings")) add_settings(m, pointer + "/settings", "", settings);
        try {
            m.integrator = core::make_integrator(registry_, scene_, m.type, settings,
                                                 file_.where(pointer + "/integrator"), warnings_);
        } catch (const InputError& error) {
            throw InputError(std::string(error.what()) + " (method '" + printable(m.name) + "')");
        }
        return m;
    }
    void name_file(Method& m, const std::string& pointer) {
        if (!names_.insert(m.name).second)
            fail(pointer + "/name", "there are two methods '" + printable(m.name) + "'");
        m.slug = slug_of(m.name);
        if (m.slug.empty()) m.slug = "method-" + std::to_string(names_.size());
        if (m.slug == "reference" || !slugs_.insert(m.slug).second)
            fail(pointer + "/name", "the name '" + printable(m.name) + "' gives the file name '" + m.slug +
                                        ".exr', which is taken: choose another");
    }
    /// "compensation": {"type": "approximate", "depth": 2} is what "compensation": "approximate" and
    /// "compensation.depth": 2 are.
    void add_settings(Method& m, const std::string& pointer, const std::string& prefix,
                      std::vector<core::IntegratorSetting>& settings) const {
        const json& values = object(pointer);
        const auto add = [&](const std::string& name, const json& value, const std::string& where) {
            if (m.settings.contains(name))
                fail(where,
                     "'" + printable(name) + "' of the method '" + printable(m.name) + "' is given twice");
            m.settings[name] = value;
            settings.push_back(setting(m, name, value, file_.where(where)));
        };
        // An object's type comes before its values.
        if (!prefix.empty()) {
            if (!values.contains("type")) fail(pointer, "'" + printable(prefix) + "' needs a 'type'");
            add(prefix, values["type"], pointer + "/type");
        }
        for (const auto& [key, value] : values.items()) {
            const std::string name = prefix.empty() ? key : prefix + "." + key;
            if (!prefix.empty() && key == "type") continue;
            if (value.is_object())
                add_settings(m, pointer + "/" + key, name, settings);
            else
                add(name, value, pointer + "/" + key);
        }
    }
    static core::IntegratorSetting setting(const Method& m, const std::string& key, const json& value,
                                           const core::SourceLocation& where) {
        const auto is_colour = [&] {
            return value.is_array() && value.size() == 3 &&
                   std::all_of(value.begin(), value.end(), [](const json& v) { return v.is_number(); });
        };
        std::string tag;
        if (value.is_boolean()) tag = "boolean";
        if (value.is_number_integer()) tag = "integer";
        if (value.is_number_float()) tag = "float";
        if (value.is_string()) tag = "string";
        if (is_colour()) tag = "rgb";
        if (tag.empty())
            throw InputError("'" + printable(key) + "' of the method '" + printable(m.name) +
                                 "' must be a number, a word, true, false or a list of three numbers",
                             where);
        return {key, tag, value_text(value), where};
    }

    const JsonLines& file_;
    const core::Registry& registry_;
    const core::Scene& scene_;
    std::vector<std::string>& warnings_;
    std::set<std::string> names_, slugs_;
};

}  // namespace

std::string slug_of(const std::string& name) {
    std::string slug;
    for (const char c : name) {
        const char lower = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
        const bool plain = (lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9') || lower == '_';
        if (plain) slug += lower;
        if (!plain && !slug.empty() && slug.back() != '-') slug += '-';
    }
    while (!slug.empty() && slug.back() == '-') slug.pop_back();
    return slug;
}

std::string Method::settings_text() const {
    std::string text;
    for (const auto& [key, value] : settings.items())
        text += (text.empty() ? "" : " ") + key + "=" + short_text(value);
    return text;
}

std::vector<std::string> Method::render_options() const {
    std::vector<std::string> options = {"--integrator", type};
    for (const auto& [key, value] : settings.items()) {
        options.emplace_back("-D");
        options.push_back("integrator." + key + "=" + short_text(value));
    }
    return options;
}

MethodsFile read_methods_file(const std::string& path, const core::Registry& registry,
                              const core::Scene& scene, std::vector<std::string>& warnings) {
    return read_methods(read_text(path), path, registry, scene, warnings);
}

MethodsFile read_methods(const std::string& text, const std::string& path, const core::Registry& registry,
                         const core::Scene& scene, std::vector<std::string>& warnings) {
    const JsonLines file(text, path);
    return Reader(file, registry, scene, warnings).read();
}

}  // namespace mote::trade
