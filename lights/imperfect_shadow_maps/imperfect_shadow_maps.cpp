#include "lights/imperfect_shadow_maps/imperfect_shadow_maps.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <string>

#include "core/math/vectorize.h"

namespace mote::lights {

using namespace core;

namespace {

constexpr int max_reach = 8;  // texels around its middle that a disc is tried in

/// A light shines to one side of a surface, or everywhere.
ShadowMapView view_of(const VplSet& vpls, const VirtualPointLight& vpl, int size) {
    const bool both = vpl.detail != VirtualPointLight::no_detail && vpl.on_surface() &&
                      vpls.details[vpl.detail].vertex.bsdf->traits().transmissive;
    return vpl.on_surface() && !both ? ShadowMapView::of_surface(vpl.position, vpl.normal, size)
                                     : ShadowMapView::of_point(vpl.position, size);
}

/// Directions of texels that all maps of one kind share in the map's own frame, each scaled to |w|_1 = 1.
std::vector<Vec3> texel_directions(ShadowMapView::Kind kind, int size) {
    std::vector<Vec3> directions;
    for (int texel = 0; texel < size * size; ++texel) {
        const Vec3 w = kind == ShadowMapView::Kind::hemispherical ? HemiOctahedralMap{size}.direction(texel)
                                                                  : OctahedralMap{size}.direction(texel);
        directions.push_back(w / (std::fabs(w.x) + std::fabs(w.y) + std::fabs(w.z)));
    }
    return directions;
}

/// One map while it is filled; nearest are the largest numbers.
class Splats {
  public:
    Splats(const ShadowMapView& view, std::span<const Vec3> directions, float radius)
        : view_(view), directions_(directions), radius_(radius), map(directions.size(), 0.0f) {
        texel_width_ = view.spacing(1.0f);
    }

    void add(const SurfaceSample& point) {
        const Vec3 d = view_.frame.to_local(point.position - view_.origin);
        const bool half = view_.kind == ShadowMapView::Kind::hemispherical;
        const float distance = glm::length(d);
        // The light's own surface is no more than rounding below it.
        if (!(distance > 0.0f) || (half && d.z <= 1e-4f * distance)) return;
        const int middle = half ? HemiOctahedralMap{view_.size}.texel(d) : OctahedralMap{view_.size}.texel(d);
        const Vec3 normal = view_.frame.to_local(point.normal);
        const float nearest = std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z);
        const float plane = depth_of_plane(d, normal, middle);
        // A plane seen along itself is anywhere.
        nearer(middle, plane > 0.5f * nearest && plane < 2.0f * nearest ? plane : nearest);
        const float reach = 1.5f * radius_ / (distance * texel_width_);  // where texels are smallest
        if (reach > 0.5f) disc(d, normal, middle, std::min(int(std::ceil(reach)), max_reach));
    }

  private:
    /// Distance of the point's plane along a texel's ray, in the measure |d|_1; negative behind the light.
    float depth_of_plane(const Vec3& d, const Vec3& normal, int texel) const {
        return glm::dot(normal, d) / glm::dot(normal, directions_[std::size_t(texel)]);
    }
    void nearer(int texel, float depth) {
        float& inverse = map[std::size_t(texel)];
        inverse = std::max(inverse, 1.0f / depth);
    }

    /// Texels whose rays meet the disc get the depth there.
    void disc(const Vec3& d, const Vec3& normal, int middle, int reach) {
        const int column = middle % view_.size, row = middle / view_.size, last = view_.size - 1;
        for (int j = std::max(row - reach, 0); j <= std::min(row + reach, last); ++j)
            for (int i = std::max(column - reach, 0); i <= std::min(column + reach, last); ++i) {
                const int texel = j * view_.size + i;
                const float t = depth_of_plane(d, normal, texel);
                const Vec3 off = t * directions_[std::size_t(texel)] - d;
                if (t > 0.0f && glm::dot(off, off) <= radius_ * radius_) nearer(texel, t);
            }
    }

    const ShadowMapView& view_;
    std::span<const Vec3> directions_;
    float radius_, texel_width_;

  public:
    std::vector<float> map;
};

}  // namespace

void ImperfectShadowMaps::build(const SurfaceSamples& points, const VplSet& vpls,
                                const ImperfectMapSettings& settings, std::uint64_t key,
                                CancelToken cancelled) {
    using Kind = ShadowMapView::Kind;
    size_ = settings.size;
    // In the measure of the map a texel's half width is 1 / size of the distance.
    margin_ = 1.0f - settings.bias / float(size_);
    views_.clear();
    for (const VirtualPointLight& vpl : vpls.lights) views_.push_back(view_of(vpls, vpl, size_));
    const double bytes = double(views_.size()) * double(settings.bytes());
    settings.memory.require(
        bytes > double(memory_bytes()) ? bytes : 0.0,
        std::to_string(views_.size()) + " imperfect shadow maps of " + std::to_string(size_) + "^2 texels");
    inverse_.resize(views_.size() * settings.bytes() / sizeof(float));
    const std::size_t all = points.points.size(), count = std::min(std::size_t(settings.points), all);
    const float radius = points.radius(count, settings.splat);
    const auto half = texel_directions(Kind::hemispherical, size_),
               full = texel_directions(Kind::octahedral, size_);
    tbb::parallel_for(std::size_t(0), views_.size(), [&](std::size_t j) {
        cancelled.check();
        Splats splats(views_[j], views_[j].kind == Kind::hemispherical ? half : full, radius);
        const std::size_t first = all > 0 ? std::size_t(hash_keys(key, j) % all) : 0;
        for (std::size_t k = 0; k < count; ++k) splats.add(points.points[(first + k) % all]);
        if (settings.pull_push) {
            pull_push(splats.map, size_);
            close_gaps(splats.map, views_[j]);
        }
        store(j, splats.map);
    });
}

void ImperfectShadowMaps::store(std::size_t light, std::span<const float> map) {
    const int stride = size_ + 2;
    float* to = inverse_.data() + light * std::size_t(stride) * std::size_t(stride);
    for (int j = -1; j <= size_; ++j)
        for (int i = -1; i <= size_; ++i) *to++ = map[std::size_t(views_[light].neighbour(i, j))];
}

void ImperfectShadowMaps::look_up(std::size_t light, const ReceiverLanes& receivers, float* visible) const {
    constexpr int width = ReceiverLanes::width;
    const ShadowMapView& view = views_[light];
    const Vec3 o = view.origin, s = view.frame.s, t = view.frame.t, n = view.frame.n;
    const float half = view.kind == ShadowMapView::Kind::hemispherical ? 1.0f : 0.0f;
    const float size = float(size_), margin = margin_;
    const std::int32_t stride = size_ + 2;
    alignas(64) float own[width];
    alignas(64) std::int32_t corner[width];
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < width; ++i) {
        const float dx = receivers.x[i] - o.x, dy = receivers.y[i] - o.y, dz = receivers.z[i] - o.z;
        const float x = dx * s.x + dy * s.y + dz * s.z, y = dx * t.x + dy * t.y + dz * t.z;
        const float z = dx * n.x + dy * n.y + dz * n.z;
        const float ax = std::fabs(x), ay = std::fabs(y);
        const float scale = 1.0f / max_of(ax + ay + std::fabs(z), 1e-30f);
        // Eqs. 7.1 and 7.2 for all directions, or the upper half, turned (core/math/octahedral.h).
        const float px = scale * x, py = scale * y, below = z < 0.0f ? 1.0f : 0.0f;
        const float full_x = px + below * (std::copysign(1.0f - scale * ay, x) - px);
        const float full_y = py + below * (std::copysign(1.0f - scale * ax, y) - py);
        const float u = half * (px - py) + (1.0f - half) * full_x;
        const float v = half * (px + py) + (1.0f - half) * full_y;
        // From the corner of the border's first texel; centres lie at halves.
        const float column = max_of(min_of((0.5f * u + 0.5f) * size + 0.5f, size), 0.0f);
        const float row = max_of(min_of((0.5f * v + 0.5f) * size + 0.5f, size), 0.0f);
        corner[i] = std::int32_t(row) * stride + std::int32_t(column), own[i] = scale;
    }
    const float* const map = inverse_.data() + light * std::size_t(stride) * std::size_t(stride);
    alignas(64) float a[width], b[width], c[width], d[width];
    for (int i = 0; i < width; ++i) {
        const float* const at = map + corner[i];
        a[i] = at[0], b[i] = at[1], c[i] = at[stride], d[i] = at[stride + 1];
    }
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < width; ++i) {
        const float farthest = min_of(min_of(a[i], b[i]), min_of(c[i], d[i]));
        visible[i] = margin * farthest > own[i] ? 0.0f : 1.0f;
    }
}

bool ImperfectShadowMaps::visible(std::size_t light, const Vec3& position) const {
    ReceiverLanes one;
    one.x[0] = position.x, one.y[0] = position.y, one.z[0] = position.z;
    float result[ReceiverLanes::width];
    look_up(light, one, result);
    return result[0] > 0.0f;
}

}  // namespace mote::lights
