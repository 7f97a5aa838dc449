#include "screenspace/ssbc/mip_pyramid.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace mote::screenspace {

using namespace core;

namespace {

/// The indices of up to four children of node (x, y), in a fixed order.
struct Children {
    std::array<std::size_t, 4> index;
    int count = 0;
    Children(const PyramidLevel& below, int x, int y) {
        for (int j = 2 * y; j < std::min(2 * y + 2, below.height); ++j)
            for (int i = 2 * x; i < std::min(2 * x + 2, below.width); ++i)
                index[std::size_t(count++)] = below.index(i, j);
    }
};

/// True if b continues a's surface up to an angle, given by its cosine and its sine.
bool continues(const SurfaceNode& a, const SurfaceNode& b, float cosine, float sine) {
    const Vec3 na = glm::normalize(a.normal), d = b.position - a.position;
    if (glm::dot(na, glm::normalize(b.normal)) < cosine) return false;
    return sqr(glm::dot(na, d)) <= sqr(sine) * glm::dot(d, d);
}

/// Area, and the means over it.
SurfaceNode mean_of(const SurfacePyramid::Level& below, const Children& children) {
    SurfaceNode node;
    for (int c = 0; c < children.count; ++c) node.area += below.nodes[children.index[std::size_t(c)]].area;
    for (int c = 0; c < children.count && node.area > 0.0f; ++c) {
        const SurfaceNode& child = below.nodes[children.index[std::size_t(c)]];
        const float fraction = child.area / node.area;
        node.position += fraction * child.position, node.normal += fraction * child.normal;
    }
    node.spread = safe_sqrt(1.0f - glm::dot(node.normal, node.normal));
    return node;
}

SurfaceNode merged(const SurfacePyramid::Level& below, const Children& children) {
    SurfaceNode node = mean_of(below, children);
    const Vec3 n = glm::normalize(node.normal);
    for (int c = 0; c < children.count; ++c) {
        const SurfaceNode& child = below.nodes[children.index[std::size_t(c)]];
        if (child.area == 0.0f) continue;
        node.bounds.extend(child.bounds);
        const Vec3 d = child.position - node.position;
        node.radius = std::max(node.radius, glm::length(d) + child.radius);
        const float slope = glm::length(glm::cross(n, glm::normalize(child.normal)));
        const float depth = std::abs(glm::dot(n, d)) + child.thickness + slope * child.radius;
        node.thickness = std::max(node.thickness, depth);
    }
    // Opposite normals have no mean, and the node no plane.
    if (!is_finite(n)) node.thickness = node.radius;
    return node;
}

bool discontinuous(const SurfacePyramid::Level& below, const Children& children, float cosine, float sine) {
    for (int i = 0; i < children.count; ++i) {
        if (below.discontinuity[children.index[std::size_t(i)]]) return true;
        const SurfaceNode& a = below.nodes[children.index[std::size_t(i)]];
        for (int j = 0; j < children.count; ++j) {
            const SurfaceNode& b = below.nodes[children.index[std::size_t(j)]];
            if (i == j || a.area == 0.0f || b.area == 0.0f) continue;
            if (!continues(a, b, cosine, sine)) return true;
        }
    }
    return false;
}

}  // namespace

SurfaceNode patch_node(const PixelPatch& patch) {
    SurfaceNode node;
    node.position = patch.centre, node.normal = patch.normal, node.area = patch.area;
    node.radius = std::sqrt(glm::dot(patch.a, patch.a) + glm::dot(patch.b, patch.b) +
                            2.0f * std::abs(glm::dot(patch.a, patch.b)));
    const Vec3 reach = glm::abs(patch.a) + glm::abs(patch.b);
    node.bounds = {patch.centre - reach, patch.centre + reach};
    return node;
}

SurfacePyramid::SurfacePyramid(int width, int height, std::vector<PixelPatch> patches, float angle)
    : patches_(std::move(patches)) {
    Level picture;
    picture.width = width, picture.height = height;
    picture.nodes.resize(picture.size()), picture.discontinuity.assign(picture.size(), 0);
    tbb::parallel_for(std::size_t(0), picture.size(), [&](std::size_t i) {
        if (patches_[i].area > 0.0f) picture.nodes[i] = patch_node(patches_[i]);
    });
    levels_.push_back(std::move(picture));

    const float cosine = std::cos(angle), sine = std::sin(angle);
    while (levels_.back().size() > 1) {
        const Level& below = levels_.back();
        Level level;
        level.width = (below.width + 1) / 2, level.height = (below.height + 1) / 2;
        level.nodes.resize(level.size()), level.discontinuity.assign(level.size(), 0);
        tbb::parallel_for(0, level.height, [&](int y) {
            for (int x = 0; x < level.width; ++x) {
                const Children children(below, x, y);
                level.nodes[level.index(x, y)] = merged(below, children);
                level.discontinuity[level.index(x, y)] = discontinuous(below, children, cosine, sine);
            }
        });
        levels_.push_back(std::move(level));
    }
}

LightPyramid::LightPyramid(const SurfacePyramid& surfaces) {
    for (const SurfacePyramid::Level& level : surfaces.levels())
        levels_.emplace_back(level.size(), Rgb(0.0f));
}

void LightPyramid::fill(const SurfacePyramid& surfaces, std::span<const Rgb> radiance) {
    const auto& levels = surfaces.levels();
    tbb::parallel_for(std::size_t(0), levels[0].size(), [&](std::size_t i) {
        const float area = levels[0].nodes[i].area;
        levels_[0][i] = area > 0.0f ? area * radiance[i] : Rgb(0.0f);
    });
    for (std::size_t l = 1; l < levels.size(); ++l)
        tbb::parallel_for(0, levels[l].height, [&](int y) {
            for (int x = 0; x < levels[l].width; ++x) {
                const Children children(levels[l - 1], x, y);
                Rgb sum(0.0f);
                for (int c = 0; c < children.count; ++c)
                    sum += levels_[l - 1][children.index[std::size_t(c)]];
                levels_[l][levels[l].index(x, y)] = sum;
            }
        });
}

}  // namespace mote::screenspace
