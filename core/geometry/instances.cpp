// From a group's space to the world: points by the matrix, normals by its inverse transpose.
#include "core/geometry/instances.h"

#include "core/geometry/mesh_checks.h"
#include "core/geometry/quadric.h"
#include "core/geometry/rounding.h"
#include "core/geometry/triangle_mesh.h"
#include "core/math/pdf_conversion.h"

namespace mote::core {
namespace {

glm::dmat3 absolute(const glm::dmat3& m) { return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])}; }

/// Embree inverts the matrix in single precision, by cofactors: bounds of the error of each entry of the
/// inverse, and of its product with a point, relative to the sum of that product's absolute terms. Counted
/// per entry: a product and a difference in the cofactor (of the terms before they cancel), the determinant
/// and a division; then three products and three sums in the transform of a point.
glm::dmat3 inversion_error(const glm::dmat3& m, const glm::dmat3& inverse) {
    const glm::dmat3 a = absolute(m);
    const double determinant = std::fabs(glm::determinant(m));
    glm::dmat3 cofactors;  // of absolute values, all terms added; column by column of the inverse's transpose
    for (int c = 0; c < 3; ++c) {
        const Vec3d &p = a[(c + 1) % 3], &q = a[(c + 2) % 3];
        cofactors[c] = {p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x};
    }
    const double cancelled = glm::dot(a[0], cofactors[0]) / determinant;
    return half_ulp *
           (4.0 / determinant * glm::transpose(cofactors) + (8.0 * cancelled + 8.0) * absolute(inverse));
}

Transform rounded(const Transform& t) { return Transform(glm::dmat4(glm::mat4(t.matrix))); }

/// Zero for numbers that single precision loses, as renders do with denormal ones.
float normal_or_zero(float x) { return std::isnormal(x) ? x : 0.0f; }

/// True if the inverse that Embree computes in single precision, by cofactors over the determinant, belongs
/// to this matrix. Otherwise Embree would trace something else, or abort on numbers that are not finite.
bool invertible_in_single_precision(const glm::dmat3& m) {
    constexpr double tolerance = 1e-3;
    const glm::mat3 a(m);
    glm::dmat3 inverse;
    for (int c = 0; c < 3; ++c) {
        const Vec3 cofactors = glm::cross(a[(c + 1) % 3], a[(c + 2) % 3]);
        const float determinant = normal_or_zero(glm::determinant(a));
        for (int r = 0; r < 3; ++r) inverse[r][c] = double(normal_or_zero(cofactors[r]) / determinant);
    }
    const glm::dmat3 traced = glm::inverse(inverse);
    for (int c = 0; c < 3; ++c)
        if (!(glm::length(traced[c] - m[c]) <= tolerance * glm::length(m[c]))) return false;
    return true;
}

}  // namespace

Placement::Placement(std::shared_ptr<const ShapeGroup> group, const Transform& to_world,
                     const SourceLocation& where)
    : group_(std::move(group)), where_(where), to_world_(rounded(to_world)) {
    if (!to_world.valid() || !to_world_.valid())
        throw InputError("the transform of an instance is singular or not finite", where);
    if (!invertible_in_single_precision(glm::dmat3(to_world_.matrix)))
        throw InputError(
            "the transform of an instance is singular in single precision: it is too small, too large or too "
            "uneven",
            where);
    to_local_ = to_world_.inverse();
    const glm::dmat3 linear(to_world_.matrix), inverse(to_local_.matrix);
    normals_ = glm::transpose(inverse);
    determinant_ = std::fabs(glm::determinant(linear));
    inversion_error_ = inversion_error(linear, inverse);
}

float Placement::error(const Vec3& position, const Vec3& normal, float local_error) const {
    // A world normal n is that of the local plane M^T n; M^T n is as long as world distances are in units of
    // local ones.
    const Vec3d local = glm::transpose(glm::dmat3(to_world_.matrix)) * Vec3d(normal);
    const double scale = glm::length(local);
    const Vec3d reach = glm::abs(Vec3d(position)) + glm::abs(Vec3d(to_world_.matrix[3]));
    const double moved = glm::dot(glm::abs(local) / scale, inversion_error_ * reach);
    return quantization_error(position, normal) + float(scale * (double(local_error) + moved));
}

double Placement::max_ray_origin() const {
    const glm::dmat3 inverse(to_local_.matrix);
    const double stretch = std::sqrt(glm::dot(inverse[0], inverse[0]) + glm::dot(inverse[1], inverse[1]) +
                                     glm::dot(inverse[2], inverse[2]));
    const double limit = double(largest_coordinate);
    return stretch < limit ? limit / stretch - glm::length(Vec3d(to_world_.matrix[3])) : -1.0;
}

InstancedShape::InstancedShape(std::shared_ptr<const Placement> placement, std::size_t member)
    : placement_(std::move(placement)), member_(member) {
    const Shape& shape = original();
    if (shape.emitter)
        throw InputError("a light cannot be instanced: its shape must stand in the scene",
                         placement_->where());
    id = shape.id;
    bsdf = shape.bsdf, interior = shape.interior, exterior = shape.exterior;
    exterior_where = shape.exterior_where;
    has_medium_boundary = shape.has_medium_boundary, tangent_matters = shape.tangent_matters;
    const Bounds3 box = shape.bounds();
    const Vec3d center = 0.5 * (Vec3d(box.lower) + Vec3d(box.upper)), half = Vec3d(box.upper) - center;
    const glm::dmat3 spread = absolute(glm::dmat3(placement_->to_world().matrix));
    bounds_ = outward_bounds(placement_->to_world().point(center), spread * half);
    if (!(max_component(glm::abs(bounds_.lower)) < largest_coordinate &&
          max_component(glm::abs(bounds_.upper)) < largest_coordinate))
        throw InputError("an instance reaches beyond 1e18", placement_->where());
}

void InstancedShape::to_world(SurfaceHit& hit) const {
    const Vec3d geometric = placement_->world_normal(Vec3d(hit.geometric_normal));
    hit.position = Vec3(placement_->to_world().point(Vec3d(hit.position)));
    hit.geometric_normal = Vec3(geometric);
    hit.error = placement_->error(hit.position, hit.geometric_normal, hit.error);
    Vec3d n = placement_->world_normal(Vec3d(hit.shading.n));
    if (glm::dot(n, geometric) < 0.0) n = -n;  // uneven maps bend normals
    if (tangent_matters) {
        hit.dp_du = Vec3(placement_->to_world().vector(Vec3d(hit.dp_du)));
        hit.dp_dv = Vec3(placement_->to_world().vector(Vec3d(hit.dp_dv)));
        hit.shading = Frame(Vec3(n), hit.dp_du);
    } else {
        hit.shading = Frame(Vec3(n));
    }
    hit.shape = this;
}

float InstancedShape::area() const {
    if (const auto* mesh = dynamic_cast<const TriangleMesh*>(&original())) {
        const Transform& map = placement_->to_world();
        double sum = 0.0;
        for (const auto& [a, b, c] : mesh->data().triangles) {
            const auto& p = mesh->data().positions;
            const Vec3d origin(p[a]);
            sum += 0.5 * glm::length(
                             glm::cross(map.vector(Vec3d(p[b]) - origin), map.vector(Vec3d(p[c]) - origin)));
        }
        return float(sum);
    }
    constexpr int n = 64;
    double mean = 0.0;
    for (int i = 0; i < n * n; ++i) {
        const Vec2 u((float(i % n) + 0.5f) / n, (float(i / n) + 0.5f) / n);
        mean += placement_->area_factor(Vec3d(original().sample_area(u).normal)) / (n * n);
    }
    return float(double(original().area()) * mean);
}

ShapeSample InstancedShape::sample_area(const Vec2& u) const {
    ShapeSample sample = original().sample_area(u);
    const Vec3d local_normal(sample.normal);
    sample.position = Vec3(placement_->to_world().point(Vec3d(sample.position)));
    sample.normal = Vec3(placement_->world_normal(local_normal));
    sample.pdf_area = float(double(sample.pdf_area) / placement_->area_factor(local_normal));
    sample.error = placement_->error(sample.position, sample.normal, sample.error);
    return sample;
}

float InstancedShape::pdf_visible(const Vec3& p, const Vec3& wi, const SurfaceHit& hit) const {
    const Vec3d local =
        glm::transpose(glm::dmat3(placement_->to_world().matrix)) * Vec3d(hit.geometric_normal);
    const double density = 1.0 / (double(original().area()) * placement_->area_factor(glm::normalize(local)));
    const Vec3 to_light = hit.position - p;
    return area_to_solid_angle(float(density), glm::dot(to_light, to_light),
                               glm::dot(hit.geometric_normal, wi));
}

std::vector<std::shared_ptr<Shape>> place_group(std::shared_ptr<const ShapeGroup> group,
                                                const Transform& to_world, const SourceLocation& where) {
    const std::size_t count = group->shapes.size();
    const auto placement = std::make_shared<const Placement>(std::move(group), to_world, where);
    std::vector<std::shared_ptr<Shape>> placed;
    for (std::size_t i = 0; i < count; ++i) placed.push_back(std::make_shared<InstancedShape>(placement, i));
    return placed;
}

}  // namespace mote::core
