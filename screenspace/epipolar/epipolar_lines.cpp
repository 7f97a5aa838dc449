#include "screenspace/epipolar/epipolar_lines.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace mote::screenspace {

namespace {

/// Distance from p in direction v to the border of the rectangle, and the side that is met: 0 top (lower y),
/// 1 right, 2 bottom, 3 left.
struct Exit {
    double t = 0.0;
    int side = 0;
};
Exit leave(const FilmRectangle& frame, const Vec2d& p, const Vec2d& v) {
    Exit exit{std::numeric_limits<double>::infinity(), 0};
    const auto side = [&](int index, double distance, double speed) {
        const double t = speed > 0.0 ? std::max(distance, 0.0) / speed : exit.t;
        if (speed > 0.0 && t < exit.t) exit = {t, index};
    };
    side(0, p.y - frame.lower.y, -v.y), side(1, frame.upper.x - p.x, v.x);
    side(2, frame.upper.y - p.y, v.y), side(3, p.x - frame.lower.x, -v.x);
    return exit;
}

}  // namespace

double EpipolarLine::project(const Vec2d& p) const {
    const Vec2d along = end - start;
    const double squared = glm::dot(along, along);
    return squared > 0.0 ? std::clamp(glm::dot(p - start, along) / squared, 0.0, 1.0) : 0.0;
}

EpipolarLines::EpipolarLines(const FilmPoint& light, const FilmRectangle& frame, int count, double offset)
    : light_(light), frame_(frame) {
    const double size =
        std::max({std::abs(light.x), std::abs(light.y), std::abs(light.w) * frame.perimeter()});
    if (count < 1) throw std::invalid_argument("epipolar lines: at least one is needed");
    if (!(frame.width() > 0.0 && frame.height() > 0.0))
        throw std::invalid_argument("epipolar lines: empty picture");
    if (!(size > 0.0) || !std::isfinite(size))
        throw std::invalid_argument("epipolar lines: the light is at the eye");
    light_ = {light.x / size, light.y / size, light.w / size};
    find_visible_border();

    const double spacing = frame.perimeter() / count;
    if (!inside_) ends_.push_back(first_);
    for (double i = std::ceil(first_ / spacing - offset); (i + offset) * spacing < last_; ++i)
        if (ends_.empty() || (i + offset) * spacing > ends_.back()) ends_.push_back((i + offset) * spacing);
    if (!inside_) ends_.push_back(last_);
    lines_.reserve(ends_.size());
    for (const double s : ends_) lines_.push_back(line_through(border_point(s)));
}

/// Proportional to p - light / w; only the sign of w is kept, since w itself may be zero.
Vec2d EpipolarLines::away_from_light(const Vec2d& p) const {
    const Vec2d v = light_.w * p - Vec2d(light_.x, light_.y);
    return light_.w < 0.0 ? -v : v;
}

void EpipolarLines::find_visible_border() {
    const double w = frame_.width(), h = frame_.height();
    const std::array<double, 5> corners{0.0, w, w + h, 2.0 * w + h, 2.0 * (w + h)};
    // Lines leave by a side when they go outwards there; all of a side agree, because it is straight.
    const Vec2d at_lower = away_from_light(frame_.lower), at_upper = away_from_light(frame_.upper);
    const std::array<bool, 4> exits{at_lower.y<0.0, at_upper.x> 0.0, at_upper.y > 0.0, at_lower.x < 0.0};
    inside_ = exits[0] && exits[1] && exits[2] && exits[3];
    if (inside_) {
        first_ = 0.0, last_ = frame_.perimeter();
        return;
    }
    std::size_t side = 0;
    while (side < 4 && !(exits[side] && !exits[(side + 3) % 4])) ++side;
    if (side == 4) throw std::invalid_argument("epipolar lines: the light is at the eye");
    first_ = last_ = corners[side];
    for (std::size_t i = side; i < side + 4 && exits[i % 4]; ++i)
        last_ += corners[i % 4 + 1] - corners[i % 4];
}

Vec2d EpipolarLines::border_point(double s) const {
    const double w = frame_.width(), h = frame_.height();
    if (s >= frame_.perimeter()) s -= frame_.perimeter();
    if (s < w) return {frame_.lower.x + s, frame_.lower.y};
    if (s < w + h) return {frame_.upper.x, frame_.lower.y + (s - w)};
    if (s < 2.0 * w + h) return {frame_.upper.x - (s - w - h), frame_.upper.y};
    return {frame_.lower.x, frame_.upper.y - (s - 2.0 * w - h)};
}

/// Where the line through p leaves the picture, along the border.
double EpipolarLines::exit(const Vec2d& p) const {
    Vec2d v = away_from_light(p);
    if (v == Vec2d(0.0)) v = {1.0, 0.0};  // on the projection itself, where all lines meet
    const Exit out = leave(frame_, p, v);
    const Vec2d b = glm::clamp(p + out.t * v, frame_.lower, frame_.upper);
    const double w = frame_.width(), h = frame_.height();
    switch (out.side) {
        case 0:
            return b.x - frame_.lower.x;
        case 1:
            return w + (b.y - frame_.lower.y);
        case 2:
            return w + h + (frame_.upper.x - b.x);
        default:
            return 2.0 * w + h + (frame_.upper.y - b.y);
    }
}

EpipolarLine EpipolarLines::line_through(const Vec2d& end) const {
    if (inside_) {
        // A ray at the light itself meets infinite light.
        const Vec2d light = Vec2d(light_.x, light_.y) / light_.w;
        return {light + (end - light) * std::min(0.1, 0.5 / std::max(glm::length(end - light), 1.0)), end};
    }
    const Vec2d v = -away_from_light(end);
    const Exit in = leave(frame_, end, v);
    return {glm::clamp(end + in.t * v, frame_.lower, frame_.upper), end};
}

EpipolarLines::Pair EpipolarLines::around(Vec2d p) const {
    double s = exit(glm::clamp(p, frame_.lower, frame_.upper));
    const std::size_t n = ends_.size();
    if (!inside_) {
        if (s < first_) s += frame_.perimeter();
        // Rounding can put the exit on a side that lines enter by: beyond the end that is nearer.
        if (s > last_ && first_ + frame_.perimeter() - s < s - last_) s = first_;
    }
    const auto after = std::size_t(std::upper_bound(ends_.begin(), ends_.end(), s) - ends_.begin());
    if (inside_) return {(after + n - 1) % n, after % n};
    const std::size_t right = std::clamp(after, std::size_t(1), n - 1);
    return {right - 1, right};
}

std::optional<std::size_t> EpipolarLines::next(std::size_t i, int step) const {
    const std::size_t n = lines_.size();
    if (inside_) return (i + n + std::size_t(step + int(n))) % n;
    if (step < 0 ? i == 0 : i + 1 >= n) return std::nullopt;
    return step < 0 ? i - 1 : i + 1;
}

}  // namespace mote::screenspace
