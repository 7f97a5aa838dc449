// The eye path: one loop for every method that looks from the camera.
//
// A path walks from vertex to vertex (core/scene/ray_walk.h), sorts the light that it finds on the way into
// layers, and hands each vertex over to its method, which adds the light that it finds there: of sampled
// lights, of virtual lights, of photons. Methods that gather at the first vertex let a path scatter once
// (max_scatterings = 1): what its direction then finds is the other technique for direct light.
#pragma once

#include <utility>

#include "core/scene/scattering_points.h"
#include "core/scene/scattering_vertex.h"
#include "integrators/eye_path/eye_path_limits.h"
#include "integrators/eye_path/eye_ray.h"
#include "integrators/eye_path/eye_roulette.h"
#include "integrators/eye_path/scattered_light.h"
#include "integrators/eye_path/transport_layers.h"
#include "lights/direct_light/direct_light.h"
#include "lights/guiding/choose_scattering.h"

namespace mote::integrators {

/// The part of a path between two vertices, for what is gathered along it.
struct EyeSegment {
    const core::Ray& ray;             ///< from the one to the other
    const core::WalkEvent& event;     ///< at its end
    const core::MediumState& start;   ///< media at ray.t_min
    const core::PathWeights& before;  ///< weights at its start
};

/// Factors of the light that a vertex scatters, for transport that leaves some out.
struct LobeFactors {
    float connectable = 1.0f;  ///< of lobes that lights can be connected to
    float delta = 1.0f;        ///< of mirrors and glass
};

/// A path from the eye, vertex by vertex.
template <bool Media>
class EyePath {
  public:
    /// `context` holds the path's generator, which also chooses the channel that drives distances.
    /// `lights`: the sampled ones, where these are not all. `guide`: of its directions and vertices.
    EyePath(const core::Scene& scene, const EyePathLimits& limits, const EyeRay& eye,
            core::WalkContext& context, const core::LitScene* lights = nullptr,
            const lights::ScatteringGuide& guide = lights::no_guide())
        : scene_(scene),
          lights_(lights ? *lights : scene),
          guide_(guide),
          chooses_vertices_(Media && guide.candidates() > 0),
          limits_(limits),
          sampler_(eye.sampler),
          ray_(eye.ray) {
        if constexpr (Media) {
            weights_.hero = core::sample_hero(context.rng);
            state_ = scene.eye_medium_state(eye.ray);
        }
    }

    /// Continues to the next vertex, and adds light found on the way and at its end to `sum`. Returns false
    /// where the path ends. `on_segment(EyeSegment)` sees every segment before its vertex is made.
    template <typename OnSegment>
    bool advance(core::WalkContext& context, TransportSum& sum, const OnSegment& on_segment) {
        return advance_by([this](core::Rgb& emitted, core::WalkContext& c) { return next_event(emitted, c); },
                          context, sum, on_segment);
    }
    /// Without.
    bool advance(core::WalkContext& context, TransportSum& sum) {
        return advance(context, sum, [](const EyeSegment&) {});
    }
    /// advance() with a walk of the method's own: walker(emitted, context) -> WalkEvent moves state() and
    /// weights() to the end of ray().
    template <typename Walker, typename OnSegment>
    bool advance_by(Walker&& walker, core::WalkContext& context, TransportSum& sum,
                    const OnSegment& on_segment) {
        if (!leave(context)) return false;
        core::WalkEvent event;
        const auto walk = [&](core::Rgb& emitted) { event = walker(emitted, context); };
        return arrive_by(walk, event, sum, on_segment);
    }

    // The two halves of advance(), between which a packet finds the first surfaces of many paths at once:
    /// Leaves the vertex, or the camera, along ray(). Returns false where the path ends instead.
    bool leave(core::WalkContext& context);
    /// Goes along ray(), of which `event` is the first surface or none (core::walk_before()), and arrives at
    /// the next vertex as advance() does.
    template <typename OnSegment>
    bool arrive(core::WalkEvent& event, core::WalkContext& context, TransportSum& sum,
                const OnSegment& on_segment);

    /// arrive() where the guide chooses the next vertex (ScatteringGuide::candidates()): the path reaches
    /// the end of the segment with certainty, weighted by its transmittance, counts the light there, and
    /// continues at the surface or at one of the candidates that media leave at `points`.
    template <typename OnSegment>
    bool arrive_by_choice(core::WalkEvent& event, core::WalkContext& context, TransportSum& sum,
                          core::ScatteringPoints& points, const OnSegment& on_segment);

    /// advance() that continues to surfaces until the path has scattered: media on the segment scatter at
    /// `points`, and let the rest through. Those of the segment are chosen from `points` afterwards, whether
    /// or not there is a vertex; what scatters there is up to the method (light_at()).
    template <typename OnSegment>
    bool advance_to_surface(core::WalkContext& context, TransportSum& sum, core::ScatteringPoints& points,
                            const OnSegment& on_segment) {
        points.start(core::Rng(context.rng.next_u32()));
        return advance_by(
            [&](core::Rgb& emitted, core::WalkContext& c) {
                return scatterings_ == 0
                           ? core::walk_to_surface(scene_, ray_, state_, weights_, emitted, points, c)
                           : next_event(emitted, c);
            },
            context, sum, on_segment);
    }

    // At a vertex:
    const core::ScatteringVertex& vertex() const { return vertex_; }
    /// Next-event estimation: light of lights sampled for the vertex (lights/direct_light/direct_light.h).
    core::Rgb sample_light(core::WalkContext& context, const lights::LightSampling& how = {}) {
        core::Rgb sum(0.0f);
        for (int k = 0; k < light_samples(); ++k) {
            lights::LightConnection connection;
            if (!begin_light(k, connection, how)) continue;
            if (!connection.map) {
                ++context.rays.occlusion;
                if (!lights_.visible(connection.shadow)) continue;
            }
            sum += finish_light(connection, context, how);
        }
        return sum;
    }
    /// Samples of lights at the vertex, whose light is added up.
    int light_samples() const { return limits_.light_samples.at(scatterings_, vertex_.on_surface()); }
    /// The two halves of sample_light(), between which a packet traces the shadow rays of many paths: sample
    /// k < light_samples(), in that order. False: no light arrives.
    bool begin_light(int k, lights::LightConnection& connection, const lights::LightSampling& how) {
        if (factors_.connectable == 0.0f) return false;
        if (k == 0) light_point_ = sampler_.next_2d();
        const LightNumbers u = numbers_of_light({choices_.x, light_point_}, k, light_samples());
        if (!lights::begin_connection(vertex_, lights_.choose_light(vertex_.light_receiver(), u.choice),
                                      u.point, how, Media, connection))
            return false;
        connection.pdf_light *= float(light_samples());  // Veach 1997, Eq. 9.8: n_i p_i
        const core::DirectSample& light = connection.light;
        if (!light.delta)
            connection.pdf_scatter =
                lights::guided_pdf(guided_, light.wi, connection.pdf_scatter, light.line_density);
        return true;
    }
    /// Light of a connection that nothing occludes.
    core::Rgb finish_light(const lights::LightConnection& connection, core::WalkContext& context,
                           const lights::LightSampling& how) {
        lights::LightSampling sampling = how;
        sampling.passes_media = chooses_vertices();
        return factors_.connectable * lights::finish_connection<Media>(lights_, vertex_, weights_, state_,
                                                                       connection, context, sampling);
    }
    /// The vertex at a scattering point of the last segment.
    core::ScatteringVertex vertex_at(const core::Vec3& position, const core::MediumState& state) const {
        core::ScatteringVertex vertex;
        vertex.position = position, vertex.wo = -ray_.direction, vertex.phase = &state.current()->phase();
        return vertex;
    }
    /// The light of lights that scatters there, by both techniques; `weight` is that of the point.
    core::Rgb light_at(const core::ScatteringVertex& point, const core::Rgb& weight,
                       const core::MediumState& state, core::WalkContext& context,
                       const lights::LightSampling& how = {});
    /// False where the last segment is the longest path's last edge.
    bool may_continue() const { return depth_ != limits_.max_depth; }
    /// Sets those of the vertex where the path is, and of later ones until it is called again.
    void set_factors(const LobeFactors& factors) { factors_ = factors; }
    /// Multiplies its weight.
    void scale(float factor) { weights_.throughput *= factor; }

    const core::Ray& ray() const { return ray_; }      ///< of the last segment
    core::MediumState& state() { return state_; }      ///< media on the side where the path is
    core::PathWeights& weights() { return weights_; }  ///< of the path so far
    core::Sampler& sampler() { return sampler_; }      ///< of the path, for what is sampled at the vertex
    /// The weight of light that reaches the path's end.
    core::Rgb throughput() const { return lights::throughput_of<Media>(weights_); }
    /// The length of hidden lights' part of the first segment, which ray() no longer holds [m].
    float passed() const { return passed_; }
    int depth() const { return depth_; }              ///< edges so far
    int scatterings() const { return scatterings_; }  ///< without those at mirrors and glass before the first
    float first_cosine() const { return first_cosine_; }      ///< C* of the first, towards the next vertex
    float segment_length() const { return segment_length_; }  ///< of the last edge [m]
    /// Layer of light joined to the vertex; of light scattered once more, in a medium, along a segment; of
    /// light found at the end of a segment.
    Transport layer_of_connection() const {
        return transport_layer(scatterings_ + 1, scatterings_ == 0 ? vertex_.on_surface() : surface_first_);
    }
    /// See layer_of_connection().
    Transport layer_along() const {
        return transport_layer(scatterings_ + 1, scatterings_ > 0 && surface_first_);
    }
    /// See layer_of_connection().
    Transport layer_of_emission() const { return transport_layer(scatterings_, surface_first_); }
    /// Layer of light scattered at the vertex after it was scattered in a medium.
    Transport layer_twice() const {
        return transport_layer(scatterings_ + 2, scatterings_ == 0 ? vertex_.on_surface() : surface_first_);
    }
    /// True where light joined to the vertex, or scattered along the segment, is wanted.
    bool wants_connection() const { return limits_.wanted[layer_of_connection()]; }
    /// See wants_connection().
    bool wants_along() const { return limits_.wanted[layer_along()]; }
    /// See layer_twice().
    bool wants_twice() const { return limits_.wanted[layer_twice()]; }
    /// Light that the vertex scatters from a direction, with the density by which the path would leave there.
    core::ScatteringValue scattered_from(const core::Vec3& wi) const {
        core::ScatteringValue f = vertex_.eval_cos_and_pdf(wi, core::TransportMode::radiance);
        f.pdf_solid_angle = lights::guided_pdf(guided_, wi, f.pdf_solid_angle);
        return f;
    }
    /// Density by which the last segment's direction was chosen [1/sr]; infinity: of a camera, a mirror or
    /// glass.
    float pdf_of_direction() const { return pdf_of_direction_; }

  private:
    core::WalkEvent next_event(core::Rgb& emitted, core::WalkContext& context) {
        return core::walk<Media>(scene_, ray_, state_, weights_, emitted, context);
    }
    template <typename Walk, typename OnSegment>
    bool arrive_by(const Walk& walk, const core::WalkEvent& event, TransportSum& sum,
                   const OnSegment& on_segment) {
        find_light(walk, event, sum, on_segment);
        return make_next_vertex(event);
    }
    template <typename Walk, typename OnSegment>
    void find_light(const Walk& walk, const core::WalkEvent& event, TransportSum& sum,
                    const OnSegment& on_segment);
    bool make_next_vertex(const core::WalkEvent& event);
    bool has_ended() const { return depth_ == limits_.max_depth || scatterings_ == limits_.max_scatterings; }
    bool chooses_vertices() const { return Media && chooses_vertices_; }
    /// Guides have not made the path's weight too large yet (lights::min_guide_ratio).
    bool is_guided() const { return guide_ratio_ >= lights::min_guide_ratio; }
    void choose_vertex(const core::ScatteringPoints& points, core::WalkEvent& event, float u);
    bool survives_roulette(core::WalkContext& context);
    bool scatter(core::WalkContext& context);
    bool wants_more() const;
    /// Lights that the camera does not see: the first segment continues behind them.
    bool hides_lights() const { return limits_.hide_emitters && depth_ == 1; }
    void pass_light(const core::WalkEvent& event);

    const core::Scene& scene_;
    const core::LitScene& lights_;
    const lights::ScatteringGuide& guide_;
    const bool chooses_vertices_;  ///< by `guide_`
    EyePathLimits limits_;
    core::Sampler sampler_;
    core::Ray ray_;
    core::MediumState state_;
    core::PathWeights weights_;
    core::ScatteringVertex vertex_;
    lights::VmfMixture guided_;  ///< directions of the guide at the vertex
    /// Radiance that the guide expects of the path, and behind the vertex without next-event estimation
    /// there, where it chooses vertices; 0: unknown.
    float expected_ = 0.0f, indirect_ = 0.0f;
    core::Vec2 choices_{0.0f};      ///< of the light, and of the lobe
    core::Vec2 light_point_{0.0f};  ///< on the light that is sampled first
    core::LightReceiver previous_;
    bool connected_ = false;  ///< next-event estimation at `previous_` could find the next light
    bool surface_first_ = true;
    LobeFactors factors_;
    int depth_ = 0, scatterings_ = 0;
    float eta_ = 1.0f;
    /// Density of its directions over that without a guide. Times the throughput it is what surfaces and
    /// media let through, which roulette follows: throughput alone is low towards bright light.
    float guide_ratio_ = 1.0f;
    float first_cosine_ = 1.0f, segment_length_ = 0.0f, passed_ = 0.0f, pdf_of_direction_ = core::infinity;
};

template <bool Media>
bool EyePath<Media>::leave(core::WalkContext& context) {
    if (depth_ > 0 && !scatter(context)) return false;
    ++depth_;
    return true;
}

template <bool Media>
template <typename OnSegment>
bool EyePath<Media>::arrive(core::WalkEvent& event, core::WalkContext& context, TransportSum& sum,
                            const OnSegment& on_segment) {
    bool first = true;  // behind a hidden light the path looks for a surface of its own
    const auto walk = [&](core::Rgb& emitted) {
        if (std::exchange(first, false))
            core::walk_before<Media>(scene_, ray_, event, state_, weights_, emitted, context);
        else
            event = next_event(emitted, context);
    };
    return arrive_by(walk, event, sum, on_segment);
}

template <bool Media>
template <typename OnSegment>
bool EyePath<Media>::arrive_by_choice(core::WalkEvent& event, core::WalkContext& context, TransportSum& sum,
                                      core::ScatteringPoints& points, const OnSegment& on_segment) {
    points.start(core::Rng(context.rng.next_u32()));
    bool first = true;  // as in arrive()
    const auto walk = [&](core::Rgb& emitted) {
        if (std::exchange(first, false))
            core::walk_to_surface_before(scene_, ray_, event, state_, weights_, emitted, points, context);
        else
            event = core::walk_to_surface(scene_, ray_, state_, weights_, emitted, points, context);
    };
    find_light(walk, event, sum, on_segment);
    if (has_ended()) return false;
    choose_vertex(points, event, context.rng.next_float());
    return make_next_vertex(event);
}

/// Makes `event` the one of the chosen vertex. The throughput turns black where there is none.
template <bool Media>
void EyePath<Media>::choose_vertex(const core::ScatteringPoints& points, core::WalkEvent& event, float u) {
    const bool surface = event.kind == core::WalkEvent::Kind::surface;
    const auto candidates = points.kept();
    const lights::ScatteringChoice choice =
        lights::choose_scattering(candidates, surface ? weights_.throughput : core::Rgb(0.0f),
                                  event.hit.position, is_guided() ? guide_ : lights::no_guide(), u);
    if (!(choice.probability > 0.0f)) {
        weights_.throughput = core::Rgb(0.0f);
        return;
    }
    if (scatterings_ == 0) expected_ = choice.known ? choice.expected : 0.0f;
    indirect_ = choice.known ? choice.indirect : 0.0f;
    if (choice.index < candidates.size()) {
        const core::ScatteringPoint& point = candidates[choice.index];
        state_ = points.state_of(point), weights_.throughput = point.weight;
        event.kind = core::WalkEvent::Kind::collision, event.medium = state_.current();
        event.distance = points.distance_of(point, ray_), event.reflected = false, event.stop_chance = 1.0f;
    }
    weights_.throughput /= choice.probability;
    guide_ratio_ *= choice.probability / choice.by_extinction;
}

/// Adds the light that a walk finds to `sum`. walk(emitted) sets `event`.
template <bool Media>
template <typename Walk, typename OnSegment>
void EyePath<Media>::find_light(const Walk& walk, const core::WalkEvent& event, TransportSum& sum,
                                const OnSegment& on_segment) {
    core::Rgb& found = sum[layer_of_emission()];
    const auto go = [&] {
        const core::MediumState start = state_;
        const core::PathWeights before = weights_;
        core::Rgb emitted(0.0f);
        walk(emitted);
        if constexpr (Media) found += emitted;
        on_segment(EyeSegment{ray_, event, start, before});
    };
    go();
    while (hides_lights() && event.kind == core::WalkEvent::Kind::surface && event.hit.shape->emitter)
        pass_light(event), go();
    const bool hidden = hides_lights() && event.kind == core::WalkEvent::Kind::escaped;
    if (limits_.wanted[layer_of_emission()] && !hidden)
        found +=
            lights::found_light<Media>(lights_, event, ray_, weights_, connected_ ? &previous_ : nullptr);
}

/// Returns false where the path ends.
template <bool Media>
bool EyePath<Media>::make_next_vertex(const core::WalkEvent& event) {
    if (event.kind == core::WalkEvent::Kind::escaped || has_ended() || core::is_black(weights_.throughput))
        return false;
    vertex_ = make_vertex(event, ray_), segment_length_ = event.distance;
    if (is_guided())
        guide_.find(vertex_, guided_);
    else
        guided_.empty = true;
    choices_ = sampler_.next_2d();
    return true;
}

template <bool Media>
core::Rgb EyePath<Media>::light_at(const core::ScatteringVertex& point, const core::Rgb& weight,
                                   const core::MediumState& state, core::WalkContext& context,
                                   const lights::LightSampling& how) {
    core::PathWeights weights;
    weights.throughput = weight, weights.hero = weights_.hero;
    return scattered_light<Media>(lights_, point, weights, state, sampler_, context, how);
}

template <bool Media>
void EyePath<Media>::pass_light(const core::WalkEvent& event) {
    const core::ScatteringVertex light = make_vertex(event, ray_);
    const core::Vec3 direction = ray_.direction;
    if constexpr (Media) state_ = light.state_towards(state_, direction);
    ray_ = {light.ray_origin(direction), direction, 0.0f, ray_.t_max - event.distance};
    passed_ += event.distance;
}

/// True where a path that leaves the vertex can find wanted light. Behind mirrors and glass that come first
/// there is all of it.
template <bool Media>
bool EyePath<Media>::wants_more() const {
    if (scatterings_ == 0 && !vertex_.connectable()) return true;
    const bool surface = scatterings_ == 0 ? vertex_.on_surface() : surface_first_;
    if (limits_.wanted[transport_layer(scatterings_ + 1, surface)]) return true;  // lights that it hits
    return scatterings_ + 1 != limits_.max_scatterings && limits_.wanted[transport_layer(2, surface)];
}

/// By the radiance that the guide expects, else by what is left of the throughput.
template <bool Media>
bool EyePath<Media>::survives_roulette(core::WalkContext& context) {
    if (expected_ > 0.0f && indirect_ > 0.0f && vertex_.connectable() &&
        depth_ < core::long_eye_path.vertices)
        return survives_by_expectation<Media>(weights_, indirect_ / expected_, context.rng.next_float());
    return depth_ < limits_.rr_depth ||
           survives<Media>(weights_, core::sqr(eta_) * guide_ratio_, depth_, context.rng.next_float());
}

/// Leaves the vertex. Returns false where the path ends instead.
template <bool Media>
bool EyePath<Media>::scatter(core::WalkContext& context) {
    if (!wants_more() || !survives_roulette(context)) return false;
    const auto guided = lights::sample_guided(vertex_, guided_, choices_.y, sampler_.next_2d(),
                                              core::TransportMode::radiance);
    if (!guided) return false;
    const core::ScatterSample* const next = &guided->scattering;
    const float factor = next->delta ? factors_.delta : factors_.connectable;
    if (factor == 0.0f) return false;
    const int samples = light_samples();
    if (!next->delta || scatterings_ > 0) {  // mirrors and glass before the first connectable vertex: none
        if (scatterings_ == 0)
            surface_first_ = vertex_.on_surface(), first_cosine_ = vertex_.shading_cosine(next->wi);
        ++scatterings_;
    }
    scale(factor);
    lights::apply_scattering<Media>(weights_, *next, vertex_.position, samples);
    if (core::is_black(weights_.throughput)) return false;
    if (Media && vertex_.on_surface()) state_ = vertex_.state_towards(state_, next->wi);
    eta_ *= next->eta, guide_ratio_ *= guided->pdf_ratio;
    connected_ = !next->delta, previous_ = vertex_.light_receiver();
    pdf_of_direction_ = next->delta ? core::infinity : next->pdf_solid_angle;
    ray_ = core::Ray{vertex_.ray_origin(next->wi), next->wi};
    return true;
}

}  // namespace mote::integrators
