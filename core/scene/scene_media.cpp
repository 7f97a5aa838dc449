// Media that surround a point.
//
// A point's shapes are found by casting a ray: along it the crossings of a closed shape alternate between
// leaving and entering, and the first one shows on which side of the surface (as its normals have it) the
// point lies. A ray that grazes a surface or meets an edge breaks the pattern and is replaced by another.
#include <algorithm>
#include <array>

#include "core/objects/error.h"
#include "core/scene/scene.h"

namespace mote::core {
namespace {

/// Directions without a rational relation to anything in a scene: the golden spiral on the sphere, turned.
const std::array<Vec3, 14>& probe_directions() {
    static const std::array<Vec3, 14> directions = [] {
        std::array<Vec3, 14> d;
        for (std::size_t i = 0; i < d.size(); ++i) {
            const double z = 1.0 - (2.0 * double(i) + 0.8137) / double(d.size());
            const double phi = 2.399963229728653 * double(i) + 0.5724;
            const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
            // turned about an axis that is no coordinate axis
            const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), 0.7391, Vec3d(0.3, 0.8, 0.5));
            d[i] =
                Vec3(glm::normalize(Vec3d(turn * glm::dvec4(r * std::cos(phi), r * std::sin(phi), z, 0.0))));
        }
        return d;
    }();
    return directions;
}

/// The hits of both groups along a ray, nearest first.
std::vector<SurfaceHit> hits_along(const RayTracer& rays, const Ray& ray) {
    std::vector<SurfaceHit> hits, more;
    rays.all_hits(ray, RayTracer::Group::surfaces, hits);
    if (rays.has_boundaries()) {
        rays.all_hits(ray, RayTracer::Group::boundaries, more);
        hits.insert(hits.end(), more.begin(), more.end());
        std::stable_sort(hits.begin(), hits.end(),
                         [](const SurfaceHit& a, const SurfaceHit& b) { return a.t < b.t; });
    }
    return hits;
}

bool leaves(const SurfaceHit& hit, const Vec3& direction) {
    return glm::dot(hit.geometric_normal, direction) > 0.0f;
}

/// Evidence of one ray about one shape.
struct Crossings {
    int count = 0;
    bool first_leaves = false, last_leaves = false;
    bool clean = true;  ///< no grazing hit, and leaving and entering alternate
};

Crossings crossings_of(const Shape& shape, const std::vector<SurfaceHit>& hits, const Vec3& direction) {
    Crossings c;
    for (const SurfaceHit& hit : hits) {
        if (hit.shape != &shape) continue;
        const bool out = leaves(hit, direction);
        if (std::fabs(glm::dot(hit.geometric_normal, direction)) < 1e-3f) c.clean = false;
        if (c.count++ == 0)
            c.first_leaves = out;
        else if (out == c.last_leaves)
            c.clean = false;
        c.last_leaves = out;
    }
    return c;
}

}  // namespace

/// The hits along each of the probe directions from a point, found when they are needed.
class ProbeRays {
  public:
    ProbeRays(const RayTracer& rays, const Vec3& p) : rays_(rays), p_(p) {}
    std::size_t size() const { return probe_directions().size(); }
    const Vec3& direction(std::size_t i) const { return probe_directions()[i]; }
    const std::vector<SurfaceHit>& hits(std::size_t i) {
        if (i >= hits_.size()) hits_.resize(i + 1);
        if (!hits_[i]) hits_[i] = hits_along(rays_, Ray{p_, direction(i), 0.0f, infinity});
        return *hits_[i];
    }

  private:
    const RayTracer& rays_;
    Vec3 p_;
    std::vector<std::optional<std::vector<SurfaceHit>>> hits_;
};

namespace {

/// True if p is on the inner side of a closed shape. Traces probe rays until one has a clean result.
bool inside_closed(const Shape& shape, bool inward, ProbeRays& probes) {
    int inside = 0, outside = 0;
    for (std::size_t i = 0; i < probes.size(); ++i) {
        const Crossings c = crossings_of(shape, probes.hits(i), probes.direction(i));
        const bool answer = c.count > 0 ? c.first_leaves : inward;
        // To infinity one ends outside, unless the normals point inwards.
        const bool ends_right = c.count == 0 || c.last_leaves == !inward;
        if (c.clean && ends_right) return answer;
        ++(answer ? inside : outside);
    }
    return inside > outside;
}

/// The nearest surface that names what is on our side of it: seen, and behind something opaque.
struct NamedOutside {
    struct Nearest {
        float t = infinity;
        const Medium* medium = nullptr;
    } seen, hidden;  // hidden: taken only when nothing is seen

    /// `state`: the closed shapes around the point that the ray begins at. `excluded`: the shape it lies on.
    void look(const std::vector<SurfaceHit>& hits, const Vec3& direction, MediumState state,
              const Shape* excluded) {
        bool blocked = false;
        for (const SurfaceHit& hit : hits) {
            const Shape& shape = *hit.shape;
            const bool inner_side = leaves(hit, direction);
            const bool names = shape.has_medium_boundary && hit.shape != excluded && !state.inside_any() &&
                               (!shape.closed() || (!inner_side && shape.exterior));
            Nearest& nearest = blocked ? hidden : seen;
            if (names) {
                if (hit.t < nearest.t)
                    nearest = {hit.t, (inner_side ? shape.interior : shape.exterior).get()};
                return;
            }
            if (shape.closed() && hit.shape != excluded) state.cross(shape, hit.geometric_normal, direction);
            blocked = blocked || !shape.bsdf->traits().passes_straight();
        }
    }
};

}  // namespace

void Scene::find_boundaries() {
    for (const auto& shape : parts_.shapes) {
        if (!shape->has_medium_boundary) continue;
        Boundary boundary{shape.get(), shape->closed(), false};
        if (boundary.closed) {
            // From outside of its bounds, the first hit enters the shape unless its normals point inwards.
            const Bounds3 box = shape->bounds();
            const Vec3 target = shape->sample_area({0.37f, 0.61f}).position;
            const Vec3 origin = box.center() + probe_directions()[0] * (2.1f * box.radius());
            const float distance = glm::length(target - origin);
            Ray ray{origin, (target - origin) / distance, 0.0f, 1.01f * distance};
            const auto hits = hits_along(*rays_, ray);
            const Crossings c = crossings_of(*shape, hits, ray.direction);
            boundary.inward = c.count > 0 && c.first_leaves;
        }
        boundaries_.push_back(boundary);
        outside_is_parted_ = outside_is_parted_ || !boundary.closed;
    }
    if (boundaries_.size() <= std::size_t(MediumState::capacity)) return;
    for (const Boundary& b : boundaries_) {
        MediumState state =
            medium_state_near(b.shape->sample_area({0.37f, 0.61f}).position, nullptr, b.shape);
        state.enter(*b.shape);
        if (state.overflow())
            throw InputError("more than " + std::to_string(MediumState::capacity) +
                                 " shapes with media are nested in each other",
                             {parts_.file, 0});
    }
}

MediumState Scene::medium_state_at(const Vec3& p, const Medium* declared) const {
    return medium_state_near(p, declared, nullptr);
}

/// `excluded`: the shape that p lies on; it takes no part.
MediumState Scene::medium_state_near(const Vec3& p, const Medium* declared, const Shape* excluded) const {
    MediumState state;
    state.set_outside(outermost_);
    if (boundaries_.empty()) return state;
    ProbeRays probes(*rays_, p);
    bool declared_is_inside = false;
    for (const Boundary& b : boundaries_)
        if (b.closed && b.shape != excluded && inside_closed(*b.shape, b.inward, probes)) {
            state.enter(*b.shape);
            declared_is_inside = declared_is_inside || b.shape->interior.get() == declared;
        }
    if (outside_is_parted_)
        state.set_outside(declared && !declared_is_inside ? declared
                                                          : outside_medium(state, p, probes, excluded));
    return state;
}

/// Where open walls part the outside of all closed shapes: the medium that the nearest surface names on our
/// side. `inside`: the closed shapes around the point.
const Medium* Scene::outside_medium(const MediumState& inside, const Vec3& p, ProbeRays& probes,
                                    const Shape* excluded) const {
    NamedOutside named;
    for (std::size_t i = 0; i < probes.size(); ++i)
        named.look(probes.hits(i), probes.direction(i), inside, excluded);
    // A wall that is far away, or small, is between the probes.
    if (named.seen.t == infinity)
        for (const Boundary& b : boundaries_) {
            if (b.closed || b.shape == excluded) continue;
            const Vec3 to_wall = b.shape->sample_area({0.37f, 0.61f}).position - p;
            const float distance = glm::length(to_wall);
            if (!(distance > 0.0f)) continue;
            const Vec3 direction = to_wall / distance;
            named.look(hits_along(*rays_, Ray{p, direction, 0.0f, infinity}), direction, inside, excluded);
        }
    if (named.seen.t < infinity) return named.seen.medium;
    if (named.hidden.t < infinity) return named.hidden.medium;
    return outermost_;
}

}  // namespace mote::core
