// Features of the first hit: against closed forms, with their variance; beside the picture of any integrator
// without changing it; the same bits on any number of threads and after a resume.
#include "core/render/first_hit_features.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "core/film/film_image.h"
#include "core/formats/xml/scene_loader.h"
#include "core/objects/error.h"
#include "core/render/camera_ray.h"
#include "core/render/render_driver.h"
#include "integrators/eye_path/eye_ray.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::tests;
using core::Rgb, core::Vec2, core::Vec3;

namespace {

constexpr int width = 6, height = 4;

/// A sensor at (0, 0, 5) that looks down the z axis: x grows to the right, y up.
std::string sensor(const std::string& type, const std::string& more, const std::string& filter = "box") {
    return fmt::format(
        R"(<sensor type="{}"><transform name="to_world">{}<lookat origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/>
        </transform>{}<sampler type="independent"/><film type="hdrfilm"><integer name="width" value="{}"/>
        <integer name="height" value="{}"/><rfilter type="{}"/></film></sensor>)",
        type, type == "orthographic" ? R"(<scale x="3" y="3"/>)" : "", more, width, height, filter);
}
const std::string wide_view = R"(<float name="fov" value="60"/>)";
const std::string plane =
    R"(<shape type="rectangle"><transform name="to_world"><scale value="20"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.2, 0.4, 0.6"/></bsdf></shape>)";
/// The half plane x > 0.3.
const std::string half_plane =
    R"(<shape type="rectangle"><transform name="to_world"><scale value="20"/><translate x="20.3"/></transform>
    <bsdf type="diffuse"/></shape>)";
const std::string lamp = R"(<emitter type="point"><point name="position" x="1" y="1" z="4"/></emitter>)";

std::unique_ptr<core::Scene> scene_of(const std::string& body) {
    return core::load_scene_from_string("<scene version=\"3.0.0\">" + body + "</scene>", ".", registry());
}

std::size_t layer_of(const core::Film& film, const std::string& name) {
    for (std::size_t i = 0; i < film.layers().size(); ++i)
        if (film.layers()[i].name == name) return i;
    throw std::out_of_range("no layer " + name);
}

core::RenderRequest request_of(const core::Scene& scene, std::uint32_t passes, bool features = true) {
    core::RenderRequest request;
    request.stop.passes = passes;
    if (features) request.features = core::first_hit_features(scene);
    return request;
}

core::Film film_of(const core::Scene& scene, std::uint32_t passes, const std::string& integrator = "path") {
    return core::render(scene, *integrator_from("<integrator type=\"" + integrator + "\"/>"),
                        request_of(scene, passes))
        .film;
}

/// Within five standard errors of the film's own, in every channel; the floor is rounding.
bool agrees(const core::Film& film, const std::string& layer, std::size_t pixel, const Rgb& expected) {
    const std::size_t i = layer_of(film, layer);
    const Rgb mean = film.mean(i)[pixel], variance = film.layer_variance_of_mean(i)[pixel];
    for (int c = 0; c < 3; ++c)
        if (!(std::fabs(mean[c] - expected[c]) <= 5.0f * std::sqrt(variance[c]) + 2e-6f)) return false;
    return true;
}

/// Where the plane z = 0 is seen through a film position, in units of half the picture's width at distance 1.
Vec2 on_plane(double x, double y, double scale) {
    return {float(scale * (2.0 * x / width - 1.0)),
            float(scale * (1.0 - 2.0 * y / height) * double(height) / width)};
}

template <typename Check>
void for_each_pixel(const Check& check) {
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            CAPTURE(x, y);
            check(x, y, std::size_t(y * width + x));
        }
}

}  // namespace

TEST_CASE("a plane has the features of the closed form, through the filter", "[render][features]") {
    const double scale = 5.0 * std::tan(glm::radians(30.0));
    for (const std::string filter : {"box", "tent", "gaussian"}) {
        INFO(filter);
        const auto scene = scene_of(plane + lamp + sensor("perspective", wide_view, filter));
        const core::Film film = film_of(*scene, 2000);
        for_each_pixel([&](int x, int y, std::size_t i) {
            // Positions are affine in the film, so a symmetric filter's mean is the pixel's middle.
            const Vec2 p = on_plane(x + 0.5, y + 0.5, scale);
            CHECK(agrees(film, "P", i, Vec3(p, 0.0f)));
            CHECK(film.mean(layer_of(film, "N"))[i] == Vec3(0, 0, 1));
            CHECK(film.mean(layer_of(film, "Ns"))[i] == Vec3(0, 0, 1));
            CHECK(glm::length(film.mean(layer_of(film, "Albedo"))[i] - Rgb(0.2f, 0.4f, 0.6f)) < 1e-6f);
            CHECK(film.mean(layer_of(film, "Coverage"))[i].x == 1.0f);
        });
        // Planted: the neighbour's.
        CHECK_FALSE(agrees(film, "P", 8, Vec3(on_plane(3.5, 1.5, scale), 0.0f)));
    }
}

TEST_CASE("features see a mask as often as it is there, and look through glass", "[render][features][mask]") {
    // 1 m before the plane, 0.3 of it solid; a pane before that.
    const std::string mask =
        R"(<shape type="rectangle"><transform name="to_world"><scale value="20"/><translate z="1"/></transform>
        <bsdf type="mask"><float name="opacity" value="0.3"/><bsdf type="diffuse"><rgb name="reflectance" value="1, 0.5, 0"/>
        </bsdf></bsdf></shape>
        <shape type="rectangle"><transform name="to_world"><scale value="20"/><translate z="2"/></transform>
        <bsdf type="thindielectric"/></shape>)";
    const auto scene = scene_of(plane + mask + lamp + sensor("orthographic", ""));
    const core::Film film = film_of(*scene, 4000);
    for_each_pixel([&](int, int, std::size_t i) {
        CHECK(agrees(film, "Depth", i, Rgb(0.3f * 4.0f + 0.7f * 5.0f)));
        CHECK(agrees(film, "Albedo", i, 0.3f * Rgb(1.0f, 0.5f, 0.0f) + 0.7f * Rgb(0.2f, 0.4f, 0.6f)));
        // Planted: 0.4 of it solid. 4000 passes see 0.1 m as 14 standard errors.
        CHECK_FALSE(agrees(film, "Depth", i, Rgb(0.4f * 4.0f + 0.6f * 5.0f)));
    });
}

TEST_CASE("depth and the variance of features are those of the box filter", "[render][features]") {
    const double scale = 5.0 * std::tan(glm::radians(30.0));
    constexpr std::uint32_t passes = 4000;
    const auto scene = scene_of(plane + lamp + sensor("perspective", wide_view));
    const core::Film film = film_of(*scene, passes);
    const std::vector<Rgb> variance = film.layer_variance_of_mean(layer_of(film, "P"));
    double sum = 0.0;
    for_each_pixel([&](int x, int y, std::size_t i) {
        double depth = 0.0;  // by the midpoint rule, right to 1e-6
        for (int k = 0; k < 400; ++k) {
            const Vec2 p = on_plane(x + (k % 20 + 0.5) / 20.0, y + (k / 20 + 0.5) / 20.0, scale);
            depth += std::sqrt(25.0 + double(p.x) * p.x + double(p.y) * p.y) / 400.0;
        }
        CHECK(agrees(film, "Depth", i, Rgb(float(depth))));
        sum += double(variance[i].x) * passes;
    });
    // A pixel is w wide on the plane: x is even over it. The sample variance s^2 of n even numbers has the
    // variance (w^4/80 - w^4/144)/n.
    const double w = 2.0 * scale / width, n = double(passes) * width * height;
    CHECK(std::fabs(sum / (width * height) - w * w / 12.0) <
          5.0 * std::sqrt((1.0 / 80.0 - 1.0 / 144.0) / n) * w * w);
}

TEST_CASE("at an edge, features are means over what is there", "[render][features]") {
    const double scale = 3.0;
    const auto scene = scene_of(half_plane + lamp + sensor("orthographic", ""));
    const core::Film film = film_of(*scene, 2000);
    const core::ImageChannels image = core::film_image(film);
    REQUIRE(image.find("Coverage.Y"));
    REQUIRE(image.find("Depth.Z"));
    REQUIRE(image.find("Variance.Depth.Z"));
    REQUIRE(image.find("Variance.P.X"));
    REQUIRE(image.find("Variance.Albedo.R"));
    for_each_pixel([&](int x, int y, std::size_t i) {
        const float left = on_plane(x, 0.0, scale).x, right = on_plane(x + 1, 0.0, scale).x;
        const float from = std::fmax(left, 0.3f);
        const double covered = std::fmax(0.0, double(right - from)) / double(right - left);
        const float coverage = (*image.find("Coverage.Y"))[i], depth = (*image.find("Depth.Z"))[i];
        CHECK(std::fabs(double(coverage) - covered) <=
              5.0 * std::sqrt(covered * (1.0 - covered) / 2000.0) + 1e-6);
        if (covered == 0.0) {
            CHECK(std::isinf(depth));
            CHECK(film.mean(layer_of(film, "P"))[i] == Vec3(0.0f));
            CHECK(film.mean(layer_of(film, "Albedo"))[i] == Rgb(0.0f));
            return;
        }
        CHECK(depth == Approx(5.0).epsilon(1e-6));
        CHECK((*image.find("Variance.Depth.Z"))[i] == Approx(0.0).margin(1e-9));
        CHECK(agrees(film, "P", i, {0.5f * (from + right), on_plane(0.0, y + 0.5, scale).y, 0.0f}));
        // Normals and albedo count misses as zero.
        CHECK(film.mean(layer_of(film, "N"))[i].z == Approx(coverage).epsilon(1e-6));
        CHECK(film.mean(layer_of(film, "Albedo"))[i].y == Approx(0.5 * double(coverage)).epsilon(1e-6));
    });
}

TEST_CASE("the transmittance to the first hit, in scenes with media alone", "[render][features]") {
    // Two metres of fog before the plane.
    const std::string fog = R"(<shape type="cube"><transform name="to_world"><scale x="10" y="10"/>
        <translate z="2"/></transform><bsdf type="null"/><medium type="homogeneous" name="interior">
        <rgb name="sigma_t" value="0.1, 0.5, 2"/></medium></shape>)";
    const auto clear = scene_of(plane + lamp + sensor("orthographic", ""));
    CHECK(core::first_hit_features(*clear).size() + 1 ==
          core::first_hit_features(*scene_of(plane + fog + lamp + sensor("orthographic", ""))).size());
    const auto scene = scene_of(plane + fog + lamp + sensor("orthographic", ""));
    const core::Film film = film_of(*scene, 4, "volpath");
    const Rgb mean = film.mean(layer_of(film, "Transmittance"))[7];
    CHECK(mean.x == Approx(std::exp(-0.2)).epsilon(1e-5));
    CHECK(mean.y == Approx(std::exp(-1.0)).epsilon(1e-5));
    CHECK(mean.z == Approx(std::exp(-4.0)).epsilon(1e-5));
}

TEST_CASE("features follow the very rays of the eye paths", "[render][features]") {
    const auto scene = scene_of(
        plane + lamp +
        sensor("thinlens", wide_view + R"(<float name="aperture_radius" value="0.5"/>)", "gaussian"));
    const auto filter = core::make_pixel_filter("gaussian", 2.0f, 0.5f);
    const std::atomic<bool> never{false};
    for (const core::SamplerKind kind : {core::SamplerKind::sobol, core::SamplerKind::independent})
        for (std::uint32_t pass = 0; pass < 40; ++pass) {
            const core::RenderOptions options{5, width, height, kind};
            const core::PassContext context{pass, *filter, never};
            for_each_pixel([&](int x, int y, std::size_t) {
                const core::Ray a = core::camera_ray(scene->camera(), options, context, x, y),
                                b = integrators::make_eye_ray(*scene, options, context, x, y).ray;
                CHECK((a.origin == b.origin && a.direction == b.direction && a.t_min == b.t_min));
            });
        }
}

TEST_CASE("every integrator has features beside its picture, and keeps its bits", "[render][features]") {
    // Fog and one point light suit all of them but those for surfaces, which refuse media.
    const std::string fog = R"(<shape type="cube"><transform name="to_world"><scale value="2"/></transform>
        <bsdf type="null"/><medium type="homogeneous" name="interior"><rgb name="sigma_t" value="0.3"/></medium>
        </shape>)";
    const auto foggy = scene_of(plane + fog + lamp + sensor("perspective", wide_view)),
               clear = scene_of(plane + lamp + sensor("perspective", wide_view));
    const std::vector<std::string> types = registry().types(core::Category::integrator);
    REQUIRE(types.size() >= 7);
    for (const std::string& type : types) {
        INFO(type);
        const bool bundles = type == "mote_ray_bundles", points = type == "mote_micro_rendering";
        const auto& scene =
            type == "mote_vsl" || type == "mote_vpl_ray_bundles" || bundles || points ? clear : foggy;
        // The default exchanges light along more directions than features need.
        const std::string few =
            bundles  ? R"(<integer name="directions" value="16"/><integer name="texel_budget" value="1000"/>)"
            : points ? R"(<integer name="points" value="200"/><integer name="micro_buffer" value="4"/>)"
                     : "";
        const auto integrator = integrator_from("<integrator type=\"" + type + "\">" + few + "</integrator>");
        const auto plain = core::render(*scene, *integrator, request_of(*scene, 3, false));
        const auto with = core::render(*scene, *integrator, request_of(*scene, 3));
        const std::size_t own = plain.film.layers().size();
        // Those of the first part of a picture that has several.
        const std::uint32_t passes = with.film.pass_count(0);
        const core::Film expected = film_of(*scene, passes);
        REQUIRE(with.film.layers().size() == own + core::first_hit_features(*scene).size());
        for (std::size_t i = 0; i < own; ++i) CHECK(with.film.mean(i) == plain.film.mean(i));
        CHECK(with.film.beauty() == plain.film.beauty());
        CHECK(with.film.beauty_variance_of_mean() == plain.film.beauty_variance_of_mean());
        CHECK(with.film.noise() == plain.film.noise());
        for (const core::HitFeature& feature : core::first_hit_features(*scene)) {
            const std::string& layer = feature.layer.name;
            CHECK(with.film.mean(layer_of(with.film, layer)) == expected.mean(layer_of(expected, layer)));
        }
        CHECK(with.statistics.rays.at("closest") ==
              (plain.statistics.rays.contains("closest") ? plain.statistics.rays.at("closest") : 0) +
                  passes * width * height);
    }
}

TEST_CASE("features have the same bits on one thread and on many", "[render][features]") {
    const auto scene = scene_of(half_plane + lamp + sensor("perspective", wide_view, "gaussian"));
    const auto many = film_of(*scene, 20).serialize();
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    CHECK(film_of(*scene, 20).serialize() == many);
}

TEST_CASE("a resumed render has the bits of its features too", "[render][features]") {
    const TemporaryFolder folder;
    const auto scene = scene_of(half_plane + lamp + sensor("perspective", wide_view, "gaussian"));
    const auto path = integrator_from(R"(<integrator type="path"/>)");
    const auto whole = core::render(*scene, *path, request_of(*scene, 21));
    core::RenderRequest request = request_of(*scene, 9);
    request.checkpoint_path = folder.file("c"), request.content_hash = "same";
    core::render(*scene, *path, request);
    request.stop.passes = 21, request.resume = true;
    const auto resumed = core::render(*scene, *path, request);
    CHECK(resumed.resumed_at == 9);
    CHECK(resumed.film.serialize() == whole.film.serialize());
    // A render without features is another render.
    request.features.clear();
    CHECK_THROWS_AS(core::render(*scene, *path, request), core::InputError);
}
