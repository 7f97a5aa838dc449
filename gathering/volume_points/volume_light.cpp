#include "gathering/volume_points/volume_light.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/objects/error.h"

namespace mote::gathering {

using namespace core;

namespace {

/// Lobes more narrow than this are as narrow as this: nodes are not points.
constexpr float sharpest = 0.98f;

/// Of points, and their sums of nodes: power over 4 pi [W/sr], and the same as a vector.
struct Moments {
    Rgb mean{0.0f};
    Vec3 flow{0.0f};
    Moments operator+(const Moments& o) const { return {mean + o.mean, flow + o.flow}; }
};

}  // namespace

VolumeLight::VolumeLight(const VolumeHierarchy& hierarchy, const VolumePoints& points,
                         std::span<const Fluence> fluence) {
    const PointHierarchy& tree = hierarchy.tree();
    if (fluence.size() != points.size() || points.size() != tree.points())
        throw InputError(
            fmt::format("light of {} points for a hierarchy of {}", fluence.size(), tree.points()));
    std::vector<Moments> sums(tree.nodes().size());
    for (std::uint32_t leaf = 0; leaf < tree.points(); ++leaf) {
        const std::uint32_t i = tree.order()[leaf];
        if (!is_finite(fluence[i].amount) || !is_finite(Rgb(fluence[i].flow)))
            throw InputError("the light of points must be finite");
        const Rgb scattering = inv_four_pi * points.volumes[i] * points.sigma_s[i];
        const float g = points.states[i].current()->phase().mean_cosine();
        sums[leaf] = {scattering * fluence[i].amount, g * average(scattering) * fluence[i].flow};
    }
    for (std::uint32_t level = 1; level < tree.levels(); ++level)
        for (std::uint32_t i = 0; i < tree.count(level); ++i) {
            const NodePlace node{level, i}, a = node.first_child(), b{a.level, a.index + 1};
            Moments& sum = sums[tree.node_index(node)];
            sum = sums[tree.node_index(a)];
            if (tree.exists(b)) sum = sum + sums[tree.node_index(b)];
        }
    lobes_.reserve(sums.size());
    for (const Moments& m : sums) {
        const float length = glm::length(m.flow), whole = average(m.mean);
        const float g = whole > 0.0f ? std::min(length / whole, sharpest) : 0.0f;
        lobes_.push_back({m.mean, length > 0.0f ? m.flow / length : Vec3(0.0f, 0.0f, 1.0f), g});
    }
}

}  // namespace mote::gathering
