// Which media surround a point: nested, overlapping, open and inward-facing shapes; paths and their reverse.
#include "core/scene/medium_state.h"

#include <fmt/format.h>

#include <fstream>

#include "core/geometry/analytic_shapes.h"
#include "core/geometry/shape.h"
#include "core/math/warp.h"
#include "core/scene/requirements.h"
#include "tests/core/scene/scene_fixture.h"
#include "tests/support/temporary_folder.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

/// Media a, b, c with extinction 1, 2, 4, and then `body`.
std::unique_ptr<Scene> scene_with_media(const std::string& body) {
    std::string media;
    for (const auto& [id, sigma] : {std::pair("a", "1"), std::pair("b", "2"), std::pair("c", "4")})
        media += std::string("<medium type='homogeneous' id='") + id + "'><float name='sigma_t' value='" +
                 sigma + "'/></medium>\n";
    return load_body(media + body);
}

std::string sphere(const std::string& x, const std::string& radius, const std::string& content) {
    return "<shape type='sphere'><point name='center' x='" + x +
           "' y='0' z='0'/><float name='radius' value='" + radius + "'/><bsdf type='null'/>" + content +
           "</shape>";
}
std::string box(const std::string& size, const std::string& content, const std::string& bsdf = "null") {
    return "<shape type='cube'><transform name='to_world'><scale value='" + size +
           "'/></transform><bsdf type='" + bsdf + "'/>" + content + "</shape>";
}
std::string inside(const std::string& id) { return "<ref name='interior' id='" + id + "'/>"; }
std::string outside(const std::string& id) { return "<ref name='exterior' id='" + id + "'/>"; }

/// The extinction at a point; 0 for vacuum.
float sigma(const MediumState& state) {
    return state.current() ? dynamic_cast<const FakeMedium&>(*state.current()).sigma_t.x : 0.0f;
}
float sigma_at(const Scene& scene, const Vec3& p) { return sigma(scene.medium_state_at(p, nullptr)); }

float transmittance(const Scene& scene, const Vec3& from, const Vec3& to) {
    Rng rng(1);
    TrackingCounters counters;
    return scene.transmittance(from, to, scene.medium_state_at(from, nullptr), rng, counters).x;
}

struct TestSphere {
    std::shared_ptr<AnalyticShape> shape = make_sphere(Vec3d(0.0), 1.0, Transform(), false);
    /// With an exterior of its own it represents an open wall, which parts the outside.
    TestSphere(std::uint32_t index, std::shared_ptr<Medium> in, std::shared_ptr<Medium> out = nullptr) {
        shape->index = index, shape->interior = std::move(in), shape->exterior = std::move(out);
        shape->has_medium_boundary = true, shape->parts_the_outside = shape->exterior != nullptr;
    }
    const Shape& operator*() const { return *shape; }
};

}  // namespace

TEST_CASE("Inside several shapes the one declared last wins, whatever the order of entry", "[scene][media]") {
    const auto a = std::make_shared<FakeMedium>(), b = std::make_shared<FakeMedium>();
    const TestSphere first(0, a), second(1, b), hollow(2, nullptr);
    MediumState one, two;
    one.enter(*first), one.enter(*second);
    two.enter(*second), two.enter(*first);
    CHECK(one.current() == b.get());
    CHECK(two.current() == b.get());
    one.leave(*first);
    two.leave(*second);
    CHECK(one.current() == b.get());
    CHECK(two.current() == a.get());
    two.enter(*hollow);
    CHECK(two.current() == nullptr);
    two.leave(*hollow), two.leave(*first);
    CHECK(two.current() == nullptr);
    CHECK_FALSE(two.inside_any());
}

TEST_CASE("The medium outside follows what open walls declare, never closed shapes", "[scene][media]") {
    const auto fog = std::make_shared<FakeMedium>(), smoke = std::make_shared<FakeMedium>();
    const TestSphere both(0, smoke, fog), plain(1, smoke);
    MediumState s;
    s.set_outside(fog.get());
    s.enter(*plain);
    CHECK(s.current() == smoke.get());
    s.leave(*plain);
    CHECK(s.current() == fog.get());
    s.set_outside(nullptr);
    s.enter(*both);
    CHECK(s.outside() == fog.get());
    s.leave(*both);
    CHECK(s.current() == fog.get());
    // A closed shape leaves the outside as it is, whatever it declares.
    TestSphere closed(3, smoke, fog);
    closed.shape->parts_the_outside = false;
    s.set_outside(nullptr);
    s.enter(*closed), s.leave(*closed), s.leave(*closed);
    CHECK(s.current() == nullptr);
    s.set_outside(fog.get());
    // A start on the inner side, not counted as inside: leaving leads to the exterior.
    s.set_outside(smoke.get());
    s.leave(*both);
    CHECK(s.current() == fog.get());
    // Twice the same crossing, a rounding error at an edge, changes nothing.
    s.enter(*plain), s.enter(*plain), s.leave(*plain);
    CHECK(s.current() == fog.get());
    // Shapes without media change nothing.
    TestSphere none(2, nullptr);
    none.shape->has_medium_boundary = false;
    s.enter(*none);
    CHECK_FALSE(s.inside_any());
    s.cross(*plain, {0, 0, 1}, {0, 0, -1});
    CHECK(s.inside(*plain));
    s.cross(*plain, {0, 0, 1}, {0, 0, 1});
    CHECK_FALSE(s.inside(*plain));
}

TEST_CASE("More than eight nested shapes overflow", "[scene][media]") {
    std::vector<TestSphere> spheres;
    for (std::uint32_t i = 0; i < 9; ++i) spheres.emplace_back(i, std::make_shared<FakeMedium>());
    MediumState s;
    for (int i = 0; i < 8; ++i) s.enter(*spheres[std::size_t(i)]);
    CHECK_FALSE(s.overflow());
    CHECK(s.current() == spheres[7].shape->interior.get());
    s.enter(*spheres[8]);
    CHECK(s.overflow());
    std::string body;
    for (int i = 1; i <= 9; ++i) body += sphere("0", std::to_string(i), inside("a"));
    CHECK_THROWS_AS(scene_with_media(body), InputError);
    body.clear();  // as many side by side are no trouble
    for (int i = 1; i <= 20; ++i) body += sphere(std::to_string(3 * i), "1", inside("a"));
    CHECK_NOTHROW(scene_with_media(body));
}

TEST_CASE("Points in nested, overlapping and hollow shapes", "[scene][media]") {
    const auto nested = scene_with_media(sphere("0", "3", inside("a")) + box("1", inside("b")));
    CHECK(sigma_at(*nested, {0, 0, 0}) == 2);
    CHECK(sigma_at(*nested, {2, 0, 0}) == 1);
    CHECK(sigma_at(*nested, {4, 0, 0}) == 0);
    // Declared the other way round, the large one wins everywhere.
    const auto swallowed = scene_with_media(box("1", inside("b")) + sphere("0", "3", inside("a")));
    CHECK(sigma_at(*swallowed, {0, 0, 0}) == 1);
    const auto overlapping = scene_with_media(sphere("0", "2", inside("a")) + sphere("2", "2", inside("c")));
    CHECK(sigma_at(*overlapping, {-1, 0, 0}) == 1);
    CHECK(sigma_at(*overlapping, {1, 0, 0}) == 4);
    CHECK(sigma_at(*overlapping, {3, 0, 0}) == 4);
    CHECK(sigma_at(*overlapping, {5, 0, 0}) == 0);
}

TEST_CASE("A random point is inside exactly where geometry says", "[scene][media]") {
    const auto scene = scene_with_media(box("1", inside("a")) + sphere("1.5", "1", inside("b")));
    Rng rng(7);
    for (int i = 0; i < 3000; ++i) {
        const Vec3 p =
            Vec3(6.0f, 4.0f, 4.0f) * Vec3(rng.next_float(), rng.next_float(), rng.next_float()) - Vec3(2.0f);
        const bool in_sphere = glm::length(p - Vec3(1.5f, 0, 0)) < 1.0f;
        const bool in_box = max_component(glm::abs(p)) < 1.0f;
        const float expected = in_sphere ? 2.0f : in_box ? 1.0f : 0.0f;
        INFO(p.x << " " << p.y << " " << p.z);
        REQUIRE(sigma_at(*scene, p) == expected);
    }
}

TEST_CASE("Points in line with edges and corners", "[scene][media]") {
    const auto scene = scene_with_media(box("1", inside("a")));
    for (const float x : {0.0f, 0.5f, 0.999f})
        for (const float y : {0.0f, -0.5f, x}) {
            CHECK(sigma_at(*scene, {x, y, 0.0f}) == 1);
            CHECK(sigma_at(*scene, {x, y, x}) == 1);
            CHECK(sigma_at(*scene, {x, y, 1.001f}) == 0);
        }
}

TEST_CASE("The camera's medium: declared, or found", "[scene][media]") {
    const auto declared =
        scene_with_media("<sensor type='perspective'><ref id='b'/></sensor>" + sphere("0", "1", inside("a")));
    CHECK(declared->camera_medium_state().outside() == declared->camera().medium.get());
    CHECK(sigma(declared->camera_medium_state()) == 1);  // inside the sphere, in a world of b
    CHECK(find_requirements(*declared).camera_in_medium);
    MediumState state = declared->camera_medium_state();
    state.leave(*declared->shapes()[0]);
    CHECK(sigma(state) == 2);

    // Declared, and the interior of the shape that the camera is inside: outside of it is vacuum.
    const auto same =
        scene_with_media("<sensor type='perspective'><ref id='a'/></sensor>" + sphere("0", "1", inside("a")));
    CHECK(sigma(same->camera_medium_state()) == 1);
    state = same->camera_medium_state();
    state.leave(*same->shapes()[0]);
    CHECK(sigma(state) == 0);

    CHECK(
        sigma(scene_with_media("<sensor type='perspective'><ref id='c'/></sensor>")->camera_medium_state()) ==
        4);
    CHECK(sigma(scene_with_media(sphere("5", "1", inside("a")))->camera_medium_state()) == 0);
}

TEST_CASE("Open walls that declare an exterior make a room of fog", "[scene][media]") {
    std::string walls;
    for (const char* turn :
         {"<rotate y='1' angle='0'/>", "<rotate y='1' angle='90'/>", "<rotate y='1' angle='180'/>",
          "<rotate y='1' angle='270'/>", "<rotate x='1' angle='90'/>", "<rotate x='1' angle='270'/>"})
        walls += std::string("<shape type='rectangle'><transform name='to_world'><translate z='-1'/>") +
                 turn + "<scale value='5'/></transform><bsdf type='" +
                 (std::string(turn).find("'0'") != std::string::npos ? "null" : "diffuse") + "'/>" +
                 outside("a") + "</shape>";
    // A pillar that says nothing about media stands in the way of some walls.
    const auto scene = scene_with_media(walls +
                                        "<shape type='cube'><transform name='to_world'><scale value='.3'/>"
                                        "<translate x='2'/></transform></shape>");
    CHECK(sigma_at(*scene, {0, 0, 0}) == 1);
    CHECK(sigma_at(*scene, {2.5f, 0.1f, 0.2f}) == 1);
    CHECK(sigma_at(*scene, {0, 0, -20}) == 0);
    // In and out through the window, wherever one starts.
    CHECK(transmittance(*scene, {0, 0, 0}, {0, 0, -9}) == Approx(std::exp(-5.0)));
    CHECK(transmittance(*scene, {0, 0, -9}, {0, 0, 0}) == Approx(std::exp(-5.0)));
}

// Two boxes that overlap, in one mesh: a ray from where they do leaves it twice.
TEST_CASE("The inside of a closed mesh is not what lies around it", "[scene][media]") {
    const TemporaryFolder folder;
    const std::string path = folder.file("boxes.obj");
    std::ofstream file(path);
    for (const double x : {0.0, 1.5})
        for (int corner = 0; corner < 8; ++corner)
            file << fmt::format("v {} {} {}\n", x + (corner & 1 ? 1 : -1), corner & 2 ? 1 : -1,
                                corner & 4 ? 1 : -1);
    for (const int first : {1, 9})
        for (const auto& [a, b, c, d] :
             {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4}, std::array{2, 6, 7, 3},
              std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}})
            file << fmt::format("f {} {} {} {}\n", first + a, first + b, first + c, first + d);
    file.close();
    const auto scene =
        scene_with_media("<shape type='obj'><string name='filename' value='" + path +
                         "'/><bsdf type='null'/>" + inside("a") + outside("c") +
                         "</shape><shape type='rectangle'><transform name='to_world'><translate z='-1'/>"
                         "<scale value='5'/></transform><bsdf type='null'/>" +
                         outside("b") + "</shape>");
    MediumState state = scene->medium_state_at({0.75f, 0.1f, 0.2f}, nullptr);
    CHECK(sigma(state) == 1);
    state.leave(*scene->shapes()[0]);
    CHECK(sigma(state) == 2);
}

TEST_CASE("A closed room with its normals inwards", "[scene][media]") {
    const auto scene = scene_with_media(
        "<shape type='cube'><transform name='to_world'><scale value='5'/></transform>"
        "<boolean name='flip_normals' value='true'/><bsdf type='null'/>" +
        outside("a") + inside("c") + "</shape>" + sphere("1", "1", inside("b")));
    CHECK(sigma_at(*scene, {-2, 0, 0}) == 1);
    CHECK(sigma_at(*scene, {1, 0, 0}) == 2);
    CHECK(sigma_at(*scene, {0, 9, 0}) == 4);
    CHECK(transmittance(*scene, {-2, 0, 0}, {-7, 0, 0}) == Approx(std::exp(-3.0 - 8.0)).epsilon(1e-5));
}

TEST_CASE("A lamp in a box of smoke says nothing about the world outside", "[scene][media]") {
    const std::string lamp = "<shape type='sphere'><float name='radius' value='.1'/><emitter type='area'/>" +
                             outside("a") + "</shape>";
    const auto scene = scene_with_media(box("1", inside("a")) + lamp);
    CHECK(sigma_at(*scene, {0, 0, 9}) == 0);
    CHECK(sigma_at(*scene, {0, 0, 0.5f}) == 1);
    const auto& emitter = *scene->shapes()[1]->emitter;
    const auto sample = emitter.sample_emission({0.2f, 0.6f}, {0.5f, 0.5f});
    MediumState state = scene->emitter_medium_state(emitter, *sample);
    CHECK(sigma(state) == 1);
    state.leave(*scene->shapes()[0]);
    CHECK(sigma(state) == 0);
    // Opaque things in an endless fog, all of which say so.
    const auto fog = scene_with_media(lamp + sphere("3", "1", outside("a") + inside("b")));
    CHECK(sigma_at(*fog, {0, 5, 0}) == 1);
    CHECK(sigma_at(*fog, {3, 0, 0}) == 2);
}

// Where open walls part the outside, a lamp says what it stands in by its exterior; what it is filled with is
// not that.
TEST_CASE("An area light begins outside of its shape", "[scene][media]") {
    const auto scene = scene_with_media(
        "<shape type='rectangle'><transform name='to_world'><translate z='-3'/></transform><bsdf "
        "type='null'/>" +
        outside("a") +
        "</shape><shape type='sphere'><float name='radius' value='.1'/>"
        "<emitter type='area'/>" +
        outside("a") + inside("b") + "</shape>");
    const auto& lamp = *scene->shapes()[1]->emitter;
    const auto sample = lamp.sample_emission({0.2f, 0.6f}, {0.5f, 0.5f});
    CHECK(sigma(scene->emitter_medium_state(lamp, *sample)) == 1);
}

// Files of version 0.x often write their fog out at each wall; two objects of it would part light from eye
// paths.
TEST_CASE("Media that are written alike are one, whatever their ids and names", "[scene][media]") {
    const auto fog = [](const std::string& name, const std::string& sigma, const std::string& id = "") {
        return "<medium type='homogeneous' name='" + name + "'" + id + "><float name='sigma_t' value='" +
               sigma + "'/></medium>";
    };
    const auto scene =
        load_body(sphere("0", "1", fog("interior", "1")) + sphere("3", "1", fog("exterior", "1")) +
                  sphere("6", "1", fog("interior", "2")) + sphere("9", "1", fog("interior", "1", " id='x'")));
    const auto& shapes = scene->shapes();
    std::vector<const Medium*> media;
    for (const auto& shape : shapes)
        if (shape->has_medium_boundary)
            media.push_back(shape->interior ? shape->interior.get() : shape->exterior.get());
    REQUIRE(media.size() == 4);
    CHECK(media[0] == media[1]);
    CHECK(media[0] != media[2]);
    CHECK(media[0] == media[3]);
    CHECK(scene->media().size() == 2);
}

// A window of fog, seen from far, fills less than a hundredth of the directions around the camera.
TEST_CASE("A far open wall says what lies before it and behind it", "[scene][media]") {
    const auto scene = scene_with_media(
        "<shape type='rectangle'><transform name='to_world'><translate z='1'/></transform>"
        "<bsdf type='null'/>" +
        inside("a") +
        "</shape><shape type='sphere'><float name='radius' value='.3'/><bsdf type='dielectric'/>" +
        outside("a") + "</shape>");
    for (const float z : {7.0f, 20.0f, 300.0f}) {
        CHECK(sigma_at(*scene, {0, 0, z}) == 0);
        CHECK(sigma_at(*scene, {0.1f, 0.2f, -z}) == 1);
    }
    CHECK(sigma_at(*scene, {0.5f, 0, 0}) == 1);
}

TEST_CASE("Lights that reach through a boundary are tested point by point", "[scene][media]") {
    const auto scene = scene_with_media(
        box("1", inside("a")) +
        "<shape type='rectangle'><transform name='to_world'><rotate x='1' angle='90'/><scale value='2'/>"
        "</transform><emitter type='area'/></shape><emitter type='point'><point name='position' value='.5 0 "
        "0'/>"
        "</emitter>");
    const auto& lamp = *scene->shapes()[1]->emitter;
    Rng rng(3);
    int within = 0;
    for (int i = 0; i < 400; ++i) {
        const auto s = lamp.sample_emission(rng.next_vec2(), {0.5f, 0.5f});
        const bool in_box = max_component(glm::abs(s->origin)) < 1.0f;
        within += in_box;
        REQUIRE(sigma(scene->emitter_medium_state(lamp, *s)) == (in_box ? 1.0f : 0.0f));
    }
    CHECK(within > 60);  // a quarter of 400, give or take four deviations
    CHECK(within < 140);
    const auto& point = *scene->emitters()[1];
    CHECK(sigma(scene->emitter_medium_state(point, *point.sample_emission({}, {}))) == 1);
}

TEST_CASE("Transmittance is the product over segments, both ways", "[scene][media]") {
    const auto scene = scene_with_media(sphere("0", "2", inside("a")) + sphere("2", "2", inside("c")) +
                                        box("0.5", inside("b")));
    // Along x from -5 to 5: a on [-2,-.5], b on [-.5,.5] (but c is declared before b, so b wins), c on
    // [.5,4].
    const double depth = 1.5 * 1 + 1 * 2 + 3.5 * 4;
    CHECK(transmittance(*scene, {-5, 0.01f, 0.02f}, {5, 0.01f, 0.02f}) ==
          Approx(std::exp(-depth)).epsilon(1e-3));
    CHECK(transmittance(*scene, {1, 0, 0}, {1, 0, 0}) == 1.0f);
    Rng rng(11);
    TrackingCounters counters;
    for (int i = 0; i < 500; ++i) {
        const Vec3 p = 4.0f * square_to_sphere(rng.next_vec2()) * rng.next_float();
        const Vec3 q = 4.0f * square_to_sphere(rng.next_vec2()) * rng.next_float();
        const float there = transmittance(*scene, p, q);
        INFO(p.x << " " << p.y << " " << p.z << " to " << q.x << " " << q.y << " " << q.z);
        // Rounding of hit distances, of a few 1e-6 each, times an extinction of 4.
        REQUIRE(there == Approx(transmittance(*scene, q, p)).epsilon(1e-4));
        const Vec3 d = q - p;
        PathWeights w;
        scene->connect({p, glm::normalize(d), 0.0f, glm::length(d)}, scene->medium_state_at(p, nullptr), w,
                       rng, counters);
        REQUIRE(w.throughput.x == Approx(there).epsilon(1e-4));
    }
}

TEST_CASE("Without media everything is transparent; a light at infinity ends in the dark", "[scene][media]") {
    CHECK(transmittance(*load_body(box("1", "")), {-3, 0, 0}, {3, 0, 0}) == 1.0f);
    const auto fog = scene_with_media("<sensor type='perspective'><ref id='a'/></sensor>");
    PathWeights w;
    Rng rng;
    TrackingCounters counters;
    fog->connect({{0, 0, 0}, {0, 0, 1}}, fog->camera_medium_state(), w, rng, counters);
    CHECK(w.throughput == Rgb(0.0f));
}

TEST_CASE("Requirements count what the scene holds", "[scene][media]") {
    const auto scene = scene_with_media(sphere("0", "2", inside("a")) + box("5", inside("b")) +
                                        "<shape type='cube'><bsdf type='plastic'/></shape><shape "
                                        "type='cube'><bsdf type='dielectric'/></shape>"
                                        "<shape type='rectangle'><emitter type='area'/></shape>"
                                        "<emitter type='point'/><emitter type='constant'/>"
                                        "<shape type='rectangle'><bsdf type='diffuse'><texture "
                                        "type='checkerboard' name='reflectance'/></bsdf>"
                                        "</shape>");
    const Requirements r = find_requirements(*scene);
    CHECK(r.shapes == 6);
    CHECK(r.analytic_shapes == 1);
    CHECK(r.triangles == 3 * 12 + 2 * 2);
    CHECK(r.bsdfs_null == 2);
    CHECK(r.bsdfs_delta == 2);
    CHECK(r.bsdfs_diffuse == 2);
    CHECK(r.textures);
    CHECK(r.lights_point == 1);
    CHECK(r.lights_area == 1);
    CHECK(r.lights_infinite == 1);
    CHECK(r.media == 2);
    CHECK(r.media_homogeneous == 2);
    CHECK(r.camera_in_medium);
    CHECK(r.media_bounds.lower.x == Approx(-5));
    CHECK(r.media_bounds.upper.y == Approx(5));
}
