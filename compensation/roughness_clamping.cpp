#include "compensation/roughness_clamping.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "core/math/kd_tree.h"

namespace mote::compensation {

using namespace core;

void clamp_roughness(lights::VplSet& vpls, const RoughnessClamping& clamping, float fraction) {
    vpls.peak_density.assign(vpls.lights.size(), infinity);
    std::vector<Vec3> points;
    std::vector<std::size_t> index;
    for (std::size_t j = 0; j < vpls.lights.size(); ++j)
        if (vpls.lights[j].on_surface()) points.push_back(vpls.lights[j].position), index.push_back(j);
    const KdTree tree(points);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 256), [&](const auto& range) {
        std::vector<KdTree::Neighbour> heap;
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            // The light itself is one of those found. Fewer than m' lights have m'/n of the density.
            tree.nearest(points[i], std::size_t(clamping.neighbours) + 1, infinity, heap);
            const float r2 = heap.front().distance_squared;
            const float known = float(heap.size() - 1) / float(clamping.neighbours);
            vpls.peak_density[index[i]] = heap.size() > 1 ? fraction * known / (pi * r2) : 0.0f;
        }
    });
}

}  // namespace mote::compensation
