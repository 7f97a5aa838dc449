// Micro-buffers and ray-bundles over a triangle list of one's own: a unit square that shines above a
// receiver, and the light that crosses between two squares, each against its closed form.
#include <mote/gathering/micro_buffers/micro_buffers.h>
#include <mote/gathering/ray_bundles/bundle_tracer.h>
#include <mote/gathering/ray_bundles/triangle_list.h>
#include <mote/gathering/surface_points/surfels.h>

#include <cmath>
#include <cstdio>

using namespace mote;
using core::Rgb, core::Vec2, core::Vec3;

/// The unit square at a height, its front up or down.
void add_square(gathering::SurfaceTriangles& surfaces, std::uint32_t shape, float z, bool up) {
    gathering::TriangleList list(surfaces, shape);
    const auto corner = [&](float x, float y) { return gathering::TriangleList::Corner{{x, y, z}, {}, {}}; };
    list.add(corner(0, 0), up ? corner(1, 0) : corner(1, 1), up ? corner(1, 1) : corner(1, 0), 0);
    list.add(corner(0, 0), up ? corner(1, 1) : corner(0, 1), up ? corner(0, 1) : corner(1, 1), 1);
}

/// Irradiance below the middle of a square of radiance 1 at distance 1 (Howell's catalogue, B-3).
double irradiance_of_square(double half_side) {
    const double a = half_side, p = std::sqrt(1.0 + a * a);
    return 4.0 * a / p * std::atan(a / p);
}

struct Found {
    double irradiance, disc_radius;
};

Found by_micro_buffers() {
    gathering::SurfaceTriangles lamp;
    add_square(lamp, 0, 1.0f, false);
    lamp.bounds = {{0, 0, 1}, {1, 1, 1}};
    const gathering::Surfels points = gathering::blue_noise_surfels(lamp, 2000);
    const gathering::PointHierarchy hierarchy(points);
    const gathering::NodeRadiance radiance(hierarchy, std::vector<Rgb>(points.size(), Rgb(1.0f)));
    const gathering::MicroReceiver receiver{{0.5f, 0.5f, 0.0f}, core::Frame(Vec3(0, 0, 1))};
    std::vector<Rgb> irradiance(1);
    double sum = 0.0;
    constexpr int passes = 16;
    for (int i = 0; i < passes; ++i) {  // rays in another place of their texels each time
        const gathering::MicroBuffers buffers(
            hierarchy, {.side = 32, .place = {(float(i % 4) + 0.5f) / 4, (float(i) + 0.5f) / passes}});
        gathering::gather_irradiance(buffers, radiance, {&receiver, 1}, irradiance);
        sum += double(irradiance[0].x) / passes;
    }
    return {sum, double(points.radius)};
}

double by_bundle(const Vec3& direction) {
    gathering::SurfaceTriangles surfaces;
    add_square(surfaces, 0, 0.0f, true), add_square(surfaces, 1, 1.0f, false);
    surfaces.bounds = {Vec3(0.0f), Vec3(1.0f)};
    const gathering::BundleTracer tracer(surfaces);
    const auto grid = gathering::bundle_grid(direction, surfaces.bounds, 1.0f / 512.0f, Vec2(0.5f));
    double area = 0.0;
    gathering::for_each_link(tracer.trace(grid),
                             [&](auto, const auto&, const auto&) { area += double(grid.ray_area()); });
    return area;
}

int main() {
    // The discs of points at the edge reach beyond it, by their radius at most.
    const auto [found, radius] = by_micro_buffers();
    const double least = irradiance_of_square(0.5), most = irradiance_of_square(0.5 + radius);
    std::printf("micro-buffers: %.4f W/m^2 between %.4f and %.4f\n", found, least, most);
    const Vec3 direction = glm::normalize(Vec3(0.25f, 0.0f, 1.0f));
    const double linked = by_bundle(direction),
                 crossing = 0.75 * double(direction.z);  // the slant takes a quarter
    std::printf("ray-bundle: links %.4f m^2 of %.4f\n", linked, crossing);
    return found > 0.99 * least && found < 1.01 * most && std::fabs(linked / crossing - 1.0) < 0.01 ? 0 : 1;
}
