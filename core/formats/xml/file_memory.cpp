#include "core/formats/xml/file_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "core/objects/properties.h"

namespace mote::core {

namespace {

class FilesOfScene {
  public:
    FilesOfScene(const SceneDocument& document, const Registry& registry)
        : document_(document), registry_(registry) {}

    std::vector<MemoryOfFile> all() {
        visit(document_.scene);
        std::vector<MemoryOfFile> files;
        for (const auto& [path, bytes] : bytes_) files.push_back({path, bytes});
        std::stable_sort(files.begin(), files.end(),
                         [](const MemoryOfFile& a, const MemoryOfFile& b) { return a.bytes > b.bytes; });
        return files;
    }

  private:
    void visit(const Element& element) {
        for (const Element& child : element.children) visit(child);
        const auto category = find_category(element.tag);
        const FileMemory* memory = category ? registry_.file_memory(*category, element.get("type")) : nullptr;
        if (!memory) return;
        try {
            const Properties p = texts_of(element);
            const std::string path = p.find_file("filename");
            if (seen_.insert(path + values_of(element)).second) bytes_[path] += (*memory)(p);
        } catch (const std::exception&) {  // loading says what is wrong with it
        }
    }
    Properties texts_of(const Element& element) const {
        Properties p;
        p.search_paths = document_.search_paths;
        p.search_paths.insert(p.search_paths.begin(), element.folder);
        for (const Element& child : element.children)
            if (child.tag == "string") p.values[child.get("name")] = {child.get("value"), child.where};
        return p;
    }
    /// Those that decide what is loaded: materials, media and lights do not.
    static std::string values_of(const Element& element) {
        std::string text = " " + element.tag;
        for (const auto& [name, value] : element.attributes)
            if (name != "id" && name != "name") text += " " + value;
        for (const Element& child : element.children)
            if (child.tag != "ref" && !find_category(child.tag)) text += values_of(child);
        return text;
    }

    const SceneDocument& document_;
    const Registry& registry_;
    std::map<std::string, double> bytes_;
    std::set<std::string> seen_;
};

std::string named(const MemoryOfFile& file) {
    return fmt::format("{} {:.2g} GB", printable(std::filesystem::path(file.path).filename().string(), 100),
                       file.bytes * 1e-9);
}

}  // namespace

std::vector<MemoryOfFile> memory_of_files(const SceneDocument& document, const Registry& registry) {
    return FilesOfScene(document, registry).all();
}

double sum_of(const std::vector<MemoryOfFile>& files) {
    double sum = 0.0;
    for (const MemoryOfFile& file : files) sum += file.bytes;
    return sum;
}

std::string memory_summary(const std::vector<MemoryOfFile>& files) {
    constexpr std::size_t most = 3;
    std::string text = fmt::format("{:.2g} GB: ", sum_of(files) * 1e-9);
    for (std::size_t i = 0; i < std::min(most, files.size()); ++i)
        text += (i > 0 ? ", " : "") + named(files[i]);
    return text + (files.size() > most ? ", ..." : "");
}

void require_memory(const std::vector<MemoryOfFile>& files, const MemoryBudget& memory) {
    memory.require(sum_of(files), "the files of the scene", [&](double available) {
        double rest = sum_of(files);
        std::string without;
        for (const MemoryOfFile& file : files) {
            if (rest <= available) break;
            rest -= file.bytes;
            without += (without.empty() ? "" : ", ") + named(file);
        }
        return "what fits: all without " + without;
    });
}

}  // namespace mote::core
