// The exported folder: the scene, its files, and the list of what was dropped.
#include <filesystem>
#include <pugixml.hpp>
#include <sstream>

#include "apps/export/mitsuba_export.h"
#include "core/formats/meshes/ply_writer.h"
#include "session/output_files.h"

namespace mote::apps {

using namespace session;

using core::Element;

namespace fs = std::filesystem;

namespace {

void add(pugi::xml_node parent, const Element& e) {
    pugi::xml_node node = parent.append_child(e.tag.c_str());
    for (const auto& [key, value] : e.attributes) node.append_attribute(key.c_str()) = value.c_str();
    for (const Element& c : e.children) add(node, c);
}

std::string xml_text(const Element& scene) {
    pugi::xml_document document;
    add(document, scene);
    std::ostringstream stream;
    document.save(stream, "    ");
    return stream.str();
}

std::string list_of(const std::vector<std::string>& notes) {
    if (notes.empty()) return "nothing was dropped or changed\n";
    std::string text;
    for (const std::string& note : notes) text += note + "\n";
    return text;
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw core::InputError("cannot be made: " + error.message(), {folder.string(), 0});
}

void copy_file(const std::string& from, const fs::path& to) {
    std::error_code error;
    if (fs::equivalent(from, to, error)) return;
    fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
    if (error) throw core::InputError("cannot be copied: " + error.message(), {from, 0});
}

void check_files(const MitsubaExport& result, const fs::path& root) {
    std::vector<NamedFile> outputs;
    const auto add = [&](const std::string& name) {
        outputs.push_back({"'" + name + "' of the export", (root / name).string()});
    };
    add("scene.xml"), add("dropped.txt");
    for (const auto& [name, source] : result.copies)
        if (!same_file(source, (root / name).string())) add(name);  // else it stays as it is
    for (const auto& [name, grid] : result.grids) add(name);
    for (const auto& [name, mesh] : result.meshes) add(name);
    check_outputs(outputs, scene_inputs(result.inputs));
    check_companions(outputs, (root / "dropped.txt").string());
}

}  // namespace

void write_export(const MitsubaExport& result, const std::string& folder) {
    const fs::path root(folder);
    check_files(result, root);
    make_folder(root);
    const auto place = [&](const std::string& name) {
        make_folder((root / name).parent_path());
        return root / name;
    };
    for (const auto& [name, source] : result.copies) copy_file(source, place(name));
    for (const auto& [name, grid] : result.grids) media::write_vol_file(place(name).string(), grid);
    for (const auto& [name, mesh] : result.meshes) write_text(place(name).string(), core::ply_bytes(mesh));
    write_text((root / "scene.xml").string(), xml_text(result.scene));
    write_text((root / "dropped.txt").string(), list_of(result.notes));
}

}  // namespace mote::apps
