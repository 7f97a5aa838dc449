// Columns along the azimuth, rows from the pole +z to the pole -z (Blinn & Newell 1976; Engelhardt 2013,
// Sec. 5.1.1). Unlike emitters/environment_picture.h, which follows the pictures of environments, no row of
// texels lies on a pole.

#include "tools/directional_maps/directional_map_kinds.h"

namespace mote::tools {

using namespace core;

namespace {

class LatitudeLongitudeMap : public DirectionalMap {
  public:
    explicit LatitudeLongitudeMap(int size) : DirectionalMap(1, 2 * size, size) {}

    /// The inverse of Eq. 5.1, which is printed without the divisions by 2 pi and pi.
    MapPoint project(const Vec3& d) const override {
        const float u = std::atan2(d.y, d.x) * inv_two_pi;
        // acos(z) would lose half the digits near the poles.
        const float v = std::atan2(std::hypot(d.x, d.y), d.z) * inv_pi;
        return {0, {u < 0.0f ? u + 1.0f : u, v}};
    }
    /// Eq. 5.1.
    Vec3 unproject(const MapPoint& p) const override {
        const float phi = 2.0f * pi * p.uv.x, theta = pi * p.uv.y;
        return {std::cos(phi) * std::sin(theta), std::sin(phi) * std::sin(theta), std::cos(theta)};
    }
    double solid_angle(int texel) const override {
        // A difference of cosines as a product, exact at the poles, too.
        const double half_row = 0.5 * pi_d / height(), middle = (2.0 * place(texel).j + 1.0) * half_row;
        return 2.0 * pi_d / width() * 2.0 * std::sin(middle) * std::sin(half_row);
    }

  protected:
    void add_beyond_edge(FilterTaps& taps, const Place& p, float weight) const override {
        // Beyond a pole the opposite meridian comes back. The width is even.
        const bool over_pole = p.j < 0 || p.j >= height();
        const int i = p.i + width() + (over_pole ? width() / 2 : 0);
        const int j = p.j < 0 ? 0 : p.j >= height() ? height() - 1 : p.j;
        taps.add(index({0, i % width(), j}), weight);
    }

  private:
    static constexpr double pi_d = 3.14159265358979323846;
};

}  // namespace

std::unique_ptr<DirectionalMap> make_latitude_longitude_map(int size) {
    return std::make_unique<LatitudeLongitudeMap>(size);
}

}  // namespace mote::tools
