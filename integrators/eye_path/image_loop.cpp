#include "integrators/eye_path/image_loop.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace mote::integrators {

using namespace core;

namespace {

constexpr int side = 4, width = side * side;

}  // namespace

PacketLayout::PacketLayout(const RenderOptions& options, const ImageLoopSettings& settings)
    : width_(options.width),
      height_(options.height),
      interleaving_(settings.interleaving),
      upsampling_(settings.upsampling),
      across_(settings.by_rows ? width : side) {
    const int spacing = std::max(interleaving_, upsampling_);
    tile_size_ = side * spacing * std::max(1, 4 / spacing);  // a multiple of what a packet's pixels lie in
    const auto shares = std::uint64_t(interleaving_) * std::uint64_t(interleaving_);
    first_share_ = std::size_t(hash_keys(options.seed, 0x696e7465726cull) % shares);
}

screenspace::ShadedLattice PacketLayout::lattice(std::uint32_t pass) const {
    const auto n = std::uint32_t(upsampling_), at = pass % (n * n);
    return {upsampling_, int(at % n), int(at / n)};
}

/// Every pixel comes by all of the n^2 shares, beginning anywhere: that makes its mean right, since the first
/// lights of a set are not like the last.
std::size_t PacketLayout::share_of(int place, std::uint32_t pass) const {
    const auto n = std::size_t(interleaving_);
    return (std::size_t(place) + first_share_ + pass) % (n * n);
}

std::vector<PacketPixels> PacketLayout::packets(int x0, int y0, int x1, int y1, std::uint32_t pass,
                                                const screenspace::ShadedLattice* lattice) const {
    const int n = std::max(interleaving_, upsampling_), down = width / across_;
    std::vector<PacketPixels> packets;
    for (int y = y0; y < y1; y += down * n)
        for (int x = x0; x < x1; x += across_ * n)
            for (int i = 0; i < n * n; ++i) {
                PacketPixels packet;
                const glm::ivec2 first(x + i % n, y + i / n);
                for (int lane = 0; lane < width; ++lane) {
                    const glm::ivec2 p = first + n * glm::ivec2(lane % across_, lane / across_);
                    packet.pixels[std::size_t(lane)] = p.x < x1 && p.y < y1 ? p : glm::ivec2(-1);
                }
                packet.place = interleaving_ > 1 ? i : 0;
                packet.share = share_of(packet.place, pass);
                packet.gathers = !lattice || lattice->holds(first.x, first.y);
                packets.push_back(packet);
            }
    return packets;
}

std::vector<PacketPixels> PacketLayout::packets(std::span<const std::uint32_t> pixels) const {
    std::vector<PacketPixels> packets((pixels.size() + width - 1) / width);
    for (PacketPixels& packet : packets) packet.pixels.fill(glm::ivec2(-1));
    for (std::size_t i = 0; i < pixels.size(); ++i)
        packets[i / width].pixels[i % width] = {int(pixels[i]) % width_, int(pixels[i]) / width_};
    return packets;
}

void for_each_range(std::span<const std::uint32_t> pixels, const std::atomic<bool>& cancelled,
                    const std::function<void(std::span<const std::uint32_t>)>& task) {
    constexpr std::size_t size = 256;
    tbb::parallel_for(std::size_t(0), (pixels.size() + size - 1) / size, [&](std::size_t t) {
        if (cancelled) return;
        task(pixels.subspan(t * size, std::min(size, pixels.size() - t * size)));
    });
}

}  // namespace mote::integrators
