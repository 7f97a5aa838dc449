#include "tools/geometry/soup.h"

#include <algorithm>

namespace mote::tools {

Vec3 Placement::operator()(const Vec3& p) const {
    const float c = std::cos(turn), s = std::sin(turn);
    return origin + scale * Vec3(c * p.x + s * p.z, p.y, c * p.z - s * p.x);
}

void Soup::quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    triangle(a, b, c);
    triangle(a, c, d);
}

void Soup::hexahedron(const std::array<Vec3, 8>& p) {
    static constexpr int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& f : faces) quad(p[f[0]], p[f[1]], p[f[2]], p[f[3]]);
}

void Soup::box(const Vec3& lower, const Vec3& upper) {
    std::array<Vec3, 8> corners;
    for (int i = 0; i < 8; ++i)
        corners[i] = {i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z};
    hexahedron(corners);
}

void Soup::sheet(int nu, int nv, const std::function<Vec3(float, float)>& point) {
    std::vector<Vec3> row(nu + 1), next(nu + 1);
    for (int j = 0; j <= nv; ++j) {
        for (int i = 0; i <= nu; ++i) next[i] = point(float(i) / float(nu), float(j) / float(nv));
        for (int i = 0; j > 0 && i < nu; ++i) quad(row[i], row[i + 1], next[i + 1], next[i]);
        std::swap(row, next);
    }
}

void Soup::lathe(const Vec3& foot, const std::vector<Vec2>& profile, int segments) {
    const int last = int(profile.size()) - 1;
    lathe(foot, last, segments, [&](float t, float) { return profile[std::lround(t * float(last))]; });
}

void Soup::lathe(const Vec3& foot, int rings, int segments,
                 const std::function<Vec2(float, float)>& profile) {
    // The last meridian is the first one to the bit, so that welding closes the seam.
    sheet(segments, rings, [&](float u, float v) {
        const float angle =
            2.0f * core::pi * float(std::lround(u * float(segments)) % segments) / float(segments);
        const Vec2 at = profile(v, angle);
        return foot + Vec3(at.x * std::cos(angle), at.y, -at.x * std::sin(angle));
    });
}

void Soup::frame(const Vec3& lower, const Vec3& upper, const std::vector<Vec2>& profile, bool inwards) {
    const float sign = inwards ? -1.0f : 1.0f;
    const auto corner = [&](int k, const Vec2& at) {
        const bool right = k == 1 || k == 2, back = k >= 2;  // counter-clockwise from above
        return Vec3(right ? upper.x + sign * at.x : lower.x - sign * at.x, at.y,
                    back ? lower.z - sign * at.x : upper.z + sign * at.x);
    };
    for (int k = 0; k < 4; ++k)
        for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
            const int next = (k + 1) % 4;
            const Vec3 a = corner(k, profile[i]), b = corner(next, profile[i]);
            const Vec3 c = corner(next, profile[i + 1]), d = corner(k, profile[i + 1]);
            inwards ? quad(b, a, d, c) : quad(a, b, c, d);
        }
}

void Soup::add(const Soup& part, const Placement& placement) {
    for (const auto& t : part.triangles_) triangle(placement(t[0]), placement(t[1]), placement(t[2]));
}

void add_parts(Parts& all, const Parts& part, const Placement& placement) {
    for (const auto& [name, soup] : part) all[name].add(soup, placement);
}

int segments(float n, float detail, int least) { return std::max(least, int(std::lround(n * detail))); }

}  // namespace mote::tools
