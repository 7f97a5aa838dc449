// A render loop of one's own with a progress bar: a scene as text, passes until the noise is low enough, and
// the picture in memory. A ball of reflectance 1/2 under an even sky of radiance 1 looks 1/2 all over.
#include <mote/core/formats/xml/scene_loader.h>
#include <mote/core/objects/registry.h>
#include <mote/core/render/render_driver.h>
#include <mote/integrators/register_integrators.h>
#include <mote/lights/register_lights.h>
#include <mote/media/register_media.h>

#include <cmath>
#include <cstdio>

using namespace mote;

const char* const scene_text = R"(<scene version="3.0.0">
  <integrator type="path"/>
  <sensor type="perspective">
    <float name="fov" value="30"/>
    <transform name="to_world"><lookat origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="64"/><integer name="height" value="64"/><rfilter type="box"/></film>
  </sensor>
  <emitter type="constant"><rgb name="radiance" value="1"/></emitter>
  <shape type="sphere"><bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf></shape>
</scene>)";

int main() {
    core::Registry registry;
    core::register_core(registry), media::register_media(registry);
    lights::register_lights(registry), integrators::register_integrators(registry);
    const auto scene = core::load_scene_from_string(scene_text, ".", registry);

    core::RenderRequest request;
    request.stop.noise = 0.01, request.stop.passes = 256;
    request.progress = [](const core::RenderProgress& p) {
        const double done = std::isfinite(p.noise) ? std::fmin(1.0, 0.01 * 0.01 / (p.noise * p.noise)) : 0.0;
        std::fprintf(stderr, "\r[%-40.*s] %u passes", int(40 * done),
                     "########################################", p.passes);
    };
    const core::RenderResult result = core::render(*scene, *scene->integrator(), request);
    std::fputs("\n", stderr);

    const std::vector<core::Rgb> picture = result.film.beauty();
    double ball = 0.0;  // the middle 16 x 16 pixels
    for (int y = 24; y < 40; ++y)
        for (int x = 24; x < 40; ++x) ball += double(picture[std::size_t(64 * y + x)].x) / 256.0;
    std::printf("%u passes, noise %.4f: the ball's radiance is %.4f\n", result.film.pass_count(),
                result.film.noise(), ball);
    return std::fabs(ball - 0.5) < 0.005 && std::fabs(double(picture[0].x) - 1.0) < 1e-6 ? 0 : 1;
}
