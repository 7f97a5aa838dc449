// The exchange of radiance under a sky that is not the same on all sides: a constant one does not distinguish
// ahead from behind.
#include "lights/emitters/emitters.h"
#include "tests/gathering/furnace_scenes.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;
using namespace mote::tests;

namespace {

/// Radiance 3 straight up (+y), falling to 0 at the horizon and below; twice as much on the side of +x.
std::shared_ptr<Emitter> sky() {
    Bitmap picture{8, 5, std::vector<Rgb>(40, Rgb(0.0f))};
    for (std::size_t x = 0; x < 8; ++x)
        picture.pixels[x] = Rgb(3.0f), picture.pixels[8 + x] = Rgb(x < 4 ? 2.0f : 1.0f);
    return lights::make_environment_map(picture);
}

/// Irradiance of a surface in the open, by quadrature.
double irradiance(const Emitter& sky, const Vec3& normal) {
    double sum = 0.0;
    constexpr int n = 400;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < 2 * n; ++j) {
            const double z = -1.0 + (i + 0.5) * 2.0 / n, phi = double(pi) * (j + 0.5) / n;
            const double r = std::sqrt(1.0 - z * z);
            const Vec3 w(Vec3d(r * std::cos(phi), z, r * std::sin(phi)));
            const double cosine = double(glm::dot(w, normal));
            if (cosine > 0.0) sum += double(sky.environment(w).x) * cosine * 2.0 * double(pi) / (n * n);
        }
    return sum;
}

}  // namespace

TEST_CASE("every side of a surface receives its own side of the sky", "[exchange][analytic][directions]") {
    const auto light = sky();
    for (const auto& [turn, normal] : {std::pair(R"(<rotate x="1" angle="-90"/>)", Vec3(0, 1, 0)),
                                       std::pair(R"(<rotate x="1" angle="90"/>)", Vec3(0, -1, 0)),
                                       std::pair(R"(<rotate y="1" angle="90"/>)", Vec3(1, 0, 0)),
                                       std::pair(R"(<rotate y="1" angle="-90"/>)", Vec3(-1, 0, 0))}) {
        const ExchangeStage stage(
            fmt::format(
                R"(<scene version="3.0.0"><shape type="rectangle"><transform name="to_world">{}</transform>
                <bsdf type="diffuse"/></shape><emitter type="point"/><sensor type="perspective"/></scene>)",
                turn),
            {.texels_per_metre = 3.0f});
        const ExchangeScene lit{stage.atlas, stage.materials, stage.tracer, light.get()};
        ExchangeSettings settings;
        settings.directions = 64;
        Trials found;
        for (std::uint64_t key = 0; key < 20; ++key) {
            ExchangeStatistics statistics;
            found.add(stage.mean(exchange_light(lit, settings, {}, key, {}, statistics).direct));
        }
        const double exact = irradiance(*light, normal);
        INFO("normal " << normal.x << ", " << normal.y << ": " << found.mean() << " of " << exact);
        if (exact < 1e-9)
            CHECK(found.mean() == 0.0);
        else
            CHECK(found.is(exact));
        if (normal.x > 0.0f) CHECK_FALSE(found.is(irradiance(*light, -normal)));
    }
}
