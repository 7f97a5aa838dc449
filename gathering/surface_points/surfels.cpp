#include "gathering/surface_points/surfels.h"

#include <fmt/format.h>

#include "core/objects/error.h"
#include "core/objects/memory_error.h"
#include "gathering/surface_points/dart_throwing.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr std::uint32_t largest_count = 1u << 24;
/// Farther than this from its point, in roots of a point's patch, hardly any place is by area alone.
constexpr double stratified_reach = 1.0;

void check_memory(std::uint32_t count, std::size_t bytes_per_point, std::size_t budget) {
    const std::size_t fits = std::min<std::size_t>(budget / bytes_per_point, largest_count);
    if (count <= fits) return;
    throw InputError(fmt::format("{} points on surfaces take{}; {} fit into the{} allowed", count,
                                 memory_text(double(count) * double(bytes_per_point)), fits,
                                 memory_text(double(budget))));
}

Surfels placed(const SurfaceTriangles& triangles, std::vector<SurfacePoint> places, double area) {
    Surfels surfels;
    surfels.positions.reserve(places.size()), surfels.normals.reserve(places.size());
    for (const SurfacePoint& p : places) {
        const auto& c = triangles.corners[p.triangle];
        const Vec3d e1 = Vec3d(c[1]) - Vec3d(c[0]), e2 = Vec3d(c[2]) - Vec3d(c[0]);
        surfels.positions.push_back(Vec3(Vec3d(c[0]) + double(p.u) * e1 + double(p.v) * e2));
        surfels.normals.push_back(Vec3(glm::normalize(glm::cross(e1, e2))));
    }
    surfels.area = area;
    surfels.places = std::move(places);
    return surfels;
}

}  // namespace

void check_surfel_memory(std::uint32_t count, const SurfelSettings& settings, bool blue_noise) {
    constexpr std::size_t point = sizeof(Vec3) * 2 + sizeof(SurfacePoint);
    check_memory(count, blue_noise ? settings.candidates * (point + 8) + 64 : point, settings.memory_budget);
}

Surfels stratified_surfels(const SurfaceTriangles& triangles, std::uint32_t count,
                           const SurfelSettings& settings) {
    check_surfel_memory(count, settings, false);
    const SurfacePoints surface(triangles);
    std::vector<SurfacePoint> places;
    surface.draw(settings.seed, count, 0, count, places);
    Surfels surfels = placed(triangles, std::move(places), surface.area());
    surfels.radius = settings.disc_size * float(stratified_reach * std::sqrt(surfels.patch()));
    return surfels;
}

Surfels blue_noise_surfels(const SurfaceTriangles& triangles, std::uint32_t count,
                           const SurfelSettings& settings) {
    if (settings.candidates == 0) throw InputError("points on surfaces need candidates");
    check_surfel_memory(count, settings, true);
    const SurfacePoints surface(triangles);
    const auto candidates =
        std::uint32_t(std::min<std::uint64_t>(std::uint64_t(count) * settings.candidates, 0xffffffffu));
    std::vector<SurfacePoint> places;
    surface.draw(settings.seed, candidates, 0, candidates, places);
    const Surfels all = placed(triangles, std::move(places), surface.area());
    const DartThrow darts = throw_darts(all.positions, all.normals, std::min<std::size_t>(count, all.size()),
                                        surface.area(), settings.seed, settings.cancelled);
    Surfels chosen;
    for (const std::uint32_t i : darts.chosen) {
        chosen.positions.push_back(all.positions[i]), chosen.normals.push_back(all.normals[i]);
        chosen.places.push_back(all.places[i]);
    }
    chosen.area = surface.area(), chosen.radius = settings.disc_size * darts.covering_radius;
    return chosen;
}

}  // namespace mote::gathering
