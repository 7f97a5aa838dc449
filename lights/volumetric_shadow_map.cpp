#include "lights/volumetric_shadow_map.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/scene/error.h"
#include "media/heterogeneous_medium.h"

namespace mote::lights {

using namespace core;

namespace {

/// What marching needs to know of a medium, asked once: traits are made for people and take long.
struct MarchedMedium {
    const Medium* medium;
    const media::HeterogeneousMedium* grid;  ///< null: homogeneous
    float voxel;

    explicit MarchedMedium(const Medium& m)
        : medium(&m),
          grid(dynamic_cast<const media::HeterogeneousMedium*>(&m)),
          voxel(m.traits().voxel_size) {}

    /// Optical depth per channel of a part of a ray inside it; `step` in voxels.
    Vec3d optical_depth(const Ray& part, float step, TrackingCounters& counters) const {
        const float length = part.t_max - part.t_min;
        if (grid)
            return grid->optical_depth_by_marching(part, std::isfinite(voxel) ? voxel * step : length,
                                                   counters);
        return Vec3d(medium->coefficients(part.origin).sigma_t) * double(length);
    }
};

/// One medium along a part of the ray.
struct Segment {
    const MarchedMedium* medium;
    float begin, end;
};

/// A node of a piecewise-linear function.
struct Node {
    float distance;
    Rgb value;
};

/// Twice the area between the function and what is left of it when `b` goes: what its integral would lose.
float loss(const Node& a, const Node& b, const Node& c) {
    const float share = (b.distance - a.distance) / std::max(c.distance - a.distance, 1e-30f);
    const Rgb difference = glm::abs(b.value - (a.value + share * (c.value - a.value)));
    return max_component(difference) * (c.distance - a.distance);
}

/// Drops nodes, the least important first, until `count` are left. The first and the last always stay.
void simplify(std::vector<Node>& nodes, std::size_t count) {
    while (nodes.size() > std::max<std::size_t>(count, 2)) {
        std::size_t least = 1;
        float least_loss = infinity;
        for (std::size_t i = 1; i + 1 < nodes.size(); ++i)
            if (const float l = loss(nodes[i - 1], nodes[i], nodes[i + 1]); l < least_loss)
                least = i, least_loss = l;
        nodes.erase(nodes.begin() + std::ptrdiff_t(least));
    }
}

}  // namespace

std::size_t ShadowMapSettings::bytes(int size, bool chromatic) const {
    const std::size_t channels = chromatic ? 3 : 1, texel = 3 * sizeof(float);
    const std::size_t values =
        storage == Storage::intervals ? std::size_t(intervals) + 1 : std::size_t(nodes);
    const std::size_t distances = storage == Storage::nodes ? values : 0;
    return std::size_t(size) * std::size_t(size) * (texel + sizeof(float) * (values * channels + distances));
}

void ShadowMapSettings::check(int size, bool chromatic) const {
    if (intervals < 1 || nodes < 2 || size < 1 || !(step > 0.0f))
        throw InputError(
            "a volumetric shadow map needs at least one texel, one interval, two nodes and a step above 0");
    if (bytes(size, chromatic) <= max_bytes) return;
    const auto fits = int(std::sqrt(double(max_bytes) / double(bytes(1, chromatic))));
    throw InputError(
        fmt::format("a volumetric shadow map of {0} x {0} texels takes {1:.1f} MB, above the limit of "
                    "{2:.1f} MB; {3} x {3} would fit",
                    size, double(bytes(size, chromatic)) * 1e-6, double(max_bytes) * 1e-6, fits));
}

/// Fills texels; one a thread.
class VolumetricShadowMap::Builder {
  public:
    Builder(const Scene& scene, VolumetricShadowMap& map, const MediumState& at_light)
        : scene_(scene), map_(map), at_light_(at_light) {
        for (const auto& medium : scene.media()) media_.emplace_back(*medium);
    }

    void fill(int index) {
        const Ray ray = map_.view_.ray(index);
        Texel& texel = map_.texels_[std::size_t(index)];
        ++rays.closest;
        const auto hit = scene_.rays().closest(ray);
        texel.surface = hit ? hit->t : infinity;
        find_segments(ray, texel.surface);
        const float begin = segments_.empty() ? 0.0f : segments_.front().begin;
        const float end = segments_.empty() ? 0.0f : segments_.back().end;
        const int intervals = map_.settings_.intervals;
        texel.enter = begin, texel.step = (end - begin) / float(intervals);
        sample(ray, texel);
        if (map_.settings_.storage == ShadowMapSettings::Storage::intervals)
            for (int k = 0; k <= intervals; ++k)
                put(std::size_t(index) * std::size_t(intervals + 1) + std::size_t(k), k);
        else
            put_nodes(std::size_t(index));
    }

    RayCounters rays;

  private:
    const MarchedMedium& marched(const Medium* medium) const {
        return *std::find_if(media_.begin(), media_.end(), [&](auto& m) { return m.medium == medium; });
    }

    /// The media along the ray up to `end`, clipped to where they are.
    void find_segments(const Ray& ray, float end) {
        segments_.clear();
        MediumState state = at_light_;
        // Beyond the scene's bounds no receiver can be.
        const Bounds3 bounds = scene_.bounds();
        const float far = glm::distance(ray.origin, bounds.center()) + bounds.radius();
        end = std::min(end, far);
        float t = ray.t_min;
        const auto pass = [&](float to) {
            const Medium* medium = state.current();
            if (medium && t < to) {
                const auto part = intersect(medium->bounds(), Ray{ray.origin, ray.direction, t, to});
                if (part) segments_.push_back({&marched(medium), part->t0, part->t1});
            }
            t = std::max(t, to);
        };
        if (scene_.rays().has_boundaries()) {
            ++rays.boundary;
            scene_.rays().all_hits(Ray{ray.origin, ray.direction, ray.t_min, end},
                                   RayTracer::Group::boundaries, boundaries_);
            for (const SurfaceHit& boundary : boundaries_) {
                pass(boundary.t);
                state.cross(*boundary.shape, boundary.geometric_normal, ray.direction);
            }
        }
        pass(end);
    }

    /// Transmittance at the ends of all intervals.
    void sample(const Ray& ray, const Texel& texel) {
        const int intervals = map_.settings_.intervals;
        values_.assign(std::size_t(intervals) + 1, Rgb(1.0f));
        if (!(texel.step > 0.0f)) return;
        Vec3d depth(0.0);
        std::size_t s = 0;
        for (int k = 1; k <= intervals; ++k) {
            const float from = texel.enter + float(k - 1) * texel.step,
                        to = texel.enter + float(k) * texel.step;
            while (s < segments_.size() && segments_[s].end <= from) ++s;
            for (std::size_t i = s; i < segments_.size() && segments_[i].begin < to; ++i) {
                const Ray part{ray.origin, ray.direction, std::max(from, segments_[i].begin),
                               std::min(to, segments_[i].end)};
                if (part.t_min < part.t_max)
                    depth += segments_[i].medium->optical_depth(part, map_.settings_.step, counters_);
            }
            for (int c = 0; c < 3; ++c) values_[std::size_t(k)][c] = float(std::exp(-depth[c]));
        }
    }

    void put(std::size_t place, int k) {
        for (int c = 0; c < map_.channels_; ++c)
            map_.values_[place * std::size_t(map_.channels_) + std::size_t(c)] = values_[std::size_t(k)][c];
    }

    void put_nodes(std::size_t index) {
        const Texel& texel = map_.texels_[index];
        nodes_.clear();
        for (std::size_t k = 0; k < values_.size(); ++k)
            nodes_.push_back({texel.enter + float(k) * texel.step, values_[k]});
        const auto count = std::size_t(map_.settings_.nodes);
        simplify(nodes_, count);
        while (nodes_.size() < count) nodes_.push_back(nodes_.back());
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t place = index * count + i;
            map_.distances_[place] = nodes_[i].distance;
            for (int c = 0; c < map_.channels_; ++c)
                map_.values_[place * std::size_t(map_.channels_) + std::size_t(c)] = nodes_[i].value[c];
        }
    }

    const Scene& scene_;
    VolumetricShadowMap& map_;
    const MediumState& at_light_;
    std::vector<MarchedMedium> media_;
    TrackingCounters counters_;
    std::vector<SurfaceHit> boundaries_;
    std::vector<Segment> segments_;
    std::vector<Rgb> values_;
    std::vector<Node> nodes_;
};

void VolumetricShadowMap::build(const Scene& scene, const ShadowMapView& view, const MediumState& at_light,
                                const ShadowMapSettings& settings) {
    const auto media = scene.media();
    const bool chromatic =
        std::any_of(media.begin(), media.end(), [](const auto& m) { return m->traits().chromatic; });
    settings.check(view.size, chromatic);
    view_ = view, settings_ = settings, channels_ = chromatic ? 3 : 1;
    slack_ = view.texel_angle();
    const auto texels = std::size_t(view.texels());
    const bool nodes = settings.storage == ShadowMapSettings::Storage::nodes;
    const std::size_t per_texel = nodes ? std::size_t(settings.nodes) : std::size_t(settings.intervals) + 1;
    texels_.resize(texels);
    values_.resize(texels * per_texel * std::size_t(channels_));
    distances_.resize(nodes ? texels * per_texel : 0);
    tbb::enumerable_thread_specific<Builder> builders([&] { return Builder(scene, *this, at_light); });
    tbb::parallel_for(0, view.size, [&](int row) {
        Builder& builder = builders.local();
        for (int column = 0; column < view.size; ++column) builder.fill(row * view.size + column);
    });
    rays_ = {};
    for (const Builder& builder : builders) rays_.add(builder.rays);
}

Rgb VolumetricShadowMap::at_intervals(std::size_t texel, float distance) const {
    const Texel& t = texels_[texel];
    const std::size_t first = texel * std::size_t(settings_.intervals + 1);
    const float x = t.step > 0.0f ? (distance - t.enter) / t.step : 0.0f;
    if (!(x > 0.0f)) return Rgb(1.0f);
    if (x >= float(settings_.intervals)) return value(first + std::size_t(settings_.intervals));
    const auto k = std::size_t(x);
    const float f = x - float(k);
    return (1.0f - f) * value(first + k) + f * value(first + k + 1);
}

Rgb VolumetricShadowMap::at_nodes(std::size_t texel, float distance) const {
    const auto count = std::size_t(settings_.nodes);
    const float* first = distances_.data() + texel * count;
    const auto after = std::size_t(std::upper_bound(first, first + count, distance) - first);
    if (after == 0) return Rgb(1.0f);
    if (after == count) return value(texel * count + count - 1);
    const float f = (distance - first[after - 1]) / (first[after] - first[after - 1]);
    return (1.0f - f) * value(texel * count + after - 1) + f * value(texel * count + after);
}

Rgb VolumetricShadowMap::transmittance(const Vec3& p) const {
    const auto place = view_.place(p);
    if (!place) return Rgb(0.0f);
    const bool nodes = settings_.storage == ShadowMapSettings::Storage::nodes;
    Rgb sum(0.0f);
    for (std::size_t i = 0; i < 4; ++i) {
        const auto texel = std::size_t(place->footprint.texel[i]);
        if (place->distance > texels_[texel].surface * (1.0f + slack_)) continue;
        sum += place->footprint.weight[i] *
               (nodes ? at_nodes(texel, place->distance) : at_intervals(texel, place->distance));
    }
    return sum;
}

std::size_t VolumetricShadowMap::memory_bytes() const {
    return texels_.capacity() * sizeof(Texel) + (values_.capacity() + distances_.capacity()) * sizeof(float);
}

}  // namespace mote::lights
