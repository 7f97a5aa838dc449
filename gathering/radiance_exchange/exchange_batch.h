// A batch of directions: each is one task with sums of its own, which are then added up in the order of the
// directions. So the bits do not depend on the number of threads, and no two threads write to one texel.
#pragma once

#include "core/scene/emitter.h"
#include "gathering/radiance_exchange/batch_directions.h"
#include "gathering/radiance_exchange/link_exchange.h"
#include "gathering/radiance_exchange/texel_materials.h"
#include "gathering/ray_bundles/bundle_tracer.h"

namespace mote::gathering {

/// Irradiance of every texel [W/m^2].
struct TexelIrradiance {
    std::vector<core::Rgb> emitted;    ///< of light that comes from lights; empty where bundles bring none
    std::vector<core::Rgb> reflected;  ///< of light that was reflected before
};

/// Scene of an exchange; all of it must outlive the objects that refer to it.
struct ExchangeScene {
    const SurfaceAtlas& atlas;
    const TexelMaterials& materials;
    const BundleTracer& tracer;
    const core::Emitter* environment = nullptr;  ///< null: nothing comes from outside
};

class ExchangeBatch {
  public:
    /// `lights`: bundles carry the light of emitting texels and of the environment.
    ExchangeBatch(const ExchangeScene& scene, float spacing, std::uint32_t directions, bool lights);

    /// Radiance that texels send: `more` as in SentRadiance. Glossy radiance is by direction and glossy
    /// texel.
    struct Sent {
        Rgb4Vector reflected, glossy;
    };

    /// Directions [first, first + size()). Throws Cancelled.
    void run(const BatchDirections& directions, std::uint32_t first, const Sent& sent,
             core::CancelToken cancelled);

    std::uint32_t size() const { return count_; }
    /// The mean over the batch's directions, by Eq. (1) of link_exchange.h, divided by what it makes of a
    /// uniform radiance in the mean over all surfaces, which is 1 but for how the directions fell. So a
    /// closed room keeps its power from batch to batch.
    TexelIrradiance mean() const;
    /// The estimate of one texel from direction i alone, emitted and reflected light together, and the
    /// direction that it comes from: the bundle's or the opposite one.
    core::Rgb irradiance(std::uint32_t i, std::uint32_t texel) const;
    core::Vec3 direction_above(std::uint32_t i, std::uint32_t texel) const;
    /// Hits of all rays so far.
    std::uint64_t hits() const { return hits_; }
    std::size_t memory_bytes() const;

  private:
    /// Per direction and texel: 2 pi s^2 / A, times the shading cosine over the geometric one.
    float weight(std::uint32_t i, const AtlasTexel& texel) const;
    /// Computes scale_ from how often the batch's rays met texels.
    void find_scale(double met);

    ExchangeScene scene_;
    float spacing_;
    std::uint32_t count_;
    bool lights_;
    Rgb4Vector emitted_;                                 ///< by texel
    std::vector<Rgb4Vector> from_light_, from_surface_;  ///< received, by direction and texel
    std::vector<core::Vec3> directions_;
    float scale_ = 1.0f;  ///< by which a uniform radiance is kept
    std::uint64_t hits_ = 0;
};

}  // namespace mote::gathering
