#include "integrators/upbp/light_beams.h"

#include <algorithm>

namespace mote::integrators {

using namespace core;

std::optional<Crossing> crossing_of(const Ray& query, const Ray& beam) {
    const Vec3d u(query.direction), v(beam.direction), from = Vec3d(beam.origin) - Vec3d(query.origin);
    const Vec3d n = glm::cross(u, v);
    const double n2 = glm::dot(n, n);
    if (!(n2 > 1e-14)) return std::nullopt;  // what rounding leaves of directions in single precision
    const double sine = std::sqrt(n2);
    return Crossing{glm::dot(glm::cross(from, v), n) / n2, glm::dot(glm::cross(from, u), n) / n2,
                    std::fabs(glm::dot(from, n)) / sine, std::min(sine, 1.0)};
}

namespace {

/// Where light is left of a beam that is in the medium from ray.t_min on: exp(-104) is no number.
float last_light(const Medium& medium, const Ray& ray) {
    const Bounds3 bounds = medium.bounds();
    if (is_finite(bounds.lower) && is_finite(bounds.upper))
        return std::min(ray.t_max, exit_distance(bounds, ray));
    const Rgb sigma_t = medium.coefficients(ray.at(ray.t_min)).sigma_t;
    float least = infinity;
    for (int c = 0; c < 3; ++c)
        if (sigma_t[c] > 0.0f) least = std::min(least, sigma_t[c]);
    return std::min({ray.t_max, ray.t_min + 104.0f / least, 1e17f});  // the last: as far as Embree's boxes
}

}  // namespace

LightBeams::LightBeams(const std::vector<Subpath>& paths, const std::vector<std::vector<LightBeam>>& rows,
                       const MergeSettings& merging, double size, Rng rng)
    : paths_(&paths), radius_(merging.radius[std::size_t(Merge::beam_beam_1d)]) {
    for (const auto& row : rows)
        for (const LightBeam& b : row)
            if (merging.sampled(Merge::beam_beam_1d, rng)) beams_.push_back(&b);
    const auto piece = float(std::max(size / 24.0, 4.0 * radius_));
    for (std::size_t i = 0; i < beams_.size(); ++i)
        cut(std::uint32_t(i), beams_[i]->beam, beams_[i]->beam.end(merging.light_beams), piece);
    if (!boxes_.empty()) hierarchy_ = std::make_unique<BoxHierarchy>(boxes_);
}

void LightBeams::cut(std::uint32_t index, const Beam& beam, float end, float length) {
    MediumState state = beam.state;
    Ray part = beam.ray;
    const auto up_to = [&](float t) {
        part.t_max = std::min(t, end);
        if (state.current() && part.t_min < part.t_max) {
            part.t_max = last_light(*state.current(), part);
            cut_part(index, part, length);
        }
        part.t_min = t;
    };
    for (const SurfaceHit& boundary : beam.boundaries) {
        if (!(boundary.t < end)) break;
        up_to(boundary.t);
        state.cross(*boundary.shape, boundary.geometric_normal, beam.ray.direction);
    }
    up_to(end);
}

void LightBeams::cut_part(std::uint32_t beam, const Ray& part, float length) {
    const float whole = part.t_max - part.t_min;
    if (!(whole > 0.0f)) return;
    const int count = int(std::clamp(std::ceil(whole / length), 1.0f, float(max_pieces)));
    const auto at = [&](int i) {
        return i == count ? part.t_max : part.t_min + whole * float(i) / float(count);
    };
    for (int i = 0; i < count; ++i) {
        const Piece piece{beam, at(i), at(i + 1)};
        Bounds3 box;
        box.extend(part.at(piece.first)), box.extend(part.at(piece.last));
        const Vec3 margin(float(radius_) + 1e-6f * max_component(glm::max(-box.lower, box.upper)));
        box.lower -= margin, box.upper += margin;
        pieces_.push_back(piece), boxes_.push_back(box);
    }
}

std::size_t LightBeams::crossings(const Ray& ray, std::vector<Hit>& hits) const {
    hits.clear();
    std::size_t tested = 0;
    if (!hierarchy_ || !(ray.t_min < ray.t_max)) return tested;
    hierarchy_->for_each_box(ray, [&](std::uint32_t box) {
        ++tested;
        const Piece& piece = pieces_[box];
        const auto c = crossing_of(ray, beams_[piece.beam]->beam.ray);
        if (!c || !(c->apart < radius_)) return;
        const auto t = float(c->t), s = float(c->s);
        if (t > ray.t_min && t < ray.t_max && s >= piece.first && s < piece.last)
            hits.push_back({t, s, float(c->sine), piece.beam});
    });
    std::sort(hits.begin(), hits.end(),
              [](const Hit& a, const Hit& b) { return a.t != b.t ? a.t < b.t : a.beam < b.beam; });
    const auto same = [](const Hit& a, const Hit& b) { return a.beam == b.beam; };
    hits.erase(std::unique(hits.begin(), hits.end(), same), hits.end());  // Embree may visit a box twice
    return tested;
}

}  // namespace mote::integrators
