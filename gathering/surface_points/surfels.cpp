#include "gathering/surface_points/surfels.h"

#include <fmt/format.h>

#include "core/objects/error.h"
#include "core/objects/memory_error.h"
#include "gathering/surface_points/dart_throwing.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr std::uint32_t largest_count = 1u << 24;

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

void check_surfel_memory(std::uint32_t count, const SurfelSettings& settings) {
    constexpr std::size_t candidate = sizeof(Vec3) * 2 + sizeof(SurfacePoint) + 8;
    const std::size_t bytes_per_point = settings.candidates * candidate + 64;
    const std::size_t fits = std::min<std::size_t>(settings.memory_budget / bytes_per_point, largest_count);
    if (count <= fits) return;
    throw InputError(fmt::format("{} points on surfaces take{}; {} fit into the{} allowed", count,
                                 memory_text(double(count) * double(bytes_per_point)), fits,
                                 memory_text(double(settings.memory_budget))));
}

Surfels blue_noise_surfels(const SurfaceTriangles& triangles, std::uint32_t count,
                           const SurfelSettings& settings) {
    if (settings.candidates == 0) throw InputError("points on surfaces need candidates");
    check_surfel_memory(count, settings);
    const SurfacePoints surface(triangles);
    const auto candidates =
        std::uint32_t(std::min<std::uint64_t>(std::uint64_t(count) * settings.candidates, 0xffffffffu));
    std::vector<SurfacePoint> places;
    surface.sample(settings.seed, candidates, 0, candidates, places);
    const Surfels all = placed(triangles, std::move(places), surface.area());
    const DartThrow darts = throw_darts(all.positions, all.normals, std::min<std::size_t>(count, all.size()),
                                        surface.area(), settings.seed, settings.cancelled);
    Surfels chosen;
    for (const std::uint32_t i : darts.chosen) {
        chosen.positions.push_back(all.positions[i]), chosen.normals.push_back(all.normals[i]);
        chosen.places.push_back(all.places[i]);
    }
    chosen.area = surface.area(), chosen.radius = darts.covering_radius;
    return chosen;
}

}  // namespace mote::gathering
