// Transmittance along links against closed forms: fog between walls, fog within glass, panes.
#include "gathering/ray_bundles/link_transmittance.h"
#include "gathering/ray_bundles/bundle_tracer.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;

namespace {

struct Link {
    double length;
    Rgb transmittance;
    std::uint32_t near, far;  ///< shapes
};

/// Links of a ray along +z near the middle, beside the diagonals of the shapes.
std::vector<Link> links_along_z(const Scene& scene) {
    const SurfaceTriangles triangles = surface_triangles(scene.shapes());
    const BundleTracer tracer(triangles);
    const RayBundle bundle = tracer.trace(bundle_grid({0, 0, 1}, triangles.bounds, 0.1f, {0.5f, 0.5f}));
    const LinkTransmittance media(scene, scene.shapes(), triangles, scene.outermost_medium());
    const std::size_t ray = bundle.grid.rows / 2 * bundle.grid.columns + bundle.grid.columns / 2 + 2;
    const auto hits = bundle.hits_of(ray);
    std::vector<Rgb> between(hits.size());
    Rng rng(1);
    TrackingCounters counters;
    media.along(bundle, ray, rng, counters, between);
    std::vector<Link> links;
    for (std::size_t i = 0; i + 1 < hits.size(); ++i)
        links.push_back({double(hits[i + 1].distance) - double(hits[i].distance), between[i],
                         triangles.shape[hits[i].index()], triangles.shape[hits[i + 1].index()]});
    return links;
}

}  // namespace

TEST_CASE("links lose what fog, glass full of fog and panes take", "[ray_bundles]") {
    // Along z: a wall at 0; fog from 1 to 3 within a null box; a body of glass with fog of its own from 4 to
    // 5; a pane at 6; a wall at 8.
    const auto scene = tests::scene_from(R"(<scene version="3.0.0">
        <shape type="rectangle"><bsdf type="diffuse"/></shape>
        <shape type="cube"><transform name="to_world"><translate z="2"/></transform><bsdf type="null"/>
          <medium type="homogeneous" name="interior"><rgb name="sigma_t" value="0.5, 0.25, 0.1"/></medium></shape>
        <shape type="cube"><transform name="to_world"><scale z="0.5"/><translate z="4.5"/></transform><bsdf type="dielectric"/>
          <medium type="homogeneous" name="interior"><float name="sigma_t" value="0.7"/></medium></shape>
        <shape type="rectangle"><transform name="to_world"><translate z="6"/></transform><bsdf type="thindielectric"/></shape>
        <shape type="rectangle"><transform name="to_world"><translate z="8"/></transform><bsdf type="diffuse"/></shape>
        <emitter type="point"/><sensor type="perspective"/></scene>)");
    const auto links = links_along_z(*scene);
    REQUIRE(links.size() == 3);
    CHECK(links[0].length == Approx(4.0));
    CHECK((links[0].near == 0 && links[0].far == 2));
    const double sigma[] = {0.5, 0.25, 0.1};
    for (int c = 0; c < 3; ++c)
        CHECK(double(links[0].transmittance[c]) == Approx(std::exp(-2.0 * sigma[c])).epsilon(1e-5));
    CHECK(links[1].length == Approx(1.0));
    CHECK(double(links[1].transmittance.x) == Approx(std::exp(-0.7)).epsilon(1e-5));
    // Transmittance of glass of IOR 1.5046 at normal incidence: 1 - 2 r / (1 + r), r = ((n - 1) / (n + 1))^2.
    CHECK((links[2].transmittance.x > 0.90f && links[2].transmittance.x < 0.93f));
}

TEST_CASE("a scene within an outermost medium has it between all of its surfaces", "[ray_bundles]") {
    const auto scene = tests::scene_from(R"(<scene version="3.0.0">
        <medium type="homogeneous" id="air"><float name="sigma_t" value="0.3"/></medium>
        <shape type="cube"><transform name="to_world"><scale value="0.5"/></transform><bsdf type="dielectric"/>
          <medium type="homogeneous" name="interior"><float name="sigma_t" value="2"/></medium><ref name="exterior" id="air"/></shape>
        <shape type="rectangle"><transform name="to_world"><translate z="3"/></transform><bsdf type="diffuse"/></shape>
        <emitter type="point"/><sensor type="perspective"><ref name="medium" id="air"/></sensor></scene>)");
    const auto links = links_along_z(*scene);
    REQUIRE(links.size() == 2);
    CHECK(double(links[0].transmittance.x) == Approx(std::exp(-2.0)).epsilon(1e-5));
    CHECK(double(links[1].transmittance.x) == Approx(std::exp(-0.3 * 2.5)).epsilon(1e-5));
}
