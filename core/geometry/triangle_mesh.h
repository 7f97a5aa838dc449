// Indexed triangle meshes in world space, with optional normals and texture coordinates.
#pragma once

#include <array>
#include <span>

#include "core/geometry/rounding.h"
#include "core/geometry/shape.h"
#include "core/math/distribution.h"
#include "core/math/transform.h"
#include "core/objects/found_once.h"

namespace mote::core {

/// Values of vertices or faces beyond what a mesh is made of, see SurfaceAttributes.
struct MeshAttribute {
    std::string name;         ///< begins with "vertex_" or "face_"
    bool of_faces = false;    ///< one value a triangle, not a vertex
    std::vector<Rgb> values;  ///< one a vertex or triangle; three times the same where there is one number
};

/// Arrays of a mesh.
struct MeshData {
    std::vector<Vec3> positions;  ///< of the vertices [m]
    std::vector<Vec3> normals;    ///< per vertex, or empty: geometric normals are used
    std::vector<Vec2> uvs;        ///< per vertex, or empty: barycentric coordinates are used
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< three vertices each
    std::vector<MeshAttribute> attributes = {};           ///< that textures may read
};

/// The point of a triangle with barycentric coordinates u and v of its second and third corner.
inline Vec3 triangle_point(const Vec3& a, const Vec3& b, const Vec3& c, float u, float v) {
    const Vec3d p0(a);
    return Vec3(p0 + double(u) * (Vec3d(b) - p0) + double(v) * (Vec3d(c) - p0));
}

/// Points corner + u.x first + u.y second of u in the unit square.
struct Parallelogram {
    Vec3 corner, first, second;  ///< [m]
    Vec3 normal;                 ///< geometric, unit
    float area;                  ///< [m^2]
};

/// Triangles as one shape; its data does not change.
class TriangleMesh final : public Shape, private SurfaceAttributes {
  public:
    /// Takes the data as it is (world space). Throws InputError for an index out of range, a position that is
    /// not finite or beyond 1e18, or no triangle left; triangles without area are dropped and counted in
    /// notes.
    explicit TriangleMesh(MeshData data);

    /// A shape of the same triangles, which both hold: in memory once. Nothing is attached to `other` yet.
    TriangleMesh(const TriangleMesh& other) = default;

    /// Shapes that hold its triangles, this one among them.
    long holders() const { return built_.use_count(); }

    /// The arrays that it was made of.
    const MeshData& data() const { return built_->data; }
    /// Fills everything of a hit but t, from the barycentric coordinates (u, v) that Embree reports.
    void fill_hit(std::uint32_t primitive, float u, float v, SurfaceHit& hit) const;

    Bounds3 bounds() const override { return built_->bounds; }
    DirectionCone normals() const override;
    float support(const Vec3& direction) const override;
    float area() const override { return built_->area; }
    ShapeSample sample_area(const Vec2& u) const override;
    bool closed() const override;  ///< found when first needed
    std::size_t primitive_count() const override { return built_->data.triangles.size(); }
    const SurfaceAttributes* attributes() const override {
        return built_->data.attributes.empty() ? nullptr : this;
    }

    /// Data of a triangle that fill a hit: one cache miss instead of two dependent ones.
    struct alignas(64) Triangle {
        std::array<Vec3, 3> corners;  ///< [m]
        Vec3 normal;                  ///< geometric, unit
        float plane_error = 0.0f;     ///< of Embree's test on which side a ray starts, along the normal [m]
        Triangle() = default;
        /// From its corners, in order [m].
        explicit Triangle(const std::array<Vec3, 3>& corners);
        Vec3 point(float u, float v) const {
            return triangle_point(corners[0], corners[1], corners[2], u, v);
        }  ///< at the barycentric coordinates u and v [m]
        float error(const Vec3& at) const { return quantization_error(at, normal) + plane_error; }  ///< [m]
    };
    const Triangle& triangle(std::uint32_t i) const { return built_->triangles[i]; }  ///< of primitive i
    /// Interpolated, on the side of the geometric normal; that one itself where vertices have none.
    Vec3 shading_normal(std::uint32_t primitive, float u, float v, const Vec3& geometric) const {
        return built_->data.normals.empty() ? geometric : interpolated_normal(primitive, u, v, geometric);
    }
    /// The parallelogram that its two triangles form, or nothing.
    std::optional<Parallelogram> parallelogram() const;

  private:
    Vec3 interpolated_normal(std::uint32_t primitive, float u, float v, const Vec3& geometric) const;
    /// dp/du and dp/dv; across the geometric normal where the texture coordinates do not define them.
    void fill_derivatives(std::uint32_t primitive, SurfaceHit& hit) const;
    TextureCoordinates texture_coordinates(std::uint32_t primitive, float u, float v) const;

    bool has_attribute(std::string_view name) const override { return find_attribute(name) != nullptr; }
    Rgb attribute(std::string_view name, std::uint32_t primitive, const Vec2& barycentric) const override;
    Rgb attribute_mean(std::string_view name) const override;
    Vec2 attribute_range(std::string_view name) const override;
    const MeshAttribute* find_attribute(std::string_view name) const;
    Rgb attribute_at(const MeshAttribute& attribute, std::uint32_t primitive, const Vec2& b) const;

    struct Point {
        std::uint32_t primitive;
        Vec2 barycentric;  ///< coordinates of the triangle's second and third corner
    };
    Point sample_point(const Vec2& u) const;
    /// Two triangles that form a parallelogram: their corners opposite to the diagonal that they share.
    struct Halves {
        int first, second;  ///< 0 to 2
        bool turned;        ///< the second one's next corner is the first one's next corner, too
    };
    static std::optional<Halves> find_halves(std::span<const Triangle> triangles);

    /// Properties of triangles and vertices alone; it does not change.
    struct Built {
        MeshData data;
        Bounds3 bounds;
        std::vector<Triangle> triangles;
        std::optional<Halves> halves;  ///< of a parallelogram, which needs no table of areas
        float area = 0.0f;
        FoundOnce<bool> closed;           ///< needed where a medium begins or ends
        FoundOnce<Distribution1D> areas;  ///< areas relative to the largest, for samples of points
    };
    const Distribution1D& areas() const;
    std::shared_ptr<const Built> built_;
};

/// Applies a transform to positions and normals (in double precision) and keeps the orientation of the faces:
/// a mirroring transform swaps two indices of each triangle.
void transform_mesh(MeshData& data, const Transform& to_world);

/// [-1,1]^2 facing +z, and [-1,1]^3 facing outwards, as Mitsuba 3 has them.
MeshData make_rectangle();
/// The cube [-1, 1]^3.
MeshData make_cube();

/// Reads OBJ, PLY and what else assimp reads. Throws InputError naming the file. `flip_v` follows Mitsuba:
/// OBJ flips V, PLY does not. Counts dropped faces in `notes`.
MeshData load_mesh(const std::string& path, bool face_normals, bool flip_v, std::vector<std::string>& notes);

}  // namespace mote::core
