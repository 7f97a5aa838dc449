// Reflective shadow maps: the light that VPLs bring is that of particle tracing, for every kind of light that
// has a map, alone and among others; and maps represent all directions.
#include "lights/reflective_shadow_maps/reflective_shadow_maps.h"

#include <cmath>

#include "core/scene/scene.h"
#include "tests/lights/closed_box.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::lights;
using namespace mote::tests;

namespace {

/// Sums over the VPLs of a pass, cell by cell of 2 x 2 x 2 about the middle, of each channel, and of all
/// above.
constexpr int cells = 8, sums = 3 * cells;
using Sums = std::array<double, sums>;

Sums sums_of(const VplSet& set) {
    Sums s{};
    for (const VirtualPointLight& vpl : set.lights) {
        const int cell = (vpl.position.x > 0.1f) + 2 * (vpl.position.y > -0.2f) + 4 * (vpl.position.z > 0.0f);
        for (int c = 0; c < 3; ++c) s[std::size_t(3 * cell + c)] += double(vpl.intensity[c]);
    }
    return s;
}

struct Means {
    Sums mean{}, variance{};  ///< of the mean

    explicit Means(const std::vector<Sums>& passes) {
        const double n = double(passes.size());
        for (const Sums& s : passes)
            for (int i = 0; i < sums; ++i) mean[std::size_t(i)] += s[std::size_t(i)] / n;
        for (const Sums& s : passes)
            for (int i = 0; i < sums; ++i) {
                const double d = s[std::size_t(i)] - mean[std::size_t(i)];
                variance[std::size_t(i)] += d * d / (n * (n - 1));
            }
    }
};

/// The largest difference in standard errors; `scale` is a planted error of `b`.
double largest_z(const Means& a, const Means& b, double scale = 1.0) {
    double z = 0.0;
    for (std::size_t i = 0; i < sums; ++i) {
        const double difference = std::fabs(a.mean[i] - scale * b.mean[i]);
        const double deviation = std::sqrt(a.variance[i] + b.variance[i]);
        if (difference > 1e-5 * (a.mean[i] + b.mean[i])) z = std::max(z, difference / deviation);
    }
    return z;
}

template <typename Trace>
Means means_of(int passes, const Trace& trace) {
    std::vector<Sums> all;
    for (int k = 0; k < passes; ++k) all.push_back(sums_of(trace(std::uint32_t(k))));
    return Means(all);
}

std::unique_ptr<Scene> lit_by(const std::string& lights, const std::string& medium = "") {
    std::string xml = closed_box(
        R"(<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.5, 0.4"/></bsdf></bsdf>)",
        medium);
    const auto lamp = xml.find("<emitter");
    if (lamp != std::string::npos) xml.erase(lamp, xml.find("</emitter>", lamp) + 10 - lamp);
    xml.insert(xml.find("<sensor"), lights);
    return scene_from(xml);
}

const std::string point = R"(<emitter type="point"><point name="position" x="0.3" y="0.2" z="0.1"/>
    <rgb name="intensity" value="3, 2, 1"/></emitter>)";
const std::string spot =
    R"(<emitter type="spot"><rgb name="intensity" value="5, 6, 7"/><float name="cutoff_angle" value="50"/>
    <float name="beam_width" value="20"/><transform name="to_world">
    <lookat origin="-0.5, 0.6, 0.4" target="0.2, -0.3, -0.5" up="0, 1, 0"/></transform></emitter>)";
const std::string wide_spot =
    R"(<emitter type="spot"><rgb name="intensity" value="2, 1, 3"/><float name="cutoff_angle" value="80"/>
    <transform name="to_world"><lookat origin="0.1, 0.1, 0.1" target="0.9, 0.2, -0.5" up="0, 1, 0"/></transform></emitter>)";
const std::string sun = R"(<emitter type="directional"><vector name="direction" x="0.3" y="-1" z="0.2"/>
    <rgb name="irradiance" value="2, 3, 4"/></emitter>)";
const std::string panel =
    R"(<shape type="rectangle"><transform name="to_world"><scale value="0.2"/><translate z="-0.9"/></transform>
    <emitter type="area"><rgb name="radiance" value="20"/></emitter></shape>)";

}  // namespace

TEST_CASE("The measure of a map's pieces adds up to all that it shows", "[reflective_shadow_maps]") {
    const auto whole = [](const ShadowMapView& view) {
        constexpr int n = 400;
        double sum = 0.0;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
                sum += double(view.measure(Vec2(float(i) + 0.5f, float(j) + 0.5f) / float(n))) / (n * n);
        return sum;
    };
    const auto near = [](double value) { return Approx(value).epsilon(1e-4); };
    const Vec3 up(0, 0, 1);
    CHECK(whole(ShadowMapView::of_point(Vec3(0.0f), 8)) == near(4.0 * pi));
    CHECK(whole(ShadowMapView::of_surface(Vec3(0.0f), up, 8)) == near(2.0 * pi));
    CHECK(whole(ShadowMapView::of_parallel(up, Vec3(0.0f), 1.5f, 8)) == near(9.0));
    const double a = std::atan(1.0), square = 4.0 * std::asin(std::sin(a) * std::sin(a));  // of 90 degrees
    CHECK(whole(ShadowMapView::of_spot(Vec3(0.0f), up, float(a), 8)) == near(square));
    // And texel by texel, a direction lies where it is looked up.
    const auto view = ShadowMapView::of_point(Vec3(0.0f), 8);
    for (int texel = 0; texel < view.texels(); ++texel)
        CHECK(OctahedralMap{8}.texel(view.ray(texel).direction) == texel);
}

TEST_CASE("VPLs of reflective shadow maps have the mean of particle tracing", "[reflective_shadow_maps]") {
    const LightPathSettings first{.paths = 128, .max_vertices = 1}, all{.paths = 128, .max_vertices = 3};
    const struct {
        std::string name, lights, medium;
        LightPathSettings paths;
    } cases[] = {{"point", point, "", first},
                 {"spot", spot, "", first},
                 {"wide spot", wide_spot, "", first},
                 {"directional", sun, "", first},
                 {"all of them and a panel", point + spot + sun + panel, "", first},
                 {"three bounces", point + panel, "", all}};
    for (const auto& c : cases) {
        const auto scene = lit_by(c.lights, c.medium);
        const Means traced = means_of(800, [&](std::uint32_t pass) {
            return trace_light_paths(*scene, c.paths, 1, pass, SamplerKind::independent);
        });
        const ReflectiveShadowMaps maps(*scene, 10, 64);
        LightPathSettings settings = c.paths;
        settings.paths = maps.paths();
        const Means mapped = means_of(400, [&](std::uint32_t pass) {
            return trace_light_paths(*scene, settings, 2, pass, SamplerKind::independent, {}, &maps);
        });
        INFO(c.name);
        CHECK(largest_z(traced, mapped) < 4.5);
        CHECK(largest_z(traced, mapped, 1.05) > 4.5);
        // Texels are spread evenly over a point light's directions: less noise a pass, with fewer paths.
        if (c.name == "point") CHECK(400.0 * mapped.variance[0] < 0.6 * 800.0 * traced.variance[0]);
    }
}

TEST_CASE("Texels that all counted alike would be found out", "[reflective_shadow_maps]") {
    /// The solid angle of a texel taken for that of the mean one.
    struct Flat final : LightPathStarts {
        const ReflectiveShadowMaps& maps;
        explicit Flat(const ReflectiveShadowMaps& m) : maps(m) {}
        std::optional<LightPathStart> start(std::uint32_t path, Sampler& sampler) const override {
            auto begin = maps.start(path, sampler);
            if (begin) begin->power = Rgb(3, 2, 1) * 4.0f * pi / 100.0f;
            return begin;
        }
    };
    const auto scene = lit_by(point);
    const ReflectiveShadowMaps maps(*scene, 10, 64);
    REQUIRE(maps.paths() == 100);
    const Flat flat(maps);
    const LightPathSettings settings{.paths = 100, .max_vertices = 1};
    const Means traced = means_of(800, [&](std::uint32_t pass) {
        return trace_light_paths(*scene, {.paths = 128, .max_vertices = 1}, 1, pass,
                                 SamplerKind::independent);
    });
    const Means mapped = means_of(400, [&](std::uint32_t pass) {
        return trace_light_paths(*scene, settings, 2, pass, SamplerKind::independent, {}, &flat);
    });
    CHECK(largest_z(traced, mapped) > 4.5);
    CHECK_THROWS_AS(ReflectiveShadowMaps(*scene, 0, 1), std::invalid_argument);
}
