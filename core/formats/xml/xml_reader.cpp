// Reads scene files with pugixml and turns them into plain elements.
#include "core/formats/xml/xml_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <pugixml.hpp>

namespace mote::core {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t max_file_bytes = std::uintmax_t(64) << 20;
constexpr int max_element_depth = 64;
constexpr std::size_t max_include_depth = 16, max_files = 1000, max_elements = 4'000'000;

/// One file: its text, the byte offsets at which its lines end, and how it is called in messages.
struct SourceText {
    std::string text, name, folder;
    std::vector<std::size_t> line_ends;
    bool legacy = false;

    SourceText(std::string text_, std::string name_, std::string folder_)
        : text(std::move(text_)), name(std::move(name_)), folder(std::move(folder_)) {
        for (std::size_t i = 0; i < text.size(); ++i)
            if (text[i] == '\n') line_ends.push_back(i);
    }
    SourceLocation at(std::ptrdiff_t offset) const {
        if (offset < 0) return {name, 0};
        const auto it = std::lower_bound(line_ends.begin(), line_ends.end(), std::size_t(offset));
        return {name, int(it - line_ends.begin()) + 1};
    }
};

std::string read_text(const std::string& path, const SourceLocation& named_at) {
    std::error_code error;
    if (!fs::is_regular_file(path, error))
        throw InputError(fs::exists(path, error) ? "'" + printable(path, 300) + "' is not a file"
                                                 : "file '" + printable(path, 300) + "' was not found",
                         named_at);
    const std::uintmax_t size = fs::file_size(path, error);
    if (error) throw InputError("file '" + printable(path, 300) + "': " + error.message(), named_at);
    if (size > max_file_bytes) throw InputError("the file is larger than 64 MB", {path, 0});
    std::string text(std::size_t(size), '\0');
    std::ifstream stream(path, std::ios::binary);
    if (!stream.read(text.data(), std::streamsize(size)))
        throw InputError("the file cannot be read", {path, 0});
    return text;
}

pugi::xml_document parse(const SourceText& source) {
    const std::string_view text = source.text;
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
        throw InputError("the file is UTF-16; scene files are UTF-8", {source.name, 1});
    if (const auto zero = text.find('\0'); zero != std::string_view::npos)
        throw InputError("the file holds a zero byte; it is no XML", source.at(std::ptrdiff_t(zero)));
    pugi::xml_document document;
    const pugi::xml_parse_result result =
        document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!result)
        throw InputError(std::string("malformed XML: ") + result.description(), source.at(result.offset));
    return document;
}

/// "3.0.0" -> {3, 0, 0}.
std::array<int, 3> parse_version(const std::string& text, const SourceLocation& where) {
    std::array<int, 3> version{};
    const char* p = text.data();
    const char* const end = p + text.size();
    for (std::size_t i = 0; i < 3; ++i) {
        const auto [next, error] = std::from_chars(p, end, version[i]);
        if (error != std::errc() || version[i] < 0)
            throw InputError("'" + printable(text) + "' is not a version such as 3.0.0", where);
        p = next;
        if (p == end) return version;
        if (*p++ != '.') break;
    }
    if (p != end) throw InputError("'" + printable(text) + "' is not a version such as 3.0.0", where);
    return version;
}

class Reader {
  public:
    explicit Reader(SceneDefines& defines) : defines_(defines) {}

    SceneDocument read(SourceText source, const std::string& path) {
        document_.search_paths.push_back(source.folder);
        if (!path.empty()) document_.files.push_back(path);
        open_.push_back(canonical(path));
        document_.scene = read_root(source);
        if (document_.scene.tag != "scene")
            throw InputError("a scene file starts with <scene>, not <" + printable(document_.scene.tag) + ">",
                             document_.scene.where);
        return std::move(document_);
    }

  private:
    static std::string canonical(const std::string& path) {
        std::error_code error;
        const fs::path result = fs::weakly_canonical(path, error);
        return error ? path : result.string();
    }

    Element read_root(SourceText& source) {
        const pugi::xml_document xml = parse(source);
        pugi::xml_node root;
        for (const pugi::xml_node node : xml.children()) {
            const SourceLocation where = source.at(node.offset_debug());
            if (node.type() != pugi::node_element) throw InputError("text outside of any element", where);
            if (root) throw InputError("more than one element at the top of the file", where);
            root = node;
        }
        const SourceLocation where = source.at(root.offset_debug());
        if (std::string_view(root.name()) == "scene") {
            if (const pugi::xml_attribute version = root.attribute("version"))
                source.legacy = parse_version(version.value(), where)[0] < 2;
            else
                document_.warnings.push_back(
                    InputError("<scene> has no version; 3.0.0 is assumed", where).what());
        }
        return read_element(root, source, 0);
    }

    Element read_element(const pugi::xml_node& node, const SourceText& source, int depth) {
        Element e;
        e.tag = node.name();
        e.where = source.at(node.offset_debug());
        e.folder = source.folder;
        e.legacy = source.legacy;
        if (depth > max_element_depth) throw InputError("elements are nested more than 64 deep", e.where);
        if (++elements_ > max_elements) throw InputError("more than 4 million elements", e.where);
        for (const pugi::xml_attribute attribute : node.attributes()) {
            e.guard([&] {
                if (e.find(attribute.name()))
                    throw InputError("attribute '" + printable(attribute.name()) + "' is given twice",
                                     e.where);
                e.attributes.emplace_back(attribute.name(), attribute.value());
                e.attributes.back().second = defines_.substitute(attribute.value(), e.where);
            });
        }
        for (const pugi::xml_node child : node.children()) {
            if (child.type() == pugi::node_element)
                add_child(e, read_element(child, source, depth + 1), depth);
            else
                e.children.push_back(stray_text(e, child.value(), source.at(child.offset_debug())));
        }
        return e;
    }

    /// Words between elements: a fault that stands where they stand.
    static Element stray_text(const Element& parent, const char* text, const SourceLocation& where) {
        Element e;
        e.where = where, e.folder = parent.folder;
        e.fault = std::make_shared<const InputError>(
            "text inside <" + printable(parent.tag) + ">: '" + printable(text, 40) + "'", where);
        return e;
    }

    /// Handles the elements that speak to the reader itself; everything else, and what is wrong with these,
    /// becomes a child.
    void add_child(Element& parent, Element child, int depth) {
        const bool ours = child.tag == "default" || child.tag == "include" || child.tag == "path";
        std::string included;
        if (ours && !child.fault) child.guard([&] { obey(child, depth, included); });
        if (!ours || child.fault)
            parent.children.push_back(std::move(child));
        else if (!included.empty())
            include(parent, child, included);
    }

    /// Applies the element; the file of an <include> is left to the caller.
    void obey(const Element& e, int depth, std::string& included) {
        if (!e.children.empty())
            throw InputError("<" + e.tag + "> holds no other elements", e.children.front().where);
        if (depth > 0) throw InputError("<" + e.tag + "> belongs directly into <scene>", e.where);
        if (e.tag == "default") {
            e.check_attributes({"name", "value"});
            defines_.set_default(e.require("name"), e.require("value"));
        } else if (e.tag == "path") {
            e.check_attributes({"value"});
            add_search_path(e);
        } else {
            e.check_attributes({"filename"});
            included = check_included(e);
        }
    }

    void add_search_path(const Element& e) {
        const fs::path path = fs::path(e.folder) / e.require("value");
        std::error_code error;
        if (!fs::is_directory(path, error))
            throw InputError("folder '" + printable(e.require("value"), 300) + "' was not found", e.where);
        document_.search_paths.push_back(path.string());
    }

    std::string find_included(const Element& e) const {
        const fs::path file = e.require("filename");
        if (file.empty()) throw InputError("<include> needs a file name", e.where);
        std::error_code error;
        const fs::path beside = fs::path(e.folder) / file;
        if (fs::exists(beside, error)) return beside.string();
        for (const std::string& folder : document_.search_paths)
            if (fs::exists(fs::path(folder) / file, error)) return (fs::path(folder) / file).string();
        return beside.string();
    }

    /// The path of the file to be included. Throws InputError where it cannot be.
    std::string check_included(const Element& e) {
        const std::string path = find_included(e);
        std::error_code error;
        if (!fs::is_regular_file(path, error)) read_text(path, e.where);  // says what is wrong
        if (std::find(open_.begin(), open_.end(), canonical(path)) != open_.end())
            throw InputError("'" + printable(path, 300) + "' includes itself", e.where);
        if (open_.size() >= max_include_depth)
            throw InputError("includes are nested more than 16 deep", e.where);
        if (++files_read_ > max_files) throw InputError("more than 1000 files are included", e.where);
        return path;
    }

    /// Malformed XML ends all reading.
    void include(Element& parent, const Element& e, const std::string& path) {
        open_.push_back(canonical(path));
        document_.files.push_back(path);
        SourceText source(read_text(path, e.where), path, fs::path(path).parent_path().string());
        Element included = read_root(source);
        open_.pop_back();
        if (included.tag == "scene") {
            included.guard([&] { included.check_attributes({"version"}); });
            if (included.fault) {
                parent.children.push_back(e);
                parent.children.back().fault = included.fault;
            }
            for (Element& c : included.children) parent.children.push_back(std::move(c));
        } else {
            parent.children.push_back(std::move(included));
        }
    }

    SceneDefines& defines_;
    SceneDocument document_;
    std::vector<std::string> open_;  ///< files that are being read, to find cycles
    std::size_t elements_ = 0, files_read_ = 0;
};

}  // namespace

SceneDocument read_scene_file(const std::string& path, SceneDefines& defines) {
    SourceText source(read_text(path, {}), path, fs::path(path).parent_path().string());
    return Reader(defines).read(std::move(source), path);
}

SceneDocument read_scene_text(const std::string& xml, const std::string& folder, const std::string& name,
                              SceneDefines& defines) {
    if (xml.size() > max_file_bytes) throw InputError("the scene is larger than 64 MB", {name, 0});
    return Reader(defines).read(SourceText(xml, name, folder), "");
}

}  // namespace mote::core
