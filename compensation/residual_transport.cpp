#include "compensation/residual_transport.h"

#include <algorithm>

#include "compensation/bounded_geometry.h"
#include "compensation/region_distance.h"
#include "core/scene/media_along.h"

namespace mote::compensation {

using namespace core;

namespace {

/// Distances are never sampled from less than a tenth of an optical depth over the region: the mean may be
/// nearly zero where there is extinction on one side, and every point must have a chance.
constexpr float min_optical_depth = 0.1f;

/// Where a path along the ray stops at the latest: at the first surface, or by chance at a pane before it.
struct Stop {
    std::optional<SurfaceHit> hit;
    bool by_pane = false;
    float chance = 1.0f;  ///< StraightPassage::stops of that pane
};

Stop first_stop(const RayQueries& scene, const Ray& ray, WalkContext& context) {
    ++context.rays.closest;
    Stop stop{scene.first_hit(ray)};
    if (!scene.has_panes()) return stop;
    Ray before = ray;
    if (stop.hit) before.t_max = stop.hit->t;
    ++context.rays.boundary;
    scene.for_each_boundary(before, [&](const SurfaceHit& hit) {
        if (!is_pane(hit)) return true;
        const StraightPassage passage = passage_through(hit, ray.direction);
        if (context.rng.next_float() < passage.probability()) return true;
        stop = {hit, true, passage.stops};
        return false;
    });
    return stop;
}

/// Weight of a path that passed the panes on its way by chance, times the transmittance of the media between
/// them.
Rgb transmittance_past_panes(const RayQueries& scene, const Ray& ray, const MediumState& state, bool media,
                             WalkContext& context) {
    Rgb product(1.0f);
    const auto part = [&](float t0, float t1, const MediumState& here) {
        const Medium* medium = here.current();
        if (media && medium && t0 < t1)
            product *=
                medium->transmittance(Ray{ray.origin, ray.direction, t0, t1}, context.rng, context.tracking);
        return !is_black(product);
    };
    for_each_part(scene, ray, state, part, [&](const SurfaceHit& hit) {
        product *= passage_through(hit, ray.direction).weight;
        return !is_black(product);
    });
    return product;
}

/// The media at the end of `ray`, which starts in `state`.
MediumState state_at_end(const RayQueries& scene, const Ray& ray, const MediumState& state,
                         WalkContext& context) {
    if (!scene.has_boundaries()) return state;
    ++context.rays.boundary;
    const auto pass = [](float, float, const MediumState&) { return true; };
    return *for_each_part(scene, ray, state, pass, [](const SurfaceHit&) { return true; });
}

Rgb exponential(const Rgb& optical_depth) {
    return {std::exp(-optical_depth.x), std::exp(-optical_depth.y), std::exp(-optical_depth.z)};
}

/// A distance along a ray in a homogeneous medium, up to a surface if one is within reach.
struct Placement1D {
    float distance = 0.0f;
    float density = 0.0f;  ///< p(t) [1/m]; at the surface the probability to reach it
    bool at_surface = false, lost = false;
};

/// One channel of `extinction` drives the distance; the density is the average over all of them.
Placement1D sample_distance(const Rgb& extinction, float surface, float radius, bool keep_inside, Rng& rng) {
    const float s = extinction[std::min(int(rng.next_float() * 3.0f), 2)], u = rng.next_float();
    const bool reach_surface = surface < radius;
    Placement1D p;
    if (reach_surface || !keep_inside) {
        const float end = reach_surface ? surface : radius;
        p.distance = s > 0.0f ? -std::log1p(-u) / s : infinity;
        if (p.distance < end) {
            p.density = average(extinction * exponential(extinction * p.distance));
        } else {
            p.at_surface = reach_surface, p.lost = !reach_surface;
            p.distance = end, p.density = average(exponential(extinction * end));
        }
        return p;
    }
    p.distance = RegionDistance(s, radius).sample(u);  // Engelhardt 2013, Eqs. 10.14 and 10.13
    for (int c = 0; c < 3; ++c)
        p.density += RegionDistance(extinction[c], radius).pdf_distance(p.distance) / 3.0f;
    return p;
}

bool within(const Bounds3& box, const Vec3& p, float distance) {
    const Vec3 nearest = glm::clamp(p, box.lower, box.upper);
    return !box.empty() && glm::dot(nearest - p, nearest - p) <= distance * distance;
}

/// Volume that the box has in common with the cube around p whose half edge is `radius` [m^3].
float common_volume(const Bounds3& box, const Vec3& p, float radius) {
    const Vec3 edges = glm::min(box.upper, p + radius) - glm::max(box.lower, p - radius);
    return edges.x * edges.y * edges.z;
}

}  // namespace

ResidualTransport::ResidualTransport(const RayQueries& scene, float bound,
                                     const CompensationSettings& settings)
    : scene_(scene), settings_(settings), bound_(bound), radius_(bounding_radius(bound)) {
    if (by_free_path()) return;
    for (const auto& medium : scene.media()) {
        const Bounds3 extent = scene.medium_extent(*medium);
        media_.push_back({medium.get(), extent, media::MeanExtinction(*medium, extent)});
    }
}

std::size_t ResidualTransport::memory_bytes() const {
    std::size_t bytes = 0;
    for (const LocalMedium& m : media_) bytes += m.mean.memory_bytes();
    return bytes;
}

ResidualPath ResidualTransport::start(const ScatteringVertex& receiver, const MediumState& state,
                                      const Rgb& throughput, Rng& rng) const {
    ResidualPath path;
    path.vertex = receiver, path.state = state;
    path.weights.throughput = throughput;
    path.weights.hero = sample_hero(rng);
    find_mean_extinction(path);
    return path;
}

bool ResidualTransport::by_free_path() const {
    return settings_.placement == Placement::free_path && settings_.local_visibility &&
           settings_.transmittance == LocalTransmittance::exact;
}

/// Mean extinction of all media within the bounding radius [1/m], each with the volume that it may have
/// there; nothing where there is none.
void ResidualTransport::find_mean_extinction(ResidualPath& path) const {
    const Vec3 p = path.vertex.position;
    path.mean_extinction.reset();
    float sum = 0.0f;
    for (const LocalMedium& m : media_) {
        if (!within(m.extent, p, radius_)) continue;
        const Rgb before = path.mean_extinction.value_or(Rgb(0.0f)), mean = m.mean.mean(p, radius_);
        const float volume = common_volume(m.extent, p, radius_);
        sum += volume;
        path.mean_extinction = before + (mean - before) * (sum > 0.0f ? volume / sum : 1.0f);
    }
    path.mean_known = true;
}

bool ResidualTransport::may_hold(const Medium& medium, const Vec3& p) const {
    const auto m = std::find_if(media_.begin(), media_.end(), [&](auto& l) { return l.medium == &medium; });
    return m->extent.contains(p) && medium.bounds().contains(p);
}

template <bool Media>
bool ResidualTransport::sample_by_free_path(ResidualPath& path, const Ray& ray, WalkContext& context) const {
    Rgb emitted(0.0f);  // emission on the way is not part of the VPLs' light
    const WalkEvent event = walk<Media>(scene_, ray, path.state, path.weights, emitted, context);
    if (event.kind == WalkEvent::Kind::escaped) return false;
    path.vertex = make_vertex(event, ray);
    return true;
}

bool ResidualTransport::sample_in_mean_medium(ResidualPath& path, const Ray& ray,
                                              WalkContext& context) const {
    const bool look = settings_.local_visibility || path.vertex.on_surface();
    const Stop stop = look ? first_stop(scene_, ray, context) : Stop{};
    const std::optional<SurfaceHit>& hit = stop.hit;
    if (!path.mean_known) find_mean_extinction(path);
    if (!path.mean_extinction && !hit) return false;
    const Rgb mean = path.mean_extinction.value_or(Rgb(0.0f));
    const Rgb sampled_from = path.mean_extinction ? glm::max(mean, Rgb(min_optical_depth / radius_)) : mean;
    const Placement1D p = sample_distance(sampled_from, hit ? hit->t : infinity, radius_,
                                          settings_.placement == Placement::in_region, context.rng);
    if (p.lost || !(p.density > 0.0f)) return false;

    const Ray part{ray.origin, ray.direction, 0.0f, p.distance};
    const MediumState start = path.state;
    const Vec3 z = ray.at(p.distance);
    // Without rays a medium ends at its box alone, and another one may begin there.
    const Medium* here = start.current();
    const bool left = here && media_.size() > 1 && !may_hold(*here, z);
    if (look || left) path.state = state_at_end(scene_, part, start, context);
    WalkEvent event;
    event.distance = p.distance;
    if (p.at_surface) {
        event.kind = WalkEvent::Kind::surface, event.hit = *hit;
        event.reflected = stop.by_pane, event.stop_chance = stop.chance;
    } else {
        event.kind = WalkEvent::Kind::collision, event.medium = path.state.current();
        if (!event.medium || !may_hold(*event.medium, z)) return false;
        path.weights.throughput *= event.medium->coefficients(z).sigma_s;  // in L(y <- z) of Eq. 10.11
    }
    path.vertex = make_vertex(event, ray);
    // The mean: Sec. 10.2.2, tau = exp(-mean |y - z|).
    const bool exact = settings_.transmittance == LocalTransmittance::exact;
    Rgb transmittance = exact ? Rgb(1.0f) : exponential(mean * p.distance);
    if (look && scene_.has_panes())
        transmittance *= transmittance_past_panes(scene_, part, start, exact, context);
    else if (exact)
        transmittance = scene_.transmittance(ray.origin, z, start, context.rng, context.tracking);
    path.weights.throughput *= transmittance / p.density;  // tau(y,z) / p(t) of Eq. 10.11
    return true;
}

template <bool Media>
bool ResidualTransport::step(ResidualPath& path, WalkContext& context) const {
    const float before = max_component(glm::abs(path.throughput()));  // estimates may be negative
    const float u_lobe = context.rng.next_float();
    const auto next = path.vertex.sample(u_lobe, context.rng.next_vec2(), TransportMode::radiance);
    if (!next || next->delta) return false;   // light through mirrors and glass is no VPL's
    path.weights.throughput *= next->weight;  // f*(x<-y<-z) C*(y->z) / p(w) of Eq. 10.11
    if (Media && path.vertex.on_surface()) path.state = path.vertex.state_towards(path.state, next->wi);
    const float cosine = path.vertex.shading_cosine(next->wi);
    const Ray ray{path.vertex.ray_origin(next->wi), next->wi, 0.0f, radius_};

    bool placed;
    if (!Media || by_free_path())
        placed = sample_by_free_path<Media>(path, ray, context);
    else
        placed = sample_in_mean_medium(path, ray, context);
    path.mean_known = false;
    if (!placed || !path.vertex.connectable()) return false;

    const float distance = glm::distance(ray.origin, path.vertex.position);
    // B*(y,z), below Eq. 10.11, and on surfaces the factor of Eq. 4.7. C* with the shading normal at the
    // receiver and the geometric one at the other end, as VPLs are gathered.
    path.weights.throughput *=
        residual_factor(cosine * path.vertex.geometric_cosine(path.vertex.wo), distance, bound_);
    const float remaining = max_component(glm::abs(path.throughput()));
    if (!(remaining > 0.0f)) return false;
    if (remaining < before) {
        const float q = remaining / before;
        if (!(context.rng.next_float() < q)) return false;
        path.weights.throughput /= q;
    }
    return true;
}

template bool ResidualTransport::step<true>(ResidualPath&, WalkContext&) const;
template bool ResidualTransport::step<false>(ResidualPath&, WalkContext&) const;

}  // namespace mote::compensation
