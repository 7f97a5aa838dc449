// Light that light paths bring to the film. A task keeps its own in order; when all tasks of a part of the
// picture are done they are added up task by task, so that the sum has the same bits on any number of
// threads.
#pragma once

#include <tbb/parallel_for.h>

#include <vector>

#include "core/render/splat.h"

namespace mote::integrators {

struct Splat {
    core::Vec2 film;  ///< [pixels]
    core::Rgb light;  ///< over the number of light paths for one ray of each pixel
    std::uint32_t layer;
};

/// Adds the splats of all tasks, in their order, to the layers of the image (see core/render/splat.h).
/// Threads share out the rows.
inline void add_splats(const std::vector<std::vector<Splat>>& tasks, const core::PixelFilter& filter,
                       core::PassImage& image) {
    constexpr int rows = 32;
    const float reach = filter.radius() + 1.0f;
    tbb::parallel_for(0, (image.height() + rows - 1) / rows, [&](int band) {
        const int begin = band * rows, end = std::min(image.height(), begin + rows);
        for (const auto& splats : tasks)
            for (const Splat& splat : splats) {
                if (splat.film.y < float(begin) - reach || splat.film.y > float(end) + reach) continue;
                core::for_each_splat(filter, splat.film, image.width(), image.height(),
                                     [&](int x, int y, float f) {
                                         if (y >= begin && y < end)
                                             image.at(splat.layer, x, y) += f * splat.light;
                                     });
            }
    });
}

}  // namespace mote::integrators
