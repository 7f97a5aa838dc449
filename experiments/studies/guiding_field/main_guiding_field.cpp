// A field of guided paths (lights/guiding) as pictures: --probabilities FILE.exr holds the probability that
// an eye ray scatters in a medium before its surface, by extinction and by the guide; --lobes FILE.exr what
// the guide has learned of the light that arrives at a point, and that light itself, over all directions:
// rows from up to down, columns around the y axis.
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <CLI/CLI.hpp>
#include <iostream>

#include "core/film/image_channels.h"
#include "core/formats/pictures/image_file.h"
#include "core/formats/xml/scene_loader.h"
#include "core/render/pass_runner.h"
#include "integrators/path_tracing/guided_paths.h"
#include "lights/guiding/choose_scattering.h"
#include "session/registry.h"

namespace {

using namespace mote;
using namespace mote::core;
using namespace mote::integrators;

struct Arguments {
    std::string scene, probabilities, lobes;
    int width = 320, height = 200;
    int paths = 65536;  ///< of each of the seven training passes
    int samples = 64;   ///< a pixel
    std::vector<float> at{0.0f, 0.0f, 0.0f};
};

std::unique_ptr<Scene> load(const Arguments& a) {
    LoadOptions options;
    options.defines = {{"film.width", std::to_string(a.width)}, {"film.height", std::to_string(a.height)}};
    return load_scene(a.scene, session::make_registry(), options);
}

/// Averages value(random numbers, sample) over samples of every pixel.
template <typename Value>
std::vector<Rgb> picture(int width, int height, int samples, const Value& value) {
    std::vector<Rgb> pixels(std::size_t(width) * std::size_t(height));
    tbb::parallel_for(std::size_t(0), pixels.size(), [&](std::size_t i) {
        Rng rng(i + 1);
        double sum = 0.0;
        for (int s = 0; s < samples; ++s)
            sum += double(value(int(i % std::size_t(width)), int(i / std::size_t(width)), rng));
        pixels[i] = Rgb(float(sum / samples));
    });
    return pixels;
}

/// 1 where the eye ray of a pixel scatters in a medium.
float scatters_in_media(const Scene& scene, const lights::ScatteringGuide& guide, int candidates, int x,
                        int y, Rng& rng) {
    const Ray ray = scene.camera().sample_ray(Vec2(float(x), float(y)) + rng.next_vec2(), rng.next_vec2());
    WalkContext walk;
    walk.rng = Rng(rng.next_u32());
    MediumState state = scene.eye_medium_state(ray);
    PathWeights weights;
    Rgb emitted(0.0f);
    ScatteringPoints points(candidates);
    points.start(Rng(rng.next_u32()));
    const WalkEvent event = walk_to_surface(scene, ray, state, weights, emitted, points, walk);
    const Rgb behind = event.kind == WalkEvent::Kind::surface ? weights.throughput : Rgb(0.0f);
    const auto choice =
        lights::choose_scattering(points.kept(), behind, event.hit.position, guide, rng.next_float());
    return choice.probability > 0.0f && choice.index < points.kept().size() ? 1.0f : 0.0f;
}

void write_probabilities(const Arguments& a, const Scene& scene, const lights::LearnedGuide& guide) {
    ImageChannels image{a.width, a.height, {}, {}, {}};
    const auto by = [&](const lights::ScatteringGuide& g) {
        return picture(a.width, a.height, a.samples, [&](int x, int y, Rng& rng) {
            return scatters_in_media(scene, g, guide.candidates(), x, y, rng);
        });
    };
    image.add_rgb("extinction", by(lights::no_guide())), image.add_rgb("guide", by(guide));
    write_exr(a.probabilities, image);
}

/// Radiance from a direction, with all light that next-event estimation finds at the point itself.
float incident(const Scene& scene, const Vec3& point, const Vec3& direction, Rng& rng) {
    WalkContext walk;
    walk.rng = Rng(rng.next_u32());
    const EyeRay eye{{point, direction}, {}, {SamplerKind::independent, 1, 0, rng.next_u32()}, walk.rng};
    EyePath<true> path(scene, {}, eye, walk);
    TransportSum sum;
    while (path.advance(walk, sum))
        if (path.vertex().connectable()) sum[path.layer_of_connection()] += path.sample_light(walk);
    float all = 0.0f;
    for (const Rgb& light : sum.light) all += average(light);
    return all;
}

void write_lobes(const Arguments& a, const Scene& scene, const lights::LearnedGuide& guide) {
    const int width = 128, height = 64;
    const Vec3 point(a.at[0], a.at[1], a.at[2]);
    const lights::VmfMixture lobes = guide.media().at(point);
    const auto direction = [&](int x, int y, const Vec2& u) {
        const float theta = pi * (float(y) + u.y) / height, phi = 2.0f * pi * (float(x) + u.x) / width;
        return Vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
    };
    ImageChannels image{width, height, {}, {}, {}};
    image.add_rgb("lobes", picture(width, height, 4, [&](int x, int y, Rng& rng) {
                      return lobes.empty ? 0.0f : lobes.pdf_solid_angle(direction(x, y, rng.next_vec2()));
                  }));
    image.add_rgb("light", picture(width, height, a.samples, [&](int x, int y, Rng& rng) {
                      return incident(scene, point, direction(x, y, rng.next_vec2()), rng);
                  }));
    write_exr(a.lobes, image);
}

}  // namespace

int main(int argc, char** argv) try {
    Arguments a;
    CLI::App app{"A field of guided paths as pictures"};
    app.add_option("scene", a.scene, "scene file, with media")->required();
    app.add_option("--probabilities", a.probabilities,
                   "of scattering in media, by extinction and by the guide");
    app.add_option("--lobes", a.lobes, "learned at a point in a medium, and the light that arrives there");
    app.add_option("--at", a.at, "the point [m]")->expected(3);
    app.add_option("--width", a.width, "of the picture"), app.add_option("--height", a.height, "");
    app.add_option("--paths", a.paths, "of a training pass"),
        app.add_option("--samples", a.samples, "a pixel");
    CLI11_PARSE(app, argc, argv);
    const auto scene = load(a);
    const RenderOptions options{.seed = 1, .width = a.width, .height = a.height};
    PathSettings settings;
    settings.guiding = {.mode = Guiding::on, .passes = first_training_passes, .paths = a.paths};
    SharedCounters counters;
    const GuideTraining<true> training(*scene, options, settings, 1.0, counters);
    if (!a.probabilities.empty()) write_probabilities(a, *scene, *training.guide());
    if (!a.lobes.empty()) write_lobes(a, *scene, *training.guide());
} catch (const std::exception& e) {
    std::cerr << e.what() << "\n";
    return 1;
}
