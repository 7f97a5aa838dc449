// Loop subdivision with boundaries (Hoppe et al. 1994; weights as in "Physically based rendering", 4th ed.,
// Sec. 6.4 online).
#include <map>
#include <set>

#include "core/formats/pbrt/pbrt_meshes.h"
#include "core/geometry/mesh_edits.h"

namespace mote::core {
namespace {

constexpr std::size_t max_triangles = 50'000'000;

struct Edge {
    std::uint32_t opposite[2] = {0, 0};
    int faces = 0;
    std::uint32_t middle = 0;
};
using Key = std::pair<std::uint32_t, std::uint32_t>;

Key key(std::uint32_t a, std::uint32_t b) { return a < b ? Key(a, b) : Key(b, a); }

std::map<Key, Edge> edges_of(const MeshData& mesh) {
    std::map<Key, Edge> edges;
    for (const auto& t : mesh.triangles)
        for (int i = 0; i < 3; ++i) {
            Edge& e = edges[key(t[i], t[(i + 1) % 3])];
            if (e.faces < 2) e.opposite[e.faces] = t[(i + 2) % 3];
            ++e.faces;
        }
    return edges;
}

/// Sum and number of neighbours of every vertex: on the boundary those along it alone.
struct Ring {
    Vec3d sum{0.0};
    int count = 0;
    bool boundary = false;
};
std::vector<Ring> rings_of(const MeshData& mesh, const std::map<Key, Edge>& edges) {
    std::vector<Ring> rings(mesh.positions.size());
    for (const auto& [ends, e] : edges)
        if (e.faces != 2) rings[ends.first].boundary = rings[ends.second].boundary = true;
    for (const auto& [ends, e] : edges)
        for (const auto& [from, to] : {ends, Key(ends.second, ends.first)})
            if (!rings[from].boundary || e.faces != 2)
                rings[from].sum += Vec3d(mesh.positions[to]), ++rings[from].count;
    return rings;
}

/// Each vertex moved by its neighbours, with weights for the inside (by valence) and the boundary.
template <typename Inside>
std::vector<Vec3> moved(const MeshData& mesh, const std::map<Key, Edge>& edges, const Inside& inside,
                        double boundary) {
    const std::vector<Ring> rings = rings_of(mesh, edges);
    std::vector<Vec3> positions;
    for (std::size_t i = 0; i < rings.size(); ++i) {
        const double w = rings[i].count == 0 ? 0.0 : rings[i].boundary ? boundary : inside(rings[i].count);
        positions.push_back(Vec3((1.0 - rings[i].count * w) * Vec3d(mesh.positions[i]) + w * rings[i].sum));
    }
    return positions;
}

double beta(int valence) { return valence == 3 ? 3.0 / 16.0 : 3.0 / (8.0 * valence); }

MeshData refined(const MeshData& mesh) {
    std::map<Key, Edge> edges = edges_of(mesh);
    MeshData out;
    out.positions = moved(mesh, edges, beta, 1.0 / 8.0);
    for (auto& [ends, e] : edges) {
        const Vec3 a = mesh.positions[ends.first] + mesh.positions[ends.second];
        e.middle = std::uint32_t(out.positions.size());
        out.positions.push_back(e.faces == 2 ? 0.375f * a + 0.125f * (mesh.positions[e.opposite[0]] +
                                                                      mesh.positions[e.opposite[1]])
                                             : 0.5f * a);
    }
    for (const auto& t : mesh.triangles) {
        std::uint32_t m[3];
        for (int i = 0; i < 3; ++i) m[i] = edges.at(key(t[i], t[(i + 1) % 3])).middle;
        for (int i = 0; i < 3; ++i) out.triangles.push_back({t[i], m[i], m[(i + 2) % 3]});
        out.triangles.push_back({m[0], m[1], m[2]});
    }
    return out;
}

}  // namespace

MeshData pbrt_loop_subdivision(const PbrtObject& shape) {
    shape.ignore({"scheme"});
    const int levels = shape.integer("levels", 3);
    MeshData mesh = pbrt_triangle_mesh(shape);
    mesh.normals.clear(), mesh.uvs.clear();
    if (levels < 0 || levels > 16 ||
        (double(mesh.triangles.size()) * std::pow(4.0, levels) > double(max_triangles)))
        throw InputError("a mesh is subdivided too often: more than 50 million triangles", shape.where);
    for (int i = 0; i < levels; ++i) mesh = refined(mesh);
    const auto limit = [](int valence) { return 1.0 / (valence + 3.0 / (8.0 * beta(valence))); };
    mesh.positions = moved(mesh, edges_of(mesh), limit, 1.0 / 5.0);
    compute_vertex_normals(mesh);
    return mesh;
}

}  // namespace mote::core
