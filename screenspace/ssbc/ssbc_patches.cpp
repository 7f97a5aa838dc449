#include "screenspace/ssbc/ssbc_patches.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/math/frame.h"
#include "screenspace/ssbc/ssbc_upsampling.h"

namespace mote::screenspace {

using namespace core;

namespace {

/// A pixel and its neighbours in the picture, on all sides.
class Neighbourhood {
  public:
    Neighbourhood(const SsbcSurfaces& surfaces, const SideLayout& layout, float sine, int side, int x, int y)
        : s_(surfaces), layout_(layout), sine_(sine), side_(side), x_(x), y_(y), here_(index(side, x, y)) {}

    PixelPatch patch() const {
        const auto [along_x, along_y] = steps();
        const float left = reach(-1, 0, -along_x, along_y), right = reach(1, 0, along_x, along_y);
        const float up = reach(0, -1, -along_y, along_x), down = reach(0, 1, along_y, along_x);
        PixelPatch p;
        p.a = 0.5f * (left + right) * along_x, p.b = 0.5f * (up + down) * along_y;
        p.centre = s_.position[here_] + 0.5f * (right - left) * along_x + 0.5f * (down - up) * along_y;
        p.normal = s_.normal[here_], p.area = s_.area[here_] * (left + right) * (up + down);
        return p;
    }

  private:
    std::size_t index(int side, int x, int y) const {
        return std::size_t(side * layout_.pitch + y) * std::size_t(s_.width) + std::size_t(x);
    }
    bool takes_part(int side, int dx, int dy) const {
        const int x = x_ + dx, y = y_ + dy;
        return x >= 0 && y >= 0 && x < s_.width && y < layout_.height && s_.area[index(side, x, y)] > 0.0f;
    }
    bool continues(int side, int dx, int dy) const {
        return takes_part(side, dx, dy) &&
               same_surface(s_, here_, index(side, x_ + dx, y_ + dy), sine_) > 0.0f;
    }
    /// Where the surface continues there: on its own side, or else on the first that has it.
    std::optional<std::size_t> next(int dx, int dy) const {
        if (continues(side_, dx, dy)) return index(side_, x_ + dx, y_ + dy);
        for (int side = 0; side < layout_.sides; ++side)
            if (side != side_ && continues(side, dx, dy)) return index(side, x_ + dx, y_ + dy);
        return std::nullopt;
    }

    /// Distance that the point of the surface moves with one pixel [m], from neighbours on the same surface;
    /// zero where there are none. The nearer of two: where the surface runs to the horizon the other is
    /// anywhere.
    Vec3 step(int dx, int dy) const {
        const Vec3 &p = s_.position[here_], &n = s_.normal[here_];
        Vec3 forward(0.0f), back(0.0f);
        if (const auto there = next(dx, dy)) forward = s_.position[*there] - p;
        if (const auto there = next(-dx, -dy)) back = p - s_.position[*there];
        forward -= n * glm::dot(n, forward), back -= n * glm::dot(n, back);
        const float f = glm::dot(forward, forward), b = glm::dot(back, back);
        return b == 0.0f || (f > 0.0f && f < b) ? forward : back;
    }
    /// Both steps; without a neighbour the patch is made a rectangle of the right area, but no strip
    /// that is longer than those at a slant of 80 degrees.
    std::pair<Vec3, Vec3> steps() const {
        const Vec3& n = s_.normal[here_];
        const float area = s_.area[here_];
        const Vec3 x = step(1, 0), y = step(0, 1);
        const float xx = glm::dot(x, x), yy = glm::dot(y, y);
        if (xx > 0.0f && yy > 0.0f) return {x, y};
        if (xx > 0.0f) return {x, glm::cross(n, x) * std::min(area / xx, 6.0f)};
        if (yy > 0.0f) return {glm::cross(y, n) * std::min(area / yy, 6.0f), y};
        const Frame frame(n);
        return {frame.s * std::sqrt(area), frame.t * std::sqrt(area)};
    }
    /// Fraction of `towards`, the step to a neighbour, that belongs to the patch: all of it up to a concave
    /// edge, the nearest one.
    float reach(int dx, int dy, const Vec3& towards, const Vec3& other_step) const {
        float nearest = infinity;
        const auto shorten_to = [&](std::size_t there) {
            if (const auto edge = cut(there, dx, towards, other_step)) nearest = std::min(nearest, *edge);
        };
        if (takes_part(side_, dx, dy) && !continues(side_, dx, dy))
            shorten_to(index(side_, x_ + dx, y_ + dy));
        for (int side = 0; side < layout_.sides; ++side) {
            if (side == side_) continue;
            for (const int there : {0, 1})
                if (takes_part(side, there * dx, there * dy)) {
                    const std::size_t i = index(side, x_ + there * dx, y_ + there * dy);
                    if (crosses(i)) shorten_to(i);
                }
        }
        return nearest < infinity ? nearest : 0.5f;
    }
    /// Not so for surfaces along each other, such as the two sides of one.
    bool crosses(std::size_t there) const {
        const float aligned = glm::dot(s_.normal[here_], s_.normal[there]);
        return 1.0f - sqr(aligned) > sqr(sine_);
    }
    /// Fraction of the step before the surface `there`, if both meet in a concave edge within the step.
    std::optional<float> cut(std::size_t there, int dx, const Vec3& towards, const Vec3& other_step) const {
        const Vec3 d = s_.position[there] - s_.position[here_];
        const float over_there = -glm::dot(s_.normal[there], d), over_here = glm::dot(s_.normal[here_], d);
        const float approach = -glm::dot(s_.normal[there], towards);
        const float rounding = -1e-3f * glm::length(d);  // a centre may lie on the edge itself
        if (over_there < rounding || over_here < rounding) return std::nullopt;
        if (over_there > 1.25f * approach || !(approach > -rounding))
            return std::nullopt;  // perspective bends steps
        const float across = std::abs(glm::dot(s_.normal[there], other_step));
        if (approach < across || (approach == across && dx != 0)) return std::nullopt;
        return std::clamp(over_there / approach, 0.05f, 1.0f);
    }

    const SsbcSurfaces& s_;
    const SideLayout& layout_;
    const float sine_;
    const int side_, x_, y_;
    const std::size_t here_;
};

}  // namespace

std::vector<PixelPatch> pixel_patches(const SsbcSurfaces& surfaces, float angle) {
    return pixel_patches(surfaces, {surfaces.height, surfaces.height, 1}, angle);
}

std::vector<PixelPatch> pixel_patches(const SsbcSurfaces& surfaces, const SideLayout& layout, float angle) {
    std::vector<PixelPatch> patches(surfaces.pixel_count());
    const float sine = std::sin(angle);
    tbb::parallel_for(0, layout.sides * layout.height, [&](int row) {
        const int side = row / layout.height, y = row % layout.height;
        for (int x = 0; x < surfaces.width; ++x) {
            const std::size_t i =
                std::size_t(side * layout.pitch + y) * std::size_t(surfaces.width) + std::size_t(x);
            if (surfaces.area[i] > 0.0f)
                patches[i] = Neighbourhood(surfaces, layout, sine, side, x, y).patch();
        }
    });
    return patches;
}

}  // namespace mote::screenspace
