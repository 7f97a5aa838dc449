// Rays that touch edges and corners of media: what continues to infinity ends outside.
#include "core/geometry/triangle_mesh.h"
#include "core/math/warp.h"
#include "core/scene/ray_walk.h"
#include "tests/core/scene/scene_fixture.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

const std::string fog =
    "<medium type='homogeneous' id='fog'><float name='sigma_t' value='1'/></medium>"
    "<medium type='homogeneous' id='mist'><float name='sigma_t' value='2'/></medium>";

std::string box(const std::string& transform, const std::string& medium = "fog") {
    return "<shape type='cube'><transform name='to_world'>" + transform +
           "</transform><bsdf type='null'/><ref name='interior' id='" + medium + "'/></shape>";
}
const std::string haze = "<scale x='17.8' y='6.2' z='9.8'/><translate y='6.18'/>";

/// A point of the edges of a mesh, often a corner; of a sphere where a ray from `origin` touches it.
Vec3 point_to_touch(const Shape& shape, const Vec3& origin, Rng& rng) {
    if (const auto* mesh = dynamic_cast<const TriangleMesh*>(&shape)) {
        const auto& triangle = mesh->data().triangles[rng.next_u32() % mesh->data().triangles.size()];
        const std::uint32_t first = rng.next_u32() % 3;
        const float u = rng.next_u32() % 8 == 0 ? 0.0f : rng.next_float();
        return glm::mix(mesh->data().positions[triangle[first]],
                        mesh->data().positions[triangle[(first + 1) % 3]], u);
    }
    const Vec3 center = shape.bounds().center(), away = center - origin;
    const float radius = 0.5f * shape.bounds().diagonal().x, distance = glm::length(away);
    const Vec3 across = glm::normalize(glm::cross(away, square_to_sphere(rng.next_vec2())));
    const float sine = radius / distance;
    return center - sine * radius * away / distance +
           radius * std::sqrt(std::max(0.0f, 1.0f - sine * sine)) * across;
}

/// Where a walk ends that continues straight to infinity.
bool ends_inside(const Scene& scene, const Ray& ray, MediumState state, WalkContext& context) {
    PathWeights weights;
    Rgb emitted(0.0f);
    walk<true>(scene, ray, state, weights, emitted, context);
    return state.inside_any();
}

/// How many rays from anywhere, which touch the scene's first shape, end elsewhere than outside. `inward`:
/// who is outside of everything counts as inside of the shape.
int lost_rays(const Scene& scene, int rays, bool inward = false) {
    const Shape& shape = *scene.shapes()[0];
    const float radius = shape.bounds().radius();
    int lost = 0;
    WalkContext context;
    for (int i = 0; i < rays; ++i) {
        Rng& rng = context.rng;
        const Vec3 origin =
            shape.bounds().center() + 3.0f * radius * rng.next_float() * square_to_sphere(rng.next_vec2());
        // From a tenth of a rounding to a thousand of them beside the edge.
        const float off = radius * std::pow(10.0f, lerp(-8.0f, -4.0f, rng.next_float()));
        const Vec3 target = point_to_touch(shape, origin, rng) + off * square_to_sphere(rng.next_vec2());
        const Ray ray{origin, glm::normalize(target - origin)};
        lost += ends_inside(scene, ray, scene.medium_state_at(origin, nullptr), context) != inward;
    }
    return lost;
}

/// Scatters as near to the end of each part as there is a number, or to its start.
struct ClingingMedium : FakeMedium {
    bool to_start = false;
    mutable bool scatters = true;
    std::optional<float> sample_collision(const Ray& part, PathWeights&, Rgb&, Rng&,
                                          TrackingCounters&) const override {
        if (!scatters || part.t_max == infinity) return std::nullopt;
        return to_start ? std::nextafter(part.t_min, infinity) : std::nextafter(part.t_max, 0.0f);
    }
};

/// How many paths that scatter beside the boundary of the scene's first shape end in it.
int lost_paths(const Scene& scene, int paths, bool to_start) {
    Shape& shape = *scene.shapes()[0];
    const auto medium = std::make_shared<ClingingMedium>();
    medium->to_start = to_start, shape.interior = medium;
    const float radius = shape.bounds().radius();
    int lost = 0;
    WalkContext context;
    for (int i = 0; i < paths; ++i) {
        Rng& rng = context.rng;
        const Vec3 origin = shape.bounds().center() + 2.0f * radius * square_to_sphere(rng.next_vec2());
        const Ray ray{origin, glm::normalize(shape.sample_area(rng.next_vec2()).position - origin)};
        MediumState state = scene.medium_state_at(origin, nullptr);
        PathWeights weights;
        Rgb emitted(0.0f);
        medium->scatters = true;
        const WalkEvent event = walk<true>(scene, ray, state, weights, emitted, context);
        if (event.kind != WalkEvent::Kind::collision) continue;
        medium->scatters = false;
        lost +=
            ends_inside(scene, {ray.at(event.distance), square_to_sphere(rng.next_vec2())}, state, context);
    }
    return lost;
}

std::string sphere(const std::string& content) {
    return "<shape type='sphere'><point name='center' x='1' y='2' z='3'/><bsdf type='null'/>" + content +
           "</shape>";
}
const std::string of_fog = "<ref name='interior' id='fog'/>";
const std::string oblique =
    "<scale x='3' y='0.2' z='1'/><rotate x='1' y='2' z='0.5' angle='40'/><translate x='20'/>";

}  // namespace

TEST_CASE("Rays through edges and corners of a medium leave it", "[scene][media]") {
    CHECK(lost_rays(*load_body(fog + box(haze)), 300000) == 0);
    CHECK(lost_rays(*load_body(fog + box("") + box("<translate x='2'/>", "mist")), 300000) == 0);
    CHECK(lost_rays(*load_body(fog + sphere(of_fog)), 100000) == 0);
    const std::string room =
        "<shape type='cube'><transform name='to_world'><scale value='5'/></transform>"
        "<boolean name='flip_normals' value='true'/><bsdf type='null'/>"
        "<ref name='exterior' id='fog'/></shape>";
    CHECK(lost_rays(*load_body(fog + room), 100000, true) == 0);
    // Edges that lie along no axis: of a hundred thousand that touch one, a ray or two slip between the two
    // faces, and nothing is met where they leave. It was one in thirty that met but one of the two.
    CHECK(lost_rays(*load_body(fog + box(oblique)), 200000) <= 20);
}

TEST_CASE("Paths that scatter beside a boundary leave the medium", "[scene][media]") {
    for (const bool to_start : {false, true}) {
        CHECK(lost_paths(*load_body(fog + box(haze)), 30000, to_start) == 0);
        CHECK(lost_paths(*load_body(fog + box(oblique)), 30000, to_start) == 0);
        CHECK(lost_paths(*load_body(fog + sphere(of_fog)), 30000, to_start) == 0);
    }
}
