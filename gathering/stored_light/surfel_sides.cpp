#include "gathering/stored_light/surfel_sides.h"

#include <tbb/parallel_for.h>

#include <array>

#include "core/geometry/bsdf_point.h"
#include "gathering/atlas/surface_sides.h"

namespace mote::gathering {

using namespace core;

namespace {

Rgb reflectance_at(const SurfaceHit& hit, bool back) {
    const Bsdf& bsdf = *hit.shape->bsdf;
    const BsdfPoint point = bsdf_point(hit);
    const Vec3 above(0.0f, 0.0f, back ? -1.0f : 1.0f);
    return bsdf.diffuse_reflectance(point, above).value_or(bsdf.albedo(point, above));
}

}  // namespace

SurfelSides::SurfelSides(const SurfaceTriangles& surfaces, ShapeSpan shapes, const Surfels& surfels)
    : surfaces_(surfaces), shapes_(shapes), surfels_(surfels) {
    std::vector<SurfaceSides> sides(shapes.size());
    for (std::size_t i = 0; i < shapes.size(); ++i)
        if (shapes[i]->bsdf && shapes[i]->bsdf->traits().smooth) sides[i] = sides_of(*shapes[i]);
    std::vector<std::array<Rgb, 2>> found(surfels.size());
    tbb::parallel_for(std::size_t(0), surfels.size(), [&](std::size_t i) {
        const SurfaceSides& of = sides[surfaces.shape[surfels.places[i].triangle]];
        found[i] = {Rgb(0.0f), Rgb(0.0f)};
        if (of.count() == 0) return;
        const SurfaceHit here = hit(std::uint32_t(i));
        if (of.front) found[i][0] = reflectance_at(here, false);
        if (of.back) found[i][1] = reflectance_at(here, true);
    });
    for (std::uint32_t i = 0; i < surfels.size(); ++i)
        for (const bool back : {false, true})
            if (const Rgb& reflectance = found[i][back]; !is_black(reflectance)) {
                places_.push_back({i, back, reflectance});
                any_back_ |= back;
            }
}

SurfaceHit SurfelSides::hit(std::uint32_t surfel) const {
    const SurfacePoint& p = surfels_.places[surfel];
    return surface_place(surfaces_, shapes_, p.triangle, {p.u, p.v});
}

ScatteringVertex SurfelSides::vertex(std::size_t place) const {
    return white_vertex(hit(places_[place].surfel), !places_[place].back);
}

SurfelSides::Radiance SurfelSides::reflected(std::span<const Rgb> irradiance) const {
    Radiance light;
    light.front.assign(surfels_.size(), Rgb(0.0f));
    if (any_back_) light.back.assign(surfels_.size(), Rgb(0.0f));
    for (std::size_t i = 0; i < places_.size(); ++i)
        (places_[i].back ? light.back : light.front)[places_[i].surfel] =
            inv_pi * places_[i].reflectance * irradiance[i];
    return light;
}

}  // namespace mote::gathering
