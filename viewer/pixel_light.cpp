#include "viewer/pixel_light.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/formats/xml/integrator_maker.h"
#include "core/objects/error.h"
#include "core/render/pass_runner.h"
#include "viewer/eye_vertices.h"

namespace mote::viewer {

namespace {

using core::Rgb, core::Vec3;
using nlohmann::json;

/// Pass 0 of the method whose points are shown.
class FirstPass {
  public:
    FirstPass(const session::LoadedScene& scene, std::uint64_t seed)
        : scene_(scene.scene()),
          options_(core::render_options(scene_, seed, core::pass_split(scene_, scene.integrator()))),
          filter_(core::film_filter(scene_)),
          method_(scene.integrator().type()),
          lights_(scene.integrator().point_lights(scene_, options_)) {
        if (lights_) return;
        method_ = "mote_vpl";
        std::vector<std::string> warnings;
        vpls_ =
            core::make_integrator(scene.registry(), scene_, method_, {}, {"light of a pixel", 0}, warnings);
        lights_ = vpls_->point_lights(scene_, options_);
    }
    core::PassContext context() const { return {0, *filter_, never_}; }
    const core::RenderOptions& options() const { return options_; }
    core::PointLights& lights() { return *lights_; }
    json header() const { return {{"kind", lights_->kind()}, {"method", method_}}; }

  private:
    const core::Scene& scene_;
    core::RenderOptions options_;
    std::unique_ptr<core::PixelFilter> filter_;
    std::atomic<bool> never_{false};
    std::string method_;
    std::shared_ptr<const core::Integrator> vpls_;  ///< instead of the scene's
    std::unique_ptr<core::PointLights> lights_;
};

json source_json(const core::Scene& scene, const core::PixelLight::Source& s) {
    json source = {{"index", s.index},
                   {"position", numbers(s.point.position)},
                   {"film", film_position(scene, s.point.position)},
                   {"depth", s.point.depth},
                   {"light", numbers(s.light)},
                   {"weight", s.weight},
                   {"cluster", s.cluster > 0 ? json(s.cluster) : json()},
                   {"unbounded", nullptr}};
    if (s.bounded > 0.0f) source["unbounded"] = numbers(s.light / s.bounded);
    return source;
}

/// True where the camera sees the point, or nothing but media lie before it.
bool is_seen(const core::Scene& scene, const Vec3& p, const core::Vec2& film) {
    const core::Ray ray = scene.camera().sample_ray(film, core::Vec2(0.5f));
    const auto hit = scene.first_hit(ray);
    constexpr float tolerance = 1e-3f;
    return !hit || hit->t > (1.0f - tolerance) * glm::distance(ray.origin, p);
}

}  // namespace

json pixel_light(const session::LoadedScene& loaded, int x, int y, std::uint64_t seed) {
    const core::Scene& scene = loaded.scene();
    if (x < 0 || y < 0 || x >= scene.film().width || y >= scene.film().height)
        throw core::InputError("the pixel is outside of the image");
    FirstPass pass(loaded, seed);
    core::PixelLight light = pass.lights().light_of(pass.context(), x, y);
    Rgb sum(0.0f);
    for (const auto& s : light.sources) sum += s.light;
    std::ranges::stable_sort(light.sources, std::ranges::greater(),
                             [](const auto& s) { return core::max_component(s.light); });
    json result = pass.header();
    result.update({{"x", x},
                   {"y", y},
                   {"first", first_hit(scene, x, y)},
                   {"path", eye_vertices(scene, pass.options(), pass.context(), x, y)},
                   {"facts", light.facts},
                   {"connected", light.connected},
                   {"lit_by", light.sources.size()},
                   {"sources", json::array()},
                   {"sum", numbers(sum)},
                   {"residual", numbers(light.residual)}});
    for (const auto& s : std::span(light.sources).first(std::min(light.sources.size(), max_listed_lights)))
        result["sources"].push_back(source_json(scene, s));
    return result;
}

json light_points(const session::LoadedScene& loaded, std::uint64_t seed) {
    const core::Scene& scene = loaded.scene();
    FirstPass pass(loaded, seed);
    const std::vector<core::LightPoint> points = pass.lights().points(pass.context());
    float largest = 0.0f;
    for (const core::LightPoint& p : points) largest = std::max(largest, core::max_component(p.power));
    json result = pass.header();
    result["count"] = points.size(), result["points"] = json::array();
    const std::size_t step =
        std::max<std::size_t>(1, (points.size() + max_shown_points - 1) / max_shown_points);
    for (std::size_t i = 0; i < points.size(); i += step) {
        const auto film = scene.camera().project(points[i].position, 0.0f);
        if (!film || !is_seen(scene, points[i].position, *film)) continue;
        const Rgb power = points[i].power / std::max(largest, 1e-30f);
        result["points"].push_back({film->x, film->y, power.x, power.y, power.z});
    }
    return result;
}

}  // namespace mote::viewer
