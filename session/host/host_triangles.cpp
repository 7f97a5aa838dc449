#include "session/host/host_triangles.h"

#include <map>

#include "core/objects/error.h"
#include "gathering/micro_buffers/micro_buffers.h"
#include "gathering/ray_bundles/bundle_tracer.h"
#include "gathering/ray_bundles/triangle_list.h"
#include "gathering/surface_points/surfels.h"

namespace mote::session {

using core::Rgb, core::Vec2, core::Vec3;

namespace {

bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

gathering::SurfaceTriangles listed(const HostTriangles& mesh) {
    for (const Vec3& position : mesh.positions)
        if (!is_finite(position)) throw core::InputError("a corner of a triangle is not finite");
    gathering::SurfaceTriangles list;
    gathering::TriangleList adder(list, 0);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        std::array<gathering::TriangleList::Corner, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t index = mesh.triangles[i][k];
            if (index >= mesh.positions.size())
                throw core::InputError("triangle " + std::to_string(i) + " names corner " +
                                       std::to_string(index) + ": there are " +
                                       std::to_string(mesh.positions.size()));
            corners[k].position = mesh.positions[index];
        }
        adder.add(corners[0], corners[1], corners[2], i);
    }
    return list;
}

}  // namespace

std::vector<Rgb> micro_irradiance(const HostTriangles& mesh, std::span<const Rgb> radiance,
                                  std::span<const Vec3> positions, std::span<const Vec3> normals,
                                  const MicroGatherSettings& settings) {
    if (radiance.size() != mesh.triangles.size()) throw core::InputError("each triangle has a radiance");
    if (positions.size() != normals.size())
        throw core::InputError("each receiver has a position and a normal");
    if (settings.passes < 1 || settings.points < 1) throw core::InputError("there is a point, and a pass");
    std::vector<gathering::MicroReceiver> receivers;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (!is_finite(positions[i]) || !(std::fabs(glm::dot(normals[i], normals[i]) - 1.0f) < 1e-3f))
            throw core::InputError("a receiver has a finite position and a unit normal");
        receivers.push_back({positions[i], core::Frame(normals[i])});
    }
    const gathering::SurfaceTriangles list = listed(mesh);
    const gathering::Surfels points =
        gathering::blue_noise_surfels(list, settings.points, {.seed = settings.seed});
    const gathering::PointHierarchy hierarchy(points);
    std::vector<Rgb> sent;
    sent.reserve(points.size());
    for (const gathering::SurfacePoint& place : points.places) sent.push_back(radiance[place.triangle]);
    const gathering::NodeRadiance of_nodes(hierarchy, sent);
    std::vector<Rgb> sum(receivers.size(), Rgb(0.0f)), one(receivers.size());
    for (std::uint32_t i = 0; i < settings.passes; ++i) {  // Hammersley's places of the rays
        std::uint32_t reversed = 0;
        for (int bit = 0; bit < 32; ++bit) reversed |= (i >> bit & 1u) << (31 - bit);
        const Vec2 place((float(i) + 0.5f) / float(settings.passes),
                         std::min(float(reversed) * 0x1p-32f + 0.5f / float(settings.passes), 0.999f));
        const gathering::MicroBuffers buffers(hierarchy, {.side = settings.side, .place = place});
        gathering::gather_irradiance(buffers, of_nodes, receivers, one);
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += one[k] / float(settings.passes);
    }
    return sum;
}

std::vector<BundleLink> bundle_links(const HostTriangles& mesh, const Vec3& direction, float spacing,
                                     const Vec2& offset) {
    const float length = glm::length(direction);
    if (!(length > 0.0f) || !std::isfinite(length)) throw core::InputError("a direction is finite and not 0");
    if (!(offset.x >= 0.0f && offset.x < 1.0f && offset.y >= 0.0f && offset.y < 1.0f))
        throw core::InputError("the offset is in [0, 1)");
    const gathering::SurfaceTriangles list = listed(mesh);
    const gathering::BundleTracer tracer(list);
    const gathering::BundleGrid grid =
        gathering::bundle_grid(direction / length, list.bounds, spacing, offset);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> rays;
    gathering::for_each_link(tracer.trace(grid), [&](std::size_t, const auto& near, const auto& far) {
        ++rays[{near.index(), far.index()}];
    });
    std::vector<BundleLink> links;
    for (const auto& [pair, count] : rays)
        links.push_back({pair.first, pair.second, double(count) * double(grid.ray_area())});
    return links;
}

}  // namespace mote::session
