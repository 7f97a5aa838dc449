// Media that surround a point of a path: the shapes it is inside of, and the medium outside all of them.
//
// A scene has one outermost medium (Scene::outermost_medium): what is outside of all shapes is in it, be it
// the sensor, a light, or a vertex of a path. Open walls, such as those of a room with a window, may part the
// outside into regions of different media; closed shapes never do.
//
// Media are interior and exterior of shapes. Inside several shapes at once the one declared last in the scene
// file wins: a rule of position alone, so that a path and its reverse agree (a stack ordered by entry would
// not), and overlapping media are well defined. A shape whose interior was left out holds vacuum.
#pragma once

#include <array>
#include <cstdint>

#include "core/math/vec.h"

namespace mote::core {

class Medium;
class Shape;

/// The shapes around a point, and the medium there.
class MediumState {
  public:
    static constexpr int capacity = 8;  ///< nesting depth; deeper scenes are refused at load

    /// The medium at this point, or null for vacuum.
    const Medium* current() const { return current_; }
    const Medium* outside() const { return outside_; }  ///< outside of all shapes, or null

    /// The medium outside of all shapes; null: vacuum.
    void set_outside(const Medium* medium);
    /// Crosses the surface of `shape` in `direction` (shapes without media change nothing).
    void cross(const Shape& shape, const Vec3& geometric_normal, const Vec3& direction);
    /// From outside to inside.
    void enter(const Shape& shape);
    void leave(const Shape& shape);
    /// True if the point is inside of it.
    bool inside(const Shape& shape) const;
    bool inside_any() const { return count_ > 0; }  ///< of any shape
    /// True when more than `capacity` shapes were entered; the state is no longer reliable.
    bool overflow() const { return overflow_; }

  private:
    void update();

    std::array<const Shape*, capacity> inside_{};  ///< unordered; count_ entries
    const Medium* outside_ = nullptr;
    const Medium* current_ = nullptr;
    std::uint8_t count_ = 0;
    bool overflow_ = false;
};

}  // namespace mote::core
