// Virtual point lights over a host's scene, with any selection and with compensation; and tiles of its
// receivers.
#pragma once

#include "lights/virtual_lights/vpl_gather.h"
#include "session/host/host_light.h"

namespace mote::session {

class HostLight::Method {
  public:
    virtual ~Method() = default;
    virtual std::size_t size() const = 0;  ///< HostLight::size()
    virtual std::vector<core::Rgb> reflected(std::span<const HostReceiver> receivers) const = 0;
};

/// Throws InputError for a selection that there is none of, or that does not go with compensation.
std::unique_ptr<const HostLight::Method> host_vpls(const HostScene& host, const HostLightSettings& settings);

/// Radiance by receiver from gather(vertices, tile, lanes), which is called for sixteen receivers at a time
/// and returns lights::TileLight; the last tile has fewer lanes.
template <typename Gather>
std::vector<core::Rgb> in_tiles(const HostScene& host, std::span<const HostReceiver> receivers,
                                core::Rng& rng, const Gather& gather) {
    constexpr std::size_t width = lights::ReceiverLanes::width;
    std::vector<core::Rgb> radiance;
    radiance.reserve(receivers.size());
    std::array<core::ScatteringVertex, width> vertices;
    for (std::size_t begin = 0; begin < receivers.size(); begin += width) {
        const std::size_t count = std::min(width, receivers.size() - begin);
        lights::ReceiverTile tile;
        tile.clear();
        for (std::size_t i = 0; i < count; ++i) {
            vertices[i] = host.vertex(receivers[begin + i]);
            tile.set(int(i), vertices[i], core::Rgb(1.0f), host.scene().medium_state(),
                     core::Rng(rng.next_u32()), 65535);
        }
        const lights::TileLight light =
            gather(std::span<const core::ScatteringVertex>(vertices).first(count), tile, int(count));
        radiance.insert(radiance.end(), light.begin(), light.begin() + std::ptrdiff_t(count));
    }
    return radiance;
}

}  // namespace mote::session
