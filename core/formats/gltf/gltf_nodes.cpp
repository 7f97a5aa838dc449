// Depth first through the tree.
#include "core/formats/gltf/gltf_nodes.h"

#include <algorithm>
#include <glm/gtc/quaternion.hpp>

namespace mote::core {
namespace {

Transform local_transform(const GltfValue& node) {
    if (node["matrix"].present()) {
        const auto n = node["matrix"].numbers(std::vector<double>(16, 0.0));
        glm::dmat4 m;
        for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = n[std::size_t(i)];  // column by column
        return Transform(m);
    }
    const auto t = node["translation"].numbers({0, 0, 0}), s = node["scale"].numbers({1, 1, 1});
    const auto r = node["rotation"].numbers({0, 0, 0, 1});
    const glm::dquat q(r[3], r[0], r[1], r[2]);
    const double length = glm::length(q);
    if (!(length > 0.0)) node["rotation"].refuse("is no quaternion");
    glm::dmat4 m = glm::translate(glm::dmat4(1.0), glm::dvec3(t[0], t[1], t[2]));
    m = m * glm::mat4_cast(q / length);
    return Transform(glm::scale(m, glm::dvec3(s[0], s[1], s[2])));
}

void check(const GltfFile& file, const GltfValue& node, ConversionReport& report) {
    if (node["skin"].present() && node["mesh"].present())
        report.fault(node.title() + " is a skin over bones, whose pose is not built in",
                     "it stands as it is stored");
    if (node["extensions"]["EXT_mesh_gpu_instancing"].present())
        report.fault(node.title() + " stands in many places by EXT_mesh_gpu_instancing, which is not read",
                     "it stands in one place");
    const auto mesh = node["mesh"].index_below(file.root()["meshes"].size());
    if (!mesh) return;
    const GltfValue own = node["weights"], shared = file.root()["meshes"].at(*mesh)["weights"];
    const GltfValue weights = own.present() ? own : shared;
    for (std::size_t i = 0; i < weights.size(); ++i)
        if (weights.at(i).number(0.0) != 0.0)
            report.fault(node.title() + " has a shape key (morph target), which is not built in",
                         "it has its basic shape");
}

}  // namespace

std::vector<GltfNode> gltf_nodes(const GltfFile& file, ConversionReport& report) {
    const GltfValue nodes = file.root()["nodes"], scenes = file.root()["scenes"];
    std::vector<GltfNode> all;
    if (scenes.size() == 0) return all;
    const GltfValue scene = scenes.at(file.root()["scene"].index_below(scenes.size()).value_or(0));
    std::vector<bool> seen(nodes.size(), false);
    std::vector<std::pair<std::size_t, Transform>> stack;
    const auto push = [&](const GltfValue& list, const Transform& parent) {
        for (std::size_t i = list.size(); i-- > 0;) {
            const auto number = list.at(i).index_below(nodes.size());
            if (number) stack.emplace_back(*number, parent);
        }
    };
    push(scene["nodes"], Transform());
    while (!stack.empty()) {
        const auto [number, parent] = stack.back();
        stack.pop_back();
        const GltfValue node = nodes.at(number);
        if (seen[number]) node.refuse("is reached twice: nodes form a tree");
        seen[number] = true;
        check(file, node, report);
        all.push_back({node, parent * local_transform(node)});
        push(node["children"], all.back().to_world);
    }
    return all;
}

}  // namespace mote::core
