#include "screenspace/ssbc/ssbc_surfaces.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <stdexcept>

#include "core/geometry/shape.h"
#include "core/materials/bsdf.h"
#include "core/math/frame.h"
#include "screenspace/g_buffer/g_buffer.h"

namespace mote::screenspace {

using namespace core;

namespace {

/// pi times the smallest value of the BSDF over directions around the normal on wo's side: the base of a
/// plastic, and next to nothing for a metal, whose lobe misses some.
Rgb even_part(const Bsdf& bsdf, const BsdfPoint& p, const Vec3& wo) {
    const float s = std::sqrt(0.5f), up = wo.z > 0.0f ? 1.0f : -1.0f;
    Rgb least(1.0f);
    for (const Vec3& wi : {Vec3(0, 0, 1), Vec3(s, 0, s), Vec3(-s, 0, s), Vec3(0, s, s), Vec3(0, -s, s)})
        least = glm::min(least, pi * bsdf.eval(p, wo, Vec3(wi.x, wi.y, up * wi.z), TransportMode::radiance));
    return least;
}

/// Diffuse reflectance of a pixel. The albedo in the buffer depends on which side of the surface is
/// seen; the normals are turned to the viewer.
Rgb diffuse_part(const GBuffer& buffer, std::size_t i) {
    if (!buffer.shape[i]) return buffer.reflectance[i];
    const Bsdf* bsdf = buffer.shape[i]->bsdf.get();
    if (!bsdf || !bsdf->traits().smooth) return Rgb(0.0f);
    if (bsdf->traits().diffuse) return buffer.reflectance[i];
    const Vec3 wo = Frame(buffer.shading_normal[i]).to_local(-buffer.view[i]);
    if (!(wo.z > 0.0f)) return Rgb(0.0f);
    return glm::min(even_part(*bsdf, BsdfPoint{buffer.uv[i]}, wo), buffer.reflectance[i]);
}

/// The longest way along rows or columns between two hits, per pixel and across the view [m].
Vec3 pixel_step(const GBuffer& buffer, bool along_rows) {
    const int lines = along_rows ? buffer.height : buffer.width,
              length = along_rows ? buffer.width : buffer.height;
    const auto at = [&](int line, int i) {
        return along_rows ? buffer.index(i, line) : buffer.index(line, i);
    };
    Vec3 step(0.0f);
    int longest = 0;
    for (int line = 0; line < lines; ++line) {
        int first = 0, last = length - 1;
        while (first < length && !buffer.hit[at(line, first)]) ++first;
        while (last > first && !buffer.hit[at(line, last)]) --last;
        if (last - first <= longest) continue;
        longest = last - first;
        const Vec3 d = buffer.position[at(line, last)] - buffer.position[at(line, first)],
                   view = buffer.view[0];
        step = (d - view * glm::dot(view, d)) / float(longest);
    }
    return step;
}

/// Cross-section of a pixel's beam in a parallel projection, where solid angles are zero [m^2].
float beam_area(const GBuffer& buffer) {
    const bool parallel = std::all_of(buffer.solid_angle.begin(), buffer.solid_angle.end(),
                                      [](float angle) { return angle == 0.0f; });
    return parallel ? glm::length(glm::cross(pixel_step(buffer, true), pixel_step(buffer, false))) : 0.0f;
}

}  // namespace

Rgb diffuse_reflectance(const Bsdf& bsdf, const BsdfPoint& p, const Vec3& wo) {
    const BsdfTraits traits = bsdf.traits();
    if (!traits.smooth) return Rgb(0.0f);
    const Rgb albedo = bsdf.albedo(p, wo);
    return glm::clamp(traits.diffuse ? albedo : glm::min(even_part(bsdf, p, wo), albedo), Rgb(0.0f),
                      Rgb(1.0f));
}

SsbcSurfaces::SsbcSurfaces(int w, int h) : width(w), height(h) {
    if (w <= 0 || h <= 0) throw std::invalid_argument("a picture needs at least one pixel");
    const std::size_t n = pixel_count();
    position.assign(n, Vec3(0.0f)), normal.assign(n, Vec3(0.0f)), reflectance.assign(n, Rgb(0.0f));
    facing.assign(n, 0.0f), area.assign(n, 0.0f);
}

void SsbcSurfaces::set(std::size_t i, const Vec3& p, const Vec3& n, const Vec3& to_viewer, float surface_area,
                       const Rgb& diffuse_reflectance) {
    const float length = glm::length(n), distance = glm::length(to_viewer);
    const bool finite = is_finite(p) && is_finite(length) && is_finite(distance) && is_finite(surface_area);
    if (!finite || !(length > 0.0f) || !(distance > 0.0f) || !(surface_area > 0.0f)) return;
    if (is_black(diffuse_reflectance)) return;
    const float cosine = glm::dot(n, to_viewer) / (length * distance);
    position[i] = p, normal[i] = (cosine < 0.0f ? -n : n) / length, facing[i] = std::abs(cosine);
    area[i] = surface_area, reflectance[i] = diffuse_reflectance;
}

void SsbcSurfaces::check() const {
    if (width <= 0 || height <= 0) throw std::invalid_argument("a picture needs at least one pixel");
    for (std::size_t size : {position.size(), normal.size(), facing.size(), area.size(), reflectance.size()})
        if (size != pixel_count()) throw std::invalid_argument("a buffer's size is not that of the picture");
    for (const Rgb& r : reflectance)
        if (!(min_component(r) >= 0.0f) || !(max_component(r) <= 1.0f))
            throw std::invalid_argument("a reflectance is not between 0 and 1");
    for (std::size_t i = 0; i < pixel_count(); ++i) {
        if (area[i] == 0.0f) continue;
        if (!(area[i] > 0.0f) || !is_finite(area[i]))
            throw std::invalid_argument("an area is negative or not finite");
        if (!is_finite(position[i]) || !is_finite(normal[i]) ||
            !(facing[i] >= -1e-4f && facing[i] <= 1.0001f))  // rounded cosines
            throw std::invalid_argument(
                "a position, normal or cosine of a patch is not finite or out of range");
        if (std::abs(glm::dot(normal[i], normal[i]) - 1.0f) > 1e-2f)
            throw std::invalid_argument("a normal of a patch is not a unit vector");
    }
}

SsbcSurfaces ssbc_surfaces(const GBuffer& buffer) {
    SsbcSurfaces surfaces(buffer.width, buffer.height);
    const float beam = beam_area(buffer);
    tbb::parallel_for(std::size_t(0), buffer.pixel_count(), [&](std::size_t i) {
        if (!buffer.hit[i]) return;
        const Rgb reflectance = glm::clamp(diffuse_part(buffer, i), Rgb(0.0f), Rgb(1.0f));
        const float facing = std::abs(glm::dot(buffer.geometric_normal[i], buffer.view[i]));
        const float area = beam > 0.0f ? beam / std::max(facing, 1e-4f) : buffer.surface_area(i);
        surfaces.set(i, buffer.position[i], buffer.geometric_normal[i], -buffer.view[i], area, reflectance);
    });
    return surfaces;
}

}  // namespace mote::screenspace
