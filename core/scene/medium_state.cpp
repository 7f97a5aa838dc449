// Entering and leaving shapes.
#include "core/scene/medium_state.h"

#include "core/geometry/shape.h"
#include "core/scene/medium.h"

namespace mote::core {

void MediumState::set_outside(const Medium* medium) {
    outside_ = medium;
    update();
}

void MediumState::cross(const Shape& shape, const Vec3& geometric_normal, const Vec3& direction) {
    if (!shape.has_medium_boundary) return;
    if (glm::dot(geometric_normal, direction) < 0.0f)
        enter(shape);
    else
        leave(shape);
}

void MediumState::enter(const Shape& shape) {
    if (!shape.has_medium_boundary || inside(shape)) return;
    // Outside of every shape, the medium on this side is the one that the wall itself names.
    if (count_ == 0 && shape.parts_the_outside && shape.exterior) outside_ = shape.exterior.get();
    if (count_ == capacity) {
        overflow_ = true;
        return;
    }
    inside_[count_++] = &shape;
    update();
}

void MediumState::leave(const Shape& shape) {
    if (!shape.has_medium_boundary) return;
    bool was_inside = false;
    for (std::uint8_t i = 0; i < count_; ++i) {
        if (inside_[i] != &shape) continue;
        inside_[i] = inside_[--count_];
        was_inside = true;
        break;
    }
    if (shape.parts_the_outside) {
        // The path began on the inner side of an open surface, such as a window of a room full of fog.
        if (!was_inside && outside_ == shape.interior.get()) outside_ = shape.exterior.get();
        if (count_ == 0 && shape.exterior) outside_ = shape.exterior.get();
    }
    update();
}

bool MediumState::inside(const Shape& shape) const {
    for (std::uint8_t i = 0; i < count_; ++i)
        if (inside_[i] == &shape) return true;
    return false;
}

void MediumState::update() {
    const Shape* last = nullptr;
    for (std::uint8_t i = 0; i < count_; ++i)
        if (!last || inside_[i]->index > last->index) last = inside_[i];
    current_ = last ? last->interior.get() : outside_;
}

}  // namespace mote::core
