#include "integrators/vpl_ray_bundles/vpl_bundle_tile.h"

namespace mote::integrators {

using namespace core;

void VplBundleTile::start(int lane, const EyeRay& eye, int paths) {
    Lane& l = lanes_[std::size_t(lane)];
    l.found = l.gathered = {}, l.alive = true, l.paths = float(paths);
    walk_.rng = eye.rng;
    l.path.emplace(scene_, settings_.eye, eye, walk_, pass_.eye_lights());
    l.rng = walk_.rng;
}

void VplBundleTile::stop(int lane) {
    Lane& l = lanes_[std::size_t(lane)];
    l.found = l.gathered = {}, l.alive = false;
}

void VplBundleTile::add_direct(int lane, const EyeRay& eye) {
    const double begin = thread_cpu_seconds();
    EyePathLimits limits = settings_.eye;
    limits.wanted = limits.wanted - Transport::indirect;
    walk_.rng = eye.rng;
    EyePath<false> path(scene_, limits, eye, walk_, pass_.eye_lights());
    TransportSum& sum = lanes_[std::size_t(lane)].found;
    while (advance(path, sum)) {
    }
    time_.eye += thread_cpu_seconds() - begin;
}

TransportSum VplBundleTile::sum(int lane) const {
    const Lane& l = lanes_[std::size_t(lane)];
    TransportSum sum = l.gathered;
    for (std::size_t i = 0; i < transport_count; ++i) sum.light[i] += l.found.light[i] / l.paths;
    return sum;
}

void VplBundleTile::run(const lights::VplRange& share,
                        std::span<const gathering::BundleDirection> directions) {
    for (bool any = true; any;) {
        const double begin = thread_cpu_seconds();
        tile_.clear();
        receivers_.fill({});
        any = false;
        for (int i = 0; i < width; ++i) {
            Lane& lane = lanes_[std::size_t(i)];
            walk_.rng = lane.rng;
            if (lane.alive) lane.alive = advance(i);
            lane.rng = walk_.rng;
            any |= lane.alive;
        }
        time_.eye += thread_cpu_seconds() - begin;
        if (tile_.any_active) gather(share, directions);
    }
}

/// Follows an eye path to its next vertex, and adds the direct light there. Returns whether there is one.
bool VplBundleTile::advance(EyePath<false>& path, TransportSum& sum) {
    const auto sky_behind = [&](const EyeSegment& segment) {
        // The sky is no light of the eye path then, but is seen.
        if (pass_.bundles.sky && segment.event.kind == WalkEvent::Kind::escaped && path.scatterings() == 0 &&
            !(settings_.eye.hide_emitters && path.depth() == 1))
            sum[Transport::emission] +=
                path.throughput() * pass_.bundles.sky->environment(segment.ray.direction);
    };
    if (!path.advance(walk_, sum, sky_behind)) return false;
    if (path.vertex().connectable() && path.wants_connection())
        sum[path.layer_of_connection()] += path.sample_light(walk_);
    return true;
}

/// The first eye path of a pixel; makes its vertex a receiver where it can be connected.
bool VplBundleTile::advance(int index) {
    Lane& lane = lanes_[std::size_t(index)];
    EyePath<false>& path = *lane.path;
    if (!advance(path, lane.found)) return false;
    if (path.vertex().connectable() && (settings_.eye.wanted[Transport::indirect] || pass_.bundles.sky))
        add_receiver(index, path);
    return true;
}

void VplBundleTile::add_receiver(int index, const EyePath<false>& path) {
    const int max_depth = settings_.eye.max_depth;
    std::int32_t vpl_depth =
        max_depth < 0 ? std::numeric_limits<std::int32_t>::max() : max_depth - path.depth() - 1;
    if (!settings_.eye.wanted[Transport::indirect]) vpl_depth = 0;
    Lane& lane = lanes_[std::size_t(index)];
    tile_.set(index, path.vertex(), path.throughput(), {}, Rng(walk_.rng.next_u32()), vpl_depth);
    receivers_[std::size_t(index)] = {&path.vertex(), path.throughput(), vpl_depth, &lane.path->sampler()};
}

void VplBundleTile::gather(const lights::VplRange& share,
                           std::span<const gathering::BundleDirection> directions) {
    const double begin = thread_cpu_seconds();
    const lights::GatherContext context{scene_, scratch_, walk_.rays, walk_.tracking, walk_.cancelled};
    const bool own_rays = pass_.own_rays() > 0.0f && tile_.any_directional;
    const auto light =
        own_rays ? lights::gather(context, pass_.vpls, share,
                                  gathering::AgainstBundlesAndOwnRays{pass_.rivals, pass_.own_rays()}, tile_)
                 : lights::gather(context, pass_.vpls, share, gathering::AgainstBundles{pass_.rivals}, tile_);
    const double middle = thread_cpu_seconds();
    lights::TileLight indirect{}, direct{};
    for (std::size_t m = 0; m < directions.size(); ++m) {
        walk_.cancelled.check();
        bundles_.add(receivers_, directions, m, indirect, direct);
    }
    if (own_rays) bundles_.add_own_rays(receivers_, directions, indirect, direct);
    for (std::size_t i = 0; i < std::size_t(width); ++i) {
        lanes_[i].gathered[Transport::indirect] += float(share.stride) * light[i] + indirect[i];
        if (settings_.eye.wanted[Transport::direct]) lanes_[i].gathered[Transport::direct] += direct[i];
    }
    time_.vpls += middle - begin, time_.bundles += thread_cpu_seconds() - middle;
}

}  // namespace mote::integrators
