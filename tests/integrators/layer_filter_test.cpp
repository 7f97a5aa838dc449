// Layers of a film filtered in image space: features of a scene against closed forms, and a render with and
// without.
#include "integrators/layer_filter/layer_filter.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "core/render/pass_runner.h"
#include "core/render/render_driver.h"
#include "integrators/layer_filter/eye_march.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/environment.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::core;
using namespace mote::integrators;
using namespace mote::screenspace;
using namespace mote::tests;

namespace {

const std::string coloured_fog =
    R"(<medium type="homogeneous" name="interior"><rgb name="sigma_t" value="0.7, 0.5, 0.3"/>
    <rgb name="albedo" value="0.8, 0.6, 0.4"/></medium>)";

RenderOptions options_of(const Scene& scene) {
    RenderOptions options;
    options.seed = 3, options.width = scene.film().width, options.height = scene.film().height;
    return options;
}

FilterFeatures features_of(const Scene& scene, int samples = 8) {
    return find_filter_features(scene, options_of(scene), {samples, 1.0f});
}

/// The film of volpath after some passes.
Film rendered(const Scene& scene, std::uint32_t passes, std::uint64_t seed) {
    const auto integrator = integrator_from(R"(<integrator type="volpath"/>)");
    Film film(scene.film().width, scene.film().height, film_layers(scene, *integrator, {}), true);
    PassRunner runner(scene, *integrator, seed, film);
    const std::atomic<bool> never{false};
    while (film.pass_count() < passes) runner.run_pass(never);
    return film;
}

std::size_t layer_called(const Film& film, const std::string& name) {
    for (std::size_t i = 0; i < film.layers().size(); ++i)
        if (film.layers()[i].name == name) return i;
    throw std::out_of_range(name);
}

double squared_error(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += double(average((a[i] - b[i]) * (a[i] - b[i])));
    return sum / double(a.size());
}

}  // namespace

TEST_CASE("Transmittance and scattering along eye rays are their closed forms", "[layer_filter]") {
    const auto scene = scene_from(box(grey, coloured_fog), 16);
    WalkContext walk;
    EyeMarch march;
    const Ray ray{{0, 0, 3.6f}, {0, 0, -1}};  // the fog from 0.9 to -0.9, that is from 2.7 to 4.5
    march.march(*scene, ray, 4.6f, 1.0f, walk);
    const Vec3d sigma(0.7, 0.5, 0.3), albedo(0.8, 0.6, 0.4);
    for (const float t : {1.0f, 3.0f, 4.0f, 4.6f, infinity}) {
        CAPTURE(t);
        const EyeMarch::Value value = march.at(t);
        const double length = std::clamp(double(t) - 2.7, 0.0, 1.8);
        for (int c = 0; c < 3; ++c) {
            // Linear between 32 steps: off by (sigma step)^2 / 8 at most.
            const double passes = std::exp(-sigma[c] * length), step = sigma[c] * 1.8 / 32.0;
            CHECK(std::abs(double(value.transmittance[c]) - passes) < step * step / 8.0 + 1e-6);
            CHECK(std::abs(double(value.scattering[c]) - albedo[c] * (1.0 - passes)) <
                  step * step / 8.0 + 1e-6);
        }
    }
}

TEST_CASE("Rays that never end see all that an endless medium scatters", "[layer_filter]") {
    const std::string around =
        R"(<medium type="homogeneous" id="fog"><float name="sigma_t" value="0.5"/><float name="albedo" value="0.9"/></medium>)";
    const auto scene = scene_from(
        "<scene version=\"3.0.0\">" + around +
            R"(<shape type="sphere"><float name="radius" value="0.5"/><ref id="fog" name="exterior"/></shape>
            <emitter type="point"><point name="position" x="0" y="3" z="3"/></emitter>
            <sensor type="perspective"><transform name="to_world"><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/>
            </transform><ref id="fog"/></sensor></scene>)",
        16);
    const FilterFeatures f = features_of(*scene);
    CHECK(f.kind[0] == PixelKind::none);
    CHECK(f.scattering[0].x == Approx(0.9f).epsilon(1e-5));
    const std::size_t middle = 8 * 16 + 8;
    CHECK(f.kind[middle] != PixelKind::none);
    const float to_ball = std::exp(-0.5f * (f.distance[middle] - 0.01f));  // from near_clip on
    // Linear between 32 steps, and eight rays' distances for one: both of second order in 0.5 * 3.6 / 32.
    CHECK(f.transmittance[middle] == Approx(to_ball).epsilon(2e-3));
    CHECK(f.scattering[middle].x == Approx(0.9f * (1.0f - to_ball)).epsilon(2e-3));
}

TEST_CASE("Features do not depend on threads, and pixels at edges keep their samples", "[layer_filter]") {
    const auto scene = scene_from(box(grey, coloured_fog), 24);
    const auto with = [&](std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return features_of(*scene);
    };
    const FilterFeatures one = with(1), many = with(4);
    CHECK(one.kind == many.kind);
    CHECK(one.position == many.position);
    CHECK(one.scattering == many.scattering);
    CHECK(one.mixed == many.mixed);
    CHECK(!one.mixed.empty());
    CHECK(one.mixed.size() < one.pixels() / 2);
    CHECK(one.samples.size() == one.mixed.size() * 8);
}

TEST_CASE("A filtered render has less noise, and filtering it again changes nothing", "[layer_filter]") {
    const auto scene = scene_from(box(grey, coloured_fog), 32);
    const Film reference = rendered(*scene, 512, 9);
    Film film = rendered(*scene, 8, 1);
    const std::vector<LayerFilter::Choice> choices = {
        {layer_called(film, "indirect"), LayerKind::surface},
        {layer_called(film, "multiple_scattering"), LayerKind::volume}};
    std::vector<std::vector<Rgb>> before, once;
    for (const auto& c : choices) before.push_back(film.mean(c.layer));
    LayerFilter filter(*scene, options_of(*scene), {}, choices);
    filter.apply(film);
    for (std::size_t k = 0; k < choices.size(); ++k) {
        once.push_back(film.mean(choices[k].layer));
        const std::vector<Rgb> truth = reference.mean(choices[k].layer);
        CAPTURE(film.layers()[choices[k].layer].name);
        CHECK(squared_error(once[k], truth) < squared_error(before[k], truth) / 4.0);
    }
    filter.apply(film);
    for (std::size_t k = 0; k < choices.size(); ++k) CHECK(film.mean(choices[k].layer) == once[k]);
    CHECK(filter.variances().size() == choices.size());
}

TEST_CASE("The variance of few passes is not known: OpenImageDenoise smooths it, our own filter leaves it",
          "[layer_filter]") {
    const auto scene = scene_from(box(grey, coloured_fog), 32);
    Film film = rendered(*scene, 1, 1);
    const std::size_t layer = layer_called(film, "indirect");
    const std::vector<Rgb> before = film.mean(layer);
    LayerFilter own(*scene, options_of(*scene), {}, {{layer, LayerKind::surface}});
    own.apply(film);
    CHECK(film.mean(layer) == before);
    // The stand-in for the library doubles what it gets.
    const Environment stand_in("MOTE_OIDN", MOTE_BINARY_DIR "/stand_ins");
    const auto doubled = [&](std::uint32_t passes) {
        Film noisy = rendered(*scene, passes, 1);
        const std::vector<Rgb> mean = noisy.mean(layer);
        LayerFilter(*scene, options_of(*scene), FeatureSettings(), std::make_shared<const OidnLibrary>(),
                    {{layer, LayerKind::surface}})
            .apply(noisy);
        std::size_t lit = 0, twice = 0;
        for (std::size_t i = 0; i < mean.size(); ++i) {
            if (mean[i] == Rgb(0.0f)) continue;
            ++lit, twice += noisy.mean(layer)[i] == 2.0f * mean[i];
        }
        CHECK(lit > 100);
        return double(twice) / double(lit);
    };
    CHECK(doubled(1) == 1.0);
    CHECK(doubled(3) == 1.0);
    CHECK(doubled(4) < 1.0);  // mixed with the mean
}

TEST_CASE("A preview shows the filtered sum of the layers of a kind", "[layer_filter]") {
    const auto scene = scene_from(box(grey, coloured_fog), 32);
    Film film = rendered(*scene, 1, 1);  // whose variance is not known: what is shown is all the library's
    const std::array layers{layer_called(film, "direct"), layer_called(film, "indirect")};
    const std::vector<LayerFilter::Choice> choices = {{layers[0], LayerKind::surface},
                                                      {layers[1], LayerKind::surface}};
    const std::vector<Rgb> before[] = {film.mean(layers[0]), film.mean(layers[1])};
    const Environment stand_in("MOTE_OIDN", MOTE_BINARY_DIR "/stand_ins");
    LayerFilter filter(*scene, options_of(*scene), FeatureSettings(), std::make_shared<const OidnLibrary>(),
                       choices);
    CHECK(!filter.apply_for_preview(film));
    CHECK(filter.seconds_to_apply(film) > 0.0);
    for (std::size_t p = 0; p < film.pixels(); ++p)
        for (int c = 0; c < 3; ++c) {
            const float sum = before[0][p][c] + before[1][p][c],
                        shown = film.mean(layers[0])[p][c] + film.mean(layers[1])[p][c];
            CHECK(shown == Approx(4.0f * sum));  // at balanced quality the stand-in quadruples
            if (sum > 0.0f) CHECK(film.mean(layers[1])[p][c] / shown == Approx(before[1][p][c] / sum));
        }
    // A picture after a preview is what it is without one.
    filter.apply(film);
    const std::vector<Rgb> after = film.mean(layers[1]);
    film.set_mean(layers[1], {});
    LayerFilter(*scene, options_of(*scene), FeatureSettings(), std::make_shared<const OidnLibrary>(), choices)
        .apply(film);
    CHECK(film.mean(layers[1]) == after);
}

// The denoiser brings light to pixels where no path has met any; a layer that is black stays so.
TEST_CASE("Light of pixels without any is shared out as that of the picture is", "[layer_filter]") {
    const auto scene = scene_from(box(grey, coloured_fog), 32);
    Film film = rendered(*scene, 1, 1);
    const std::array names = {"emission", "direct", "indirect"};
    std::vector<LayerFilter::Choice> choices;
    std::array<std::vector<Rgb>, 3> before;
    Vec3d light[3] = {}, all(0.0);
    for (std::size_t l = 0; l < names.size(); ++l) {
        choices.push_back({layer_called(film, names[l]), LayerKind::surface});
        before[l] = film.mean(choices[l].layer);
        for (const Rgb& value : before[l]) light[l] += Vec3d(value), all += Vec3d(value);
    }
    const Environment stand_in("MOTE_OIDN", MOTE_BINARY_DIR "/stand_ins"), more("MOTE_STAND_IN_LIGHT", "1");
    LayerFilter(*scene, options_of(*scene), FeatureSettings(), std::make_shared<const OidnLibrary>(), choices)
        .apply_for_preview(film);
    int dark = 0;
    for (std::size_t p = 0; p < film.pixels(); ++p) {
        if (max_component(before[0][p] + before[1][p] + before[2][p]) > 0.0f) continue;
        ++dark;
        for (std::size_t l = 0; l < names.size(); ++l)
            for (int c = 0; c < 3; ++c)
                CHECK(film.mean(choices[l].layer)[p][c] == Approx(light[l][c] / all[c]).margin(1e-6));
    }
    CHECK(dark > 10);
}

TEST_CASE(
    "After little work layers of a kind are denoised as one by noisy features, after more by clean ones",
    "[layer_filter]") {
    const auto scene = scene_from(box(grey, coloured_fog), 16);
    Film film = rendered(*scene, 1, 1);
    const std::vector<LayerFilter::Choice> choices = {
        {layer_called(film, "emission"), LayerKind::surface},
        {layer_called(film, "direct"), LayerKind::surface},
        {layer_called(film, "indirect"), LayerKind::surface},
        {layer_called(film, "single_scattering"), LayerKind::volume},
        {layer_called(film, "multiple_scattering"), LayerKind::volume}};
    const TemporaryFolder folder;
    const Environment stand_in("MOTE_OIDN", MOTE_BINARY_DIR "/stand_ins"),
        log("MOTE_STAND_IN_LOG", folder.file("log"));
    const auto runs = [&](const Film& f) {
        Film copy = f;
        std::ofstream(folder.file("log"));
        LayerFilter(*scene, options_of(*scene), FeatureSettings(), std::make_shared<const OidnLibrary>(),
                    choices)
            .apply(copy);
        std::ifstream file(folder.file("log"));
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    const auto add_work = [&](double of_pixel) {
        film.add_pass(PassImage(film.width(), film.height(), film.layers().size()), 0,
                      of_pixel * double(film.pixels()));
    };
    CHECK(film.work(0) > 0.0);  // counted, although the film has one part
    CHECK(film.work(0) < 90.0 * double(film.pixels()));
    const auto of = [](int count, const std::string& run) {
        std::string all;
        for (int i = 0; i < count; ++i) all += run;
        return all;
    };
    // Surfaces, light scattered once, and light scattered more often.
    CHECK(runs(film) == "quality 0, noisy features\n" + of(2, "quality 0, noisy features, no normals\n"));
    add_work(50.0);
    // Each layer, those of media without normals.
    const auto each = [&](const std::string& quality) {
        return of(3, quality + "\n") + of(2, quality + ", no normals\n");
    };
    CHECK(runs(film) == each("quality 0, noisy features"));
    add_work(100.0);
    CHECK(runs(film) == each("quality 0"));
    add_work(1000.0);
    CHECK(runs(film) == each("quality 0"));  // it has no quarters
}

TEST_CASE("The time of the filter is that after another pass, of layers that have noise", "[layer_filter]") {
    const auto scene = scene_from(box(grey, ""), 16);
    const Environment stand_in("MOTE_OIDN", MOTE_BINARY_DIR "/stand_ins");
    // Three passes; emission has no noise.
    const auto film_of = [](double work_of_pixel) {
        Film film(16, 16,
                  {{"emission", "", false, true, "", Transport::emission},
                   {"direct", "", false, true, "", Transport::direct},
                   {"indirect", "", false, true, "", Transport::indirect}});
        for (std::uint32_t pass = 0; pass < 3; ++pass) {
            PassImage image(16, 16, 3);
            for (int i = 0; i < 256; ++i)
                for (const std::size_t layer : {1, 2})
                    image.at(layer, i % 16, i / 16) = Rgb(float(hash_keys(pass, i, layer) % 1000));
            film.add_pass(image, 0, work_of_pixel * 256.0 / 3.0);
        }
        return film;
    };
    LayerFilter filter(*scene, options_of(*scene), FeatureSettings(), std::make_shared<const OidnLibrary>(),
                       {{0, LayerKind::surface}, {1, LayerKind::surface}, {2, LayerKind::surface}});
    Film film = film_of(20.0);
    CHECK_FALSE(filter.apply_for_preview(film));
    // From 30 hits a pixel on, each layer by itself; from 90 on with full features, and their network.
    const double of_sum = filter.seconds_to_apply(film_of(22.0));
    CHECK(of_sum > 0.0);
    CHECK(filter.seconds_to_apply(film_of(23.0)) == Approx(2.0 * of_sum));
    CHECK(filter.seconds_to_apply(film_of(67.0)) == Approx(2.0 * of_sum));
    CHECK(filter.seconds_to_apply(film_of(68.0)) > OidnLibrary::high_per_balanced * 2.0 * of_sum);
    // Where there is no time for those, rough ones stay; but for a film that is worth full ones already.
    filter.keep_features(film_of(91.0));
    CHECK(filter.seconds_to_apply(film_of(91.0)) > OidnLibrary::high_per_balanced * 2.0 * of_sum);
    filter.keep_features(film_of(68.0));
    CHECK(filter.seconds_to_apply(film_of(68.0)) == Approx(2.0 * of_sum));
    CHECK(filter.seconds_to_apply(film_of(91.0)) == Approx(2.0 * of_sum));
}

TEST_CASE("After much work and 32 passes quarters of pixels are denoised", "[layer_filter][fine]") {
    const auto scene = scene_from(box(grey, ""), 16);
    const TemporaryFolder folder;
    const Environment stand_in("MOTE_OIDN", MOTE_BINARY_DIR "/stand_ins"), sharp("MOTE_STAND_IN_SHARP", "1"),
        log("MOTE_STAND_IN_LOG", folder.file("log"));
    Layer direct{"direct", "", false, true, "", Transport::direct};
    direct.fine = true;
    struct Shown {
        std::string log;
        std::vector<Rgb> passes, picture;
    };
    const auto shown = [&](std::uint32_t passes, double work, bool noise,
                           PassSplit split = PassSplit::whole) {
        Film film(16, 16, {direct}, false, split);
        for (std::uint32_t pass = 0; pass < passes; ++pass) {
            PassImage image(16, 16, 1);
            image.keep_places();
            for (int y = 0; y < 16; ++y)
                for (int x = 0; x < 16; ++x) {
                    image.at(0, x, y) = Rgb(noise ? float(hash_keys(pass, x, y) % 1000) : 3.0f);
                    image.place(
                        x, y,
                        Vec2(float(x), float(y)) + 0.25f + 0.5f * Vec2(float(pass % 2), float(pass / 2 % 2)));
                }
            film.add_pass(image, 0, work * 256.0 / double(passes));
        }
        std::ofstream(folder.file("log"));
        const std::vector<Rgb> before = film.mean(0);
        LayerFilter(*scene, options_of(*scene), FeatureSettings(), std::make_shared<const OidnLibrary>(),
                    {{0, LayerKind::surface}})
            .apply(film);
        std::ifstream file(folder.file("log"));
        return Shown{std::string(std::istreambuf_iterator<char>(file), {}), before, film.mean(0)};
    };
    CHECK(shown(32, 301.0, true).log == "quality 0, quarters\n");
    CHECK(shown(32, 299.0, true).log == "quality 0\n");
    CHECK(shown(31, 301.0, true).log == "quality 0\n");
    CHECK(shown(32, 301.0, true, PassSplit::halves).log == "quality 0\nquality 0\n");
    const Shown noisy = shown(64, 301.0, true), even = shown(64, 301.0, false);
    CHECK(even.picture == even.passes);  // without noise there is nothing to denoise
    CHECK(even.log.empty());
    CHECK(noisy.picture != noisy.passes);
}

TEST_CASE("Features of quarters are those of pixels, seen closer", "[layer_filter][fine]") {
    for (const std::string& medium : {std::string(), coloured_fog}) {
        const auto scene = scene_from(box(grey, medium), 24);
        const FineFeatures fine = find_fine_features(*scene, options_of(*scene), {64, 1.0f});
        const FilterFeatures coarse = features_of(*scene, 64);
        REQUIRE(fine.width == 48);
        REQUIRE(fine.reflected.size() == 4 * coarse.pixels());
        CHECK(fine.sharp);
        // Two of 64 rays may fall beyond an edge that none of the pixel's own have met. Media are marched
        // along the first ray of each, which is another one: on the mean they are alike.
        const float tolerance = medium.empty() ? 2.0f / 64.0f * glm::length(Rgb(0.6f, 0.5f, 0.4f)) : 0.2f;
        Vec3d difference(0.0);
        double pixels = 0.0;
        for (std::size_t p = 0; p < coarse.pixels(); ++p) {
            if (coarse.kind[p] != PixelKind::single) continue;
            const std::size_t q = p / 24 * 2 * 48 + p % 24 * 2;
            const Rgb mean = 0.25f * (fine.reflected[q] + fine.reflected[q + 1] + fine.reflected[q + 48] +
                                      fine.reflected[q + 49]);
            CHECK(glm::length(mean - coarse.reflected[p]) < tolerance);
            CHECK(glm::length(fine.normal[q] - coarse.shading_normal[p]) < 1e-3f);
            difference += Vec3d(mean - coarse.reflected[p]), pixels += 1.0;
        }
        CHECK(pixels > 300.0);
        CHECK(glm::length(difference / pixels) < 2e-3);
    }
}

TEST_CASE("A preview by our own filter is its picture", "[layer_filter]") {
    const auto scene = scene_from(box(grey, coloured_fog), 32);
    Film film = rendered(*scene, 8, 1);
    const std::size_t layer = layer_called(film, "indirect");
    const std::vector<Rgb> before = film.mean(layer);
    LayerFilter own(*scene, options_of(*scene), {}, {{layer, LayerKind::surface}});
    CHECK(own.apply_for_preview(film));
    const std::vector<Rgb> previewed = film.mean(layer);
    CHECK(previewed != before);
    own.apply(film);
    CHECK(film.mean(layer) == previewed);
}

TEST_CASE("What cannot be filtered is said", "[layer_filter]") {
    const auto scene = scene_from(box(grey, ""), 8);
    Film film(8, 8, {{"indirect", ""}});
    LayerFilter filter(*scene, options_of(*scene), {}, {{0, LayerKind::surface}});
    CHECK_THROWS_AS(filter.apply(film), std::invalid_argument);
    const std::atomic<bool> stop{true};
    RenderOptions options = options_of(*scene);
    options.cancelled = stop;
    CHECK_THROWS_AS(find_filter_features(*scene, options, {}), Cancelled);
}

TEST_CASE("the variance of a layer's mean is the spread over seeds", "[layer_filter][statistics][long]") {
    // Edges of a chequerboard, of a lamp in view and of what it lights: Sobol points show them much better
    // than independent ones. Of light reflected often they are no better.
    const std::string checkered =
        R"(<bsdf type="twosided"><bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
        <rgb name="color0" value="0.7, 0.6, 0.5"/><rgb name="color1" value="0.2, 0.3, 0.4"/>
        <transform name="to_uv"><scale x="7" y="7"/></transform></texture></bsdf></bsdf>)";
    const auto scene = scene_from(box(checkered, ""), 40);
    const auto integrator = integrator_from(R"(<integrator type="mote_layers"/>)");
    constexpr std::uint64_t seeds = 16;
    constexpr std::uint32_t passes = 128;
    std::vector<Film> films;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        films.emplace_back(40, 40, film_layers(*scene, *integrator, {}));
        PassRunner runner(*scene, *integrator, seed, films.back());
        const std::atomic<bool> never{false};
        while (films.back().pass_count() < passes) runner.run_pass(never);
    }
    for (const std::string name : {"emission", "direct", "indirect"}) {
        const std::size_t layer = layer_called(films[0], name);
        double points = 0.0, independent = 0.0, spread = 0.0;
        std::vector<Rgb> mean(films[0].pixels(), Rgb(0.0f));
        const double n = double(seeds) * double(mean.size());
        for (Film& film : films) {
            const LayerOfPasses of = layer_of_passes(film, layer, 2, PassVariance::points),
                                as_independent = layer_of_passes(film, layer, 2, PassVariance::independent);
            for (std::size_t p = 0; p < mean.size(); ++p) {
                mean[p] += of.mean[p] / float(seeds);
                points += double(average(of.variance[p])) / n;
                independent += double(average(as_independent.variance[p])) / n;
            }
        }
        for (const Film& film : films) spread += squared_error(film.mean(layer), mean) / (seeds - 1.0);
        INFO(name << ": spread " << spread << ", of points " << points << ", of independent passes "
                  << independent);
        CHECK(points / spread < 2.0);  // Eq. (2) of local_gain.h: by less than a doubling
        CHECK(points / spread > 0.5);
        if (name == "indirect")
            CHECK(independent / spread < 2.0);
        else
            CHECK(independent / spread > 4.0);
    }
}
