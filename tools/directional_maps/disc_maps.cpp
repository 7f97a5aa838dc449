// Mirrors seen by a viewer who looks along -z from far away: a sphere (Engelhardt 2013, Sec. 5.1.2), and two
// paraboloids back to back (Heidrich & Seidel 1998; Sec. 5.1.4). The images are discs in squares.

#include "tools/directional_maps/directional_map_kinds.h"
#include "tools/directional_maps/texel_solid_angle.h"

namespace mote::tools {

using namespace core;

namespace {

class DiscMap : public DirectionalMap {
  public:
    using DirectionalMap::DirectionalMap;

    double used_fraction() const override { return 0.78539816339744830962; }
    double used_fraction(int texel) const override {
        const Rectangle r = rectangle(texel);
        return disc_area(r) / ((r.high.x - r.low.x) * (r.high.y - r.low.y));
    }

  protected:
    Rectangle rectangle(int texel) const {
        const Place p = place(texel);
        const double edge = 2.0 / double(width());
        return {edge * glm::dvec2(p.i, p.j) - 1.0, edge * glm::dvec2(p.i + 1, p.j + 1) - 1.0};
    }
};

/// +z in the middle; the whole rim is -z. The printed inverse, with -omega and 1 - omega_z, belongs to a
/// viewer who looks along +z, against the text (docs/errata.md).
class SphereMap : public DiscMap {
  public:
    explicit SphereMap(int size) : DiscMap(1, size, size) {}

    MapPoint project(const Vec3& d) const override {
        const float length = glm::length(d), across = std::hypot(d.x, d.y);
        // |p| = sin(theta / 2), without a difference of nearly equal numbers on either side.
        const float radius = d.z >= 0.0f ? across / std::sqrt(2.0f * length * (length + d.z))
                                         : std::sqrt(0.5f * (length - d.z) / length);
        const Vec2 p = across > 0.0f ? radius / across * Vec2(d.x, d.y) : Vec2(radius, 0.0f);
        return {0, 0.5f * p + 0.5f};
    }
    /// Beyond the rim the way through -z continues, up the other side.
    Vec3 unproject(const MapPoint& point) const override {
        Vec2 p = 2.0f * point.uv - 1.0f;
        if (const float r = glm::length(p); r > 1.0f) p *= -std::fmax(2.0f - r, 0.0f) / r;
        const float r2 = glm::dot(p, p), scale = 2.0f * safe_sqrt(1.0f - r2);
        return glm::normalize(Vec3(scale * p, 1.0f - 2.0f * r2));
    }
    /// cos(theta) = 1 - 2 |p|^2: equal areas have equal solid angles (Lambert's azimuthal projection).
    double solid_angle(int texel) const override { return 4.0 * disc_area(rectangle(texel)); }
};

/// Face 0 shows z >= 0, face 1 the rest, not mirrored: both have x along the columns.
class ParaboloidMap : public DiscMap {
  public:
    explicit ParaboloidMap(int size) : DiscMap(2, size, size) {}

    /// Sec. 5.1.4: u = w_x / (1 + w_z), and v alike, of either hemisphere.
    MapPoint project(const Vec3& d) const override {
        const float scale = 0.5f / (glm::length(d) + std::fabs(d.z));
        return {int(!(d.z >= 0.0f)), scale * Vec2(d.x, d.y) + 0.5f};
    }
    /// Beyond the rim follows the other hemisphere.
    Vec3 unproject(const MapPoint& point) const override {
        const Vec2 p = 2.0f * point.uv - 1.0f;
        const float r2 = glm::dot(p, p);
        const Vec3 d = Vec3(2.0f * p, 1.0f - r2) / (1.0f + r2);
        return {d.x, d.y, point.face == 0 ? d.z : -d.z};
    }
    double solid_angle(int texel) const override { return paraboloid_rectangle(rectangle(texel)); }
};

}  // namespace

std::unique_ptr<DirectionalMap> make_sphere_map(int size) { return std::make_unique<SphereMap>(size); }
std::unique_ptr<DirectionalMap> make_paraboloid_map(int size) {
    return std::make_unique<ParaboloidMap>(size);
}

}  // namespace mote::tools
