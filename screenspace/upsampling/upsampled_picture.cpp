#include "screenspace/upsampling/upsampled_picture.h"

#include <cmath>
#include <stdexcept>

namespace mote::screenspace {

using core::Rgb, core::Vec3;

namespace {

std::vector<UpsamplingPoint> points_of(const SurfacePicture& s) {
    const std::size_t pixels = s.width > 0 && s.height > 0 ? std::size_t(s.width) * std::size_t(s.height) : 0;
    if (pixels == 0 || s.position.size() != pixels || s.normal.size() != pixels ||
        !(s.albedo.empty() || s.albedo.size() == pixels))
        throw std::invalid_argument("positions, normals and albedo have one entry a pixel");
    if (!(s.focal_length > 0.0) || !std::isfinite(s.focal_length))
        throw std::invalid_argument("the focal length is positive");
    std::vector<UpsamplingPoint> points(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        const float distance = glm::length(s.position[i]);
        if (!std::isfinite(distance)) continue;  // black: without light
        points[i].position = s.position[i];
        points[i].normal = points[i].shading_normal = s.normal[i];
        points[i].footprint = distance / float(s.focal_length);
        points[i].modulation = s.albedo.empty() ? Rgb(1.0f) : s.albedo[i];
    }
    return points;
}

}  // namespace

UpsampledPicture upsampled(const SurfacePicture& surfaces, int spacing, const ShadeFunction& shade) {
    const std::vector<UpsamplingPoint> points = points_of(surfaces);
    if (spacing < 1) throw std::invalid_argument("the spacing is positive");
    const int first = spacing / 2;
    const ShadedLattice lattice{spacing, std::min(first, surfaces.width - 1),
                                std::min(first, surfaces.height - 1)};
    const Upsampling upsampling(surfaces.width, surfaces.height, lattice, LayerKind::surface, points);
    UpsampledPicture result;
    result.light.assign(points.size(), Rgb(0.0f));
    const auto shade_at = [&](int x, int y) {
        const std::size_t i = std::size_t(y) * std::size_t(surfaces.width) + std::size_t(x);
        if (core::is_black(points[i].modulation)) return;
        result.light[i] = shade(x, y), ++result.shaded;
    };
    for (int y = lattice.row; y < surfaces.height; y += spacing)
        for (int x = lattice.column; x < surfaces.width; x += spacing) shade_at(x, y);
    for (const std::uint32_t i : upsampling.again())
        shade_at(int(i) % surfaces.width, int(i) / surfaces.width);
    upsampling.fill(result.light);
    return result;
}

}  // namespace mote::screenspace
