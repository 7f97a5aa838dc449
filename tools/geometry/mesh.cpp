#include "tools/geometry/mesh.h"

#include <bit>
#include <stdexcept>
#include <unordered_map>

#include "core/files/atomic_file.h"
#include "core/math/random.h"

namespace mote::tools {
namespace {

using core::hash_keys;

std::array<std::uint32_t, 3> bits(const Vec3& v) {
    const Vec3 w = v + Vec3(0.0f);  // -0 becomes 0
    return {std::bit_cast<std::uint32_t>(w.x), std::bit_cast<std::uint32_t>(w.y),
            std::bit_cast<std::uint32_t>(w.z)};
}

/// Numbers things by their bits, in the order in which they come.
template <std::size_t N>
class Numbering {
  public:
    using Key = std::array<std::uint32_t, N>;
    explicit Numbering(std::size_t expected) { numbers_.reserve(expected); }
    std::uint32_t operator()(const Key& key) { return numbers_.emplace(key, numbers_.size()).first->second; }
    std::size_t size() const { return numbers_.size(); }

  private:
    struct Hash {
        std::size_t operator()(const Key& key) const {
            std::uint64_t h = 0;
            for (const std::uint32_t k : key) h = hash_keys(h, k);
            return std::size_t(h);
        }
    };
    std::unordered_map<Key, std::uint32_t, Hash> numbers_;
};

bool has_area(const std::array<Vec3, 3>& t) {
    const Vec3 e = t[1] - t[0], f = t[2] - t[0], g = t[2] - t[1];
    const float area = glm::length(glm::cross(e, f));
    const float longest = std::fmax(glm::dot(e, e), std::fmax(glm::dot(f, f), glm::dot(g, g)));
    return area > 2e-12f && area > 1e-6f * longest;
}

/// The faces around every point, one after the other: those of point i begin at first[i].
struct Fans {
    std::vector<std::uint32_t> first, faces;

    Fans(const std::vector<std::array<std::uint32_t, 3>>& points, std::size_t count) : first(count + 1, 0) {
        for (const auto& t : points)
            for (const std::uint32_t p : t) ++first[p + 1];
        for (std::size_t i = 0; i < count; ++i) first[i + 1] += first[i];
        faces.resize(3 * points.size());
        std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
        for (std::uint32_t f = 0; f < points.size(); ++f)
            for (const std::uint32_t p : points[f]) faces[next[p]++] = f;
    }
};

}  // namespace

IndexedMesh weld(const Soup& soup, float crease_degrees) {
    Numbering<3> point_of(soup.size());
    std::vector<std::array<std::uint32_t, 3>> points;
    std::vector<std::array<Vec3, 3>> corners;
    std::vector<Vec3> area_normals;
    for (const auto& t : soup.triangles()) {
        for (const Vec3& p : t)
            if (!core::is_finite(p)) throw std::logic_error("a generated position is not finite");
        if (!has_area(t)) continue;
        points.push_back({point_of(bits(t[0])), point_of(bits(t[1])), point_of(bits(t[2]))});
        corners.push_back(t);
        area_normals.push_back(glm::cross(t[1] - t[0], t[2] - t[0]));
    }
    const Fans fans(points, point_of.size());
    const float crease = std::cos(crease_degrees * core::pi / 180.0f);
    Numbering<6> vertex_of(points.size());
    IndexedMesh mesh;
    for (std::size_t f = 0; f < points.size(); ++f) {
        const Vec3 own = glm::normalize(area_normals[f]);
        std::array<std::uint32_t, 3> triangle;
        for (int k = 0; k < 3; ++k) {
            Vec3 sum(0.0f);
            for (std::uint32_t i = fans.first[points[f][k]]; i < fans.first[points[f][k] + 1]; ++i) {
                const Vec3& other = area_normals[fans.faces[i]];
                if (glm::dot(own, other) >= crease * glm::length(other)) sum += other;
            }
            const Vec3 normal = glm::normalize(sum);
            const auto p = bits(corners[f][k]), n = bits(normal);
            triangle[k] = vertex_of({p[0], p[1], p[2], n[0], n[1], n[2]});
            if (triangle[k] < mesh.positions.size()) continue;
            mesh.positions.push_back(corners[f][k]);
            mesh.normals.push_back(normal);
        }
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

void write_ply(const std::filesystem::path& path, const IndexedMesh& mesh) {
    static_assert(std::endian::native == std::endian::little);
    const std::string header =
        "ply\nformat binary_little_endian 1.0\ncomment made by mote_geometry\nelement vertex " +
        std::to_string(mesh.positions.size()) +
        "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n"
        "property float nz\nelement face " +
        std::to_string(mesh.triangles.size()) + "\nproperty list uchar uint vertex_indices\nend_header\n";
    std::vector<std::byte> bytes;
    bytes.reserve(header.size() + 24 * mesh.positions.size() + 13 * mesh.triangles.size());
    const auto put = [&](const void* data, std::size_t size) {
        const auto* from = static_cast<const std::byte*>(data);
        bytes.insert(bytes.end(), from, from + size);
    };
    put(header.data(), header.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        put(&mesh.positions[i], sizeof(Vec3));
        put(&mesh.normals[i], sizeof(Vec3));
    }
    for (const auto& t : mesh.triangles) {
        const std::uint8_t three = 3;
        put(&three, 1);
        put(t.data(), sizeof(t));
    }
    core::write_file_atomically(path.string(), bytes);
}

}  // namespace mote::tools
