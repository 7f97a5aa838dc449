// Bilateral upsampling against closed forms: what is linear on a plane stays, nothing leaks across a corner,
// between parallel planes or depths of a medium, and a pixel without similar neighbours is shaded again.
#include "screenspace/upsampling/upsampling.h"

#include <algorithm>
#include <cmath>

#include "tests/screenspace/layer_filter_views.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::screenspace;
using namespace mote::tests;

namespace {

constexpr int width = 37, height = 29;

/// Points that the pixels see through their middles, and their light.
struct View {
    std::vector<UpsamplingPoint> points;
    std::vector<Rgb> truth;
};

View view_of(const std::function<Seen(const Vec3&, int x, int y)>& see, LayerKind kind = LayerKind::surface) {
    View view;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Seen seen = see(view_direction(float(x) + 0.5f, float(y) + 0.5f, width, height), x, y);
            const FeatureSample& s = seen.sample;
            UpsamplingPoint p;
            p.position = s.position, p.normal = s.normal, p.shading_normal = s.shading_normal;
            p.footprint = s.distance * pixel_width, p.transmittance = s.transmittance;
            if (s.hit) p.distance = s.distance;
            p.modulation = kind == LayerKind::surface ? s.reflected : s.scattering;
            view.points.push_back(p), view.truth.push_back(p.modulation * seen.light);
        }
    return view;
}

/// The light after upsampling: of pixels to be shaded again, and of the lattice, it is the truth.
std::vector<Rgb> upsampled(const View& view, const ShadedLattice& lattice, LayerKind kind,
                           std::vector<std::uint32_t>* again = nullptr) {
    const Upsampling upsampling(width, height, lattice, kind, view.points);
    std::vector<Rgb> light(view.truth.size(), Rgb(-1.0f));  // wrong where nothing sets it
    for (int i = 0; i < width * height; ++i)
        if (lattice.holds(i % width, i / width)) light[std::size_t(i)] = view.truth[std::size_t(i)];
    for (const std::uint32_t pixel : upsampling.again()) light[pixel] = view.truth[pixel];
    upsampling.fill(light);
    if (again) again->assign(upsampling.again().begin(), upsampling.again().end());
    return light;
}

/// The largest deviation, of the largest value.
double deviation(const std::vector<Rgb>& light, const std::vector<Rgb>& truth) {
    double worst = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < light.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            worst = std::max(worst, std::fabs(double(light[i][c]) - truth[i][c]));
            largest = std::max(largest, double(truth[i][c]));
        }
    return worst / largest;
}

const Vec3 towards_eye(0, 0, -1);

}  // namespace

TEST_CASE("upsampling leaves a plane with a gradient as it is", "[screenspace][upsampling]") {
    const auto view = view_of([](const Vec3& d, int, int) {
        Seen seen = see_plane(d, Vec3(0, 0, 3), towards_eye);
        seen.light = Rgb(2.0f + seen.sample.position.x, 2.0f, 2.0f - 1.5f * seen.sample.position.y);
        return seen;
    });
    for (const int spacing : {1, 2, 4})
        for (const int first : {0, spacing - 1}) {
            const ShadedLattice lattice{spacing, first, first};
            std::vector<std::uint32_t> again;
            const auto light = upsampled(view, lattice, LayerKind::surface, &again);
            CHECK(again.empty());
            double inside = 0.0;  // beyond the outermost lattice points light is taken from one side
            for (int y = first; y <= first + (height - 1 - first) / spacing * spacing; ++y)
                for (int x = first; x <= first + (width - 1 - first) / spacing * spacing; ++x) {
                    const auto i = std::size_t(y * width + x);
                    for (int c = 0; c < 3; ++c)
                        inside = std::max(inside, std::fabs(double(light[i][c]) - view.truth[i][c]));
                }
            INFO("spacing " << spacing << ", from " << first << ": " << inside);
            CHECK(inside < 1e-6);
            CHECK(deviation(light, view.truth) < 0.07);  // at most spacing - 1 pixels of the gradient
        }
}

TEST_CASE("upsampling keeps a texture sharp", "[screenspace][upsampling]") {
    const auto view = view_of([](const Vec3& d, int x, int y) {
        Seen seen = see_plane(d, Vec3(0, 0, 3), glm::normalize(Vec3(0.8f, 0.2f, -1.0f)));
        seen.sample.reflected = (x + y) % 3 == 0 ? Rgb(0.9f, 0.0f, 0.2f) : Rgb(0.1f, 0.5f, 0.0f);
        seen.light = Rgb(3.0f, 2.0f, 1.0f);
        return seen;
    });
    // Pixels whose neighbours all lack a channel are shaded again: some, not most.
    for (const int spacing : {2, 4}) {
        std::vector<std::uint32_t> again;
        CHECK(deviation(upsampled(view, {spacing, 0, 0}, LayerKind::surface, &again), view.truth) < 1e-5);
        CHECK((!again.empty() && again.size() < view.points.size() / 3));
    }
}

TEST_CASE("upsampling does not leak across a corner or between parallel planes",
          "[screenspace][upsampling]") {
    const auto corner = view_of([](const Vec3& d, int, int) {
        const float side = d.x < 0.0f ? 1.0f : -1.0f;
        Seen seen = see_plane(d, Vec3(0, 0, 3), glm::normalize(Vec3(side, 0.0f, -1.0f)));
        seen.light = Rgb(side < 0.0f ? 5.0f : 1.0f);
        return seen;
    });
    const auto planes = view_of([](const Vec3& d, int, int) {
        const bool near = d.x + 0.4f * d.y < 0.02f;
        Seen seen = see_plane(d, Vec3(0, 0, near ? 3.0f : 3.2f), towards_eye);
        seen.light = Rgb(near ? 1.0f : 9.0f);
        return seen;
    });
    for (const auto* view : {&corner, &planes})
        for (const int spacing : {2, 4}) {
            std::vector<std::uint32_t> again;
            const auto light = upsampled(*view, {spacing, 1, 1}, LayerKind::surface, &again);
            INFO("spacing " << spacing << ", " << again.size() << " shaded again");
            CHECK(deviation(light, view->truth) < 1e-6);
            CHECK(again.size() < std::size_t(spacing * height));  // beside the edge, nowhere else
        }
    // Were it not for the normals and planes, it would: all on one plane, the two kinds of light mix.
    auto flat = planes;
    for (int i = 0; i < width * height; ++i)
        flat.points[std::size_t(i)].position.z = 3.0f, flat.points[std::size_t(i)].normal = towards_eye;
    CHECK(deviation(upsampled(flat, {4, 1, 1}, LayerKind::surface), planes.truth) > 0.1);
}

TEST_CASE("a wire that the lattice misses is shaded again, and nothing else", "[screenspace][upsampling]") {
    const auto view = view_of([](const Vec3& d, int x, int) {
        Seen seen = see_plane(d, Vec3(0, 0, x == 10 ? 2.0f : 3.0f), towards_eye);
        seen.light = Rgb(x == 10 ? 7.0f : 1.0f);
        return seen;
    });
    std::vector<std::uint32_t> again;
    CHECK(deviation(upsampled(view, {4, 0, 0}, LayerKind::surface, &again), view.truth) < 1e-6);
    REQUIRE(again.size() == std::size_t(height));
    for (int y = 0; y < height; ++y) CHECK(again[std::size_t(y)] == std::uint32_t(y * width + 10));
    // Light that no pixel shares, and pixels without any.
    auto alone = view;
    alone.points[width * 5 + 21].shared = false;
    alone.points[width * 6 + 10].modulation = Rgb(0.0f), alone.truth[width * 6 + 10] = Rgb(0.0f);
    CHECK(deviation(upsampled(alone, {4, 0, 0}, LayerKind::surface, &again), alone.truth) < 1e-6);
    CHECK(again.size() == std::size_t(height));  // one more, one less
    CHECK(std::binary_search(again.begin(), again.end(), std::uint32_t(width * 5 + 21)));
}

TEST_CASE("light scattered in a medium is upsampled over one depth of it", "[screenspace][upsampling]") {
    const auto fog_before = [](const std::function<float(const Vec3&)>& depth, float sigma) {
        return view_of(
            [=](const Vec3& d, int, int) {
                Seen seen = see_plane(d, Vec3(0, 0, depth(d)), towards_eye);
                seen.sample.transmittance = std::exp(-sigma * seen.sample.distance);
                seen.sample.scattering = Rgb(1.0f - seen.sample.transmittance);
                // J = 1 before, 6 behind the nearer plane: what a ray scatters on the way.
                const float near = 1.0f - std::exp(-sigma * std::min(seen.sample.distance, 2.0f));
                seen.light =
                    (Rgb(near) + 6.0f * (seen.sample.scattering - Rgb(near))) / seen.sample.scattering;
                return seen;
            },
            LayerKind::volume);
    };
    const auto step = fog_before([](const Vec3& d) { return d.x < 0.03f ? 1.9f : 6.0f; }, 0.5f);
    CHECK(deviation(upsampled(step, {4, 0, 0}, LayerKind::volume), step.truth) < 2e-3);
    // Behind dense fog the step is invisible, and the light of both is the same.
    const auto dense = fog_before([](const Vec3& d) { return d.x < 0.03f ? 1.9f : 6.0f; }, 9.0f);
    std::vector<std::uint32_t> again;
    CHECK(deviation(upsampled(dense, {4, 0, 0}, LayerKind::volume, &again), dense.truth) < 1e-3);
    CHECK(again.empty());
}

TEST_CASE("points that do not fit the picture are refused", "[screenspace][upsampling]") {
    const std::vector<UpsamplingPoint> points(12);
    CHECK_THROWS_AS(Upsampling(4, 4, {2, 0, 0}, LayerKind::surface, points), std::invalid_argument);
    CHECK_THROWS_AS(Upsampling(4, 3, {0, 0, 0}, LayerKind::surface, points), std::invalid_argument);
    CHECK_THROWS_AS(Upsampling(4, 3, {2, 2, 0}, LayerKind::surface, points), std::invalid_argument);
    std::vector<Rgb> light(11);
    CHECK_THROWS_AS(Upsampling(4, 3, {2, 1, 0}, LayerKind::surface, points).fill(light),
                    std::invalid_argument);
}
