// Ray-bundles against what they stand on: Embree's bare rays, a bare pass over the triangles; and imperfect
// bundles against exact ones.
#include <tbb/global_control.h>

#include <cmath>
#include <filesystem>

#include "core/formats/xml/scene_loader.h"
#include "core/geometry/embree_api.h"
#include "experiments/benchmarks/half_million.h"
#include "experiments/benchmarks/turns.h"
#include "gathering/ray_bundles/bundle_directions.h"
#include "gathering/ray_bundles/bundle_tracer.h"
#include "gathering/ray_bundles/grid_steps.h"
#include "gathering/ray_bundles/imperfect_bundles.h"
#include "gathering/ray_bundles/projected_triangle.h"
#include "session/registry.h"

namespace mote::benchmarks {
namespace {

using namespace core;
using namespace gathering;

constexpr std::uint32_t directions = 3;

BundleGrid grid_of(const SurfaceTriangles& triangles, std::uint32_t side, std::uint32_t index) {
    const BundleSample sample = bundle_sample(1, index);
    return bundle_grid(sample.direction, triangles.bounds,
                       glm::length(triangles.bounds.diagonal()) / float(side), sample.offset);
}

/// The room of half a million triangles with a bundle of each direction.
struct Room {
    SurfaceTriangles triangles = surface_triangles(make_room("path", 16, 16)->shapes());
    BundleTracer tracer{triangles};

    double trace(BundleForm form, std::uint32_t side) const {
        return seconds_of([&] {
            for (std::uint32_t i = 0; i < directions; ++i) {
                const RayBundle bundle = tracer.trace(grid_of(triangles, side, i), {.form = form});
                benchmark::DoNotOptimize(bundle.hits.data());
            }
        });
    }
    double hits(std::uint32_t side) const {
        double sum = 0.0;
        for (std::uint32_t i = 0; i < directions; ++i)
            sum += double(tracer.trace(grid_of(triangles, side, i)).hits.size());
        return sum;
    }
};

const Room& room() {
    static const Room room;
    return room;
}

/// Traces the same packets through Embree's own triangles; a filter counts the hits and lets the rays
/// continue.
class BareRays {
  public:
    explicit BareRays(const SurfaceTriangles& triangles)
        : triangles_(triangles), scene_(rtcNewScene(device_.get())) {
        const embree::Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
        indices_.resize(3 * triangles.size());
        for (std::size_t i = 0; i < indices_.size(); ++i) indices_[i] = unsigned(i);
        rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   triangles.corners.data(), 0, sizeof(Vec3), 3 * triangles.size());
        rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   indices_.data(), 0, 3 * sizeof(unsigned), triangles.size());
        rtcSetGeometryUserData(geometry.get(), &hits_);
        rtcSetGeometryOccludedFilterFunction(geometry.get(), count);
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometry(scene_.get(), geometry.get());
        rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
        rtcCommitScene(scene_.get());
    }
    double trace(std::uint32_t side) {
        return seconds_of([&] {
            for (std::uint32_t i = 0; i < directions; ++i) trace(grid_of(triangles_, side, i));
        });
    }
    double hits() const { return double(hits_); }

  private:
    static void count(const RTCFilterFunctionNArguments* arguments) {
        for (unsigned lane = 0; lane < arguments->N; ++lane) {
            *static_cast<std::uint64_t*>(arguments->geometryUserPtr) += arguments->valid[lane] != 0;
            arguments->valid[lane] = 0;
        }
    }
    void trace(const BundleGrid& grid) {
        alignas(64) int valid[16];
        RTCRay16 rays{};
        for (std::uint32_t y = 0; y < grid.rows; y += 4)
            for (std::uint32_t x = 0; x < grid.columns; x += 4) {
                for (std::uint32_t lane = 0; lane < 16; ++lane) {
                    const Vec3 o = grid.ray_origin(x + lane % 4, y + lane / 4);
                    rays.org_x[lane] = o.x, rays.org_y[lane] = o.y, rays.org_z[lane] = o.z;
                    rays.dir_x[lane] = grid.direction.x, rays.dir_y[lane] = grid.direction.y;
                    rays.dir_z[lane] = grid.direction.z;
                    rays.tnear[lane] = 0.0f, rays.tfar[lane] = infinity, rays.mask[lane] = 0xffffffffu;
                    valid[lane] = x + lane % 4 < grid.columns && y + lane / 4 < grid.rows ? -1 : 0;
                }
                embree::Query query;
                embree::use_coherent_rays(query);
                embree::occluded(valid, scene_.get(), query, rays);
            }
    }

    const SurfaceTriangles& triangles_;
    embree::Device device_{rtcNewDevice(nullptr)};
    embree::Scene scene_;
    std::vector<unsigned> indices_;
    std::uint64_t hits_ = 0;
};

/// One pass over the triangles with nothing kept: projected, cut into rows, the depths of all fragments
/// added.
double bare_scan(const SurfaceTriangles& triangles, const BundleGrid& grid) {
    const BundleProjection projection(grid);
    double sum = 0.0;
    for (const auto& corners : triangles.corners) {
        const auto p = project(projection, corners);
        const GridSteps rows(lowest_of(p[0].y, p[1].y, p[2].y), highest_of(p[0].y, p[1].y, p[2].y),
                             grid.rows);
        for (std::int64_t y = rows.from; y <= rows.to; ++y) {
            double lower = infinity, upper = -infinity;
            for (std::size_t i = 0; i < 3; ++i) {
                const Vec3d &a = p[i], &b = p[(i + 1) % 3];
                if (std::min(a.y, b.y) > double(y) || std::max(a.y, b.y) < double(y) || a.y == b.y) continue;
                const double x = a.x + (double(y) - a.y) / (b.y - a.y) * (b.x - a.x);
                lower = std::min(lower, x), upper = std::max(upper, x);
            }
            const GridSteps columns(lower, upper, grid.columns);
            for (std::int64_t x = columns.from; x <= columns.to; ++x) sum += p[0].z + 1e-3 * double(x);
        }
    }
    return sum;
}

void bundle_rays_against_bare_embree(benchmark::State& state) {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    BareRays bare(room().triangles);
    const auto side = std::uint32_t(state.range(0));
    // Embree tests four triangles of a leaf at once, and counts what passes an edge twice or not at all; the
    // rule that counts it once is requested each triangle whose box a packet meets.
    take_turns(
        state, 4.0, room().hits(side), [&] { return room().trace(BundleForm::rays, side); },
        [&] { return bare.trace(side); });
    state.counters["hits"] = room().hits(side);
}
BENCHMARK(bundle_rays_against_bare_embree)
    ->Arg(512)
    ->UseManualTime()
    ->Iterations(9)
    ->Unit(benchmark::kMillisecond);

void bundle_scan_against_bare_pass(benchmark::State& state) {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const auto side = std::uint32_t(state.range(0));
    const auto bare = [&] {
        return seconds_of([&] {
            for (std::uint32_t i = 0; i < directions; ++i)
                benchmark::DoNotOptimize(bare_scan(room().triangles, grid_of(room().triangles, side, i)));
        });
    };
    // Beside the pass: every hit is kept, and those of a ray are put in order.
    take_turns(
        state, 3.0, room().hits(side), [&] { return room().trace(BundleForm::scan, side); }, bare);
    state.counters["hits"] = room().hits(side);
    state.counters["triangles"] = double(room().triangles.size() * directions);
}
BENCHMARK(bundle_scan_against_bare_pass)
    ->Arg(64)
    ->Arg(512)
    ->UseManualTime()
    ->Iterations(9)
    ->Unit(benchmark::kMillisecond);

/// Points and rays as coarse as imperfect bundles are for, against the faster of the exact forms.
void imperfect_bundles_against_exact(benchmark::State& state, const std::string& name) {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const std::string folder = MOTE_SOURCE_DIR "/scenes/";
    if (!std::filesystem::exists(folder + "generated/" + name + ".txt")) {
        state.SkipWithError("no meshes: run scenes/generate");
        return;
    }
    const auto scene = load_scene(folder + name + ".xml", session::make_registry());
    const SurfaceTriangles triangles = surface_triangles(scene->shapes());
    const BundleTracer tracer(triangles);
    const ImperfectBundles imperfect(triangles, 4096);
    constexpr std::uint32_t side = 64, many = 8;
    const auto both = [&](const auto& trace) {
        return seconds_of([&] {
            for (std::uint32_t i = 0; i < many; ++i)
                benchmark::DoNotOptimize(trace(grid_of(triangles, side, i), i).hits.data());
        });
    };
    take_turns(
        state, 0.25, many,
        [&] {
            return both([&](const BundleGrid& grid, std::uint32_t i) { return imperfect.trace(grid, i); });
        },
        [&] { return both([&](const BundleGrid& grid, std::uint32_t) { return tracer.trace(grid); }); });
}
BENCHMARK_CAPTURE(imperfect_bundles_against_exact, atrium, "atrium")
    ->UseManualTime()
    ->Iterations(15)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(imperfect_bundles_against_exact, city, "city")
    ->UseManualTime()
    ->Iterations(15)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mote::benchmarks
