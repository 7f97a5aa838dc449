// Samples where the lines of two lights cross: one eye ray marched for both.
//
// Engelhardt 2013, Sec. 9.5, names it as an extension to several lights. Every spread sample of a line has a
// place; it may move to a crossing at most half the samples' spacing away, when the crossing lies as close to
// a free place of the other line. Samples keep their number, and no gap between neighbours grows beyond twice
// the spacing. Samples at edges in depth, and those of refinement, stay where they are.
//
// Memory: the lines of all lights are held at once, 24 bytes a texel; 160 bytes a crossing while it is
// marched.
#pragma once

#include "core/objects/cancellation.h"
#include "screenspace/epipolar/epipolar_picture.h"

namespace mote::screenspace {

/// Shares of two lines, from their starts, at the point they have in common. Nothing where they are parallel
/// or meet beyond an end.
struct Meeting {
    double a, b;
};
std::optional<Meeting> meet(const EpipolarLine& a, const EpipolarLine& b);

struct Crossing {
    /// Of each of two lights: which of the lights, which of its lines, and where on it [texels].
    struct Side {
        std::uint32_t light, line;
        double texel;
    };
    std::array<Side, 2> sides;
    Vec2d film;
};

constexpr std::size_t crossing_bytes = 176;  ///< of memory at most

/// Lines that have been searched for edges, and not been marched. One crossing at most for every place of a
/// line's spread samples, lit by both lights, the closest to both places first come.
std::vector<Crossing> choose_crossings(std::span<EpipolarPicture* const> lights,
                                       core::CancelToken cancelled = {});

/// Work of one thread: an eye ray and what two lights scatter into it. Lights are counted as in
/// Crossing::Side.
class SharedRayTask {
  public:
    virtual ~SharedRayTask() = default;
    virtual std::array<RayEnd, 2> ends_of(const Crossing& crossing) = 0;
    virtual std::array<MarchedRay, 2> march(const Crossing& crossing, const std::array<RayEnd, 2>& ends) = 0;
    virtual core::Ray ray(const Vec2d& film) = 0;
};

class SharedRaySource {
  public:
    virtual ~SharedRaySource() = default;
    virtual std::unique_ptr<SharedRayTask> start() const = 0;
};

/// Marches the chosen crossings whose ends continue both lines, and adds them there. Returns how many.
std::size_t march_crossings(std::span<EpipolarPicture* const> lights, const SharedRaySource& source,
                            const EpipolarPicture::Loop& loop, core::CancelToken cancelled = {});

}  // namespace mote::screenspace
