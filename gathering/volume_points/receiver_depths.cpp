#include "gathering/volume_points/receiver_depths.h"

namespace mote::gathering {

using namespace core;

ReceiverDepths::ReceiverDepths(const ExtinctionGrid& grid, HemisphereMap map, std::uint32_t side)
    : grid_(grid), side_(side), across_(std::min(side, largest_side)) {
    for (std::uint32_t y = 0; y < across_; ++y)
        for (std::uint32_t x = 0; x < across_; ++x)
            directions_.push_back(
                square_to_hemisphere(map, (Vec2(float(x), float(y)) + 0.5f) / float(across_)));
    begin_.resize(directions_.size()), per_metre_.resize(directions_.size());
    depths_.resize(directions_.size() * (steps + 1));
}

void ReceiverDepths::march(const MicroReceiver& receiver) {
    if (grid_.empty()) return;
    for (std::size_t r = 0; r < directions_.size(); ++r) {
        const Vec3 direction = receiver.frame.to_world(directions_[r]);
        const auto inside = intersect(grid_.box(), Ray{receiver.position, direction});
        Rgb* depths = depths_.data() + r * (steps + 1);
        depths[0] = Rgb(0.0f);
        if (!inside) {
            begin_[r] = 0.0f, per_metre_[r] = 0.0f, depths[1] = Rgb(0.0f);
            continue;
        }
        const float step = (inside->t1 - inside->t0) / float(steps);
        begin_[r] = inside->t0, per_metre_[r] = 1.0f / step;
        Vec3 p = receiver.position + (inside->t0 + 0.5f * step) * direction;
        for (std::uint32_t i = 0; i < steps; ++i, p += step * direction)
            depths[i + 1] = depths[i] + step * grid_.at(p);
    }
}

}  // namespace mote::gathering
