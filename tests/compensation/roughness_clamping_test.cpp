// Lobes as wide as the light around them is known: the limit of their peak, what it leaves alone, and that it
// goes away with more lights.
#include "compensation/roughness_clamping.h"

#include "core/math/warp.h"
#include "core/scene/scene.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;

namespace {

std::shared_ptr<const Bsdf> bsdf_of(const std::string& xml) {
    const auto scene =
        scene_from(R"(<scene version="3.0.0"><shape type="rectangle">)" + xml +
                   R"(</shape><emitter type="constant"/><sensor type="perspective"/></scene>)");
    return scene->shapes()[0]->bsdf;
}

const std::string lobes[] = {
    R"(<bsdf type="roughconductor"><float name="alpha" value="0.02"/></bsdf>)",
    R"(<bsdf type="roughconductor"><string name="distribution" value="ggx"/><float name="alpha_u" value="0.02"/>
        <float name="alpha_v" value="0.1"/></bsdf>)",
    R"(<bsdf type="roughdielectric"><float name="alpha" value="0.03"/></bsdf>)",
    R"(<bsdf type="phong"><float name="exponent" value="5000"/><rgb name="diffuse_reflectance" value="0"/>
        <rgb name="specular_reflectance" value="0.9"/></bsdf>)",
    R"(<bsdf type="principled"><float name="roughness" value="0.15"/><float name="metallic" value="1"/></bsdf>)"};

/// Highest f cos over directions around the mirror direction of wo, and its integral, with a limit.
struct Lobe {
    double peak = 0.0, integral = 0.0;
};
Lobe lobe_of(const Bsdf& bsdf, const Vec3& wo, float limit) {
    Lobe lobe;
    constexpr int n = 600;
    BsdfPoint p;
    p.peak_limit = limit;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const Vec3 wi = square_to_cosine_hemisphere({(float(i) + 0.5f) / n, (float(k) + 0.5f) / n});
            const double f = double(max_component(bsdf.eval(p, wo, wi, TransportMode::radiance)));
            lobe.peak = std::max(lobe.peak, f * double(wi.z));
            lobe.integral += f * double(pi) / (n * n);
        }
    return lobe;
}

}  // namespace

TEST_CASE("no lobe peaks above its limit, and a limit that is far away changes nothing", "[roughness]") {
    const std::string xml =
        GENERATE(from_range(std::vector<std::string>(std::begin(lobes), std::end(lobes))));
    const auto bsdf = bsdf_of(xml);
    const Vec3 wo = glm::normalize(Vec3(0.3f, 0.2f, 1.0f));
    CAPTURE(xml);
    const Lobe free = lobe_of(*bsdf, wo, infinity), far = lobe_of(*bsdf, wo, 1e9f);
    CHECK(far.peak == free.peak);
    CHECK(far.integral == free.integral);
    for (const float limit : {2.0f, 0.7f}) {
        const Lobe limited = lobe_of(*bsdf, wo, limit);
        REQUIRE(free.peak > double(limit));
        // The limit is that of D over half vectors; off the normal, factors beside D move by a few per cent.
        CHECK(limited.peak < 1.1 * double(limit));
        CHECK(limited.peak > 0.4 * double(limit));
        // Widened, not bounded: most of the light is still there, where a bound would leave next to nothing.
        CHECK(limited.integral > 0.6 * free.integral);
    }
}

TEST_CASE("what has no lobe is left alone", "[roughness]") {
    for (const std::string& xml : {grey, std::string(R"(<bsdf type="diffuse"/>)")}) {
        const auto bsdf = bsdf_of(xml);
        const Vec3 wo = glm::normalize(Vec3(0.3f, 0.2f, 1.0f));
        CHECK(lobe_of(*bsdf, wo, 0.01f).integral == lobe_of(*bsdf, wo, infinity).integral);
    }
}

TEST_CASE("the density of lights is that of their neighbours", "[roughness]") {
    // A lattice of lights, 0.1 apart: 100 a square metre.
    lights::VplSet vpls;
    for (int i = 0; i < 40; ++i)
        for (int k = 0; k < 40; ++k) {
            lights::VirtualPointLight vpl;
            vpl.position = Vec3(0.1f * float(i), 0.1f * float(k), 0.0f);
            vpl.normal = vpl.shading_normal = Vec3(0, 0, 1);
            vpls.lights.push_back(vpl);
        }
    lights::VirtualPointLight in_fog;  // has no neighbours
    vpls.lights.push_back(in_fog);
    compensation::clamp_roughness(vpls, {true, 16});
    // 16 neighbours of the middle: within 0.224 (the 20th) lie 20 others; ties make it that radius.
    const float middle = vpls.peak_density[20 * 40 + 20] * 16.0f;
    CHECK(middle > 75.0f);
    CHECK(middle < 130.0f);
    CHECK(vpls.peak_density.back() == infinity);
    const float whole = vpls.peak_density[20 * 40 + 20];
    compensation::clamp_roughness(vpls, {true, 16}, 0.25f);
    CHECK(vpls.peak_density[20 * 40 + 20] == Approx(0.25f * whole));

    lights::VplSet alone;
    alone.lights.push_back(vpls.lights[0]);
    compensation::clamp_roughness(alone, {true, 16});
    CHECK(alone.peak_density[0] == 0.0f);  // nothing is known: as rough as can be
}

TEST_CASE("roughness clamping takes spikes and goes away with more lights", "[roughness][statistics]") {
    const std::string metal =
        R"(<bsdf type="twosided"><bsdf type="roughconductor"><float name="alpha" value="0.08"/>
        <rgb name="specular_reflectance" value="0.7"/></bsdf></bsdf>)";
    const auto scene = scene_from(box(metal, ""), 8);
    const auto render = [&](int paths, const std::string& settings) {
        const auto integrator = integrator_from(fmt::format(
            R"(<integrator type="mote_vpl"><integer name="paths" value="{}"/><integer name="max_depth" value="3"/>
            <float name="bound" value="-1"/>{}</integrator>)",
            paths, settings));
        const auto found =
            render_statistics(*scene, *integrator, {.block = 8, .passes = std::uint32_t(4000 / paths)});
        return found.whole[found.layer("indirect")][1];
    };
    const std::string clamped = R"(<boolean name="roughness_clamping" value="true"/>)";
    const Estimate few = render(50, ""), few_clamped = render(50, clamped),
                   many_clamped = render(1000, clamped);
    CAPTURE(few.mean, few_clamped.mean, many_clamped.mean, few.variance_of_mean,
            few_clamped.variance_of_mean);
    // Variance over passes of the image's mean, of equal light paths, falls to a fraction.
    CHECK(few_clamped.variance_of_mean < 0.2 * few.variance_of_mean);
    CHECK(few_clamped.mean > 0.3 * many_clamped.mean);
}
