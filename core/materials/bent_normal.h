// Shared by normal maps and bump maps: a nested BSDF in a frame whose normal is bent.
//
// Mitsuba 3.9 is followed: the bent normal is turned over, within the surface, where the viewer would see its
// back (Schuessler et al. 2017), light that is below one normal and above the other is lost, and a shadowing
// term fades light towards the horizon (Estevez et al. 2019).
//
// In the frame of the surface such a BSDF is not symmetric: f(wo, wi) holds |wi.m| / |wi.n| of the light's
// direction, with m the bent normal and n the frame's, so that f |wi.n| is the nested f |wi.m|. Light that is
// traced from the lights therefore evaluates f with the two directions exchanged, and then all that is known
// of shading normals holds unchanged.
#pragma once

#include <array>

#include "core/materials/nested_bsdf.h"

namespace mote::core {

class BentNormal : public Bsdf {
  public:
    BsdfTraits traits() const override { return traits_; }
    Rgb eval(const BsdfPoint& p, const Vec3& wo, const Vec3& wi, TransportMode mode) const override;
    float pdf_solid_angle(const BsdfPoint& p, const Vec3& wo, const Vec3& wi,
                          TransportMode mode) const override;
    std::optional<BsdfSample> sample(const BsdfPoint& p, const Vec3& wo, float u_lobe, const Vec2& u,
                                     TransportMode mode) const override;
    /// Light that passes straight on does not see the normal.
    StraightPassage straight_passage(const BsdfPoint& p, const Vec3& wo) const override {
        return straight_passage_of(*nested_, p, wo);
    }
    Rgb albedo(const BsdfPoint& p, const Vec3& wo) const override;

  protected:
    BentNormal(BsdfPtr nested, const BentNormalSettings& settings, bool textured);
    /// The bent normal in the local frame, of any length.
    virtual Vec3 normal(const BsdfPoint& p) const = 0;

  private:
    /// A bent normal m and the frame around it.
    struct Bent {
        Frame frame;
        float chance = 1.0f;  ///< with which sample() takes it
        const Vec3& m() const { return frame.n; }
    };
    Vec3 unit_normal(const BsdfPoint& p) const;
    Vec3 towards(const Vec3& m, const Vec3& eye) const;
    std::array<Bent, 2> sampled_from(const Vec3& m, const Vec3& wo, TransportMode mode) const;
    float stopped_fraction(const BsdfPoint& p, const Bent& bent, const Vec3& wo) const;
    float visible_factor(const Vec3& m, const Vec3& eye, const Vec3& light) const;

    BsdfPtr nested_;
    BentNormalSettings settings_;
    BsdfTraits traits_;
};

}  // namespace mote::core
