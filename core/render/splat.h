// Pixels that a light path reaches that ends at a film position, and its weight there.
//
// A pixel's value is int f_j(x) I(x) dx (see camera.h), so a light path of contribution c (its power times
// CameraSample::weight, over the number of light paths traced) that ends at x adds c f_j(x) to every pixel j
// within the filter's reach. Eye paths of the same pixel need no such factor: they sample x by f_j itself.
//
// Multiple importance sampling of both techniques may leave the filter out of the weights: let eye paths have
// the density of one ray a pixel, as RayImportance counts it. The weights of one path then add up to 1 in
// every pixel, whatever f_j is there.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/render/integrator.h"

namespace mote::core {

/// Calls visit(x, y, f_j(film_position)) for every pixel j = (x, y) of the film where that is not zero.
template <typename Visit>
void for_each_splat(const PixelFilter& filter, const Vec2& film_position, int width, int height,
                    const Visit& visit) {
    const float r = filter.radius();
    // Centres at x + 1/2 no farther away than r.
    const auto first = [&](float at) { return std::max(0, int(std::ceil(at - r - 0.5f))); };
    const auto last = [&](float at, int size) { return std::min(size - 1, int(std::floor(at + r - 0.5f))); };
    for (int y = first(film_position.y); y <= last(film_position.y, height); ++y)
        for (int x = first(film_position.x); x <= last(film_position.x, width); ++x) {
            const Vec2 center(float(x) + 0.5f, float(y) + 0.5f);
            if (const float f = filter.pdf_area(film_position - center); f > 0.0f) visit(x, y, f);
        }
}

}  // namespace mote::core
