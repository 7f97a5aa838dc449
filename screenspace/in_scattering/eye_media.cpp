#include "screenspace/in_scattering/eye_media.h"

#include <algorithm>
#include <cmath>

namespace mote::screenspace {

using namespace core;

EyeMedia::EyeMedia(const RayQueries& scene, const Ray& ray, const MediumState& state, float voxels,
                   WalkContext& walk)
    : ray_(ray), voxels_(voxels) {
    std::vector<MediumSegment> segments;
    find_segments(scene, ray, state, segments, walk);
    Rgb before(1.0f);
    for (const MediumSegment& s : segments) {
        before *= s.panes;
        Piece piece{s, before, {}};
        const float step = s.medium ? s.medium->marching_step(voxels, s.t1 - s.t0) : infinity;
        if (std::isfinite(step) && std::isfinite(s.t1)) {
            constexpr float most = 65536.0f;  // of 24 bytes
            piece.depths.resize(std::size_t(std::clamp(std::ceil((s.t1 - s.t0) / step), 1.0f, most)));
            s.medium->optical_depths_along({ray.origin, ray.direction, s.t0, s.t1}, voxels, piece.depths,
                                           walk.tracking);
        }
        before *= within(piece, s.t1, walk);
        pieces_.push_back(std::move(piece));
    }
}

void EyeMedia::segments_up_to(float t, std::vector<MediumSegment>& segments) const {
    segments.clear();
    for (const Piece& piece : pieces_) {
        if (!(piece.segment.t0 < t)) return;
        segments.push_back(piece.segment);
        segments.back().t1 = std::min(piece.segment.t1, t);
    }
}

Rgb EyeMedia::within(const Piece& piece, float t, WalkContext& walk) const {
    const MediumSegment& s = piece.segment;
    if (!s.medium) return Rgb(1.0f);
    if (piece.depths.empty())
        return marched_transmittance(*s.medium, {ray_.origin, ray_.direction, s.t0, t}, voxels_, walk);
    const double parts = double(piece.depths.size());
    const double at =
        std::clamp(parts * (double(t) - double(s.t0)) / (double(s.t1) - double(s.t0)), 0.0, parts);
    const auto i = std::min(std::size_t(at), piece.depths.size() - 1);
    const Vec3d from = i > 0 ? piece.depths[i - 1] : Vec3d(0.0);
    const Vec3d depth = from + (at - double(i)) * (piece.depths[i] - from);
    return {float(std::exp(-depth.x)), float(std::exp(-depth.y)), float(std::exp(-depth.z))};
}

Rgb EyeMedia::transmittance(float t, WalkContext& walk) const {
    for (const Piece& piece : pieces_)
        if (t <= piece.segment.t1)
            return t > piece.segment.t0 ? piece.before * within(piece, t, walk) : piece.before;
    return pieces_.empty() ? Rgb(1.0f)
                           : pieces_.back().before * within(pieces_.back(), pieces_.back().segment.t1, walk);
}

}  // namespace mote::screenspace
