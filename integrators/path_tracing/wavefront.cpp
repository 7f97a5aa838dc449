#include "integrators/path_tracing/wavefront.h"

#include "core/geometry/shadow_segment.h"
#include "core/math/vectorize.h"
#include "core/math/warp.h"

namespace mote::integrators {

using namespace core;

namespace {

/// Multiple of a vector's lanes that holds `count`, for loops without a remainder.
int padded(int count) { return (count + 15) / 16 * 16; }

std::optional<lights::LitParallelogram> only_parallelogram(const Scene& scene) {
    const auto* light = dynamic_cast<const lights::ParallelogramLight*>(scene.only_light());
    return light ? light->parallelogram() : std::nullopt;
}

}  // namespace

WavefrontScene::WavefrontScene(const Scene& s, const EyePathLimits& l)
    : scene(s), limits(l), lambertian(s), light(only_parallelogram(s)) {}

bool WavefrontScene::suits(const Scene& scene, const PathSettings& settings) {
    return !scene.has_panes() && !settings.limits.hide_emitters && std::isinf(settings.bound);
}

Wavefront::Wavefront(const WavefrontScene& shared, WalkContext& context, const lights::ScatteringGuide& guide)
    : shared_(shared),
      scene_(shared.scene),
      limits_(shared.limits),
      context_(context),
      guide_(guide),
      guided_(&guide != &lights::no_guide()) {
    samplers_.reserve(capacity), rngs_.reserve(capacity), sums_.reserve(capacity);
    std::fill_n(own_probability_.value, capacity, 1.0f), std::fill_n(next_weight_.value, capacity, 1.0f);
    if (guided_) lobes_.resize(capacity);
}

void Wavefront::start(const EyeRay& eye) {
    const int i = rays_.count++;
    if (i == 0) samplers_.clear(), rngs_.clear(), sums_.clear(), depth_ = 0;
    samplers_.push_back(eye.sampler), rngs_.push_back(eye.rng), sums_.emplace_back();
    path_[i] = i, rays_.set(i, eye.ray);
    throughput_.set(i, Rgb(1.0f)), light_ratio_[i] = 0.0f, eta_[i] = 1.0f, scatterings_[i] = 0;
    guide_ratio_[i] = 1.0f;
}

void Wavefront::run() {
    while (rays_.count > 0) {
        context_.cancelled.check();
        ++depth_;
        context_.rays.closest += std::uint64_t(rays_.count);
        scene_.rays().closest(rays_, depth_ == 1, hits_);
        arrive();
        if (guided_) find_guides();
        for (int k = 0; k < limits_.light_samples.at_most() && next_light_sample(k); ++k) connect();
        sample_lambertian();
        if (guided_) sample_guides();
        leave();
    }
}

/// Light of emitters that the rays hit, and the vertices there.
void Wavefront::arrive() {
    any_other_ = false;
    const bool last = depth_ == limits_.max_depth;
    for (int i = 0; i < rays_.count; ++i) {
        const Shape* shape = hits_.shape[i];
        const Transport layer = transport_layer(scatterings_[i], true);
        if ((shape ? shape->emitter != nullptr : scene_.environment() != nullptr) && limits_.wanted[layer])
            sums_[std::size_t(path_[i])][layer] += found_light(i);
        kind_[i] = Kind::ended, light_samples_[i] = 0;
        if (shape && !last && scatterings_[i] != limits_.max_scatterings) make_vertex(i);
    }
    for (int i = rays_.count; i < padded(rays_.count); ++i) kind_[i] = Kind::ended, light_samples_[i] = 0;
}

Rgb Wavefront::found_light(int i) const {
    WalkEvent event;
    if (hits_.shape[i]) {
        event.kind = WalkEvent::Kind::surface;
        event.hit = scene_.rays().surface_hit(rays_, hits_, i);
    }
    PathWeights weights;
    weights.throughput = throughput_.get(i), weights.light = Rgb(light_ratio_[i]);
    return lights::found_light<false>(scene_, event, rays_.ray(i), weights,
                                      light_ratio_[i] > 0.0f ? &previous_[i] : nullptr);
}

/// The material, and the random numbers that the vertex needs.
void Wavefront::make_vertex(int i) {
    const Shape& shape = *hits_.shape[i];
    bool connectable = true;
    if (const LambertianSides* sides = shared_.lambertian.of(shape)) {
        kind_[i] = Kind::lambertian;
        const bool front = glm::dot(hits_.shading_normal.get(i), rays_.direction.get(i)) < 0.0f;
        reflectance_.set(i, front ? sides->front : sides->back);
    } else {
        kind_[i] = Kind::other;
        any_other_ = true, others_.resize(capacity);
        ScatteringVertex& vertex = others_[std::size_t(i)];
        vertex.hit = scene_.rays().surface_hit(rays_, hits_, i);
        vertex.position = vertex.hit.position, vertex.wo = wo(i), vertex.bsdf = shape.bsdf.get();
        connectable = vertex.connectable();
    }
    Sampler& sampler = samplers_[std::size_t(path_[i])];
    const Vec2 choices = sampler.next_2d();
    u_lobe_[i] = choices.y;
    if (connectable && limits_.wanted[layer_of_connection(i)]) {
        light_samples_[i] = limits_.light_samples.at(scatterings_[i], true);
        first_light_[i] = {choices.x, sampler.next_2d()};
    }
    const Vec2 u = sampler.next_2d();
    u_scatter_x_[i] = u.x, u_scatter_y_[i] = u.y;
}

LightReceiver Wavefront::receiver(int i) const {
    if (kind_[i] == Kind::other) return others_[std::size_t(i)].light_receiver();
    const Vec3 n = hits_.geometric_normal.get(i);
    return {hits_.position.get(i), glm::dot(n, rays_.direction.get(i)) > 0.0f ? -n : n};
}

/// Makes the connections of sample k of all vertices that take so many wanted. Returns false where none is.
bool Wavefront::next_light_sample(int k) {
    bool any = false;
    for (int i = 0; i < padded(rays_.count); ++i) {
        connects_[i] = k < light_samples_[i];
        if (!connects_[i]) continue;
        const LightNumbers u = numbers_of_light(first_light_[i], k, light_samples_[i]);
        u_light_[i] = u.choice, u_light_x_[i] = u.point.x, u_light_y_[i] = u.point.y;
        any = true;
    }
    return any;
}

/// Next-event estimation at all vertices.
void Wavefront::connect() {
    if (shared_.light)
        sample_parallelogram();
    else
        for (int i = 0; i < rays_.count; ++i)
            if (kind_[i] == Kind::lambertian && connects_[i]) sample_light_of(i);
    if (guided_) weight_guides_to_lights();
    weight_lambertian();
    if (any_other_)
        for (int i = 0; i < rays_.count; ++i)
            if (kind_[i] == Kind::other && connects_[i]) connect_other(i);
    trace_shadow_rays();
}

/// A point of the light for every vertex, as AreaLight::sample_direct() chooses it.
void Wavefront::sample_parallelogram() {
    const Parallelogram light = shared_.light->shape;
    const Rgb radiance = shared_.light->radiance;
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < padded(rays_.count); ++i) {
        const Vec3 point = light.corner + u_light_x_[i] * light.first + u_light_y_[i] * light.second;
        const Vec3 d = point - hits_.position.get(i);
        const float squared = glm::dot(d, d), distance = std::sqrt(squared);
        const Vec3 wi = d * (1.0f / distance);
        const float cosine = -glm::dot(light.normal, wi), pdf = squared / (light.area * cosine);
        const bool lit = (cosine > 0.0f) & (pdf > 0.0f) & (pdf < infinity);
        to_light_.set(i, wi), distance_[i] = distance;
        pdf_light_[i] = lit ? pdf : 1.0f, finds_light_[i] = 1.0f;
        radiance_.set(i, lit ? radiance : Rgb(0.0f));
    }
}

void Wavefront::sample_light_of(int i) {
    const LightChoice choice = scene_.choose_light(receiver(i), u_light_[i]);
    const auto light =
        choice.emitter ? choice.emitter->sample_direct(hits_.position.get(i), {u_light_x_[i], u_light_y_[i]})
                       : std::nullopt;
    connects_[i] = light.has_value();
    if (!light) return;
    to_light_.set(i, light->wi), distance_[i] = light->distance;
    const float pdf = light->delta ? 1.0f : light->pdf_solid_angle;
    radiance_.set(i, light->weight * pdf);
    pdf_light_[i] = choice.probability * pdf, finds_light_[i] = light->delta ? 0.0f : 1.0f;
}

/// The connections of Lambertian vertices, as lights::begin_connection() and finish_connection() make them.
void Wavefront::weight_lambertian() {
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < padded(rays_.count); ++i) {
        const Vec3 ng = hits_.geometric_normal.get(i), ns = hits_.shading_normal.get(i);
        const Vec3 wi = to_light_.get(i), towards = rays_.direction.get(i);
        const float cosine = glm::dot(ns, wi);
        const float sides =
            reflects(-glm::dot(ns, towards), cosine, -glm::dot(ng, towards), glm::dot(ng, wi));
        const float pdf = std::fabs(cosine) * inv_pi;
        // Veach 1997, Eq. 9.8, with f C* = reflectance pdf
        const float pdf_scatter = own_probability_[i] * pdf + guide_to_light_[i];
        const float pdf_light = float(light_samples_[i]) * pdf_light_[i];
        const float weight = sides > 0.0f ? pdf / (pdf_light + finds_light_[i] * pdf_scatter) : 0.0f;
        connected_.set(i, throughput_.get(i) * reflectance_.get(i) * radiance_.get(i) * weight);
        const Vec3 origin = offset_origin(hits_.position.get(i), ng, hits_.error[i], wi);
        shadow_origin_.set(i, origin);
        shadow_end_[i] = shadow_end(origin, distance_[i]);
    }
}

void Wavefront::connect_other(int i) {
    const ScatteringVertex& vertex = others_[std::size_t(i)];
    lights::LightConnection c;
    const LightChoice choice = scene_.choose_light(vertex.light_receiver(), u_light_[i]);
    connects_[i] = lights::begin_connection(vertex, choice, {u_light_x_[i], u_light_y_[i]}, {}, false, c);
    if (!connects_[i]) return;
    c.pdf_light *= float(light_samples_[i]);
    if (!c.light.delta)
        c.pdf_scatter = lights::guided_pdf(lobes(i), c.light.wi, c.pdf_scatter, c.light.line_density);
    PathWeights weights;
    weights.throughput = throughput_.get(i);
    connected_.set(i, lights::finish_connection<false>(scene_, vertex, weights, {}, c, context_, {}));
    shadow_origin_.set(i, c.shadow.origin), to_light_.set(i, c.shadow.direction);
    shadow_end_[i] = c.shadow.t_max;
}

void Wavefront::trace_shadow_rays() {
    ShadowPacket packet;
    packet.clear();
    int lanes[ShadowPacket::width], count = 0;
    const auto trace = [&] {
        for (int k = count; k < ShadowPacket::width; ++k) packet.set(k, Vec3(0.0f), Vec3(0.0f), -1.0f);
        context_.rays.occlusion += std::uint64_t(count);
        scene_.rays().occluded(packet);
        for (int k = 0; k < count; ++k)
            if (const int i = lanes[k]; !packet.occluded(k))
                sums_[std::size_t(path_[i])][layer_of_connection(i)] += connected_.get(i);
        count = 0;
    };
    for (int i = 0; i < rays_.count; ++i) {
        if (!connects_[i] || is_black(connected_.get(i))) continue;
        packet.set(count, shadow_origin_.get(i), to_light_.get(i), shadow_end_[i]), lanes[count++] = i;
        if (count == ShadowPacket::width) trace();
    }
    if (count > 0) trace();
}

/// Directions by the cosine, on wo's side. A density of 0: the path ends.
void Wavefront::sample_lambertian() {
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < padded(rays_.count); ++i) {
        const Vec3 ng = hits_.geometric_normal.get(i), ns = hits_.shading_normal.get(i);
        const Vec3 towards = rays_.direction.get(i);
        const float shading_o = -glm::dot(ns, towards);
        Vec3 local = square_to_cosine_hemisphere({u_scatter_x_[i], u_scatter_y_[i]});
        const float pdf = local.z * inv_pi;
        local.z = shading_o < 0.0f ? -local.z : local.z;
        const Vec3 world = Frame(ns).to_world(local);
        const Vec3 wi = world * (1.0f / std::sqrt(glm::dot(world, world)));
        const float sides = reflects(shading_o, glm::dot(ns, wi), -glm::dot(ng, towards), glm::dot(ng, wi));
        next_pdf_[i] = sides > 0.0f ? pdf : 0.0f;
        next_direction_.set(i, wi);
        next_origin_.set(i, offset_origin(hits_.position.get(i), ng, hits_.error[i], wi));
    }
}

/// As EyePath::wants_more(): true where a path that leaves the vertex can find wanted light.
bool Wavefront::wants_more(int i) const {
    const int scatterings = scatterings_[i];
    if (scatterings == 0 && kind_[i] == Kind::other && !others_[std::size_t(i)].connectable()) return true;
    if (limits_.wanted[transport_layer(scatterings + 1, true)]) return true;
    return scatterings + 1 != limits_.max_scatterings && limits_.wanted[Transport::indirect];
}

bool Wavefront::survives(int i) {
    PathWeights weights;
    weights.throughput = throughput_.get(i);
    const float u = rngs_[std::size_t(path_[i])].next_float();
    if (!integrators::survives<false>(weights, sqr(eta_[i]) * guide_ratio_[i], depth_, u)) return false;
    throughput_.set(i, weights.throughput);
    return true;
}

bool Wavefront::sample_other(int i) {
    const ScatteringVertex& vertex = others_[std::size_t(i)];
    const auto guided = lights::sample_guided(vertex, lobes(i), u_lobe_[i],
                                              {u_scatter_x_[i], u_scatter_y_[i]}, TransportMode::radiance);
    if (!guided) return false;
    const ScatterSample* const next = &guided->scattering;
    scatterings_[i] += !next->delta || scatterings_[i] > 0;
    const bool found_alone = next->delta || !(next->pdf_solid_angle > 0.0f);
    light_ratio_[i] = found_alone ? 0.0f : samples_of_lights(i) / next->pdf_solid_angle;
    throughput_.set(i, throughput_.get(i) * next->weight), eta_[i] *= next->eta;
    guide_ratio_[i] *= guided->pdf_ratio;
    next_direction_.set(i, next->wi), next_origin_.set(i, vertex.ray_origin(next->wi));
    return true;
}

/// The paths that continue leave their vertices, and move up in the arrays.
void Wavefront::leave() {
    int alive = 0;
    for (int i = 0; i < rays_.count; ++i) {
        if (kind_[i] == Kind::ended || !wants_more(i)) continue;
        if (depth_ >= limits_.rr_depth && !survives(i)) continue;
        if (kind_[i] == Kind::other) {
            if (!sample_other(i)) continue;
        } else {
            if (!(next_pdf_[i] > 0.0f)) continue;
            ++scatterings_[i], light_ratio_[i] = samples_of_lights(i) / next_pdf_[i];
            throughput_.set(i, throughput_.get(i) * reflectance_.get(i) * next_weight_[i]);
            guide_ratio_[i] *= min_of(1.0f / next_weight_[i], lights::max_pdf_ratio);
        }
        if (!is_black(throughput_.get(i))) move(i, alive++);
    }
    rays_.count = alive;
}

void Wavefront::move(int from, int to) {
    previous_[to] = receiver(from);
    rays_.set(to, {next_origin_.get(from), next_direction_.get(from)});
    path_[to] = path_[from], scatterings_[to] = scatterings_[from];
    throughput_.set(to, throughput_.get(from));
    light_ratio_[to] = light_ratio_[from], eta_[to] = eta_[from];
    guide_ratio_[to] = guide_ratio_[from];
}

}  // namespace mote::integrators
