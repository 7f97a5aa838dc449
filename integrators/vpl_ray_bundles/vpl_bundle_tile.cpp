#include "integrators/vpl_ray_bundles/vpl_bundle_tile.h"

namespace mote::integrators {

using namespace core;

VplBundleTile::VplBundleTile(const VplBundleSettings& settings, const VplBundlePass& pass, Packet& packet)
    : settings_(settings),
      pass_(pass),
      packet_(packet),
      walk_(packet.walk()),
      scratch_(std::make_unique<lights::GatherScratch>()),
      bundles_(pass.bundles, *scratch_, walk_) {}

void VplBundleTile::run(const PacketPixels& pixels) {
    if (pixels.sample == 0) gathered_ = {};
    double begin = thread_cpu_seconds();
    const auto sky_behind = [&](int, Packet::Lane& lane, const EyeSegment& segment) {
        // The sky is no light of the eye path then, but is seen.
        const EyePath<false>& path = *lane.path;
        if (pass_.bundles.sky && segment.event.kind == WalkEvent::Kind::escaped && path.scatterings() == 0 &&
            !(settings_.eye.hide_emitters && path.depth() == 1))
            lane.sum[Transport::emission] +=
                path.throughput() * pass_.bundles.sky->environment(segment.ray.direction);
    };
    const auto step = [&] {
        packet_.sample_lights();
        tile_.clear(), receivers_.fill({});
        if (pixels.sample == 0) packet_.for_each([&](int i, Packet::Lane& lane) { receive(i, lane); });
        time_.eye += thread_cpu_seconds() - begin;
        if (tile_.any_active) gather(pixels);
        begin = thread_cpu_seconds();
    };
    packet_.run(step, sky_behind);
}

void VplBundleTile::add_gathered(const PacketPixels& pixels, PassImage& image) const {
    pixels.for_each([&](std::size_t lane, int x, int y) {
        image.at(Transport::indirect, x, y) += gathered_[lane].indirect;
        image.at(Transport::direct, x, y) += gathered_[lane].direct;
    });
}

/// The vertex becomes a receiver where it can be connected.
void VplBundleTile::receive(int index, Packet::Lane& lane) {
    const bool indirect = settings_.eye.wanted[Transport::indirect];
    if (!lane.alive || !lane.path->vertex().connectable() || !(indirect || pass_.bundles.sky)) return;
    const EyePath<false>& path = *lane.path;
    const std::int32_t depth = indirect ? settings_.eye.light_depth(path.depth()) : 0;
    tile_.set(index, path.vertex(), path.throughput(), {}, Rng(walk_.rng.next_u32()), depth);
    receivers_[std::size_t(index)] = {&path.vertex(), path.throughput(), depth, &lane.path->sampler()};
    bundle_rng_ = Rng(walk_.rng.next_u32());
}

void VplBundleTile::gather(const PacketPixels& pixels) {
    const double begin = thread_cpu_seconds();
    const std::span<const gathering::BundleDirection> directions = pass_.lines[std::size_t(pixels.place)];
    const lights::VplRange share{pixels.share, pass_.lines.size()};
    const lights::GatherContext context{pass_.bundles.scene, *scratch_, walk_.rays, walk_.tracking,
                                        walk_.cancelled};
    const bool own_rays = pass_.own_rays() > 0.0f && tile_.any_directional;
    const auto light =
        own_rays ? lights::gather(context, pass_.vpls, share,
                                  gathering::AgainstBundlesAndOwnRays{pass_.rivals, pass_.own_rays()}, tile_)
                 : lights::gather(context, pass_.vpls, share, gathering::AgainstBundles{pass_.rivals}, tile_);
    const double middle = thread_cpu_seconds();
    lights::TileLight indirect{}, direct{};
    walk_.rng = bundle_rng_;
    for (std::size_t m = 0; m < directions.size(); ++m) {
        walk_.cancelled.check();
        bundles_.add(receivers_, directions, m, indirect, direct);
    }
    if (own_rays) bundles_.add_own_rays(receivers_, directions, indirect, direct);
    for (std::size_t i = 0; i < std::size_t(Packet::width); ++i) {
        gathered_[i].indirect += float(share.stride) * light[i] + indirect[i];
        if (settings_.eye.wanted[Transport::direct]) gathered_[i].direct += direct[i];
    }
    time_.vpls += middle - begin, time_.bundles += thread_cpu_seconds() - middle;
}

}  // namespace mote::integrators
