// Micro-buffers and ray-bundles over a host's triangles.
#include "session/host/host_triangles.h"

#include "plugins/c/handles.h"

using namespace mote;
using c::required, c::vec3;
using core::Rgb, core::Vec3;

namespace {

/// A host's mesh, copied.
struct CopiedMesh {
    std::vector<Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;

    explicit CopiedMesh(const mote_triangles& given) {
        for (std::size_t i = 0; i < given.position_count; ++i)
            positions.push_back(vec3(&required(given.positions, "the positions") + 3 * i));
        for (std::size_t i = 0; i < given.triangle_count; ++i) {
            const std::uint32_t* corners = &required(given.triangles, "the triangles") + 3 * i;
            triangles.push_back({corners[0], corners[1], corners[2]});
        }
    }
    session::HostTriangles mesh() const { return {positions, triangles}; }
};

}  // namespace

mote_status mote_micro_irradiance(const mote_micro_options* given, const mote_receiver* receivers,
                                  size_t count, float* irradiance) {
    c::LastError unheard;
    return c::guarded(unheard, [&] {
        const mote_micro_options o = c::known_options(&required(given, "the options"));
        const CopiedMesh copied(o.mesh);
        std::vector<Rgb> radiance;
        for (std::size_t i = 0; i < o.mesh.triangle_count; ++i)
            radiance.push_back(vec3(&required(o.radiance, "the radiance") + 3 * i));
        std::vector<Vec3> positions, normals;
        for (std::size_t i = 0; i < count; ++i) {
            const mote_receiver& r = (&required(receivers, "the receivers"))[i];
            positions.push_back(vec3(r.position)), normals.push_back(vec3(r.normal));
        }
        session::MicroGatherSettings settings;
        if (o.points) settings.points = o.points;
        if (o.side) settings.side = o.side;
        if (o.passes) settings.passes = o.passes;
        settings.seed = o.seed;
        const auto found = session::micro_irradiance(copied.mesh(), radiance, positions, normals, settings);
        for (std::size_t i = 0; i < count; ++i)
            for (int c = 0; c < 3; ++c)
                (&required(irradiance, "the irradiance"))[3 * i + std::size_t(c)] = found[i][c];
    });
}

mote_status mote_bundle_links(const mote_triangles* given, const float direction[3], double spacing,
                              const float offset[2], mote_bundle_link* links, size_t room, size_t* count) {
    c::LastError unheard;
    return c::guarded(unheard, [&] {
        const CopiedMesh copied(required(given, "the triangles"));
        const core::Vec2 moved = offset ? core::Vec2(offset[0], offset[1]) : core::Vec2(0.5f);
        const auto found = session::bundle_links(copied.mesh(), vec3(&required(direction, "the direction")),
                                                 float(spacing), moved);
        required(count, "the count") = found.size();
        for (std::size_t i = 0; i < std::min(room, found.size()); ++i)
            (&required(links, "the links"))[i] = {found[i].from, found[i].to, found[i].area};
    });
}
