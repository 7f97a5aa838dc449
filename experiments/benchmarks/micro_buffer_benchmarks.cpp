// Micro-buffers against as many of Embree's rays: time and noise in one run, and how time grows with points.
#include "core/geometry/embree_api.h"
#include "core/math/random.h"
#include "core/math/warp.h"
#include "experiments/benchmarks/half_million.h"
#include "experiments/benchmarks/turns.h"
#include "gathering/micro_buffers/micro_buffers.h"

namespace mote::benchmarks {
namespace {

using namespace core;
using namespace gathering;

constexpr std::uint32_t side = 16;  // texels; 256 rays a receiver
/// Four texels for each of `side`^2, with nodes as large as for one.
constexpr MicroBufferSettings settings{.side = 2 * side, .cut = 4.0f};

/// Bare Embree over a triangle list.
class BareScene {
  public:
    explicit BareScene(const SurfaceTriangles& triangles) : scene_(rtcNewScene(device_.get())) {
        const embree::Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
        indices_.resize(3 * triangles.size());
        for (std::size_t i = 0; i < indices_.size(); ++i) indices_[i] = unsigned(i);
        rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   triangles.corners.data(), 0, sizeof(Vec3), 3 * triangles.size());
        rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   indices_.data(), 0, 3 * sizeof(unsigned), triangles.size());
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometry(scene_.get(), geometry.get());
        rtcCommitScene(scene_.get());
    }
    struct Hit {
        float distance;  ///< infinity: none
        Vec3 position, normal;
    };
    Hit closest(const Vec3& origin, const Vec3& direction) const {
        RTCRayHit query{};
        query.ray.org_x = origin.x, query.ray.org_y = origin.y, query.ray.org_z = origin.z;
        query.ray.dir_x = direction.x, query.ray.dir_y = direction.y, query.ray.dir_z = direction.z;
        query.ray.tnear = 1e-4f, query.ray.tfar = infinity, query.ray.mask = 0xffffffffu;
        query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        embree::Query context;
        embree::intersect(scene_.get(), context, query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {infinity, {}, {}};
        return {query.ray.tfar, origin + query.ray.tfar * direction,
                glm::normalize(Vec3(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z))};
    }

  private:
    embree::Device device_{rtcNewDevice(nullptr)};
    embree::Scene scene_;
    std::vector<unsigned> indices_;
};

/// The room of half a million triangles under a point light, and what a camera sees of it.
struct LitRoom {
    SurfaceTriangles triangles = surface_triangles(make_room("path", 16, 16)->shapes());
    BareScene scene{triangles};
    std::vector<MicroReceiver> receivers;

    /// Radiance that leaves a place of the surface on its front: one bounce, with shadows and a texture.
    float radiance(const Vec3& p, const Vec3& n) const {
        const Vec3 light(0.2f, 0.1f, 0.6f), to = light - p;
        const float d2 = glm::dot(to, to), d = std::sqrt(d2), cosine = glm::dot(n, to) / d;
        if (!(cosine > 0.0f) || scene.closest(p + 1e-3f * n, to / d).distance < 0.999f * d) return 0.0f;
        return (0.55f + 0.35f * std::sin(7.0f * p.x) * std::sin(7.0f * p.y) * std::sin(7.0f * p.z)) * cosine /
               d2;
    }
    /// First hits of pixels x pixels, tile by tile, frames turned at random.
    explicit LitRoom(std::uint32_t pixels = 256) {
        const Frame camera(Vec3(1, 0, 0), glm::normalize(Vec3(0, 0.34f, 1.7f)),
                           glm::normalize(Vec3(0, 1.7f, -0.34f)));
        Rng rng(5);
        for (std::uint32_t i = 0; i < pixels * pixels; ++i) {
            const std::uint32_t tile = i / 16, tiles = pixels / 4;
            const float x = float(4 * (tile % tiles) + i % 4), y = float(4 * (tile / tiles) + i % 16 / 4);
            const Vec2 film = 0.7f * (2.0f * Vec2(x + 0.5f, y + 0.5f) / float(pixels) - 1.0f);
            const Vec3 origin(0, -0.7f, 0), direction = glm::normalize(camera.to_world(Vec3(film, 1.0f)));
            const BareScene::Hit hit = scene.closest(origin, direction);
            if (hit.distance == infinity) continue;
            const Vec3 n = glm::dot(hit.normal, direction) > 0.0f ? -hit.normal : hit.normal;
            const float turn = 2.0f * pi * rng.next_float();
            const Frame any(n);
            receivers.push_back(
                {hit.position + 1e-4f * n, Frame(n, std::cos(turn) * any.s + std::sin(turn) * any.t)});
        }
    }
    /// Mean of `count` rays from a receiver, of strata or independent [W/(m^2 sr)]: irradiance over pi.
    double by_rays(const MicroReceiver& receiver, std::uint32_t strata, bool independent, Rng& rng) const {
        double sum = 0.0;
        for (std::uint32_t i = 0; i < strata * strata; ++i) {
            Vec2 u = rng.next_vec2();
            if (!independent) u = (Vec2(float(i % strata), float(i / strata)) + u) / float(strata);
            const Vec3 direction = receiver.frame.to_world(square_to_cosine_hemisphere(u));
            const BareScene::Hit hit = scene.closest(receiver.position, direction);
            if (hit.distance < infinity && glm::dot(hit.normal, direction) < 0.0f)
                sum += double(radiance(hit.position, hit.normal));
        }
        return sum / double(strata * strata);
    }
};

const LitRoom& lit_room() {
    static const LitRoom room;
    return room;
}

/// Points of the room, lit.
struct LitPoints {
    explicit LitPoints(std::uint32_t count)
        : surfels(blue_noise_surfels(lit_room().triangles, count)), hierarchy(surfels) {}
    NodeRadiance light() const {
        std::vector<Rgb> front(surfels.size());
        for (std::size_t i = 0; i < front.size(); ++i)
            front[i] = Rgb(lit_room().radiance(surfels.positions[i], surfels.normals[i]));
        return NodeRadiance(hierarchy, front);
    }
    /// Seconds for every `step`-th tile of the receivers.
    double gather(std::size_t step) const {
        const MicroBuffers buffers(hierarchy, settings);
        std::vector<MicroTexel> texels(16 * buffers.texels_each());
        const std::span<const MicroReceiver> all = lit_room().receivers;
        return seconds_of([&] {
            for (std::size_t i = 0; i + 16 <= all.size(); i += 16 * step)
                buffers.render(all.subspan(i, 16), texels);
        });
    }

    Surfels surfels;
    PointHierarchy hierarchy;
};

const LitPoints& usual_points() {
    static const LitPoints points(100'000);
    return points;
}

/// Root mean square errors, relative to that of the reference.
struct GatherErrors {
    double micro = 0.0, independent = 0.0, stratified = 0.0;
};

GatherErrors gather_errors(const LitPoints& points) {
    const NodeRadiance light = points.light();
    const MicroBuffers buffers(points.hierarchy, settings);
    std::vector<MicroTexel> texels(buffers.texels_each());
    GatherErrors errors;
    double norm = 0.0;
    for (std::size_t i = 0; i < lit_room().receivers.size(); i += 256) {
        const MicroReceiver& receiver = lit_room().receivers[i];
        Rng rng(i);
        const double exact = lit_room().by_rays(receiver, 96, false, rng);
        buffers.render(std::span(&receiver, 1), texels);
        const Rgb e = gathered(texels, buffers.texels().cosine_weight(), light);
        const auto squared = [&](double x) { return (x - exact) * (x - exact); };
        errors.micro += squared(double(e.x) / double(pi));
        errors.independent += squared(lit_room().by_rays(receiver, side, true, rng));
        errors.stratified += squared(lit_room().by_rays(receiver, side, false, rng));
        norm += exact * exact;
    }
    for (double* error : {&errors.micro, &errors.independent, &errors.stratified})
        *error = std::sqrt(*error / norm);
    return errors;
}

/// 65,536 receivers with 16 x 16 texels over 100,000 points against 256 rays each.
void micro_buffers_against_rays(benchmark::State& state) {
    const LitPoints& points = usual_points();
    const std::size_t receivers = lit_room().receivers.size();
    take_turns(
        state, 1.5, double(receivers) * side * side, [&] { return points.gather(1); },
        [&] {
            Rng rng(3);
            float sum = 0.0f;
            const double seconds = seconds_of([&] {
                for (const MicroReceiver& r : lit_room().receivers)
                    for (std::uint32_t k = 0; k < side * side; ++k)
                        sum += lit_room()
                                   .scene
                                   .closest(r.position,
                                            r.frame.to_world(square_to_cosine_hemisphere(rng.next_vec2())))
                                   .distance;
            });
            benchmark::DoNotOptimize(sum);
            return seconds;
        });
    state.counters["receivers"] = double(receivers);
}
BENCHMARK(micro_buffers_against_rays)->UseManualTime()->Iterations(3)->Unit(benchmark::kMillisecond);

/// Error of micro-buffers, with their bias, over that of as many independent rays: a third at most.
void micro_buffer_error_against_rays(benchmark::State& state) {
    const GatherErrors errors = gather_errors(usual_points());
    for (auto _ : state) state.SetIterationTime(1e-3);
    state.counters["ratio"] = errors.micro / errors.independent, state.counters["target"] = 1.0 / 3.0;
    state.counters["error"] = errors.micro, state.counters["error_of_rays"] = errors.independent;
    state.counters["error_of_stratified_rays"] = errors.stratified;
    state.counters["ours_M_per_s"] = state.counters["bare_M_per_s"] = 0.0;
}
BENCHMARK(micro_buffer_error_against_rays)->UseManualTime()->Iterations(1);

/// A hundred times the points: the ratio is that of the times, at most 100^0.4.
void micro_buffers_of_a_million_points(benchmark::State& state) {
    const LitPoints few(10'000), many(1'000'000);
    const double receivers = double(lit_room().receivers.size()) / 16.0;
    take_turns(
        state, std::pow(100.0, 0.4), receivers * side * side, [&] { return many.gather(16); },
        [&] { return few.gather(16); });
    state.counters["exponent"] = std::log(state.counters["ratio"]) / std::log(100.0);
}
BENCHMARK(micro_buffers_of_a_million_points)->UseManualTime()->Iterations(9)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mote::benchmarks
