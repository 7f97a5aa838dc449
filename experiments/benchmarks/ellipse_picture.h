// A picture of ellipses in random places, one before the other, with the bounds that their projection would
// give: what visibility queries are measured on. Long ones fill little of their rectangles, as most objects
// do.
#pragma once

#include <cmath>
#include <vector>

#include "core/math/random.h"
#include "screenspace/visibility/item_bounds.h"

namespace mote::benchmarks {

struct EllipsePicture {
    int width, height;
    std::vector<std::uint32_t> items;
    std::vector<screenspace::ItemBounds> bounds;

    screenspace::IdPicture view() const { return {width, height, items}; }
};

struct EllipseSettings {
    int width = 512, height = 512, count = 100;
    float min_radius = 6.0f, largest_radius = 11.0f;  ///< the longer half axis [pixels]
    float aspect = 3.0f;                              ///< of the longer to the shorter
    float spread =
        0.25f;  ///< fraction of the picture's width and height, about its middle, where middles lie
    std::uint64_t seed = 1;
};

/// (x, y) of a pixel, relative to the middle.
struct Ellipse {
    float x, y, a, b, cosine, sine;

    bool covers(float px, float py) const {
        const float dx = px - x, dy = py - y;
        const float u = (cosine * dx + sine * dy) / a, v = (cosine * dy - sine * dx) / b;
        return u * u + v * v <= 1.0f;
    }
    /// Half of its extent along (dx, dy), times the length of that.
    float reach(float dx, float dy) const {
        return std::hypot(a * (cosine * dx + sine * dy), b * (cosine * dy - sine * dx));
    }
    screenspace::ItemBounds bounds() const {
        return screenspace::bounds_of_outline(x, y, reach(1, 0), reach(0, 1), reach(1, 1), reach(1, -1));
    }
};

inline EllipsePicture make_ellipses(const EllipseSettings& s) {
    using namespace screenspace;
    EllipsePicture picture{s.width, s.height, {}, {}};
    picture.items.assign(std::size_t(s.width) * std::size_t(s.height), no_item);
    core::Rng rng(s.seed);
    for (int i = 0; i < s.count; ++i) {
        const float x = float(s.width) * (0.5f + s.spread * (rng.next_float() - 0.5f));
        const float y = float(s.height) * (0.5f + s.spread * (rng.next_float() - 0.5f));
        const float r = s.min_radius + (s.largest_radius - s.min_radius) * rng.next_float();
        const float turn = core::pi * rng.next_float();
        const Ellipse ellipse{x, y, r, r / s.aspect, std::cos(turn), std::sin(turn)};
        picture.bounds.push_back(ellipse.bounds());
        const PixelRectangle box = intersection(picture.bounds.back().rectangle, {0, 0, s.width, s.height});
        for (int py = box.y0; py < box.y1; ++py)
            for (int px = box.x0; px < box.x1; ++px)
                if (ellipse.covers(float(px) + 0.5f, float(py) + 0.5f))
                    picture.items[std::size_t(py) * std::size_t(s.width) + std::size_t(px)] =
                        std::uint32_t(i);
    }
    return picture;
}

}  // namespace mote::benchmarks
