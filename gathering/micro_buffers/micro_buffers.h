// Micro-buffers: what a receiver sees of a point hierarchy, in n x n texels over its hemisphere (Engelhardt
// 2013, Sec. 8.1.2; Ritschel et al. 2009).
//
// A walk down the tree ends at nodes that are flat and small beside the texel that they fall on, and at
// points. Both are discs, which the ray of a texel's middle meets or not; the nearest along the ray is kept.
// Points larger than a texel fill several: the thesis's ray casting after the traversal.
#pragma once

#include <tbb/parallel_for.h>

#include "core/math/frame.h"
#include "gathering/micro_buffers/brdf_warp.h"
#include "gathering/micro_buffers/disc_raster.h"
#include "gathering/micro_buffers/hemisphere_texels.h"
#include "gathering/point_hierarchy/node_radiance.h"

namespace mote::gathering {

struct MicroReceiver {
    core::Vec3 position{0.0f};  ///< [m]
    core::Frame frame;  ///< n: the normal on the side that gathers. Turn s and t at random: no banding
};

/// First hit of the ray of a texel.
struct MicroTexel {
    static constexpr std::uint32_t nothing = 0xffffffffu;   ///< value of `hit` where the ray meets nothing
    static constexpr std::uint32_t back_bit = 0x80000000u;  ///< set in `hit` where a back is met

    float distance = core::infinity;  ///< [m]
    std::uint32_t hit = nothing;      ///< node of PointHierarchy::nodes(), and the side

    bool empty() const { return hit == nothing; }           ///< the ray meets nothing
    std::uint32_t node() const { return hit & ~back_bit; }  ///< into PointHierarchy::nodes()
    /// The back of the node is met.
    bool from_behind() const { return (hit & back_bit) != 0; }
};

/// Resolution of buffers, and what they may leave out.
struct MicroBufferSettings {
    std::uint32_t side = 16;  ///< texels
    /// Where in each of them its ray lies, in [0, 1)^2: buffers that are averaged should differ in it, else
    /// all of them miss the same.
    core::Vec2 place{0.5f};
    /// A node is not entered whose solid angle is at most this fraction of its texel's.
    float cut = 1.0f;
    /// If true, points fill all texels whose rays meet them (Fig. 8.13), else only the one that they fall on.
    bool cast_leaves = true;
};

/// Makes the buffers of receivers over one hierarchy; has no state that changes.
class MicroBuffers {
  public:
    /// Keeps a reference to the hierarchy. Throws InputError for a side of 0 or above 256, or a cut that is
    /// not positive.
    explicit MicroBuffers(const PointHierarchy& hierarchy, const MicroBufferSettings& settings = {});

    const PointHierarchy& hierarchy() const { return hierarchy_; }  ///< that it was made for
    const HemisphereTexels& texels() const { return texels_; }      ///< their directions and weights
    std::uint32_t texels_each() const { return texels_.count(); }   ///< of a receiver
    /// Fills texels_each() texels for every receiver, one after the other. In one thread.
    void render(std::span<const MicroReceiver> receivers, std::span<MicroTexel> texels) const;
    /// render() with a warped buffer for each receiver: warps[i] belongs to receivers[i], and its
    /// fill_weights(texels().side(), ...) are the texels' weights. Points fill all texels that they meet.
    void render_warped(std::span<const MicroReceiver> receivers, std::span<const BrdfWarp> warps,
                       std::span<MicroTexel> texels) const;
    /// visit(i, texels) for every receiver i, from many threads at once; receivers that follow each other
    /// should be near each other (Morton order, tiles of a picture).
    template <typename Visit>
    void for_each(std::span<const MicroReceiver> receivers, const Visit& visit) const {
        const std::size_t tasks = (receivers.size() + task_size - 1) / task_size;
        tbb::parallel_for(std::size_t(0), tasks, [&](std::size_t task) {
            const std::size_t begin = task * task_size, count = std::min(task_size, receivers.size() - begin);
            std::vector<MicroTexel> texels(count * texels_each());
            render(receivers.subspan(begin, count), texels);
            for (std::size_t i = 0; i < count; ++i)
                visit(begin + i,
                      std::span<const MicroTexel>(texels).subspan(i * texels_each(), texels_each()));
        });
    }
    static constexpr std::size_t task_size = 16;  ///< receivers that are rendered together

  private:
    const PointHierarchy& hierarchy_;
    MicroBufferSettings settings_;
    HemisphereTexels texels_;
    RayDirections rays_;
};

/// Sum of weight times radiance over the texels. With cosine_weight() this is irradiance [W/m^2].
core::Rgb gathered(std::span<const MicroTexel> texels, float weight, const NodeRadiance& radiance);

/// Sum with the weights of a BrdfWarp: reflected radiance [W/(m^2 sr)].
core::Rgb gathered(std::span<const MicroTexel> texels, std::span<const core::Rgb> weights,
                   const NodeRadiance& radiance);

/// Irradiance of each receiver [W/m^2], in parallel; the same for any number of threads.
void gather_irradiance(const MicroBuffers& buffers, const NodeRadiance& radiance,
                       std::span<const MicroReceiver> receivers, std::span<core::Rgb> irradiance);

}  // namespace mote::gathering
