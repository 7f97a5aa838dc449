// Micro-buffers that look through media: surfaces behind fog, and the light that the fog itself scatters.
//
// Surfaces come first, from micro-buffers as ever. Then a walk down the hierarchy of volume points adds what
// each node sends to the receiver to the texel that it falls on; a point larger than a texel is a ball, and
// the rays that cross it collect as much as they have way through it. What lies behind the surface of a texel
// is not seen. All of it is weakened by the transmittance to it. Nothing is sorted: light of media adds up.
#pragma once

#include "gathering/volume_points/receiver_depths.h"
#include "gathering/volume_points/volume_light.h"

namespace mote::gathering {

/// Memory of one thread, reused from receiver to receiver.
struct FogScratch {
    std::optional<ReceiverDepths> depths;
    std::vector<MicroTexel> texels;
    std::vector<float> distance, red, green, blue;  ///< by texel: of the surface [m], light of the media
};

class FogBuffers {
  public:
    /// All three are kept by reference. `cut`: a node of the volume is taken as one point where its ball
    /// covers at most this many texels, and the receiver is more than its diameter away. Throws InputError
    /// for a cut that is not positive.
    FogBuffers(const MicroBuffers& surfaces, const VolumeHierarchy& volume, const ExtinctionGrid& extinction,
               float cut);

    const MicroBuffers& surfaces() const { return surfaces_; }
    std::uint32_t texels_each() const { return surfaces_.texels_each(); }
    /// The radiance that arrives through every texel, receiver after receiver [W/(m^2 sr)]: of surfaces
    /// (`environment` where there are none), behind media, and of media. In one thread.
    void render(std::span<const MicroReceiver> receivers, const NodeRadiance& surfaces,
                const VolumeLight& volume, std::span<core::Rgb> radiance, FogScratch& scratch,
                const core::Rgb& environment = core::Rgb(0.0f)) const;

  private:
    const MicroBuffers& surfaces_;
    const VolumeHierarchy& volume_;
    const ExtinctionGrid& extinction_;
    float cut_;
    RayDirections rays_;
};

/// Sum of weight times radiance over the texels of a receiver; irradiance [W/m^2] with cosine_weights().
template <typename Weight>
core::Rgb weighted(std::span<const core::Rgb> radiance, std::span<const Weight> weights) {
    core::Vec3d sum(0.0);
    for (std::size_t i = 0; i < radiance.size(); ++i)
        sum += core::Vec3d(core::Vec3(weights[i])) * core::Vec3d(radiance[i]);
    return core::Rgb(sum);
}

}  // namespace mote::gathering
