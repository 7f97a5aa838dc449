// The emission of a medium as a light: points of it are sampled for receivers, and particles start in it.
//
// Receivers find the same emission by walking through it. Both techniques are weighted against each other per
// length of the ray (see DirectSample::line_density): a direction of density p_w that leads to a point y
// finds it with p_w c(y), light sampling with p_V(y) d^2, where c(y) is the extinction there. Any c would do,
// as long as both sides use the same; the extinction is what delta tracking samples by.
#pragma once

#include "core/math/distribution.h"
#include "core/scene/emitter.h"
#include "core/scene/medium.h"

namespace mote::media {

class MediumEmitter final : public core::Emitter {
  public:
    /// `source` must outlive this; `box` holds the part of it that emits. `direct` = false makes it a source
    /// of particles alone.
    MediumEmitter(const core::Medium& source, const core::Bounds3& box, bool direct);

    core::EmitterTraits traits() const override {
        return {.kind = core::EmitterKind::medium, .direct = direct_};
    }
    std::optional<core::DirectSample> sample_direct(const core::Vec3& p, const core::Vec2& u) const override;
    /// No surface of it can be hit; what a walk finds is weighted by light_over_walk().
    float pdf_direct(const core::Vec3&, const core::Vec3&, const core::SurfaceHit*) const override {
        return 0.0f;
    }
    std::optional<core::EmissionSample> sample_emission(const core::Vec2& u_position,
                                                        const core::Vec2& u_direction) const override;
    core::EmissionDensity pdf_emission(const core::Vec3& origin, const core::Vec3& /*normal*/,
                                       const core::Vec3& /*direction*/) const override {
        return {pdf_volume(origin), core::inv_four_pi};
    }
    core::Rgb power() const override { return power_; }
    void set_direct_probability(float p) override { probability_ = p; }

    /// Chance of light sampling at `from` over that of a walk from there, both at y and per the walk's
    /// density of directions: P p_V(y) d^2 / c(y). `sigma_t` is the extinction at y, not black.
    float light_over_walk(const core::Vec3& from, const core::Vec3& y, const core::Rgb& sigma_t) const;

  private:
    struct Point {
        core::Vec3 position;
        float pdf_volume;  ///< p_V [1/m^3]
    };
    Point sample_point(const core::Vec2& u) const;
    float pdf_volume(const core::Vec3& p) const;
    core::Rgb cell_emission(const glm::ivec3& cell) const;
    glm::ivec3 cell_of(std::size_t index) const;
    void make_cells();

    const core::Medium& medium_;
    core::Bounds3 box_;
    bool direct_;
    glm::ivec3 cells_{1};
    core::Distribution1D choice_;  ///< of cells, by emission, a tenth of it even
    core::Rgb power_{0.0f};
    float probability_ = 0.0f;  ///< that a receiver chooses this light
};

}  // namespace mote::media
