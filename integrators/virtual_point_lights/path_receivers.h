// Receivers on eye paths of their own, spread over the image: a sample of all, for selectors that evaluate
// VPLs at some.
#pragma once

#include <cmath>
#include <vector>

#include "integrators/virtual_point_lights/eye_receivers.h"

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

/// Keeps the receivers of eye paths; nothing is gathered at them.
template <bool Media>
class ReceiverRecorder final : public EyeReceivers<Media> {
  public:
    ReceiverRecorder(const VplSettings& settings, EyePacket<Media>& packet)
        : EyeReceivers<Media>(settings, packet, nullptr) {}
    std::vector<lights::PathReceiver> receivers;

  private:
    void add(int, const core::ScatteringVertex& vertex, const core::Rgb& throughput,
             const core::MediumState& state, std::int32_t depth) override {
        receivers.push_back({vertex, throughput, state, depth});
    }
    void gather(const lights::VplRange&, float) override {}
};

/// Receivers on about `paths` eye paths, on surfaces and in media. `key` chooses their pixels; `walk` counts.
template <bool Media>
std::vector<lights::PathReceiver> sample_path_receivers(const core::Scene& scene, const VplSettings& settings,
                                                        const core::RenderOptions& options,
                                                        const core::PassContext& pass, std::size_t paths,
                                                        std::uint64_t key, core::WalkContext& walk) {
    if (paths == 0) return {};
    EyePacket<Media> packet(scene, EyeReceivers<Media>::packet_settings(settings), walk);
    ReceiverRecorder<Media> recorder(settings, packet);
    core::RenderOptions own = options;
    own.seed = core::hash_keys(options.seed, selection_stream);
    const auto pixels = spread_pixels(options.width, options.height, paths, key);
    constexpr std::size_t lanes = lights::ReceiverTile::width;
    for (std::size_t first = 0; first < pixels.size() && !pass.cancelled; first += lanes) {
        for (std::size_t i = 0; i < lanes; ++i)
            if (first + i < pixels.size())
                packet.start(int(i),
                             make_eye_ray(scene, own, pass, pixels[first + i].x, pixels[first + i].y));
            else
                packet.stop(int(i));
        recorder.follow({}, 1.0f);
    }
    return std::move(recorder.receivers);
}

}  // namespace mote::integrators
