#include "session/in_scattered_feature.h"

#include "core/render/render_driver.h"
#include "core/scene/requirements.h"
#include "integrators/single_scattering/single_scattering_estimator.h"

namespace mote::session {

using namespace core;

namespace {

constexpr TransportSet marched_cell = TransportSet::positional_scattering();

std::shared_ptr<const Integrator> marching(const Registry& registry) {
    Properties p;
    p.category = Category::integrator, p.type = "mote_single_scattering";
    p.values["lights"] = {std::string("positional"), {}};
    p.values["steps"] = {std::int64_t(16), {}};  // 64 take twice as long and gain nothing in the regression
    return std::dynamic_pointer_cast<const Integrator>(registry.make(p));
}

}  // namespace

std::vector<Rgb> in_scattered(const ImageChannels& image) {
    std::vector<Rgb> light = image.rgb(in_scattered_layer);
    return light.empty() ? image.rgb(transport_name(marched_cell)) : light;
}

void add_in_scattered(ImageChannels& image, const Scene& scene, const Registry& registry) {
    if (!find_requirements(scene).media_scattering || integrators::positional_lights(scene).empty() ||
        !in_scattered(image).empty())
        return;
    const auto integrator = marching(registry);
    const std::vector<Layer> layers = integrator->layers(scene);
    RenderOptions options{0, image.width, image.height};
    options.cells = marched_cell;
    const auto filter = make_pixel_filter("box", 0.5f, 0.5f);
    const std::atomic<bool> cancelled{false};
    PassImage pass(image.width, image.height, layers.size());
    integrator->prepare(scene, options)->pass({0, *filter, cancelled}, pass);
    for (std::size_t i = 0; i < layers.size(); ++i)
        if (layers[i].transport == marched_cell) image.add_rgb(in_scattered_layer, pass.layer(i));
}

}  // namespace mote::session
