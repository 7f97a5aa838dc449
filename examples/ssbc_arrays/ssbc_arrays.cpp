// Screen-space bias compensation over arrays of another renderer: position, normal, area, reflectance and
// light of each pixel. The corner (examples/corner.h) has radiance 1 everywhere; light is missing where the
// two planes are near each other, and nowhere else.
#include <mote/screenspace/ssbc/ssbc.h>

#include <cmath>
#include <cstdio>

#include "../corner.h"

using namespace mote;
using core::Rgb;

/// `area` of a pixel's patch [m^2]: the solid angle of the pixel, times the squared distance, over the cosine
/// at the surface. That solid angle is the pixel's area on the film at distance 1, times the third power of
/// the cosine there.
float patch_area(const corner::Seen& s) {
    const float on_film = s.position.z / s.distance;
    const float solid_angle = on_film * on_film * on_film / float(corner::pixels);
    const float at_surface = -glm::dot(s.normal, s.position) / s.distance;
    return solid_angle * s.distance * s.distance / at_surface;
}

int main() {
    const std::vector<corner::Seen> view = corner::view();
    screenspace::SsbcSurfaces surfaces(corner::width, corner::height);
    double wall_area = 0.0;
    for (std::size_t i = 0; i < view.size(); ++i) {
        const corner::Seen& s = view[i];
        surfaces.set(i, s.position, s.normal, -s.position, patch_area(s), Rgb(0.5f));
        wall_area += s.floor ? 0.0 : double(surfaces.area[i]);
    }
    const std::vector<Rgb> reflected(view.size(), Rgb(1.0f));  // without what lamps emit
    const auto added = screenspace::compensate(surfaces, reflected, {.bound = 1.0f}).compensation;

    double near = 0.0, far = 0.0;
    for (std::size_t i = 0; i < view.size(); ++i) {
        if (view[i].position.y < -1.0f)
            far = std::max(far, double(added[i].x));  // 2 m and more from the floor
        if (view[i].position.y > 0.9f) near = std::max(near, double(added[i].x));
    }
    std::printf("the wall's patches: %.2f m^2 of 12; added beside the corner: %.3f, far from it: %.1g\n",
                wall_area, near, far);
    return std::fabs(wall_area / 12.0 - 1.0) < 0.03 && near > 0.01 && far < 1e-4 ? 0 : 1;
}
