// Functions of a host that give what is not finite or has no surface: the fault is named, not carried into
// light.
#include "core/scene/callback_scene.h"

#include "core/materials/bsdfs.h"
#include "core/materials/texture.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

constexpr float no_number = std::numeric_limits<float>::quiet_NaN();
const Bounds3 room{Vec3(-1.0f), Vec3(1.0f)};

CallbackScene scene_of(const SurfaceHit& hit) {
    return CallbackScene({.first_hit = [hit](const Ray&) { return hit; }, .bounds = room});
}

}  // namespace

TEST_CASE("A scene of callbacks needs something that light can meet", "[callbacks]") {
    CHECK_THROWS_WITH(CallbackScene({.bounds = room}), ContainsSubstring("first_hit"));
    CHECK_NOTHROW(
        CallbackScene({.transmittance = [](const Vec3&, const Vec3&) { return Rgb(0.5f); }, .bounds = room}));
}

TEST_CASE("A host's hit that is not finite or has no surface is refused", "[callbacks]") {
    const ForeignSurface wall(make_diffuse(make_constant_texture(Rgb(0.5f))));
    const Ray ray{Vec3(0.0f), Vec3(0.0f, 0.0f, 1.0f)};
    const SurfaceHit sound = wall.hit(ray, 1.0f, Vec3(0.0f, 0.0f, -1.0f));
    CHECK(scene_of(sound).first_hit(ray)->shape == &wall);
    CHECK_THROWS_WITH(scene_of(wall.hit(ray, no_number, Vec3(0.0f, 0.0f, -1.0f))).first_hit(ray),
                      ContainsSubstring("not finite"));
    CHECK_THROWS_WITH(scene_of(wall.hit(ray, 1.0f, Vec3(0.0f, no_number, -1.0f))).first_hit(ray),
                      ContainsSubstring("not finite"));
    SurfaceHit bare = sound;
    bare.shape = nullptr;
    CHECK_THROWS_WITH(scene_of(bare).first_hit(ray), ContainsSubstring("without a surface"));
    CHECK_THROWS_AS(scene_of(wall.hit(ray, no_number, Vec3(0.0f, 0.0f, -1.0f))).visible(ray), InputError);
}
