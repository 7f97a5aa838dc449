// Equi-angular sampling changes the noise of scattering in media, never its mean.
#include "integrators/path_tracing/equiangular.h"

#include <fmt/format.h>

#include <filesystem>

#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;
using mote::integrators::sample_equiangular;

namespace {

/// A point light and a spot light in the box, outside the medium: inside, light at collisions would have no
/// finite variance to test with.
std::string lit_box(const std::string& medium) {
    const std::string lights = R"(
        <emitter type="point"><point name="position" x="0.6" y="0.4" z="1.5"/>
            <rgb name="intensity" value="3, 3.5, 4"/></emitter>
        <emitter type="spot"><transform name="to_world"><lookat origin="-0.6, 0.7, 1.7" target="0, -0.4, 0"
            up="0, 0, 1"/></transform><rgb name="intensity" value="40, 30, 20"/></emitter>)";
    return with(without_area_light(box(grey, medium)), lights);  // the lamp would only add noise
}

/// `more`: settings of the paths that are lit along, `both`: of those and of the reference.
void check_equal(const std::string& xml, const std::string& more = "", const std::string& both = "") {
    const auto scene = scene_from(xml, 8);
    const auto render = [&](const std::string& settings, std::uint32_t passes, std::uint64_t seed) {
        return render_statistics(
            *scene, *integrator_from(fmt::format(R"(<integrator type="volpath">{}</integrator>)", settings)),
            {8, passes, seed});
    };
    const auto along = render(R"(<boolean name="equiangular" value="true"/>)" + more + both, 5000, 5);
    const auto reference = render(both, 10000, 6);
    for (const char* layer : {"direct", "single_scattering", "multiple_scattering", "beauty"}) {
        check_same_mean(along, layer, reference, layer, {1.1});
    }
}

}  // namespace

TEST_CASE("Equi-angular sampling keeps the mean in a homogeneous medium", "[equiangular][equality]") {
    check_equal(lit_box(fog("0.5, 1, 2", R"(<phase type="hg"><float name="g" value="0.5"/></phase>)")));
}

TEST_CASE("Equi-angular sampling keeps the mean of guided paths", "[equiangular][guiding][equality]") {
    check_equal(lit_box(fog("0.5, 1, 2", R"(<phase type="hg"><float name="g" value="0.5"/></phase>)")),
                R"(<string name="guiding" value="on"/><integer name="guiding_passes" value="6"/>)");
}

TEST_CASE("Equi-angular sampling keeps the mean of paths of three edges", "[equiangular][equality]") {
    check_equal(lit_box(fog("0.5, 1, 2", "")), "", R"(<integer name="max_depth" value="3"/>)");
}

TEST_CASE("Equi-angular sampling keeps the mean in a heterogeneous medium", "[equiangular][equality]") {
    const auto path = std::filesystem::temp_directory_path() / "mote_equiangular.vol";
    check_equal(lit_box(smoke_medium(path.string())));
    std::filesystem::remove(path);
}

TEST_CASE("Equi-angular sampling is quieter than collisions in thin fog", "[equiangular]") {
    // The point light alone: no other light shares the noise.
    const auto scene = scene_from(
        R"(<scene version="3.0.0"><shape type="cube"><bsdf type="null"/><medium type="homogeneous" name="interior">
        <float name="sigma_t" value="0.05"/></medium></shape>
        <emitter type="point"><point name="position" x="0.1" y="0.1" z="0"/></emitter>
        <sensor type="perspective"><float name="fov" value="40"/><transform name="to_world">
        <lookat origin="0, 0, 3" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)",
        8);
    const auto noise = [&](const char* value) {
        const auto xml = fmt::format(
            R"(<integrator type="volpath"><integer name="max_depth" value="2"/><boolean name="equiangular" value="{}"/>
            </integrator>)",
            value);
        const auto r = render_statistics(*scene, *integrator_from(xml), {4, 512, 1});
        return r.whole[r.layer("single_scattering")][1].variance_of_mean;
    };
    CHECK(noise("true") < 0.05 * noise("false"));
}

namespace {

/// A lamp in a cube of thin fog that scatters evenly.
constexpr double intensity = 5.0, sigma_t = 0.3, albedo = 0.8, half_edge = 2.0;
const char* const lamp_in_fog = R"(<scene version="3.0.0"><shape type="cube"><transform name="to_world">
    <scale value="2"/></transform><bsdf type="null"/><medium type="homogeneous" name="interior">
    <float name="sigma_t" value="0.3"/><float name="albedo" value="0.8"/></medium></shape>
    <emitter type="point"><rgb name="intensity" value="5"/></emitter>
    <sensor type="perspective"/></scene>)";

/// Light that reaches (0, 0, d) along the direction at the angle theta to the lamp, scattered once before
/// the border of the cube: in planes x = 0 and x = y it differs little, and the fog at both is averaged.
double light_towards_lamp(double d, double theta, double phi) {
    const core::Vec3d direction(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                -std::cos(theta));
    double border = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const double origin = axis == 2 ? d : 0.0, step = direction[axis];
        if (step != 0.0) border = std::min(border, (std::copysign(half_edge, step) - origin) / step);
    }
    // In the angle at the lamp, where 1/r^2 dt = dalpha / D.
    const double nearest = d * std::cos(theta), D = d * std::sin(theta);
    const double first = std::atan2(-nearest, D), last = std::atan2(border - nearest, D);
    constexpr int steps = 64;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double s = D * std::tan(first + (last - first) * (i + 0.5) / steps);
        sum += std::exp(-sigma_t * (nearest + s + std::sqrt(D * D + s * s)));
    }
    return sum / steps * (last - first) / D * sigma_t * albedo * intensity / (4.0 * double(core::pi));
}

/// Mean of samples and its variance.
struct Moments {
    double count = 0.0, sum = 0.0, squares = 0.0;
    void add(double x) { ++count, sum += x, squares += x * x; }
    double mean() const { return sum / count; }
    double variance_of_mean() const { return (squares / count - mean() * mean()) / (count - 1.0); }
};

/// Light that arrives from all sides, scattered again: its mean over directions.
double scattered_again(double d) {
    constexpr int thetas = 256, phis = 64;
    double sum = 0.0;
    for (int i = 0; i < thetas; ++i)
        for (int j = 0; j < phis; ++j) {
            const double theta = double(core::pi) * (i + 0.5) / thetas;
            sum += light_towards_lamp(d, theta, 2.0 * double(core::pi) * (j + 0.5) / phis) * std::sin(theta);
        }
    return sum * double(core::pi) / thetas / phis / 2.0;
}

}  // namespace

TEST_CASE("Light of a lamp in fog, scattered twice, is right and has no rare bright samples",
          "[equiangular]") {
    using namespace mote::core;
    const auto scene = scene_from(lamp_in_fog, 4);
    const integrators::EquiangularLights lights(*scene);
    const float pdf = inv_four_pi;
    for (const float d : {1.0f, 0.2f, 0.01f}) {
        ScatteringVertex vertex;
        vertex.position = Vec3(0.0f, 0.0f, d), vertex.wo = Vec3(0, 0, 1);
        WalkContext context;
        context.rng = Rng(7);
        const MediumState state = scene->eye_medium_state(Ray{vertex.position, vertex.wo});
        vertex.phase = &state.current()->phase();
        Moments own, around;
        double largest = 0.0;
        for (int i = 0; i < 200000; ++i) {
            const Vec3 wi =
                vertex.phase->sample(vertex.wo, {context.rng.next_float(), context.rng.next_float()}).wi;
            const Ray ray{vertex.position, wi};
            context.boundary_hits.clear();
            scene->boundaries_along(ray, context.boundary_hits);
            const Vec2 u{context.rng.next_float(), context.rng.next_float()};
            const Rgb along = lights.scattered_along(*scene, {ray, infinity, state, pdf}, u, context);
            const Rgb joint = lights.scattered_around_lamps(
                *scene, vertex, state,
                [&](const Vec3&) {
                    return ScatteringValue{Rgb(pdf), pdf};
                },
                context);
            own.add(double(along.x)), around.add(double(joint.x));
            largest = std::max({largest, double(along.x), double(joint.x)});
        }
        const double expected = scattered_again(double(d));
        const double mean = own.mean() + around.mean();
        const double deviation = std::sqrt(own.variance_of_mean() + around.variance_of_mean());
        INFO("at " << d << " m: " << mean << " +- " << deviation << ", expected " << expected);
        CHECK(std::fabs(mean - expected) < 4.5 * deviation + 1e-3 * expected);
        CHECK(deviation < 0.01 * expected);
        // Light along a ray is at most sigma_s I / (4 pi) pi / (d sin theta), and scattered by 1 / (4 pi)
        // over a density of 1 / (pi^2 sin theta) at least.
        CHECK(largest < double(pi) / 16.0 * sigma_t * albedo * intensity / double(d) * 1.001);
        CHECK_FALSE(std::fabs(own.mean() - expected) < 4.5 * deviation + 1e-3 * expected);
    }
}

TEST_CASE("An equi-angular density integrates to one", "[equiangular]") {
    // The mean of g(t) / p(t) is the integral of g: here of 1 over a finite ray, and of exp(-t) over an
    // infinite one.
    const core::Ray ray{core::Vec3(1, 2, 3), glm::normalize(core::Vec3(1, 1, -2)), 0.25f};
    for (const core::Vec3& light :
         {core::Vec3(2, 2, 2), ray.at(1.0f) + core::Vec3(0.02f, 0, 0), core::Vec3(-4, 0, 9),
          ray.at(-8.0f)}) {  // behind the ray, nearly on its line: all angles lie close to half of pi
        double length = 0.0, decay = 0.0;
        const int count = 200000;
        for (int i = 0; i < count; ++i) {
            const float u = (float(i) + 0.5f) / float(count);
            const auto finite = sample_equiangular(ray, 5.0f, light, u);
            const auto infinite = sample_equiangular(ray, core::infinity, light, u);
            REQUIRE((finite && infinite));
            REQUIRE((finite->t >= ray.t_min && finite->t <= 5.0f && infinite->t >= ray.t_min));
            length += 1.0 / finite->pdf_distance;
            decay += std::exp(-double(infinite->t)) / infinite->pdf_distance;
        }
        CHECK(length / count == Approx(4.75).epsilon(1e-3));
        CHECK(decay / count == Approx(std::exp(-0.25)).epsilon(1e-3));
    }
    CHECK_FALSE(sample_equiangular(ray, 0.25f, core::Vec3(0.0f), 0.5f));
}

TEST_CASE("Equi-angular sampling and a bound are refused together", "[equiangular]") {
    CHECK_THROWS_WITH(integrator_from(R"(<integrator type="volpath"><boolean name="equiangular" value="true"/>
        <float name="vpl_bound" value="2"/></integrator>)"),
                      ContainsSubstring("equiangular"));
}
