#include "lights/shadow_maps/shadow_map_builder.h"

#include <algorithm>
#include <cstring>

#include "core/scene/media_along.h"

namespace mote::lights {

using namespace core;

namespace {
/// Slope of a surface against its ray above which it is taken as that steep: a hit that grazes must not hide
/// everything behind it.
constexpr float steepest = 10.0f;
/// Distance, in texels at right angles to the ray, that the march continues behind a surface: neighbours may
/// see parts of it that lie farther away.
constexpr float march_behind = 4.0f;
}  // namespace

ShadowMapBuilder::ShadowMapBuilder(const RayQueries& scene, const VolumetricShadowMap& map,
                                   const MediumState& at_light)
    : scene_(scene), map_(map), at_light_(at_light) {
    for (const auto& m : scene.media()) media_.push_back({m.get(), m->bounds()});
}

void ShadowMapBuilder::fill(int texel, std::byte* record) {
    const ShadowMapSettings& settings = map_.settings_;
    const Ray ray = map_.view_.ray(texel);
    VolumetricShadowMap::Header header{};
    find_segments(ray, find_surface(ray, header));
    const auto [begin, end] = extent(map_.view_.spacing(panes_.empty() ? 0.0f : panes_.back().distance));
    const float step = (end - begin) / float(settings.intervals);
    header.enter = begin, header.inverse_step = step > 0.0f ? 1.0f / step : 0.0f;
    if (!std::isfinite(header.inverse_step)) header.inverse_step = 0.0f;
    std::memcpy(record, &header, sizeof header);
    march(ray, header, step);
    write(record);
}

/// From the first medium or pane to the last; a pane is never narrower than a texel.
Interval ShadowMapBuilder::extent(float spacing) const {
    Interval all{segments_.empty() ? infinity : segments_.front().begin,
                 segments_.empty() ? 0.0f : segments_.back().end};
    for (const Pane& pane : panes_) {
        all.t0 = std::min(all.t0, std::max(0.0f, pane.distance - 0.5f * spacing));
        all.t1 = std::max(all.t1, pane.distance + 0.5f * spacing);
    }
    return all.t0 < all.t1 ? all : Interval{0.0f, 0.0f};
}

/// The plane of the first surface. Returns how far to march.
float ShadowMapBuilder::find_surface(const Ray& ray, VolumetricShadowMap::Header& header) {
    header.limit = infinity;
    ++rays_.closest;
    const auto hit = scene_.first_hit(ray);
    if (!hit) return infinity;
    const ShadowMapView& view = map_.view_;
    const Vec3 direction = view.frame.to_local(ray.direction);
    const Vec3 normal = view.frame.to_local(hit->geometric_normal);
    const float cosine = glm::dot(normal, direction);
    // The plane as direction + slope: it is 1 along the ray, and slope lies at right angles to it.
    Vec3 slope = cosine == 0.0f ? Vec3(0.0f) : normal / cosine - direction;
    const float length = glm::length(slope);
    if (length > steepest) slope *= steepest / length;
    const Vec3 plane = direction + slope;
    const Vec3 local = view.frame.to_local(ray.at(hit->t) - view.origin);
    const float spacing = view.spacing(hit->t);
    header.plane_x = plane.x, header.plane_y = plane.y, header.plane_z = plane.z;
    header.limit = glm::dot(plane, local) + spacing;
    return hit->t + spacing * (1.0f + std::min(length, march_behind));
}

/// The media along the ray up to `end`, clipped to where they are.
void ShadowMapBuilder::find_segments(const Ray& ray, float end) {
    segments_.clear(), panes_.clear();
    // Beyond the scene's bounds no receiver can be.
    const Bounds3 bounds = scene_.bounds();
    end = std::min(end, glm::distance(ray.origin, bounds.center()) + bounds.radius());
    const auto keep = [&](float t, float to, const MediumState& state) {
        const Medium* medium = state.current();
        if (medium && t < to) {
            const auto known =
                std::find_if(media_.begin(), media_.end(), [&](auto& m) { return m.medium == medium; });
            const auto part = intersect(known->bounds, Ray{ray.origin, ray.direction, t, to});
            if (part) segments_.push_back({medium, part->t0, part->t1});
        }
        return true;
    };
    const auto keep_pane = [&](const SurfaceHit& hit) {
        const Rgb passes = glm::max(passage_through(hit, ray.direction).transmittance(), Rgb(1e-30f));
        panes_.push_back({hit.t, -glm::log(Vec3d(passes))});
        return true;
    };
    rays_.boundary += scene_.has_boundaries();
    for_each_part(scene_, Ray{ray.origin, ray.direction, ray.t_min, end}, at_light_, keep, keep_pane);
}

/// Optical depth at the ends of all intervals.
void ShadowMapBuilder::march(const Ray& ray, const VolumetricShadowMap::Header& header, float step) {
    const auto intervals = std::size_t(map_.settings_.intervals);
    depths_.assign(intervals, Vec3d(0.0));
    if (header.inverse_step > 0.0f) {
        if (segments_.size() == 1 && panes_.empty()) {
            const Segment& only = segments_.front();
            only.medium->optical_depths_along(Ray{ray.origin, ray.direction, only.begin, only.end},
                                              map_.settings_.step, depths_, counters_);
        } else {
            march_segments(ray, header.enter, step);
        }
    }
}

/// Several media, or panes: interval by interval.
void ShadowMapBuilder::march_segments(const Ray& ray, float enter, float step) {
    Vec3d depth(0.0);
    std::size_t s = 0;
    for (std::size_t k = 0; k < depths_.size(); ++k) {
        const float from = enter + float(k) * step, to = enter + float(k + 1) * step;
        while (s < segments_.size() && segments_[s].end <= from) ++s;
        for (std::size_t i = s; i < segments_.size() && segments_[i].begin < to; ++i) {
            const Ray part{ray.origin, ray.direction, std::max(from, segments_[i].begin),
                           std::min(to, segments_[i].end)};
            if (part.t_min < part.t_max)
                depth += segments_[i].medium->optical_depth_along(part, map_.settings_.step, counters_);
        }
        for (const Pane& pane : panes_)
            if (from < pane.distance && pane.distance <= to) depth += pane.depth;
        depths_[k] = depth;
    }
}

void ShadowMapBuilder::write(std::byte* record) const {
    std::byte* to = record + sizeof(VolumetricShadowMap::Header);
    const auto put = [&to](auto value) {
        std::memcpy(to, &value, sizeof value);
        to += sizeof value;
    };
    constexpr float codes = 65535.0f;
    for (std::size_t channel = 0; channel < map_.channels_; ++channel) {
        put(std::uint16_t(0));  // where the media begin
        for (const Vec3d& depth : depths_) {
            const float code = float(depth[int(channel)]) / VolumetricShadowMap::depth_unit;
            put(std::uint16_t(std::min(code, codes) + 0.5f));
        }
    }
}

}  // namespace mote::lights
