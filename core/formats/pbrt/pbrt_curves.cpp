// Every segment becomes a curve of four control points of its own.
#include "core/formats/pbrt/pbrt_curves.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace mote::core {
namespace {

using Cubic = std::array<Vec3d, 4>;

/// Control points of the uniform B-spline whose one segment is this Bezier curve.
Cubic bspline_of(const Cubic& b) {
    return {6.0 * b[0] - 7.0 * b[1] + 2.0 * b[2], 2.0 * b[1] - b[2], 2.0 * b[2] - b[1],
            2.0 * b[1] - 7.0 * b[2] + 6.0 * b[3]};
}

/// The quadratic Bezier curve p0 p1 p2 as a cubic one.
Cubic raised(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    return {a, a + 2.0 / 3.0 * (b - a), c + 2.0 / 3.0 * (b - c), c};
}

/// The segments as B-splines of four points.
std::vector<Cubic> segments(const std::vector<Vec3d>& p, int degree, bool bezier,
                            const SourceLocation& where) {
    const std::size_t d = std::size_t(degree), n = p.size();
    if (n < d + 1 || (bezier && (n - 1) % d != 0))
        throw InputError(
            "a curve of degree " + std::to_string(degree) + " cannot have " + std::to_string(n) + " points",
            where);
    std::vector<Cubic> list;
    for (std::size_t i = 0; i + d < n; i += bezier ? d : 1) {
        if (d == 3)
            list.push_back(bezier ? bspline_of({p[i], p[i + 1], p[i + 2], p[i + 3]})
                                  : Cubic{p[i], p[i + 1], p[i + 2], p[i + 3]});
        else if (bezier)
            list.push_back(bspline_of(raised(p[i], p[i + 1], p[i + 2])));
        else
            list.push_back(
                bspline_of(raised(0.5 * (p[i] + p[i + 1]), p[i + 1], 0.5 * (p[i + 1] + p[i + 2]))));
    }
    return list;
}

}  // namespace

std::string pbrt_curve_text(const PbrtObject& curve, const Transform& to_world, PbrtFiles& files) {
    curve.ignore({"N", "splitdepth"});
    const double width = curve.number("width", 1.0);
    const double w0 = curve.number("width0", width), w1 = curve.number("width1", width);
    const int degree = curve.integer("degree", 3);
    const std::string basis = curve.text("basis", "bezier"), kind = curve.text("type", "flat");
    if ((degree != 2 && degree != 3) || (basis != "bezier" && basis != "bspline"))
        throw InputError("a curve is of degree 2 or 3 and of basis 'bezier' or 'bspline'", curve.where);
    if (kind == "ribbon")
        files.fault(curve.where, "curves of type 'ribbon' have no counterpart here",
                    "round tubes stand in their place");
    if (kind == "flat")
        files.note("flat curves, which face the ray in pbrt, are round tubes of the same width");
    const std::vector<Cubic> all =
        segments(curve.vectors<Vec3d>("P"), degree, basis == "bezier", curve.where);
    const double scale = std::cbrt(std::fabs(to_world.determinant())), n = double(all.size());
    std::string text;
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (int k = 0; k < 4; ++k) {
            const Vec3d p = to_world.point(all[i][std::size_t(k)]);
            // The width is linear in the parameter, whose values are -1, 0, 1, 2 at the control points.
            const double radius = 0.5 * scale * std::fmax(w0 + (w1 - w0) * (double(i) + k - 1.0) / n, 0.0);
            text += fmt::format("{:.9g} {:.9g} {:.9g} {:.9g}\n", p.x, p.y, p.z, radius);
        }
        text += "\n";
    }
    return text;
}

}  // namespace mote::core
