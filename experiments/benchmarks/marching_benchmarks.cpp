// Marching and tracking through a VDB against bare NanoVDB lookups at the same points.
// clang-format off: the sampler does not include what it needs
#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/SampleFromVoxels.h>
// clang-format on

#include "core/math/frame.h"
#include "core/math/warp.h"
#include "experiments/benchmarks/smoke_grid.h"
#include "experiments/benchmarks/turns.h"
#include "media/constant_volume.h"
#include "media/phase_functions.h"
#include "media/tracked_medium.h"

namespace mote::benchmarks {
namespace {

using namespace core;
using namespace media;

constexpr int ray_count = 4096;
constexpr float step = 0.75f / 128.0f;  // three quarters of a voxel
constexpr float scale = 40.0f;          // an optical depth of about 20 across the plume

/// The points of one ray in index space, in the order of the lookups.
using Points = std::vector<nanovdb::Vec3f>;

/// Writes down where tracking looks the density up.
struct LoggingCursor {
    float lookup(const Vec3d& p) {
        points->push_back({float(p.x), float(p.y), float(p.z)});
        return cursor.lookup(p);
    }
    NanoCursor cursor;
    Points* points;
};
struct LoggingGrid {
    using Value = float;
    LoggingCursor cursor() const { return {grid.cursor(), points}; }
    NanoGrid grid;
    Transform world_to_index;
    MajorantGrid<float> majorants;
    std::string description;
    Points* points;
};

/// The plume as a medium, and rays in parallel bundles through it, as a camera or a light sends them.
struct Setup {
    std::shared_ptr<const VdbGrid> smoke = make_smoke_grid();
    NanoGrid grid{smoke, smoke->index_to_world().inverse(), nano_majorants(*smoke), "smoke"};
    std::vector<Ray> rays;

    Setup() {
        Rng rng(1);
        for (int bundle = 0; bundle < ray_count / 64; ++bundle) {
            const Vec3 direction = square_to_sphere(rng.next_vec2());
            const Vec3 target =
                0.6f * Vec3(rng.next_float() - 0.5f, 2.0f * rng.next_float() - 1.0f, rng.next_float() - 0.5f);
            const Frame frame(direction);
            for (int i = 0; i < 64; ++i) {
                const Vec2 offset = 0.004f * Vec2(float(i % 8), float(i / 8));
                const Vec3 through = target + offset.x * frame.s + offset.y * frame.t;
                rays.push_back({through - 3.0f * direction, direction, 0.0f, 6.0f});
            }
        }
    }
    MediumParts parts() const {
        MediumParts p;
        p.scale = scale;
        p.albedo = std::make_shared<ConstantVolume>(Rgb(0.8f));
        p.phase = std::make_shared<IsotropicPhase>();
        return p;
    }
    /// The points that `visit(medium, ray, rng)` looks up, ray by ray.
    template <typename Visit>
    std::vector<Points> log_points(Visit&& visit) const {
        Points current;
        const TrackedMedium<LoggingGrid> medium(
            {grid, grid.world_to_index, grid.majorants, grid.description, &current}, parts());
        std::vector<Points> all;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            Rng rng(i);
            visit(medium, rays[i], rng);
            all.push_back(std::move(current));
            current.clear();
        }
        return all;
    }
};

const Setup& setup() {
    static const Setup one;
    return one;
}

double lookups_of(const std::vector<Points>& points) {
    double sum = 0.0;
    for (const Points& p : points) sum += double(p.size());
    return sum;
}

/// NanoVDB's own trilinear sampler with one accessor a ray.
double bare_lookups(const std::vector<Points>& points) {
    const auto& grid = *setup().smoke->data().grid;
    float sum = 0.0f;
    const double seconds = seconds_of([&] {
        for (const Points& ray : points) {
            const auto accessor = grid.getAccessor();
            const auto sampler = nanovdb::createSampler<1>(accessor);
            for (const nanovdb::Vec3f& p : ray) sum += sampler(p);
        }
    });
    benchmark::DoNotOptimize(sum);
    return seconds;
}

/// `visit(medium, ray, rng)` over all rays in turns with the bare lookups at its points.
template <typename Visit>
void compare(benchmark::State& state, double target, Visit&& visit) {
    const Setup& s = setup();
    const auto points = s.log_points(visit);
    const TrackedMedium<NanoGrid> medium(s.grid, s.parts());
    const auto ours = [&] {
        return seconds_of([&] {
            for (std::size_t i = 0; i < s.rays.size(); ++i) {
                Rng rng(i);
                visit(medium, s.rays[i], rng);
            }
        });
    };
    take_turns(state, target, lookups_of(points), ours, [&] { return bare_lookups(points); });
    state.counters["lookups"] = lookups_of(points);
}

void marching_against_bare_lookups(benchmark::State& state) {
    compare(state, 0.95, [](const HeterogeneousMedium& medium, const Ray& ray, Rng&) {
        TrackingCounters counters;
        benchmark::DoNotOptimize(medium.optical_depth_by_marching(ray, step, counters));
    });
}
BENCHMARK(marching_against_bare_lookups)->UseManualTime()->Iterations(25)->Unit(benchmark::kMillisecond);

void ratio_tracking_against_bare_lookups(benchmark::State& state) {
    compare(state, 3.0, [](const HeterogeneousMedium& medium, const Ray& ray, Rng& rng) {
        TrackingCounters counters;
        benchmark::DoNotOptimize(medium.transmittance(ray, rng, counters));
    });
}
BENCHMARK(ratio_tracking_against_bare_lookups)
    ->UseManualTime()
    ->Iterations(25)
    ->Unit(benchmark::kMillisecond);

void delta_tracking_against_bare_lookups(benchmark::State& state) {
    compare(state, 4.5, [](const HeterogeneousMedium& medium, const Ray& ray, Rng& rng) {
        TrackingCounters counters;
        PathWeights weights;
        Rgb emitted(0.0f);
        benchmark::DoNotOptimize(medium.sample_collision(ray, weights, emitted, rng, counters));
    });
}
BENCHMARK(delta_tracking_against_bare_lookups)
    ->UseManualTime()
    ->Iterations(25)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mote::benchmarks
