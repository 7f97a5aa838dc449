// Features seen in near mirrors and through glass, against their closed forms.
#include "core/render/mirrored_features.h"

#include <fmt/format.h>

#include "core/formats/xml/scene_loader.h"
#include "core/render/render_driver.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;
using core::Rgb, core::Vec3;

namespace {

constexpr int width = 6, passes = 200;

/// A picture of one line, 6 m wide and 1 m high, seen straight on; a surface at z = 0, and 10 m before it,
/// behind the camera, a wall, whose right half (x > 0) is a lamp.
std::unique_ptr<core::Scene> room(const std::string& surface, const std::string& more = "") {
    return core::load_scene_from_string(
        fmt::format(
            R"(<scene version="3.0.0"><shape type="rectangle"><transform name="to_world"><scale value="50"/></transform>{}</shape>
            <shape type="rectangle"><transform name="to_world"><rotate y="1" angle="180"/><scale value="50"/><translate x="-50" z="10"/></transform>
            <bsdf type="diffuse"><rgb name="reflectance" value="0.2, 0.4, 0.6"/></bsdf></shape>
            <shape type="rectangle"><transform name="to_world"><rotate y="1" angle="180"/><scale value="50"/><translate x="50" z="10"/></transform>
            <emitter type="area"><rgb name="radiance" value="3, 2, 1"/></emitter></shape>{}
            <sensor type="orthographic"><transform name="to_world"><scale x="3" y="3"/>
            <lookat origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/></transform><sampler type="independent"/>
            <film type="hdrfilm"><integer name="width" value="{}"/><integer name="height" value="1"/>
            <rfilter type="box"/></film></sensor></scene>)",
            surface, more, width),
        ".", registry());
}

class Features {
  public:
    explicit Features(const core::Scene& scene) : film_(made(scene)) {}

    Rgb mean(const std::string& name, int x) const { return film_.mean(layer(name))[std::size_t(x)]; }
    /// Within five standard errors of the film's own; the floor is rounding.
    bool agrees(const std::string& name, int x, const Rgb& expected) const {
        const Rgb variance = film_.layer_variance_of_mean(layer(name))[std::size_t(x)];
        for (int c = 0; c < 3; ++c)
            if (!(std::fabs(mean(name, x)[c] - expected[c]) <= 5.0f * std::sqrt(variance[c]) + 1e-5f))
                return false;
        return true;
    }

  private:
    static core::Film made(const core::Scene& scene) {
        core::RenderRequest request;
        request.stop.passes = passes;
        request.features = core::mirrored_features(scene);
        return core::render(scene, *integrator_from("<integrator type=\"path\"/>"), request).film;
    }
    std::size_t layer(const std::string& name) const {
        for (std::size_t i = 0; i < film_.layers().size(); ++i)
            if (film_.layers()[i].name == "Mirrored." + name) return i;
        throw std::out_of_range("no layer " + name);
    }

    core::Film film_;
};

const std::string smooth = R"(<bsdf type="conductor"><string name="material" value="none"/></bsdf>)";
std::string rough(float alpha) {
    return fmt::format(
        R"(<bsdf type="roughconductor"><float name="alpha" value="{}"/><string name="material" value="none"/></bsdf>)",
        alpha);
}

}  // namespace

TEST_CASE("a mirror's features are those of what it shows", "[render][features][mirrored]") {
    const Features f(*room(smooth));
    for (int x = 0; x < width; ++x) {
        CAPTURE(x);
        const float at = float(x) - 2.5f;
        CHECK(f.agrees("P", x, Vec3(at, 0, 10)));
        CHECK(f.agrees("Ns", x, Vec3(0, 0, -1)));
        CHECK(f.agrees("Emission", x, at > 0.0f ? Rgb(3, 2, 1) : Rgb(0.0f)));
        if (at < 0.0f) CHECK(f.agrees("Albedo", x, Rgb(0.2f, 0.4f, 0.6f)));
        CHECK_FALSE(f.agrees("P", x, Vec3(at, 0, 0)));  // planted: the mirror's own
    }
}

TEST_CASE("a rough mirror blurs its features as it blurs the picture", "[render][features][mirrored]") {
    // Neither side is preferred, so all pixels together see half of the lamp. Of Beckmann's lobe, exp(-t) /
    // (4 pi a^2) seen from in front, what lies below one per steradian is left out: 4 pi a^2 of it.
    const Features f(*room(rough(0.05f)));
    float sum = 0.0f;
    for (int x = 0; x < width; ++x) sum += f.mean("Emission", x).x;
    const float expected = 0.5f * 3.0f * (1.0f - 4.0f * core::pi * 0.05f * 0.05f);
    // 1200 stratified means of 64: no more than 3 sqrt(1/4 / 64 / 1200) each way.
    CHECK(std::fabs(sum / width - expected) < 5.0f * 3.0f * 0.5f / std::sqrt(64.0f * 1200.0f));
    CHECK(f.mean("Emission", 2).x > 0.1f);
    CHECK(f.mean("Emission", 3).x < 2.9f);
    CHECK(f.mean("Emission", 2).x < f.mean("Emission", 3).x);
}

TEST_CASE("glass shows what is behind it, and what it reflects", "[render][features][mirrored]") {
    const std::string behind =
        R"(<shape type="rectangle"><transform name="to_world"><scale value="50"/><translate z="-4"/></transform>
        <emitter type="area"><rgb name="radiance" value="7, 7, 7"/></emitter></shape>)";
    const Features f(*room(R"(<bsdf type="dielectric"><float name="int_ior" value="1.5"/></bsdf>)", behind));
    const float reflected = 0.04f;  // ((1.5 - 1) / (1.5 + 1))^2
    CHECK(f.agrees("Emission", 0, Rgb(7.0f * (1.0f - reflected))));
    CHECK(f.agrees("Emission", 5, Rgb(7.0f * (1.0f - reflected)) + reflected * Rgb(3, 2, 1)));
    CHECK_FALSE(f.agrees("Emission", 5, Rgb(7.0f)));  // planted: nothing is reflected
}

TEST_CASE("mirrors in mirrors end, and scenes without mirrors have no such features",
          "[render][features][mirrored]") {
    // A second mirror stands before the wall: what is seen in both is followed four times.
    const std::string opposite =
        R"(<shape type="rectangle"><transform name="to_world"><rotate y="1" angle="180"/><scale value="50"/><translate z="8"/></transform>)" +
        smooth + "</shape>";
    const Features f(*room(smooth, opposite));
    CHECK(std::fabs(f.mean("P", 1).z) < 1e-3f);
    CHECK(f.mean("Emission", 5) == Rgb(0.0f));
    CHECK(core::mirrored_features(*room(R"(<bsdf type="diffuse"/>)")).empty());
    CHECK(core::mirrored_features(*room(rough(0.5f))).empty());
    CHECK(core::mirrored_features(*room(rough(0.05f))).size() == 4);
}
