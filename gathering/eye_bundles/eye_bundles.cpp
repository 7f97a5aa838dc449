#include "gathering/eye_bundles/eye_bundles.h"

#include "core/geometry/shadow_segment.h"
#include "core/math/frame.h"
#include "core/math/warp.h"
#include "core/scene/media_along.h"

namespace mote::gathering {

using namespace core;
using lights::TileLight;

namespace {

/// Light of a smaller weight is followed by chance: bundles are many, and most of what they find is far away,
/// where virtual point lights do better.
constexpr float rare_weight = 0.1f;

/// The direction along the line that leaves x to the eye's side.
Vec3 towards_eye_side(const ScatteringVertex& x, const Vec3& w) {
    const Vec3& n = x.hit.geometric_normal;
    return glm::dot(n, w) * glm::dot(n, x.wo) > 0.0f ? w : -w;
}

bool any_of(const auto& found) {
    for (const auto& y : found)
        if (y.max_vpl_depth > 0) return true;
    return false;
}

}  // namespace

void EyeBundles::add(const ReceiverArray& receivers, std::span<const BundleDirection> lines,
                     std::size_t index, TileLight& indirect, TileLight& direct) {
    const BundleDirection& line = lines[index];
    const float density = pass_.samples.directions * line.pdf_line;  // M p_r
    for (int side = 0; side < 2; ++side) {
        for (std::size_t i = 0; i < width; ++i) {
            const BundleReceiver& x = receivers[i];
            found_[i].max_vpl_depth = 0;
            if (!x.vertex) continue;
            const Vec3 leaving = towards_eye_side(*x.vertex, line.direction),
                       w = side == 0 ? leaving : -leaving;
            // Only where light comes through a surface are there two directions that count.
            if (side == 1 && !x.vertex->bsdf->traits().transmissive) continue;
            trace(x, w, density, line.kept, found_[i], direct[i]);
        }
        light_found_points(lines, index, indirect);
    }
}

void EyeBundles::add_own_rays(const ReceiverArray& receivers, std::span<const BundleDirection> lines,
                              TileLight& indirect, TileLight& direct) {
    for (std::size_t i = 0; i < width; ++i) {
        const BundleReceiver& x = receivers[i];
        found_[i].max_vpl_depth = 0;
        if (!x.vertex || !has_own_ray(*x.vertex)) continue;
        const Vec2 u = x.sampler->next_2d();
        const auto sampled = x.vertex->sample(walk_.rng.next_float(), u, TransportMode::radiance);
        if (!sampled || sampled->delta) continue;  // the eye path itself continues behind mirrors
        trace(x, sampled->wi, pass_.samples.directions * line_pdf(pass_.sky, sampled->wi), nullptr, found_[i],
              direct[i]);
    }
    light_found_points(lines, lines.size(), indirect);
}

void EyeBundles::light_found_points(std::span<const BundleDirection> lines, std::size_t index,
                                    TileLight& indirect) {
    if (!any_of(found_)) return;
    light_points(indirect);
    if (pass_.bounces > 1) continue_paths(lines, index, indirect);
    while (continue_paths()) light_points(indirect);
}

void EyeBundles::light_points(TileLight& indirect) {
    connect_lights(indirect);
    if (pass_.samples.joined_probability > 0.0f) join_lights(indirect);
}

/// Each found point becomes the next one of its path, or none. Returns whether there are any.
bool EyeBundles::continue_paths() {
    if (!(pass_.samples.continued > 0.0f)) return false;
    for (Found& y : found_)
        if (y.max_vpl_depth > 0 && !continue_path(y)) y.max_vpl_depth = 0;
    return any_of(found_);
}

bool EyeBundles::continue_path(Found& y) {
    const float chance = pass_.samples.continued;
    if (y.max_vpl_depth < 2 || !may_continue(y.vertex) || !(walk_.rng.next_float() < chance)) return false;
    const Vec3& n = y.vertex.hit.shading.n;
    const Vec3 local = square_to_cosine_hemisphere(y.sampler->next_2d());
    const Vec3 w = Frame(glm::dot(n, y.vertex.wo) < 0.0f ? -n : n).to_world(local);
    const float pdf = chance * cosine_hemisphere_pdf(local);
    Rgb scattered = y.vertex.eval_cos(w, TransportMode::radiance);
    if (is_black(scattered) || !(pdf > 0.0f)) return false;
    const Ray ray{y.vertex.ray_origin(w), w};
    const WalkEvent event = first_surface(y.vertex, ray, nullptr, scattered);
    if (event.kind == WalkEvent::Kind::escaped) return false;
    const ScatteringVertex next = make_vertex(event, ray);
    if (!next.connectable()) return false;
    y.fewer = fewer_than_next(pass_.samples, y.vertex, y.fewer, next);
    y.vertex = next, y.throughput *= scattered / pdf;
    --y.max_vpl_depth;
    return true;
}

/// Follows paths from the points that line `first` found, along lines of the same pass chosen at random. A
/// line that a path has not had yet is as good as a new one, because lines are independent of each other; one
/// that it had leads straight back, and would bias the light by 0.6 over the number of lines.
void EyeBundles::continue_paths(std::span<const BundleDirection> lines, std::size_t first,
                                TileLight& indirect) {
    std::array<std::vector<std::size_t>, width> unused;
    for (auto& left : unused)
        for (std::size_t m = 0; m < lines.size(); ++m)
            if (m != first) left.push_back(m);
    for (int bounce = 2; bounce <= pass_.bounces; ++bounce) {
        for (std::size_t i = 0; i < width; ++i) {
            const Found y = found_[i];
            found_[i].max_vpl_depth = 0;
            if (y.max_vpl_depth < 2 || unused[i].empty()) continue;
            const auto sampled =
                std::min(std::size_t(walk_.rng.next_float() * float(unused[i].size())), unused[i].size() - 1);
            const BundleDirection& line = lines[unused[i][sampled]];
            std::swap(unused[i][sampled], unused[i].back()), unused[i].pop_back();
            const BundleReceiver here{&y.vertex, y.throughput, y.max_vpl_depth - 1, y.sampler, false};
            Rgb direct(0.0f);
            trace(here, towards_eye_side(y.vertex, line.direction), line.pdf_line, line.kept, found_[i],
                  direct);
        }
        if (!any_of(found_)) return;
        connect_lights(indirect);
    }
}

/// First event along the ray from x, looked up in a kept bundle or traced.
WalkEvent EyeBundles::first_surface(const ScatteringVertex& x, const Ray& ray, const RayBundle* kept,
                                    Rgb& throughput) {
    WalkEvent event;
    const auto end = kept ? pass_.links->next(*kept, x, ray.direction) : std::nullopt;
    if (!end) {
        MediumState state;
        PathWeights weights;
        Rgb emitted(0.0f);
        event = walk<false>(pass_.scene, ray, state, weights, emitted, walk_);
        throughput *= weights.throughput;
        return event;
    }
    event.kind = end->hit ? WalkEvent::Kind::surface : WalkEvent::Kind::escaped;
    if (end->hit) event.hit = *end->hit;
    event.distance = end->distance;
    return event;
}

/// `pdf_lines`: the divisor of the direction's contribution, M p_r where there are M [1/sr].
void EyeBundles::trace(const BundleReceiver& x, const Vec3& w, float pdf_lines, const RayBundle* kept,
                       Found& y, Rgb& direct) {
    // Tokuyoshi & Ogaki 2012, Eq. 14, for all that a bundle finds.
    const float limit = pass_.vpls.peak_directions > 0.0f ? pass_.vpls.peak_directions : infinity;
    const Rgb f_cos = x.vertex->eval_cos(w, TransportMode::radiance, limit);
    if (is_black(f_cos)) return;
    const Ray ray{x.vertex->ray_origin(w), w};
    Rgb before = x.throughput * f_cos;
    const WalkEvent event = first_surface(*x.vertex, ray, kept, before);
    // All of a receiver's directions are weighted by the balance heuristic: f / (M p_r + p_f).
    const bool own = x.first && has_own_ray(*x.vertex);
    const float pdf_own = own ? own_ray_pdf(*x.vertex, w, 1.0f) : 0.0f;
    const Rgb throughput = before / (pdf_lines + pdf_own);
    if (event.kind == WalkEvent::Kind::escaped) {
        if (pass_.sky) direct += throughput * pass_.sky->environment(w);
        return;
    }
    y.vertex = make_vertex(event, ray);
    if (!y.vertex.connectable() || x.max_vpl_depth < 1) return;
    y.throughput = throughput, y.max_vpl_depth = x.max_vpl_depth, y.sampler = x.sampler;
    const float found = (uniform_line_pdf + pdf_own / pass_.samples.directions) *
                        y.vertex.geometric_cosine(w) / std::max(sqr(event.distance), 1e-30f);
    y.fewer = fewer_than_one(pass_.samples, found);
}

/// Weight of a light that is connected to y.
float EyeBundles::weight_of_connection(const Found& y, const LightChoice& choice,
                                       const DirectSample& light) const {
    if (pass_.techniques == Techniques::bundles) return 1.0f;
    const lights::LightStart end{choice.emitter, y.vertex.position + light.wi * light.distance, light.normal,
                                 -light.wi};
    return connection_weight(
        pass_.samples, y.fewer.from(y.vertex, light.wi),
        connection_over_emission(pass_.scene, y.vertex.light_receiver(), y.vertex.hit.geometric_normal, end));
}

/// Tokuyoshi & Ogaki 2012, the second term of Eq. 3.
void EyeBundles::connect_lights(TileLight& indirect) {
    TileLight light{};
    bool any = false;
    for (std::size_t i = 0; i < width; ++i) {
        shadow_.t_max[i] = -1.0f;
        Found& y = found_[i];
        if (y.max_vpl_depth < 1) continue;
        const Vec2 u = y.sampler->next_2d();
        const auto choice = pass_.scene.choose_light(y.vertex.light_receiver(), y.sampler->next_1d());
        if (!choice.emitter) continue;
        const auto sample = choice.emitter->sample_direct(y.vertex.position, u);
        if (!sample) continue;
        const Rgb value = y.throughput * y.vertex.eval_cos(sample->wi, TransportMode::radiance) *
                          sample->weight / choice.probability;
        if (is_black(value)) continue;
        float weight = weight_of_connection(y, choice, *sample);
        if (weight < rare_weight) {
            if (!(walk_.rng.next_float() * rare_weight < weight)) continue;
            weight = rare_weight;
        }
        light[i] = value * weight;
        Ray shadow{y.vertex.ray_origin(sample->wi), sample->wi};
        const float end = shadow_end(shadow.origin, sample->distance);
        shadow.t_max = sample->delta ? sample->distance : end;
        PathWeights panes;
        connect_through_panes(pass_.scene, shadow, panes);
        light[i] *= panes.throughput;
        shadow_.set(i, shadow.origin, sample->wi, end);
        any = true, ++walk_.rays.occlusion;
    }
    if (!any) return;
    pass_.scene.find_occluded({&shadow_, 1});
    for (std::size_t i = 0; i < width; ++i)
        if (!shadow_.occluded(int(i))) indirect[i] += light[i];
}

/// Tokuyoshi & Ogaki 2012, Eq. 7, for VPLs of any depth.
void EyeBundles::join_lights(TileLight& indirect) {
    std::array<FewerFound, width> fewer;
    tile_.clear();
    for (int i = 0; i < width; ++i) {
        const Found& y = found_[std::size_t(i)];
        fewer[std::size_t(i)] = y.fewer;
        if (y.max_vpl_depth > 1) tile_.set(i, y.vertex, y.throughput, {}, Rng(1), y.max_vpl_depth - 1);
    }
    const auto first = std::size_t(walk_.rng.next_float() * float(pass_.stride));
    const lights::VplRange range{std::min(first, pass_.stride - 1), pass_.stride};
    const lights::GatherContext context{pass_.scene, scratch_, walk_.rays, walk_.tracking, walk_.cancelled};
    const auto sum = [&](const auto& weight) {
        const TileLight light = lights::gather(context, pass_.vpls, range, weight, tile_);
        for (std::size_t i = 0; i < width; ++i) indirect[i] += float(pass_.stride) * light[i];
    };
    if (pass_.bound)
        sum(lights::BoundedGeometry{*pass_.bound});
    else if (pass_.techniques == Techniques::bundles)
        sum(lights::UnboundedGeometry{});
    else
        sum(AgainstLights{fewer.data(), pass_.rivals, pass_.samples});
}

}  // namespace mote::gathering
