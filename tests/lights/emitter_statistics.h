// Estimates with their standard error, and the two halves of every light as estimators of the same quantity:
// the flux through a disk, by direct sampling and by particles.
#pragma once

#include <cmath>
#include <memory>

#include "core/math/frame.h"
#include "core/math/random.h"
#include "core/math/warp.h"
#include "core/scene/emitter.h"

namespace mote::tests {

using namespace mote::core;

/// Every statistical check here allows this many standard errors. With seeds fixed and fewer than 300 checks,
/// a correct program fails one with a chance below 0.2 % when the seeds are chosen anew.
inline constexpr double sigmas = 4.5;

/// Mean and standard error (Welford 1962).
class Mean {
  public:
    void add(double x) {
        const double d = x - mean_;
        mean_ += d / double(++n_);
        m2_ += d * (x - mean_);
    }
    double value() const { return mean_; }
    double error() const { return n_ > 1 ? std::sqrt(m2_ / double(n_ - 1) / double(n_)) : infinity; }

  private:
    long n_ = 0;
    double mean_ = 0.0, m2_ = 0.0;
};

/// `floor` is the relative rounding error allowed besides: float arithmetic of a few operations.
inline bool agree(const Mean& m, double expected, double floor = 1e-5) {
    return std::fabs(m.value() - expected) <= sigmas * m.error() + floor * std::fabs(expected);
}
inline bool agree(const Mean& a, const Mean& b, double floor = 1e-5) {
    return std::fabs(a.value() - b.value()) <=
           sigmas * std::hypot(a.error(), b.error()) + floor * std::fabs(a.value());
}

struct MeanRgb {
    Mean channel[3];
    void add(const Rgb& c) {
        for (int i = 0; i < 3; ++i) channel[i].add(double(c[i]));
    }
};
inline bool agree(const MeanRgb& m, const Rgb& expected, double floor = 1e-5) {
    return agree(m.channel[0], expected.x, floor) && agree(m.channel[1], expected.y, floor) &&
           agree(m.channel[2], expected.z, floor);
}
inline bool agree(const MeanRgb& a, const MeanRgb& b) {
    return agree(a.channel[0], b.channel[0]) && agree(a.channel[1], b.channel[1]) &&
           agree(a.channel[2], b.channel[2]);
}

/// A flat round receiver.
struct Patch {
    Vec3 center{0, 0, 0}, normal{0, 0, 1};
    float radius = 0.1f;
    float area() const { return pi * radius * radius; }
};

/// Irradiance [W/m^2] at p on a surface facing n, by direct sampling.
inline MeanRgb irradiance(const Emitter& light, const Vec3& p, const Vec3& n, int samples,
                          std::uint64_t seed = 1) {
    MeanRgb mean;
    Rng rng(seed);
    for (int i = 0; i < samples; ++i) {
        const auto s = light.sample_direct(p, rng.next_vec2());
        mean.add(s ? s->weight * std::fmax(glm::dot(n, s->wi), 0.0f) : Rgb(0.0f));
    }
    return mean;
}

/// Flux [W] onto the front of the patch, by direct sampling from points spread over it.
inline MeanRgb flux_by_direct_sampling(const Emitter& light, const Patch& patch, int samples,
                                       std::uint64_t seed = 2) {
    const Frame frame(patch.normal);
    MeanRgb mean;
    Rng rng(seed);
    for (int i = 0; i < samples; ++i) {
        const Vec2 d = patch.radius * square_to_disk(rng.next_vec2());
        const auto s = light.sample_direct(patch.center + d.x * frame.s + d.y * frame.t, rng.next_vec2());
        mean.add(s ? patch.area() * s->weight * std::fmax(glm::dot(patch.normal, s->wi), 0.0f) : Rgb(0.0f));
    }
    return mean;
}

/// Flux through the patch [W] by counting the particles that fall on it.
inline MeanRgb flux_by_particles(const Emitter& light, const Patch& patch, int samples,
                                 std::uint64_t seed = 3) {
    MeanRgb mean;
    Rng rng(seed);
    for (int i = 0; i < samples; ++i) {
        const Vec2 u_position = rng.next_vec2();
        const auto s = light.sample_emission(u_position, rng.next_vec2());
        Rgb arrived(0.0f);
        if (s) {
            const float cosine = -glm::dot(s->direction, patch.normal);
            const float t = glm::dot(s->origin - patch.center, patch.normal) / cosine;
            if (cosine > 0.0f && t > 0.0f &&
                glm::length(s->origin + t * s->direction - patch.center) < patch.radius)
                arrived = s->weight;
        }
        mean.add(arrived);
    }
    return mean;
}

/// Mean power of a particle [W], samples without light counted as zero.
inline MeanRgb particle_power(const Emitter& light, int samples, std::uint64_t seed = 4) {
    MeanRgb mean;
    Rng rng(seed);
    for (int i = 0; i < samples; ++i) {
        const Vec2 u_position = rng.next_vec2();
        const auto s = light.sample_emission(u_position, rng.next_vec2());
        mean.add(s ? s->weight : Rgb(0.0f));
    }
    return mean;
}

}  // namespace mote::tests
