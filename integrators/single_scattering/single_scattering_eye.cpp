#include "integrators/single_scattering/single_scattering_eye.h"

#include "integrators/eye_path/eye_path.h"

namespace mote::integrators {

using namespace core;
using namespace screenspace;

namespace {

/// Lights without a position, scattered once along the ray, and emission of media: by one sampled distance.
void add_other_lights(const Scene& scene, const EyeSettings& settings, const Ray& ray, MediumState state,
                      PathWeights weights, Sampler& sampler, WalkContext& context, TransportSum& sum) {
    const LitScene& others = settings.others ? static_cast<const LitScene&>(*settings.others) : scene;
    weights.hero = sample_hero(context.rng);
    const WalkEvent event = walk<true>(scene, ray, state, weights, sum[Transport::emission], context);
    const Vec2 choices = sampler.next_2d(), u_light = sampler.next_2d(), u = sampler.next_2d();
    if (event.kind != WalkEvent::Kind::collision) return;
    const ScatteringVertex vertex = make_vertex(event, ray);
    Rgb& scattered = sum[Transport::single_scattering];
    scattered += lights::sample_light<true>(others, vertex, weights, state, choices.x, u_light, context,
                                            {true, settings.maps});
    if (const auto s = vertex.sample(choices.y, u, TransportMode::radiance))
        scattered += lights::light_towards<true>(others, vertex, *s, weights, state, context);
}

/// The segments of an eye path that goes from surface to surface: media in between are marched, not sampled.
template <bool Media>
class MarchedSegments {
  public:
    MarchedSegments(const Scene& scene, const EyeSettings& settings, std::span<const InScattering> positional,
                    EyePath<Media>& path, MarchScratch& scratch, EyeLight& found)
        : scene_(scene),
          settings_(settings),
          positional_(positional),
          path_(path),
          scratch_(scratch),
          found_(found) {}

    WalkEvent operator()(Rgb& emitted, WalkContext& context) {
        // Towards what a surface scatters to: the other technique for direct light, through tracked media.
        if (path_.scatterings() > 0)
            return walk<Media>(scene_, path_.ray(), path_.state(), path_.weights(), emitted, context);
        const Ray& ray = path_.ray();
        const PathWeights before = path_.weights();
        MediumState unused;
        const WalkEvent event = walk<false>(scene_, ray, unused, path_.weights(), emitted, context);
        const bool hit = event.kind == WalkEvent::Kind::surface;
        const bool first = path_.depth() == 1;
        if (first) found_.first.reset();  // a light that is hidden was not the first surface
        if (hit && first) found_.first = event.reflected ? scene_.rays().closest(ray) : event.hit;
        if (hit && first && found_.first) found_.first->t += path_.passed();
        if constexpr (Media) {
            Ray part = ray;
            part.t_max = event.surface_distance;
            add_in_scattering(part, first, before, context);
            if (hit) part.t_max = event.distance;
            cross_media(part);
        }
        return event;
    }

  private:
    /// Light scattered in media along the whole ray, through panes to the first surface.
    void add_in_scattering(const Ray& ray, bool first, const PathWeights& before, WalkContext& context) {
        const bool wanted = settings_.limits.wanted[Transport::single_scattering];
        if (settings_.other_lights && (wanted || settings_.limits.wanted[Transport::emission]))
            add_other_lights(scene_, settings_, ray, path_.state(), before, path_.sampler(), context,
                             found_.sum);
        if (first) return;
        for (const InScattering& light : positional_)
            found_.sum[Transport::single_scattering] +=
                before.throughput * light.march(ray, path_.state(), scratch_).radiance;
    }
    /// Multiplies the throughput by the transmittance to the ray's end, and sets the media there.
    void cross_media(const Ray& ray) {
        find_segments(scene_, ray, path_.state(), scratch_.eye, scratch_.walk);
        path_.weights().throughput *=
            transmittance_of_media(ray, scratch_.eye, settings_.voxels, scratch_.walk);
        if (!scratch_.eye.empty()) path_.state() = scratch_.eye.back().state;
    }

    const Scene& scene_;
    const EyeSettings& settings_;
    std::span<const InScattering> positional_;
    EyePath<Media>& path_;
    MarchScratch& scratch_;
    EyeLight& found_;
};

/// Direct light at a vertex: of every light that it is connected to, and of one that is sampled.
template <bool Media>
Rgb direct_light(const Scene& scene, const EyeSettings& settings, EyePath<Media>& path, WalkContext& walk) {
    const lights::LightSampling how{.marched_voxels = settings.voxels};
    Rgb sum(0.0f);
    for (const Emitter* light : settings.connected)
        sum += lights::connect_light<Media>(scene, path.vertex(), path.weights(), path.state(), {light, 1.0f},
                                            Vec2(0.5f), walk, how);
    return sum + path.sample_light(walk, how);
}

}  // namespace

template <bool Media>
EyeLight trace_eye(const Scene& scene, const EyeSettings& settings, std::span<const InScattering> positional,
                   const EyeRay& eye, MarchScratch& scratch) {
    EyeLight found;
    EyePath<Media> path(scene, settings.limits, eye, scratch.walk, settings.others);
    MarchedSegments<Media> segments(scene, settings, positional, path, scratch, found);
    const auto nothing = [](const EyeSegment&) {};
    while (path.advance_by(segments, scratch.walk, found.sum, nothing))
        if (path.vertex().connectable() && path.wants_connection())
            found.sum[Transport::direct] += direct_light(scene, settings, path, scratch.walk);
    return found;
}

template EyeLight trace_eye<true>(const Scene&, const EyeSettings&, std::span<const InScattering>,
                                  const EyeRay&, MarchScratch&);
template EyeLight trace_eye<false>(const Scene&, const EyeSettings&, std::span<const InScattering>,
                                   const EyeRay&, MarchScratch&);

}  // namespace mote::integrators
