#include "core/scene/light_importance.h"

namespace mote::core {
namespace {

/// Rounding must not make a bound cut off what grazes it [radians].
const AngleOf slack = AngleOf::radians(1e-3f);

/// Half the angle that a sphere fills, seen from a distance; all directions from within.
AngleOf half_angle(float radius, float distance) {
    const float sine = radius / distance;
    const bool outside = radius < distance;
    const float cosine = std::sqrt(outside ? 1.0f - sine * sine : 0.0f);
    return {outside ? cosine * slack.cos - sine * slack.sin : -1.0f,
            outside ? sine * slack.cos + cosine * slack.sin : 0.0f};
}

/// The largest cosine at the light, `off` its axis, when the cluster's normals spread and it fills `around`;
/// 0 beyond its reach.
float emitted_cosine(const LightClusters& g, std::size_t i, const AngleOf& off, const AngleOf& around) {
    const AngleOf least = minus(minus(off, {g.cos_spread[i], g.sin_spread[i]}), around);
    return least.cos > g.cos_reach[i] ? least.cos : 0.0f;
}

}  // namespace

LightClusters::LightClusters(std::span<const LightBounds> clusters) {
    double brightest = 0.0;
    for (const LightBounds& cluster : clusters) brightest = std::max(brightest, cluster.intensity);
    for (std::size_t i = 0; i < clusters.size(); ++i) {
        const LightBounds& g = clusters[i];
        const Vec3 center = g.box.center(), half = 0.5f * g.box.diagonal(), axis = g.normals.axis;
        center_x[i] = center.x, center_y[i] = center.y, center_z[i] = center.z;
        half_x[i] = half.x, half_y[i] = half.y, half_z[i] = half.z;
        axis_x[i] = axis.x, axis_y[i] = axis.y, axis_z[i] = axis.z;
        radius[i] = g.box.radius();
        back[i] = g.back + slack.sin * radius[i];
        const AngleOf spread =
            g.normals.angle >= pi ? AngleOf::straight() : AngleOf::radians(std::max(g.normals.angle, 0.0f));
        cos_spread[i] = spread.cos, sin_spread[i] = spread.sin;
        cos_reach[i] = std::cos(std::min(g.reach, 0.5f * pi));
        intensity[i] = std::max(float(g.intensity / brightest), 1e-20f);
    }
}

LightImportances light_importances(const LightClusters& g, const LightReceiver& receiver) {
    const Vec3 p = receiver.position, n = receiver.normal;
    const float any_side = n == Vec3(0.0f) ? 1.0f : 0.0f;
    LightImportances importances;
    for (std::size_t i = 0; i < LightClusters::width; ++i) {
        const float x = g.center_x[i] - p.x, y = g.center_y[i] - p.y, z = g.center_z[i] - p.z;
        const float distance2 = x * x + y * y + z * z, radius2 = g.radius[i] * g.radius[i];
        const float distance = std::sqrt(std::max(distance2, 1e-30f));
        // Within the sphere the distance says nothing: its radius replaces it.
        const float d2 = std::max(std::max(distance2, radius2), 1e-30f), per_d = 1.0f / std::sqrt(d2);

        const float along = -(g.axis_x[i] * x + g.axis_y[i] * y + g.axis_z[i] * z);
        const float off = std::clamp(along / distance, -1.0f, 1.0f);
        const AngleOf around = half_angle(g.radius[i], distance);
        const float bound = emitted_cosine(g, i, {off, std::sqrt(1.0f - off * off)}, around);
        const float emitted = std::min(bound, std::max(along + g.back[i], 0.0f) * per_d);

        const float nearest = n.x * x + n.y * y + n.z * z,  // of the centre and of the box's highest corner
            highest = nearest + std::abs(n.x) * g.half_x[i] + std::abs(n.y) * g.half_y[i] +
                      std::abs(n.z) * g.half_z[i];
        const float received = 0.5f * (std::max(nearest, 0.0f) + std::max(highest, 0.0f)) * per_d;
        importances[i] = g.intensity[i] * emitted * (any_side + received) / d2;
    }
    return importances;
}

LightImportances light_importances(const LightClusters& g, const LightSegment& segment) {
    const Vec3d d(segment.direction);
    const double t0 = double(segment.t0), t1 = std::min(double(segment.t1), 1e30);
    LightImportances importances{};
    for (std::size_t i = 0; i < LightClusters::width; ++i) {
        if (!(g.intensity[i] > 0.0f)) continue;
        const Vec3d from_light = Vec3d(segment.origin) - Vec3d(g.center_x[i], g.center_y[i], g.center_z[i]);
        const double along = glm::dot(from_light, d), off2 = glm::dot(from_light, from_light);
        const double line = std::sqrt(std::max(0.0, off2 - along * along));  // from the centre to the line
        const auto at = [&](double t) { return from_light + t * d; };
        const double nearest = std::clamp(-along, t0, t1);

        // The least angle off the axis: (A + B t) / |at(t)| has one critical point, at
        // (A along - B off2) / (B along - A).
        const Vec3d axis(g.axis_x[i], g.axis_y[i], g.axis_z[i]);
        const double A = glm::dot(axis, from_light), B = glm::dot(axis, d);
        const auto cosine = [&](double t) {
            const double length = glm::length(at(t));
            return length > 0.0 ? (A + B * t) / length : 1.0;
        };
        double largest = std::max(cosine(t0), cosine(t1));
        const double turn = (A * along - B * off2) / (B * along - A);
        if (turn > t0 && turn < t1) largest = std::max(largest, cosine(turn));

        const AngleOf around = half_angle(g.radius[i], float(glm::length(at(nearest))));
        const double D = std::max({line, double(g.radius[i]), 1e-4 * std::sqrt(off2), 1e-30});
        const double angle = std::atan2(t1 + along, D) - std::atan2(t0 + along, D);
        importances[i] = g.intensity[i] * emitted_cosine(g, i, AngleOf::cosine(float(largest)), around) *
                         float(std::max(angle, 1e-20) / D);
    }
    return importances;
}

}  // namespace mote::core
