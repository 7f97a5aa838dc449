#include "experiments/benchmarks/occlusion_forms.h"

#include <limits>

#include "experiments/benchmarks/turns.h"

namespace mote::benchmarks {
namespace {

/// One lane of a packet as a single ray.
RTCRay lane_of(const RTCRay16& p, int i) {
    RTCRay ray{};
    ray.org_x = p.org_x[i], ray.org_y = p.org_y[i], ray.org_z = p.org_z[i], ray.tnear = p.tnear[i];
    ray.dir_x = p.dir_x[i], ray.dir_y = p.dir_y[i], ray.dir_z = p.dir_z[i], ray.tfar = p.tfar[i];
    ray.time = p.time[i], ray.mask = p.mask[i];
    return ray;
}
void set_lane(RTCRay16& p, int i, const RTCRay& ray) {
    p.org_x[i] = ray.org_x, p.org_y[i] = ray.org_y, p.org_z[i] = ray.org_z, p.tnear[i] = ray.tnear;
    p.dir_x[i] = ray.dir_x, p.dir_y[i] = ray.dir_y, p.dir_z[i] = ray.dir_z, p.tfar[i] = ray.tfar;
    p.time[i] = ray.time, p.mask[i] = ray.mask, p.id[i] = 0, p.flags[i] = 0;
}

/// Embree overwrites rays, so every run gets a copy; copying is not timed and leaves the copy in the cache,
/// as rays made on the spot are.
template <typename Item, typename Trace>
double timed_on_copy(const std::vector<Item>& items, Trace&& trace) {
    std::vector<Item> copy = items;
    return seconds_of([&] { trace(copy); });
}

}  // namespace

OcclusionRays::OcclusionRays(const std::vector<LoggedPacket>& packets) : logged_(packets) {
    for (const LoggedPacket& packet : packets) {
        scene_ = packet.scene;
        for (int lane = 0; lane < 16; ++lane)
            if (packet.valid[lane]) singles_.push_back(lane_of(packet.rays, lane));
    }
    for (std::size_t i = 0; i < singles_.size(); ++i) {
        const int lane = int(i % 16);
        if (lane == 0) full_.push_back(LoggedPacket{{}, {}, scene_});
        set_lane(full_.back().rays, lane, singles_[i]);
        full_.back().valid[lane] = -1;
    }
    if (!full_.empty())  // streams know no mask: idle lanes have an empty interval
        for (int lane = 0; lane < 16; ++lane)
            if (!full_.back().valid[lane])
                full_.back().rays.tnear[lane] = 1, full_.back().rays.tfar[lane] = -1;
}

double OcclusionRays::one_by_one(const OcclusionRays& rays) {
    return timed_on_copy(rays.singles_, [&](std::vector<RTCRay>& copy) {
        for (RTCRay& ray : copy) bare_occluded(rays.scene_, ray);
    });
}

template <bool coherent>
double OcclusionRays::packets_as_logged(const OcclusionRays& rays) {
    return timed_on_copy(rays.logged_, [&](std::vector<LoggedPacket>& copy) {
        for (LoggedPacket& p : copy) bare_occluded(p.valid, p.scene, p.rays, coherent);
    });
}

template <bool coherent>
double OcclusionRays::full_packets(const OcclusionRays& rays) {
    return timed_on_copy(rays.full_, [&](std::vector<LoggedPacket>& copy) {
        for (LoggedPacket& p : copy) bare_occluded(p.valid, p.scene, p.rays, coherent);
    });
}

#if RTC_VERSION_MAJOR < 4
template <bool coherent>
double OcclusionRays::stream_of_singles(const OcclusionRays& rays) {
    return timed_on_copy(rays.singles_, [&](std::vector<RTCRay>& copy) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        rtcOccluded1M(rays.scene_, &context, copy.data(), unsigned(copy.size()), sizeof(RTCRay));
    });
}

template <bool coherent>
double OcclusionRays::stream_of_packets(const OcclusionRays& rays) {
    return timed_on_copy(rays.full_, [&](std::vector<LoggedPacket>& copy) {
        bare_occluded_stream(rays.scene_, &copy.front().rays, unsigned(copy.size()), sizeof(LoggedPacket),
                             coherent);
    });
}
#endif

std::vector<OcclusionRays::Form> OcclusionRays::forms() {
    return {
        {"one by one", one_by_one}, {"packets as logged", packets_as_logged<false>},
            {"packets as logged, coherent hint", packets_as_logged<true>},
            {"full packets", full_packets<false>}, {"full packets, coherent hint", full_packets<true>},
#if RTC_VERSION_MAJOR < 4
            {"stream of rays", stream_of_singles<false>},
            {"stream of rays, coherent hint", stream_of_singles<true>},
            {"stream of packets", stream_of_packets<false>}, {
            "stream of packets, coherent hint", stream_of_packets<true>
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
