#include "viewer/pixel_light.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/objects/error.h"
#include "core/objects/number_text.h"
#include "core/render/render_driver.h"
#include "integrators/eye_path/eye_path.h"
#include "integrators/virtual_point_lights/vpl_settings.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::viewer {

namespace {

using core::Rgb, core::Vec3;
using nlohmann::json;

json numbers(const Vec3& v) { return {v.x, v.y, v.z}; }

/// Where a point is seen on the film; null outside of it.
json film_position(const core::Scene& scene, const Vec3& p) {
    const auto film = scene.camera().project(p, 0.0f);
    return film ? json{film->x, film->y} : json();
}

core::RenderOptions options_of(const core::Scene& scene, std::uint64_t seed) {
    const core::FilmSettings& film = scene.film();
    return {seed, film.width, film.height,
            film.sampler == "sobol" ? core::SamplerKind::sobol : core::SamplerKind::independent};
}

/// Paths and bound of the scene's `mote_vpl`, else the defaults.
integrators::VplSettings vpl_settings(const core::Element& elements) {
    integrators::VplSettings settings;
    for (const core::Element& e : elements.children) {
        if (e.tag != "integrator" || e.get("type") != "mote_vpl") continue;
        for (const core::Element& value : e.children) {
            const std::string text = value.get("value");
            if (value.get("name") == "paths")
                settings.paths = std::uint32_t(core::parse_integer_text(text, value.where));
            if (value.get("name") == "bound" && text.find_first_of("0123456789") != std::string::npos)
                settings.bound = float(core::parse_number(text, value.where));
        }
    }
    return settings;
}

json first_hit(const core::Scene& scene, int x, int y) {
    const core::Ray ray = scene.camera().sample_ray({float(x) + 0.5f, float(y) + 0.5f}, core::Vec2(0.5f));
    const auto hit = scene.first_hit(ray);
    if (!hit) return nullptr;
    const core::MediumState state = scene.eye_medium_state(ray);
    return {{"position", numbers(hit->position)},
            {"depth", hit->t},
            {"geometric_normal", numbers(hit->geometric_normal)},
            {"shading_normal", numbers(hit->shading.n)},
            {"shape", hit->shape->index + 1},
            {"in_medium", state.current() != nullptr}};
}

/// The eye path of a pixel, as a path tracer continues it, and the first vertex that VPLs can light.
template <bool Media>
class TracedEyePath {
  public:
    TracedEyePath(const core::Scene& scene, const core::PassContext& pass, const core::RenderOptions& options,
                  int x, int y)
        : eye_(integrators::make_eye_ray(scene, options, pass, x, y)) {
        context_.rng = eye_.rng;
        integrators::EyePath<Media> path(scene, {}, eye_, context_);
        integrators::TransportSum sum;
        while (path.advance(context_, sum)) {
            const core::ScatteringVertex& v = path.vertex();
            vertices_.push_back({{"position", numbers(v.position)},
                                 {"film", film_position(scene, v.position)},
                                 {"kind", v.on_surface() ? "surface" : "medium"},
                                 {"segment", path.segment_length()},
                                 {"throughput", numbers(path.throughput())}});
            if (!receiver_ && v.connectable())
                receiver_ = v, throughput_ = path.throughput(), state_ = path.state(), rng_ = context_.rng;
        }
    }

    const json& vertices() const { return vertices_; }
    bool has_receiver() const { return receiver_.has_value(); }
    /// Light of one VPL at the receiver.
    template <typename Weight>
    Rgb light_of(const lights::GatherContext& gather, const lights::VplSet& vpls, std::size_t index,
                 const Weight& weight) const {
        lights::ReceiverTile tile;
        tile.clear();
        tile.set(0, *receiver_, throughput_, state_, rng_, std::numeric_limits<std::int32_t>::max());
        return lights::gather(gather, vpls, lights::VplRange::one(index), weight, tile)[0];
    }

  private:
    integrators::EyeRay eye_;
    core::WalkContext context_;
    json vertices_ = json::array();
    std::optional<core::ScatteringVertex> receiver_;
    Rgb throughput_{0.0f};
    core::MediumState state_;
    core::Rng rng_;
};

template <bool Media>
void add_lights(json& result, const core::Scene& scene, const integrators::VplSettings& settings,
                const TracedEyePath<Media>& eye, const core::RenderOptions& options) {
    const float bound = settings.bound_for(scene.bounds());
    const lights::VplSet vpls =
        lights::trace_light_paths(scene, settings.light_paths(), options.seed, 0, options.sampler);
    lights::GatherScratch scratch;
    core::RayCounters rays;
    core::TrackingCounters tracking;
    const lights::GatherContext gather{scene, scratch, rays, tracking};
    struct Contribution {
        std::size_t index;
        Rgb bounded, all;
    };
    std::vector<Contribution> found;
    Rgb sum(0.0f), residual(0.0f);
    for (std::size_t i = 0; eye.has_receiver() && i < vpls.lights.size(); ++i) {
        const Rgb all = eye.light_of(gather, vpls, i, lights::UnboundedGeometry{});
        if (core::is_black(all)) continue;
        const Rgb bounded = eye.light_of(gather, vpls, i, lights::BoundedGeometry{bound});
        found.push_back({i, bounded, all});
        sum += bounded, residual += all - bounded;
    }
    std::ranges::stable_sort(found, std::ranges::greater(),
                             [](const Contribution& c) { return core::max_component(c.all); });
    json list = json::array();
    for (const Contribution& c : std::span(found).first(std::min(found.size(), max_listed_lights))) {
        const lights::VirtualPointLight& vpl = vpls.lights[c.index];
        list.push_back({{"index", c.index},
                        {"position", numbers(vpl.position)},
                        {"film", film_position(scene, vpl.position)},
                        {"depth", vpl.depth},
                        {"bounded", numbers(c.bounded)},
                        {"all", numbers(c.all)}});
    }
    result["paths"] = settings.paths, result["lights"] = vpls.lights.size();
    result["lit_by"] = found.size(), result["vpls"] = std::move(list);
    result["bound"] = std::isfinite(bound) ? json(bound) : json();
    result["sum"] = numbers(sum), result["residual"] = numbers(residual);
}

template <bool Media>
json light_at(const core::Scene& scene, const integrators::VplSettings& settings, int x, int y,
              std::uint64_t seed) {
    const core::FilmSettings& film = scene.film();
    const core::RenderOptions options = options_of(scene, seed);
    const auto filter = core::make_pixel_filter(film.filter, film.filter_radius, film.filter_stddev);
    const std::atomic<bool> never{false};
    const TracedEyePath<Media> eye(scene, {0, *filter, never}, options, x, y);
    json result = {{"x", x}, {"y", y}, {"first", first_hit(scene, x, y)}, {"path", eye.vertices()}};
    add_lights(result, scene, settings, eye, options);
    return result;
}

}  // namespace

json pixel_light(const core::Scene& scene, const core::Element& elements, int x, int y, std::uint64_t seed) {
    const core::FilmSettings& film = scene.film();
    if (x < 0 || y < 0 || x >= film.width || y >= film.height)
        throw core::InputError("the pixel is outside of the image");
    const integrators::VplSettings settings = vpl_settings(elements);
    return scene.attenuates() ? light_at<true>(scene, settings, x, y, seed)
                              : light_at<false>(scene, settings, x, y, seed);
}

}  // namespace mote::viewer
