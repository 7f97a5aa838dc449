#include "core/scene/light_tree.h"

#include "core/scene/light_clustering.h"

namespace mote::core {
namespace {

double sum_of(const LightImportances& values) {
    double sum = 0.0;
    for (const float value : values) sum += double(value);
    return sum;
}

}  // namespace

LightTree::LightTree(std::span<const LightBounds> lights) : leaves_(lights.size()) {
    if (lights.empty()) return;
    LightClustering clustering(lights);
    struct Work {
        LightRun run;
        Place parent;
        int depth;
    };
    std::vector<Work> works{{clustering.all(), {}, 1}};
    while (!works.empty()) {
        const Work work = works.back();
        works.pop_back();
        depth_ = std::max(depth_, work.depth);
        const auto index = std::uint32_t(nodes_.size());
        if (work.parent.node != none) nodes_[work.parent.node].child[work.parent.slot] = index;
        const std::vector<LightRun> runs = clustering.cut_into(work.run, LightClusters::width);
        std::vector<LightBounds> clusters;
        Node node;
        node.parent = work.parent, node.children = std::uint32_t(runs.size());
        for (std::uint32_t slot = 0; slot < runs.size(); ++slot) {
            clusters.push_back(runs[slot].bounds);
            if (runs[slot].size() == 1) {
                const std::uint32_t light = clustering.light(runs[slot]);
                node.is_light[slot] = true, node.child[slot] = light, leaves_[light] = {index, slot};
            } else {
                works.push_back({runs[slot], {index, slot}, work.depth + 1});
            }
        }
        node.clusters = LightClusters(clusters);
        nodes_.push_back(node);
    }
}

template <typename Where>
LightImportances LightTree::importances(const Node& node, const Where& where) {
    LightImportances result = light_importances(node.clusters, where);
    const double sum = sum_of(result);
    if (sum > 0.0 && std::isfinite(sum)) return result;
    for (std::uint32_t slot = 0; slot < LightClusters::width; ++slot)
        result[slot] = slot < node.children ? 1.0f : 0.0f;
    return result;
}

template <typename Where>
LightTree::Choice LightTree::sample(const Where& where, double u) const {
    Choice choice{0, 1.0};
    for (const Node* node = &nodes_.front();;) {
        const LightImportances importance = importances(*node, where);
        const double sum = sum_of(importance);
        double left = u * sum;
        std::uint32_t slot = 0, last = 0;  // `last` of positive importance: rounding must not go beyond it
        for (std::uint32_t i = 0; i < node->children; ++i) last = importance[i] > 0.0f ? i : last;
        while (slot < last && left >= double(importance[slot])) left -= double(importance[slot++]);
        u = std::min(left / double(importance[slot]), 1.0 - 0x1p-53);
        choice.probability *= double(importance[slot]) / sum;
        choice.light = node->child[slot];
        if (node->is_light[slot]) return choice;
        node = &nodes_[choice.light];
    }
}

template <typename Where>
double LightTree::probability(const Where& where, std::uint32_t light) const {
    double probability = 1.0;
    for (Place place = leaves_[light]; place.node != none; place = nodes_[place.node].parent) {
        const LightImportances importance = importances(nodes_[place.node], where);
        probability *= double(importance[place.slot]) / sum_of(importance);
    }
    return probability;
}

template LightTree::Choice LightTree::sample(const LightReceiver&, double) const;
template LightTree::Choice LightTree::sample(const LightSegment&, double) const;
template double LightTree::probability(const LightReceiver&, std::uint32_t) const;
template double LightTree::probability(const LightSegment&, std::uint32_t) const;

}  // namespace mote::core
