// Connections take no memory: every operator new of this program is counted while many are made through
// media, boundaries and panes.
#include <atomic>
#include <cstdlib>
#include <new>

#include "core/math/warp.h"
#include "tests/core/scene/scene_fixture.h"

using namespace mote::core;
using namespace mote::tests;

namespace {
std::atomic<std::size_t> allocations{0};
}

void* operator new(std::size_t bytes) {
    ++allocations;
    if (void* memory = std::malloc(bytes > 0 ? bytes : 1)) return memory;
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

TEST_CASE("connections through media and panes take no memory", "[scene][media]") {
    std::string body = "<medium type='homogeneous' id='a'><float name='sigma_t' value='0.1'/></medium>";
    for (int i = 0; i < 6; ++i)
        body += "<shape type='sphere'><point name='center' x='" + std::to_string(i) +
                "' y='0' z='0'/><bsdf type='null'/><ref name='interior' id='a'/></shape>";
    body +=
        "<shape type='rectangle'><transform name='to_world'><scale value='9'/><rotate y='1' angle='90'/>"
        "<translate x='2'/></transform><bsdf type='thindielectric'/></shape>";
    const auto scene = load_body(body);
    const MediumState outside = scene->medium_state_at({-9, 0, 0}, nullptr);
    Rng rng(5);
    TrackingCounters counters;
    Rgb sum(0.0f);
    const auto connect = [&](int i) {
        const Vec3 from(-9, 0.1f * rng.next_float(), 0), to(9, rng.next_float(), 0.01f * float(i % 9));
        sum += scene->transmittance(from, to, outside, rng, counters);
        PathWeights weights;
        scene->connect({from, glm::normalize(to - from), 0.0f, glm::length(to - from)}, outside, weights, rng,
                       counters);
        sum += weights.throughput;
    };
    connect(0);  // whatever is made once
    std::size_t before = allocations;
    for (int i = 0; i < 1000; ++i) connect(i);
    CHECK(allocations == before);
    CHECK(sum.x > 10.0f);  // they came through
    // The count can fail: a list of the boundaries takes memory.
    before = allocations;
    std::vector<SurfaceHit> hits;
    scene->boundaries_along({{-9, 0, 0}, {1, 0, 0}}, hits);
    CHECK(hits.size() >= 13);
    CHECK(allocations > before);
}
