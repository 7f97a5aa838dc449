// mote_vsl against the path tracer: how far its blur puts it off, and what it buys on glossy surfaces.
#include <fmt/format.h>

#include <cmath>

#include "core/objects/error.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/grid_convergence.h"
#include "tests/support/render_statistics.h"

using namespace mote::tests;

namespace {

std::shared_ptr<const mote::core::Integrator> vsl(const std::string& settings) {
    return integrator_from(R"(<integrator type="mote_vsl">)" + settings + "</integrator>");
}
std::string number(const char* type, const char* name, double value) {
    return fmt::format(R"(<{} name="{}" value="{}"/>)", type, name, value);
}

/// Mean over blocks and channels of the squared difference of the indirect light, over the squared mean of
/// the reference; and what of it is noise of the two renders.
struct Difference {
    double squared, noise;
    double bias_squared() const { return squared - noise; }
};
Difference difference(const RenderStatistics& a, const std::string& layer,
                      const RenderStatistics& reference) {
    const auto& blocks = a.blocks[a.layer(layer)];
    const auto& expected = reference.blocks[reference.layer("indirect")];
    Difference d{0.0, 0.0};
    double mean = 0.0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const double delta = blocks[i].mean - expected[i].mean;
        d.squared += delta * delta;
        d.noise += blocks[i].variance_of_mean + expected[i].variance_of_mean;
        mean += expected[i].mean;
    }
    const double n = double(blocks.size());
    return {d.squared * n / (mean * mean), d.noise * n / (mean * mean)};
}

RenderStatistics reference_of(const mote::core::Scene& scene, int block, std::uint32_t passes) {
    return render_statistics(scene, *integrator_from(R"(<integrator type="path"/>)"), {block, passes, 22});
}

}  // namespace

TEST_CASE("the blur of spherical lights shrinks with their radius", "[vsl]") {
    const auto scene = scene_from(box(grey, ""), 8);
    const auto reference = reference_of(*scene, 4, 5000);
    const auto with_scale = [&](double scale, std::uint32_t passes) {
        return render_statistics(
            *scene, *vsl(number("float", "radius_scale", scale) + number("integer", "paths", 100)),
            {4, passes, 21});
    };
    const RenderStatistics wide_render = with_scale(2.0, 60);
    const Difference wide = difference(wide_render, "indirect_spherical", reference);
    const RenderStatistics narrow_render = with_scale(0.04, 150);
    const Difference narrow = difference(narrow_render, "indirect_spherical", reference);
    INFO(fmt::format("bias^2 {} +- noise {}; with a fiftieth of the radius {} +- {}", wide.bias_squared(),
                     wide.noise, narrow.bias_squared(), narrow.noise));
    CHECK(wide.bias_squared() > 10.0 * wide.noise);  // measured, not noise
    CHECK(narrow.bias_squared() < 0.1 * wide.bias_squared());
    // With narrow spheres the indirect light is right to the noise, and an error of 5 % would be seen.
    check_same_mean(narrow_render, "indirect_spherical", reference, "indirect", {1.05});
    // All else is computed as the path tracer does.
    check_same_mean(narrow_render, "direct", reference, "direct");
    CHECK_FALSE(
        same_mean(wide_render, "indirect_spherical", reference, "indirect", OnFailure::nothing).passed);
}

// The blur is at least of the first order in the radius, so spheres of four, two and one times a radius show
// how far the last may be off (tests/support/grid_convergence.h), besides the noise.
TEST_CASE("both kinds of visibility come near the path tracer; max_depth counts the whole path", "[vsl]") {
    const auto scene = scene_from(box(mixed, ""), 8);
    for (const int depth : {2, 3}) {
        const std::string limit = number("integer", "max_depth", depth);
        const auto reference = render_statistics(
            *scene, *integrator_from(R"(<integrator type="path">)" + limit + "</integrator>"), {8, 4000, 5});
        const Estimate expected = reference.whole[reference.layer("indirect")][0];
        CHECK((expected.mean > 0.0) == (depth == 3));
        for (const char* visibility : {"sample", "light"}) {
            const auto indirect = [&](double radius) {
                const auto render = render_statistics(
                    *scene,
                    *vsl(limit + number("integer", "paths", 100) + number("float", "radius_scale", radius) +
                         fmt::format(R"(<string name="visibility" value="{}"/>)", visibility)),
                    {8, 30, 6});
                return render.whole[render.layer("indirect_spherical")][0];
            };
            const Estimate narrow = indirect(0.3), wide = indirect(0.6), widest = indirect(1.2);
            const double blur = grid_convergence_index({widest.mean, wide.mean, narrow.mean}, 1.0, 2.0);
            // The radii share their light paths, so the noise of `blur` is below that of the last.
            const double noise = 4.5 * std::sqrt(narrow.variance_of_mean + expected.variance_of_mean);
            INFO(visibility << ", depth " << depth << ": " << narrow.mean << " against " << expected.mean
                            << ", blur up to " << blur << ", noise " << noise);
            CHECK((narrow.mean > 0.0) == (depth == 3));
            CHECK(std::fabs(narrow.mean - expected.mean) <= blur + noise);
            CHECK(blur + noise <= 0.2 * expected.mean);  // what the comparison would see
        }
    }
}

// Points over a glossy floor in a diffuse room are splotches: f / d^2 grows without bound in the corners and
// in the reflection of every point. At equal passes and light paths the error of spheres is far smaller, bias
// and all.
TEST_CASE("spherical lights have less error than points on glossy surfaces", "[vsl]") {
    const std::string shiny =
        R"(<bsdf type="twosided"><bsdf type="roughconductor"><float name="alpha" value="0.08"/>
        <rgb name="specular_reflectance" value="0.7"/></bsdf></bsdf>)";
    std::string xml = box(grey, "");
    for (const char* shape : {"angle=\"-90\"/>", "type=\"cube\""})  // floor and block
        xml.replace(xml.find(grey, xml.find(shape)), grey.size(), shiny);
    const auto scene = scene_from(xml, 12);
    const auto reference = reference_of(*scene, 1, 4000);
    const std::string paths = number("integer", "paths", 400);
    // Points have a long tail: one seed may miss the brightest splotches, so that errors are summed over
    // seeds.
    double error_of_points = 0.0, error_of_spheres = 0.0, noise_of_points = 0.0, noise_of_spheres = 0.0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const RenderSpec spec{1, 8, seed};
        const Difference points = difference(
            render_statistics(
                *scene,
                *integrator_from(R"(<integrator type="mote_vpl"><float name="bound" value="-1"/>)" + paths +
                                 "</integrator>"),
                spec),
            "indirect", reference);
        const Difference spheres =
            difference(render_statistics(*scene, *vsl(paths), spec), "indirect_spherical", reference);
        UNSCOPED_INFO(
            fmt::format("seed {}: squared error and noise of points {:.4g} {:.4g}, of spheres {:.4g} {:.4g}",
                        seed, points.squared, points.noise, spheres.squared, spheres.noise));
        error_of_points += points.squared, noise_of_points += points.noise;
        error_of_spheres += spheres.squared, noise_of_spheres += spheres.noise;
    }
    CHECK(2.0 * error_of_spheres < error_of_points);
    CHECK(3.0 * noise_of_spheres < noise_of_points);
}

TEST_CASE("mote_vsl refuses media and wrong settings", "[vsl][input]") {
    const auto foggy = scene_from(box(grey, fog("1", "")), 4);
    CHECK_THROWS_AS(vsl("")->prepare(*foggy, {}), mote::core::InputError);
    for (const std::string& wrong :
         {number("integer", "samples", 0), number("integer", "neighbours", 0), number("integer", "paths", -1),
          number("float", "radius_scale", -1), std::string(R"(<string name="visibility" value="samples"/>)")})
        CHECK_THROWS_AS(vsl(wrong), mote::core::InputError);
}
