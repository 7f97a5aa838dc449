#include "experiments/studies/selection/references.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <filesystem>
#include <fstream>
#include <mutex>

namespace mote::studies {

namespace {

/// The first line of a file: what its sums are of.
std::string title(const Study& study, const Arguments& a) {
    return fmt::format("{} lights of {} paths, bound {:g}, {} points, {} x {}: {}", study.lights(), a.paths,
                       double(a.bound), a.points, a.width, a.height,
                       std::filesystem::path(a.scene).stem().string());
}

std::string line_of(const glm::ivec2& tile, const Pixels& light) {
    std::string line = fmt::format("{} {}", tile.x, tile.y);
    for (const double v : light) line += fmt::format(" {:.9g}", v);
    return line + "\n";
}

/// The tiles that a file holds. Nothing where there is no file.
std::vector<std::pair<glm::ivec2, Pixels>> read(const std::string& path, const std::string& title) {
    std::vector<std::pair<glm::ivec2, Pixels>> found;
    std::ifstream file(path);
    std::string line;
    if (!std::getline(file, line)) return found;
    if (line != title)
        throw std::runtime_error(fmt::format("{} holds sums of\n{}\nnot of\n{}", path, line, title));
    glm::ivec2 tile;
    while (file >> tile.x >> tile.y) {
        Pixels light{};
        for (double& v : light) file >> v;
        if (file) found.emplace_back(tile, light);
    }
    return found;
}

}  // namespace

std::vector<Pixels> references_of(const Study& study, const Arguments& a) {
    std::vector<Pixels> references(study.tiles());
    std::vector<std::size_t> missing;
    const auto stored = a.references.empty() ? std::vector<std::pair<glm::ivec2, Pixels>>{}
                                             : read(a.references, title(study, a));
    for (std::size_t t = 0; t < study.tiles(); ++t) {
        const auto found = std::find_if(stored.begin(), stored.end(),
                                        [&](const auto& item) { return item.first == study.tile(t); });
        if (found != stored.end())
            references[t] = found->second;
        else
            missing.push_back(t);
    }
    std::ofstream file;
    if (!a.references.empty() && !missing.empty()) {
        file.open(a.references, std::ios::app);
        if (!file) throw std::runtime_error("cannot write " + a.references);
        if (stored.empty()) file << title(study, a) << "\n";
    }
    std::mutex mutex;
    const Study::Method all = study.prepare("all");
    tbb::parallel_for(std::size_t(0), missing.size(), [&](std::size_t m) {
        const std::size_t t = missing[m];
        TileCost cost;
        references[t] = study.render(t, all, cost);
        const std::lock_guard lock(mutex);
        if (file.is_open()) file << line_of(study.tile(t), references[t]) << std::flush;
    });
    return references;
}

}  // namespace mote::studies
