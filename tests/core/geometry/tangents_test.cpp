// The tangent of the shading frame: where the BSDF is anisotropic it must follow the texture coordinates.
#include "core/formats/xml/scene_loader.h"
#include "tests/core/geometry/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote::tests;

namespace {

/// Shapes get their wish for tangents from their BSDF when a scene is built.
std::unique_ptr<Scene> scene_of(const std::string& shape, const std::string& alphas) {
    return scene_from(
        R"(<scene version="3.0.0"><sensor type="perspective"/><emitter type="constant"/><shape )" + shape +
        R"(<bsdf type="twosided"><bsdf type="roughconductor">)" + alphas + "</bsdf></bsdf></shape></scene>");
}

const std::string anisotropic = R"(<float name="alpha_u" value="0.1"/><float name="alpha_v" value="0.4"/>)";
const std::string isotropic = R"(<float name="alpha" value="0.2"/>)";
const std::string turned =
    R"(<transform name="to_world"><rotate x="1" y="2" z="-0.5" angle="40"/></transform>)";

/// A step along the tangent must raise u and leave v as it is. Returns the worst ratio of the two changes.
double worst_slant(const Scene& scene) {
    Rng rng(3);
    double worst = 0.0;
    int found = 0;
    for (int i = 0; i < 200; ++i) {
        const Vec3 d = square_to_sphere({rng.next_float(), rng.next_float()});
        const auto first = scene.rays().closest(ray(4.0f * d + Vec3(0.1f, 0.2f, -0.1f), -d));
        if (!first) continue;
        const Vec3 step = 1e-3f * first->shading.s, above = 0.05f * first->geometric_normal;
        const Vec3 start = first->position + (glm::dot(d, first->geometric_normal) > 0.0f ? above : -above);
        const auto second = scene.rays().closest(ray(start + step, first->position - start));
        if (!second || second->primitive != first->primitive) continue;
        const Vec2 change = second->uv - first->uv;
        if (std::fabs(change.x) > 0.5f) continue;  // across the seam of u
        ++found;
        worst = std::max(worst, change.x > 0.0f ? double(std::fabs(change.y) / change.x) : 1e9);
    }
    REQUIRE(found > 20);
    return worst;
}

}  // namespace

TEST_CASE("the tangent follows u where the BSDF is anisotropic", "[geometry][tangents]") {
    for (const char* type : {"sphere", "disk", "rectangle", "cube", "cylinder"}) {
        INFO(type);
        const std::string shape = std::string("type=\"") + type + "\">" + turned;
        CHECK(worst_slant(*scene_of(shape, anisotropic)) < 0.02);
        // The planted error: with the frame of an isotropic surface the test must fail.
        CHECK(worst_slant(*scene_of(shape, isotropic)) > 0.1);
    }
}

TEST_CASE("hits say how far texture coordinates reach", "[geometry][tangents]") {
    // Steps of 1e-3 m along dp/du and dp/dv change the coordinates as the derivatives say, to 2 % of the
    // step.
    for (const char* type : {"sphere", "disk", "rectangle", "cube", "cylinder"}) {
        const auto scene = scene_of(std::string("type=\"") + type + "\">" + turned, anisotropic);
        Rng rng(4);
        int compared = 0;
        for (int i = 0; i < 300; ++i) {
            const Vec3 d = square_to_sphere({rng.next_float(), rng.next_float()});
            const auto first = scene->rays().closest(ray(4.0f * d + Vec3(0.1f, 0.2f, -0.1f), -d));
            if (!first) continue;
            const Vec3 above = 0.05f * first->geometric_normal;
            const Vec3 start =
                first->position + (glm::dot(d, first->geometric_normal) > 0.0f ? above : -above);
            for (const bool by_u : {true, false}) {
                const Vec3 derivative = by_u ? first->dp_du : first->dp_dv;
                const float h = 1e-3f / glm::length(derivative);
                const auto second =
                    scene->rays().closest(ray(start + h * derivative, first->position - start));
                if (!second || second->primitive != first->primitive) continue;
                const Vec2 change = (second->uv - first->uv) / h, expected = by_u ? Vec2(1, 0) : Vec2(0, 1);
                // Not across the seam, nor where polar coordinates crowd.
                if (std::fabs(change.x * h) > 0.5f || std::fabs(change.y * h) > 0.5f) continue;
                if (glm::length(first->dp_du) < 0.2f || glm::length(first->dp_dv) < 0.2f) continue;
                CAPTURE(type, by_u, change.x, change.y);
                CHECK(glm::distance(change, expected) < 0.02f);
                ++compared;
            }
        }
        CHECK(compared > 50);
    }
    // Without texture coordinates they are barycentric, and the edges are the derivatives, as in Mitsuba 3.9.
    TriangleMesh mesh({{{0, 0, 0}, {3, 0, 0}, {1, 2, 0}}, {}, {}, {{{0, 1, 2}}}});
    mesh.tangent_matters = true;
    SurfaceHit hit;
    mesh.fill_hit(0, 0.2f, 0.3f, hit);
    CHECK((hit.dp_du == Vec3(3, 0, 0) && hit.dp_dv == Vec3(1, 2, 0)));
}

TEST_CASE("a frame around a tangent", "[geometry][tangents]") {
    const Vec3 n = glm::normalize(Vec3(1, 2, 3));
    const Frame frame(n, {5, 0, 1});
    CHECK(glm::length(frame.s) == Approx(1.0));
    CHECK(glm::dot(frame.s, n) == Approx(0.0).margin(1e-6));
    CHECK(glm::dot(glm::cross(frame.s, frame.t), n) == Approx(1.0));
    CHECK(glm::dot(frame.s, Vec3(5, 0, 1)) > 0.0f);
    CHECK(glm::dot(frame.t, Vec3(5, 0, 1)) == Approx(0.0).margin(1e-5));
    const Frame any(n, 3.0f * n);  // a tangent along the normal says nothing
    CHECK(any.s == Frame(n).s);
}
