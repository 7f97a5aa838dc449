// The rectangle and the cube, with the corners and texture coordinates that Mitsuba 3 gives them.
#include "core/geometry/triangle_mesh.h"

namespace mote::core {

MeshData make_rectangle() {
    MeshData data;
    data.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    data.normals.assign(4, Vec3(0, 0, 1));
    data.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    data.triangles = {{0, 1, 2}, {2, 3, 0}};
    return data;
}

MeshData make_cube() {
    // Each face: its normal, its corner with texture coordinates (0, 0), and the directions of u and v.
    struct Face {
        Vec3 normal, corner, u, v;
    };
    static constexpr Face faces[6] = {
        {{0, -1, 0}, {-1, -1, -1}, {0, 0, 1}, {1, 0, 0}}, {{0, 1, 0}, {1, 1, 1}, {-1, 0, 0}, {0, 0, -1}},
        {{1, 0, 0}, {1, -1, 1}, {0, 1, 0}, {0, 0, -1}},   {{0, 0, 1}, {-1, -1, 1}, {0, 1, 0}, {1, 0, 0}},
        {{-1, 0, 0}, {-1, -1, -1}, {0, 1, 0}, {0, 0, 1}}, {{0, 0, -1}, {-1, 1, -1}, {0, -1, 0}, {1, 0, 0}},
    };
    MeshData data;
    for (const Face& face : faces) {
        const auto first = std::uint32_t(data.positions.size());
        for (const Vec2& uv : {Vec2(0, 1), Vec2(1, 1), Vec2(1, 0), Vec2(0, 0)}) {
            data.positions.push_back(face.corner + 2.0f * (uv.x * face.u + uv.y * face.v));
            data.normals.push_back(face.normal);
            data.uvs.push_back(uv);
        }
        data.triangles.push_back({first, first + 1, first + 2});
        data.triangles.push_back({first + 3, first, first + 2});
    }
    return data;
}

}  // namespace mote::core
