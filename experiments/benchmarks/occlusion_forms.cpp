#include "experiments/benchmarks/occlusion_forms.h"

#include <limits>

#include "core/math/vec.h"
#include "experiments/benchmarks/turns.h"

namespace mote::benchmarks {
namespace {

/// Embree overwrites rays, so every run gets a copy; copying is not timed and leaves the copy in the cache,
/// as rays made on the spot are.
template <typename Item, typename Trace>
double timed_on_copy(const std::vector<Item>& items, Trace&& trace) {
    std::vector<Item> copy = items;
    return seconds_of([&] { trace(copy); });
}

bool same_target(const RTCRay& a, const RTCRay& b) {
    const core::Vec3 end_a(a.org_x + a.dir_x, a.org_y + a.dir_y, a.org_z + a.dir_z);
    const core::Vec3 end_b(b.org_x + b.dir_x, b.org_y + b.dir_y, b.org_z + b.dir_z);
    return glm::length(end_a - end_b) <= 1e-5f * (1.0f + glm::length(end_a));
}

}  // namespace

void OcclusionRays::append(Packets& packets, int lane, const RTCRay& ray) {
    if (lane == 0) {
        Packet& p = packets.emplace_back();
        for (int i = 0; i < 16; ++i) {
            p.rays.org_x[i] = p.rays.org_y[i] = p.rays.org_z[i] = p.rays.time[i] = 0.0f;
            p.rays.dir_x[i] = p.rays.dir_y[i] = p.rays.dir_z[i] = 1.0f;
            p.rays.tnear[i] = 0.0f, p.rays.tfar[i] = -1.0f;
            p.rays.mask[i] = 0xffffffffu, p.rays.id[i] = p.rays.flags[i] = 0, p.valid[i] = 0;
        }
    }
    Packet& p = packets.back();
    p.rays.org_x[lane] = ray.org_x, p.rays.org_y[lane] = ray.org_y, p.rays.org_z[lane] = ray.org_z;
    p.rays.dir_x[lane] = ray.dir_x, p.rays.dir_y[lane] = ray.dir_y, p.rays.dir_z[lane] = ray.dir_z;
    p.rays.tnear[lane] = ray.tnear, p.rays.tfar[lane] = ray.tfar, p.valid[lane] = -1;
}

OcclusionRays::OcclusionRays(const RayLog& log) {
    int lane = 0;
    for (const LoggedRay& logged : log.rays) {
        if (!logged.occlusion) continue;
        scene_ = logged.scene;
        lane = lane == 16 || (lane > 0 && !same_target(singles_.back(), logged.ray)) ? 0 : lane;
        append(one_target_, lane++, logged.ray);
        append(full_, int(singles_.size() % 16), logged.ray);
        singles_.push_back(logged.ray);
    }
}

double OcclusionRays::one_by_one(const OcclusionRays& rays) {
    return timed_on_copy(rays.singles_, [&](std::vector<RTCRay>& copy) {
        for (RTCRay& ray : copy) bare_occluded(rays.scene_, ray);
    });
}

template <bool coherent, OcclusionRays::Packets OcclusionRays::*packets>
double OcclusionRays::in_packets(const OcclusionRays& rays) {
    return timed_on_copy(rays.*packets, [&](Packets& copy) {
        for (Packet& p : copy) bare_occluded(p.valid, rays.scene_, p.rays, coherent);
    });
}

#if RTC_VERSION_MAJOR < 4
template <bool coherent>
double OcclusionRays::in_stream(const OcclusionRays& rays) {
    return timed_on_copy(rays.singles_, [&](std::vector<RTCRay>& copy) {
        bare_occluded_stream(rays.scene_, copy.data(), unsigned(copy.size()), coherent);
    });
}
#endif

std::vector<OcclusionRays::Form> OcclusionRays::forms() {
    return {
        {"one by one", one_by_one}, {"packets of one target", in_packets<false, &OcclusionRays::one_target_>},
            {"packets of one target, coherent hint", in_packets<true, &OcclusionRays::one_target_>},
            {"full packets", in_packets<false, &OcclusionRays::full_>},
            {"full packets, coherent hint", in_packets<true, &OcclusionRays::full_>},
#if RTC_VERSION_MAJOR < 4
            {"stream of rays", in_stream<false>}, {
            "stream of rays, coherent hint", in_stream<true>
        }
#endif
    };
}

std::size_t fastest_form(const std::vector<OcclusionRays>& tiles) {
    const auto forms = OcclusionRays::forms();
    std::vector<double> best(forms.size(), std::numeric_limits<double>::infinity());
    for (int turn = 0; turn < 5; ++turn)
        for (std::size_t f = 0; f < forms.size(); ++f) {
            double sum = 0.0;
            for (const OcclusionRays& tile : tiles) sum += forms[f].seconds(tile);
            best[f] = std::min(best[f], sum);
        }
    return std::size_t(std::min_element(best.begin(), best.end()) - best.begin());
}

}  // namespace mote::benchmarks
