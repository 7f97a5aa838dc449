// Receivers on eye paths of their own, spread over the image: a sample of all, for selectors that evaluate
// VPLs at some.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "core/render/integrator.h"
#include "core/scene/scene.h"
#include "integrators/eye_path/eye_ray.h"
#include "lights/selection/selection.h"

namespace mote::integrators {

/// Stream of the random numbers that selections are prepared with, apart from those of the pass.
inline constexpr std::uint64_t selection_stream = 0x6d6174726978ull;

/// Pixels of an image of `width` x `height`, one in each cell of a grid: about `count`, or all.
inline std::vector<glm::ivec2> spread_pixels(int width, int height, std::size_t count, std::uint64_t key) {
    const double cell = std::max(1.0, std::sqrt(double(width) * double(height) / double(count)));
    const int columns = int(std::ceil(width / cell)), rows = int(std::ceil(height / cell));
    std::vector<glm::ivec2> pixels;
    core::Rng rng(key);
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const core::Vec2 u = rng.next_vec2();
            const int x = int((i + double(u.x)) * cell), y = int((j + double(u.y)) * cell);
            if (x < width && y < height) pixels.emplace_back(x, y);
        }
    return pixels;
}

/// Receivers on the eye paths of these pixels, on surfaces and in media. `tile` is an EyeTile over `packet`,
/// and records receivers from then on.
template <typename Packet, typename Tile>
std::vector<lights::PathReceiver> sample_path_receivers(const core::Scene& scene,
                                                        const core::RenderOptions& options,
                                                        const core::PassContext& pass,
                                                        std::span<const glm::ivec2> pixels, Packet& packet,
                                                        Tile& tile) {
    std::vector<lights::PathReceiver> receivers;
    tile.record_receivers(receivers);
    core::RenderOptions own = options;
    own.seed = core::hash_keys(options.seed, selection_stream);
    constexpr std::size_t lanes = lights::ReceiverTile::width;
    for (std::size_t first = 0; first < pixels.size(); first += lanes) {
        if (pass.cancelled) break;
        for (std::size_t i = 0; i < lanes; ++i)
            if (first + i < pixels.size())
                packet.start(int(i),
                             make_eye_ray(scene, own, pass, pixels[first + i].x, pixels[first + i].y));
            else
                packet.stop(int(i));
        tile.run({}, 1.0f);
    }
    return receivers;
}

}  // namespace mote::integrators
