#include "lights/ray_lights/line_importance.h"

#include <cmath>

#include "core/math/vectorize.h"
#include "lights/virtual_lights/vpl_contributions.h"

namespace mote::lights {

using namespace core;

namespace {

constexpr int lane_count = ReceiverLanes::width;
constexpr int segments = line_segments;
/// Lower bounds of cosines and phase functions, which are evaluated in the middle of a segment alone.
constexpr float min_cosine = 0.1f, min_phase = 0.15f;
/// Lower bound of the weight of a segment of the eye ray, relative to the mean of all: its middle may miss
/// what scatters.
constexpr float min_weight = 0.1f;
/// Softening of 1/w^2 where a line passes a light: this times the square of a segment of the ray light,
/// and of the line itself.
constexpr float near_on_light = 0.06f, near_on_line = 1e-4f;

/// Grows like exp(x), about.
inline float grows(float x) { return 1.0f + x * (1.0f + x * (0.5f + x * (1.0f / 6.0f))); }
/// Mean of 1/w^2 over a segment, and of the transmittance on the way [1/m^2]: from the product of the
/// distances of its ends, that of the vectors there, and an optical depth. Fourth powers of lengths would
/// leave single precision in scenes of a nanometre.
inline float falls(float distances, float vectors, float depth) {
    const float opening = 2.0f * distances / max_of(distances + vectors, 1e-6f * distances);
    return std::sqrt(opening) / (distances * grows(depth));
}
/// Henyey & Greenstein's function times 4 pi, of the cosine between the ways before and after.
inline float lobe(float g, float cosine) {
    const float d = max_of(1.0f + g * g - 2.0f * g * cosine, 1e-4f);
    return min_phase + (1.0f - g * g) / (d * std::sqrt(d));
}

float asymmetry(const MediumLine& line) {
    return line.isotropic ? 0.0f : std::fmin(std::fmax(line.medium->phase().mean_cosine(), -0.95f), 0.95f);
}

/// A line's segments: their ends, and what scatters in them.
struct LineSegments {
    Vec3 end[segments + 1];
    float weight[segments];
    float length;  ///< of one of them [m]

    explicit LineSegments(const MediumLine& line) : length(line.length / float(segments)) {
        constexpr int lookups = 4;
        for (int k = 0; k <= segments; ++k) end[k] = line.origin + float(k) * length * line.direction;
        for (int k = 0; k < segments; ++k) {
            weight[k] = 0.0f;
            for (int i = 0; i < lookups; ++i) {
                const float at = (float(k * lookups + i) + 0.5f) / float(segments * lookups);
                weight[k] += line.weights[std::uint32_t(at * float(line.cells))] / float(lookups);
            }
        }
    }
    float mean() const { return (weight[0] + weight[1] + weight[2]) / float(segments); }
};

/// A point with a light's strength, as eye rays are lit by it.
struct LitPoint {
    Vec3 at;
    float strength, near_squared;  ///< [m^2]
    Vec3 way{0.0f};                ///< of the light there, for its phase function
    float asymmetry = 0.0f;
    Vec3 normal{0.0f};  ///< of a surface, else zero
};

/// Adds what scatters along the eye rays.
template <bool Directional, bool Surface>
void add_point(const LitPoint& point, std::int32_t depth, const EyeReceivers& eyes, Lanes& out) {
    const float px = point.at.x, py = point.at.y, pz = point.at.z, near_light = point.near_squared;
    const float nx = point.normal.x, ny = point.normal.y, nz = point.normal.z;
    const float wx = point.way.x, wy = point.way.y, wz = point.way.z, g = point.asymmetry;
    const float strength = point.strength;
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < lane_count; ++i) {
        float sum = 0.0f;
        const float near_squared = near_light + eyes.near_squared[i];
        float ax = eyes.x[0][i] - px, ay = eyes.y[0][i] - py, az = eyes.z[0][i] - pz;
        float a = std::sqrt(ax * ax + ay * ay + az * az + near_squared);
        float height = ax * nx + ay * ny + az * nz, highest = height;
        for (int k = 0; k < segments; ++k) {
            const float bx = eyes.x[k + 1][i] - px, by = eyes.y[k + 1][i] - py, bz = eyes.z[k + 1][i] - pz;
            const float b = std::sqrt(bx * bx + by * by + bz * bz + near_squared);
            float value = eyes.weight[k][i] * falls(a * b, ax * bx + ay * by + az * bz + near_squared,
                                                    0.5f * eyes.extinction[i] * (a + b));
            if constexpr (Surface || Directional) {
                const float mx = ax + bx, my = ay + by, mz = az + bz;
                const float inverse = 1.0f / std::sqrt(mx * mx + my * my + mz * mz + near_squared);
                if constexpr (Surface) {
                    const float next = bx * nx + by * ny + bz * nz;
                    value *= max_of((height + next) * inverse, min_cosine);
                    height = next, highest = max_of(highest, next);
                }
                if constexpr (Directional) {
                    const float to_eye =
                        mx * eyes.direction_x[i] + my * eyes.direction_y[i] + mz * eyes.direction_z[i];
                    value *= lobe(eyes.asymmetry[i], -to_eye * inverse);
                    if constexpr (!Surface) value *= lobe(g, (mx * wx + my * wy + mz * wz) * inverse);
                }
            }
            sum += value;
            ax = bx, ay = by, az = bz, a = b;
        }
        const float open = Surface ? (highest > 0.0f ? strength : 0.0f) : strength;
        out[i] += depth <= eyes.max_depth[i] ? open * sum : 0.0f;
    }
}

}  // namespace

EyeReceivers::EyeReceivers(const EyeLines& eyes) {
    for (int i = 0; i < lane_count; ++i) {
        const EyeLine* eye = eyes.of[std::size_t(i)];
        if (!eye) {
            for (int k = 0; k <= segments; ++k) x[k][i] = float(k);  // anywhere, apart
            continue;
        }
        const MediumLine& line = eye->line;
        const LineSegments parts(line);
        const float rest = min_weight * parts.mean(), through = average(eye->throughput);
        for (int k = 0; k <= segments; ++k)
            x[k][i] = parts.end[k].x, y[k][i] = parts.end[k].y, z[k][i] = parts.end[k].z;
        for (int k = 0; k < segments; ++k)
            weight[k][i] = through * parts.length * (parts.weight[k] + rest) * inv_four_pi;
        direction_x[i] = line.direction.x, direction_y[i] = line.direction.y;
        direction_z[i] = line.direction.z;
        near_squared[i] = std::fmax(near_on_line * sqr(parts.length), 1e-36f);  // a normal number
        extinction[i] = average(line.sigma_t), asymmetry[i] = lights::asymmetry(line);
        max_depth[i] = eye->max_depth;
        directional |= !line.isotropic;
    }
}

void importance(const RayLight& light, const EyeReceivers& eyes, Lanes& out) {
    const LineSegments parts(light.line);
    const float power = average(light.power) * parts.length * inv_four_pi;
    out = {};
    for (int k = 0; k < segments; ++k) {
        LitPoint point{0.5f * (parts.end[k] + parts.end[k + 1]), power * parts.weight[k],
                       near_on_light * sqr(parts.length), light.line.direction};
        const auto depth = std::int32_t(light.depth);
        if (eyes.directional) {
            point.asymmetry = asymmetry(light.line);
            add_point<true, false>(point, depth, eyes, out);
        } else {
            add_point<false, false>(point, depth, eyes, out);
        }
    }
}

void importance(const VirtualPointLight& vpl, const EyeReceivers& eyes, Lanes& out) {
    const bool surface = vpl.detail == VirtualPointLight::no_detail;
    LitPoint point{vpl.position, average(vpl.intensity) * (surface ? 1.0f : inv_pi), 0.0f};
    const auto depth = std::int32_t(vpl.depth);
    out = {};
    if (surface) point.normal = vpl.normal;
    if (eyes.directional && surface)
        add_point<true, true>(point, depth, eyes, out);
    else if (eyes.directional)
        add_point<true, false>(point, depth, eyes, out);
    else if (surface)
        add_point<false, true>(point, depth, eyes, out);
    else
        add_point<false, false>(point, depth, eyes, out);
}

PointReceivers::PointReceivers(const ReceiverLanes& points, const Lanes& around, float b)
    : lanes(points), extinction(around), bound(b) {
    for (int i = 0; i < lane_count; ++i) {
        const bool directional = lanes.directional[i] != nullptr;
        weight[i] = average(Rgb(lanes.weight_r[i], lanes.weight_g[i], lanes.weight_b[i])) *
                    (directional ? inv_pi : 1.0f);
        all_around[i] = directional || lanes.in_medium[i] > 0.0f ? 1.0f : 0.0f;
    }
}

void importance(const RayLight& light, const PointReceivers& points, Lanes& out) {
    const LineSegments parts(light.line);
    const float power = average(light.power) * parts.length * inv_four_pi;
    const float near_squared = std::fmax(near_on_line * sqr(parts.length), min_distance_squared);
    const float bound = points.bound;
    const auto depth = std::int32_t(light.depth);
    const ReceiverLanes& r = points.lanes;
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < lane_count; ++i) {
        const float gx = r.geometric_x[i], gy = r.geometric_y[i], gz = r.geometric_z[i];
        float ax = parts.end[0].x - r.x[i], ay = parts.end[0].y - r.y[i], az = parts.end[0].z - r.z[i];
        float a = std::sqrt(ax * ax + ay * ay + az * az + near_squared);
        float highest = ax * gx + ay * gy + az * gz, sum = 0.0f;
        for (int k = 0; k < segments; ++k) {
            const float bx = parts.end[k + 1].x - r.x[i], by = parts.end[k + 1].y - r.y[i],
                        bz = parts.end[k + 1].z - r.z[i];
            const float b = std::sqrt(bx * bx + by * by + bz * bz + near_squared);
            const float mx = ax + bx, my = ay + by, mz = az + bz;
            const float m = std::sqrt(mx * mx + my * my + mz * mz + near_squared);
            const float height =
                max_of(mx * r.shading_x[i] + my * r.shading_y[i] + mz * r.shading_z[i], min_cosine * (a + b));
            const float seen = falls(a * b, ax * bx + ay * by + az * bz + near_squared,
                                     0.5f * points.extinction[i] * (a + b));
            sum += parts.weight[k] * min_of(max_of(height / m, points.all_around[i]) * seen, bound);
            highest = max_of(highest, bx * gx + by * gy + bz * gz);
            ax = bx, ay = by, az = bz, a = b;
        }
        const float weight = points.weight[i] * power;
        const float open = max_of(highest, points.all_around[i]) > 0.0f ? weight : 0.0f;
        out[i] = depth <= r.max_vpl_depth[i] ? open * sum : 0.0f;
    }
}

void importance(const VirtualPointLight& vpl, const PointReceivers& points, Lanes& out) {
    const bool plain = vpl.detail == VirtualPointLight::no_detail;
    const float px = vpl.position.x, py = vpl.position.y, pz = vpl.position.z;
    const float nx = vpl.normal.x, ny = vpl.normal.y, nz = vpl.normal.z;
    const float intensity = average(vpl.intensity) * (plain ? 1.0f : inv_pi),
                all_around = plain ? 0.0f : 1.0f;
    const float bound = points.bound;
    const auto depth = std::int32_t(vpl.depth);
    const ReceiverLanes& r = points.lanes;
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < lane_count; ++i) {
        const float dx = px - r.x[i], dy = py - r.y[i], dz = pz - r.z[i];
        const float d2 = max_of(dx * dx + dy * dy + dz * dz, min_distance_squared);
        const float inverse = 1.0f / std::sqrt(d2);
        const float cos_x =
            max_of((dx * r.shading_x[i] + dy * r.shading_y[i] + dz * r.shading_z[i]) * inverse,
                   points.all_around[i]);
        const float cos_y = max_of(-(dx * nx + dy * ny + dz * nz) * inverse, all_around);
        const float geometry = min_of(max_of(cos_x, 0.0f) * cos_y * (inverse * inverse), bound);
        const float weight = points.weight[i] * intensity;
        const float value = weight * geometry / grows(points.extinction[i] * d2 * inverse);
        out[i] = depth <= r.max_vpl_depth[i] ? max_of(value, 0.0f) : 0.0f;
    }
}

}  // namespace mote::lights
