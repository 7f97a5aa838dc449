// <volume type="constvolume"> with to_world ends at the transformed unit cube; without one it has no end.
#include "media/constant_volume.h"
#include "core/materials/texture.h"
#include "core/objects/properties.h"
#include "core/objects/registry.h"
#include "media/grid_volume.h"
#include "media/heterogeneous_medium.h"
#include "media/vol_file.h"
#include "media/volume_texture.h"
#include "tests/media/statistics.h"
#include "tests/support/catch.h"

using namespace mote::core;
using namespace mote::media;

namespace {

std::shared_ptr<HeterogeneousMedium> medium_of(const Rgb& value, std::optional<Transform> to_world) {
    MediumParts parts;
    parts.albedo = std::make_shared<ConstantVolume>(Rgb(0.0f));
    return ConstantVolume(value, std::move(to_world)).make_medium(std::move(parts));
}

double depth_along_x(const HeterogeneousMedium& medium, int channel) {
    Rng rng(1);
    TrackingCounters counters;
    const Ray ray{Vec3(-10, 0.5f, 0.5f), Vec3(1, 0, 0), 0.0f, 20.0f};
    return -std::log(double(medium.transmittance(ray, rng, counters)[channel]));
}

}  // namespace

TEST_CASE("a constant with a transform ends at its box", "[constvolume]") {
    const Transform wide(glm::scale(glm::dmat4(1.0), Vec3d(3.0, 1.0, 1.0)));
    const auto grey = medium_of(Rgb(0.4f), wide);
    CHECK(depth_along_x(*grey, 0) == Approx(1.2).epsilon(1e-5));  // 3 m of 0.4 / m
    CHECK(grey->bounds().upper.x == Approx(3.0));
    const auto coloured = medium_of(Rgb(0.1f, 0.2f, 0.3f), wide);
    for (int c = 0; c < 3; ++c) CHECK(depth_along_x(*coloured, c) == Approx(0.3 * (c + 1)).epsilon(1e-5));
    CHECK(depth_along_x(*medium_of(Rgb(0.4f), Transform()), 0) == Approx(0.4).epsilon(1e-5));
    CHECK(depth_along_x(*medium_of(Rgb(0.4f), std::nullopt), 0) == Approx(8.0).epsilon(1e-5));
}

TEST_CASE("a constant's value continues beyond its box", "[constvolume]") {
    const Transform moved(glm::translate(glm::dmat4(1.0), Vec3d(5.0)));
    CHECK(ConstantVolume(Rgb(0.1f, 0.2f, 0.3f), moved).eval(Vec3(0.0f)) == Rgb(0.1f, 0.2f, 0.3f));
}

TEST_CASE("a constant volume is a constant texture", "[constvolume]") {
    Registry registry;
    register_volume_texture(registry);
    Properties p;
    p.category = Category::texture, p.type = "volume";
    p.children = {{"volume", Category::volume, std::make_shared<ConstantVolume>(Rgb(0.1f, 0.2f, 0.3f)), {}}};
    const auto texture = std::dynamic_pointer_cast<Texture>(registry.make(p));
    REQUIRE(texture);
    CHECK(texture->eval({0.3f, 0.8f}) == Rgb(0.1f, 0.2f, 0.3f));
    CHECK(texture->constant());
}
