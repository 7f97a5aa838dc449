// Cost of mote_upbp over bare rays and point queries: a light subpath against its rays, a lookup of vertices
// against Embree's point query over the same points, and a lookup of beams against the bare traversal of
// their boxes.
#include "core/geometry/embree_api.h"
#include "experiments/benchmarks/half_million.h"
#include "experiments/benchmarks/ray_log.h"
#include "experiments/benchmarks/turns.h"
#include "integrators/bidirectional/strategies.h"
#include "integrators/upbp/light_beams.h"
#include "integrators/upbp/light_vertices.h"

namespace mote::benchmarks {
namespace {

using namespace core;
using namespace integrators;

constexpr int paths = 20000, queries = 20000;
constexpr float kernel_radius = 0.05f;  // of the kernel [m]

/// Light subpaths of the room, traced by one thread, and merged only: no connection to the lens.
class LightPaths {
  public:
    LightPaths() : scene_(make_room("path", 64, 64)), ends_(*scene_) {
        settings_.connections = false, settings_.merging.radius[std::size_t(Merge::surface)] = kernel_radius;
    }
    double trace() {
        subpaths_.resize(paths);
        WalkContext walk;
        Strategies<false> strategies(*scene_, ends_, settings_, paths, 0.5f, walk);
        return seconds_of([&] {
            for (std::uint32_t i = 0; i < paths; ++i) {
                Sampler sampler(SamplerKind::sobol, 1, i, 0, 7u);
                walk.rng = Rng(hash_keys(1, 0, i, 7u));
                strategies.trace_light_path(sampler, [](const Contribution&, const Vec2&) {});
                subpaths_[i] = strategies.light_path();
            }
        });
    }
    LightVertices vertices() const { return {subpaths_, settings_.merging, Rng(1)}; }
    /// Positions of the vertices that merge.
    std::vector<Vec3> positions() const {
        std::vector<Vec3> positions;
        for (const Subpath& path : subpaths_)
            for (std::size_t k = 1; k < path.vertices.size(); ++k)
                if (path.vertices[k].scattering.connectable() && !is_black(path.vertices[k].weight))
                    positions.push_back(path.vertices[k].scattering.position);
        return positions;
    }

  private:
    std::unique_ptr<Scene> scene_;
    LightEnds ends_;
    BidirectionalSettings settings_;
    std::vector<Subpath> subpaths_;
};

void light_subpath_against_bare_rays(benchmark::State& state) {
    LightPaths light;
    RayLog log;
    light.trace();
    log.close();
    take_turns(
        state, no_target, double(log.rays.size()), [&] { return light.trace(); },
        [&] { return trace_bare(log.rays); });
    state.counters["rays"] = double(log.rays.size());
}
BENCHMARK(light_subpath_against_bare_rays)->UseManualTime()->Iterations(15)->Unit(benchmark::kMillisecond);

/// Embree's hierarchy over points, which it queries for those within a distance.
class BarePoints {
  public:
    explicit BarePoints(std::span<const Vec3> points) : points_(points) {
        const embree::Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
        rtcSetGeometryUserPrimitiveCount(geometry.get(), unsigned(points.size()));
        rtcSetGeometryUserData(geometry.get(), this);
        rtcSetGeometryBoundsFunction(geometry.get(), bounds, nullptr);
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometry(scene_.get(), geometry.get());
        rtcCommitScene(scene_.get());
    }
    std::size_t count(const Vec3& p, float radius) const {
        Query query{this, p, radius * radius, 0};
        RTCPointQuery q{};
        q.x = p.x, q.y = p.y, q.z = p.z, q.radius = radius;
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        rtcPointQuery(scene_.get(), &q, &context, visit, &query);
        return query.found;
    }

  private:
    struct Query {
        const BarePoints* self;
        Vec3 p;
        float square;
        std::size_t found;
    };
    static void bounds(const RTCBoundsFunctionArguments* a) {
        const Vec3& p = static_cast<const BarePoints*>(a->geometryUserPtr)->points_[a->primID];
        RTCBounds& o = *a->bounds_o;
        o.lower_x = o.upper_x = p.x, o.lower_y = o.upper_y = p.y, o.lower_z = o.upper_z = p.z;
    }
    static bool visit(RTCPointQueryFunctionArguments* a) {
        Query& query = *static_cast<Query*>(a->userPtr);
        const Vec3 d = query.self->points_[a->primID] - query.p;
        query.found += glm::dot(d, d) < query.square;
        return false;
    }
    std::span<const Vec3> points_;
    embree::Device device_{rtcNewDevice(nullptr)};
    embree::Scene scene_{rtcNewScene(device_.get())};
};

void points_against_bare_queries(benchmark::State& state) {
    LightPaths light;
    light.trace();
    const LightVertices vertices = light.vertices();
    const std::vector<Vec3> positions = light.positions();
    const BarePoints bare(positions);
    std::vector<KdTree::Neighbour> scratch;
    std::size_t ours = 0, theirs = 0;
    const auto at = [&](int i) { return positions[std::size_t(i) % positions.size()]; };
    take_turns(
        state, no_target, double(queries),
        [&] {
            return seconds_of([&] {
                for (int i = 0; i < queries; ++i)
                    vertices.for_each_near(true, at(i), kernel_radius, scratch,
                                           [&](const LightVertex&) { ++ours; });
            });
        },
        [&] {
            return seconds_of([&] {
                for (int i = 0; i < queries; ++i) theirs += bare.count(at(i), kernel_radius);
            });
        });
    state.counters["found_ours"] = double(ours), state.counters["found_bare"] = double(theirs);
}
BENCHMARK(points_against_bare_queries)->UseManualTime()->Iterations(15)->Unit(benchmark::kMillisecond);

/// 2000 beams of 1 m in a cube of 2 m, and query beams like them.
struct RandomBeams {
    RandomBeams() {
        Rng rng(38);
        for (int i = 0; i < 2000; ++i) beams.push_back(beam(rng));
        for (int i = 0; i < queries; ++i) rays.push_back(beam(rng));
    }
    static Ray beam(Rng& rng) {
        const auto coordinate = [&] { return 2.0f * rng.next_float() - 1.0f; };
        Ray ray;
        ray.origin = {coordinate(), coordinate(), coordinate()};
        ray.direction = glm::normalize(Vec3(coordinate(), coordinate(), coordinate()) + Vec3(1e-4f));
        ray.t_max = 1.0f;
        return ray;
    }
    std::vector<Ray> beams, rays;
};

/// LightBeams::crossings() without its sort, against the traversal of the same boxes, 8 a beam.
void beams_against_bare_boxes(benchmark::State& state) {
    const RandomBeams random;
    std::vector<Bounds3> boxes;
    for (const Ray& beam : random.beams)
        for (int i = 0; i < 8; ++i) {
            Bounds3& box = boxes.emplace_back();
            box.extend(beam.at(float(i) / 8.0f)), box.extend(beam.at(float(i + 1) / 8.0f));
            box.lower -= Vec3(0.005f), box.upper += Vec3(0.005f);
        }
    const BoxHierarchy hierarchy(boxes);
    std::size_t visited = 0, crossed = 0;
    take_turns(
        state, no_target, double(queries),
        [&] {
            return seconds_of([&] {
                for (const Ray& ray : random.rays)
                    hierarchy.for_each_box(ray, [&](std::uint32_t box) {
                        const auto c = crossing_of(ray, random.beams[box / 8]);
                        crossed += c && c->apart < 0.005;
                    });
            });
        },
        [&] {
            return seconds_of([&] {
                for (const Ray& ray : random.rays)
                    hierarchy.for_each_box(ray, [&](std::uint32_t) { ++visited; });
            });
        });
    state.counters["boxes_a_query"] = double(visited) / double(queries);
    state.counters["crossed"] = double(crossed);
}
BENCHMARK(beams_against_bare_boxes)->UseManualTime()->Iterations(15)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mote::benchmarks
