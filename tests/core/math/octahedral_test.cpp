#include "core/math/octahedral.h"

#include "core/math/random.h"
#include "core/math/warp.h"
#include "tests/support/catch.h"

using namespace mote::core;

TEST_CASE("A direction survives 32 bits within 1e-4 rad", "[octahedral]") {
    Rng rng(1);
    double worst = 0.0;
    for (int i = 0; i < 100000; ++i) {
        const Vec3 v = square_to_sphere({rng.next_float(), rng.next_float()});
        worst = std::max(worst, double(glm::length(decode_direction(encode_direction(v)) - v)));
    }
    CHECK(worst < 1e-4);
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, -1, 0), Vec3(-1, 0, 0),
                             Vec3(0, 0, -1), Vec3(0, -0.0f, -1)})
        CHECK(glm::length(decode_direction(encode_direction(axis)) - axis) < 1e-4f);
}
