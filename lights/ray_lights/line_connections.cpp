#include "lights/ray_lights/line_connections.h"

#include <algorithm>
#include <cmath>

namespace mote::lights {

using namespace core;

namespace {

/// Distances of lines below this fraction of what surrounds them are rounding; any positive h gives a valid
/// density.
constexpr double resolution = 1e-12;
/// Fraction of an even distribution in weights that are guessed from the middles of cells.
constexpr float defensive = 0.15f;

double square(double x) { return x * x; }  // core::sqr() is for single precision
float inverse_square(double distance_squared) { return float(1.0 / distance_squared); }

using CellWeights = std::array<float, max_cells>;

/// Multiplies the weights of a line by guess(middle of the cell), and the mean of all guesses besides.
template <typename Guess>
std::span<const float> steered(const MediumLine& line, CellWeights& weights, const Guess& guess) {
    float sum = 0.0f;
    for (std::uint32_t i = 0; i < line.cells; ++i)
        sum += weights[i] = guess(double(line.length) * (double(i) + 0.5) / double(line.cells));
    const float mean = defensive * sum / float(line.cells);
    for (std::uint32_t i = 0; i < line.cells; ++i) weights[i] = line.weights[i] * (weights[i] + mean);
    return std::span(weights).first(line.cells);
}

/// Direction from one point to another, and their distance.
struct Towards {
    Vec3d between;
    double distance_squared, distance;
    Vec3 direction;
    Towards(const Vec3d& from, const Vec3d& to)
        : between(to - from),
          distance_squared(glm::dot(between, between)),
          distance(std::sqrt(distance_squared)),
          direction(between / std::max(distance, 1e-300)) {}
};

/// exp(-x), about: it steers, and need not be right.
float passes(const MediumLine& line, double distance) {
    const float x = average(line.sigma_t) * float(distance);
    return 1.0f / (1.0f + x * (1.0f + x * (0.5f + x * (1.0f / 6.0f))));
}

/// 1/(d^2 + softening^2) around a point, `softening` in metres.
InverseSquare around(const MediumLine& line, const Vec3d& point, float softening) {
    const Vec3d to = point - Vec3d(line.origin);
    const double nearest = glm::dot(to, Vec3d(line.direction));
    const Vec3d off = to - nearest * Vec3d(line.direction);
    const double least = resolution * (double(line.length) + std::fabs(nearest));
    return {nearest, std::sqrt(glm::dot(off, off) + square(double(softening)) + square(least))};
}

/// True if weights of cells alone are not enough. Not where light scatters evenly, and media are thin.
bool steers(const MediumLine& line) { return line.cells > 1; }

/// Weights of a line's cells for light between it and a point, in memory of `weights` where they are steered.
std::span<const float> weights_towards(const MediumLine& line, const Vec3d& point, CellWeights& weights) {
    if (!steers(line)) return line.cell_weights();
    return steered(line, weights, [&](double middle) {
        const Towards towards(line.at(middle), point);
        return passes(line, towards.distance) * average(line.phase(towards.direction));
    });
}

/// Distances along a line [m].
struct Range {
    double begin, end;
};
/// Range of the line above the plane through a point; nothing for a line in the plane or parallel to it and
/// below.
std::optional<Range> range_above(const MediumLine& line, const Vec3d& point, const Vec3& n) {
    Range range{0.0, double(line.length)};
    const Vec3d normal(n);
    const double height = glm::dot(Vec3d(line.origin) - point, normal),
                 slope = glm::dot(Vec3d(line.direction), normal);
    if (slope > 0.0) range.begin = std::max(range.begin, -height / slope);
    if (slope < 0.0) range.end = std::min(range.end, -height / slope);
    if (slope == 0.0 && height <= 0.0) return std::nullopt;
    return range;
}

/// The point on the ray light: by its distance from the eye ray; and, where it has cells, by what would go to
/// the nearest point of the eye ray.
std::optional<LineSample> sample_on_light(const RayLight& light, const EyeLine& eye, float u) {
    const MediumLine &y = light.line, &x = eye.line;
    const LinePair pair = line_pair(Vec3d(y.origin), Vec3d(y.direction), Vec3d(x.origin), Vec3d(x.direction));
    const double least = resolution * (double(y.length) + double(x.length) + std::fabs(pair.nearest_first));
    const InverseDistance density{pair.nearest_first, std::sqrt(square(pair.distance) + square(least)),
                                  pair.sine};
    const double length = double(y.length);
    if (!steers(y)) return sample_line(density, 0.0, length, length, y.cell_weights(), u);
    CellWeights weights;
    return sample_line(
        density, 0.0, length, length,
        steered(y, weights,
                [&](double middle) {
                    const Vec3d point = y.at(middle);
                    const double t = std::clamp(glm::dot(point - Vec3d(x.origin), Vec3d(x.direction)), 0.0,
                                                double(x.length));
                    const Towards eye_point(point, x.at(t));
                    return passes(y, eye_point.distance) * x.weights[x.cell_of(t)] *
                           average(y.phase(eye_point.direction) * x.phase(-eye_point.direction));
                }),
        u);
}

/// The point on the eye ray, around one of the light.
std::optional<LineSample> sample_on_eye(const MediumLine& eye, const MediumLine& light, const Vec3d& point,
                                        float u) {
    const InverseSquare density = around(eye, point, 0.0f);
    const double length = double(eye.length);
    if (!steers(eye)) return sample_line(density, 0.0, length, length, eye.cell_weights(), u);
    CellWeights weights;
    return sample_line(
        density, 0.0, length, length,
        steered(eye, weights,
                [&](double middle) {
                    const Towards towards(eye.at(middle), point);
                    return passes(eye, towards.distance) *
                           average(eye.phase(towards.direction) * light.phase(-towards.direction));
                }),
        u);
}

}  // namespace

std::optional<LineConnection> connect(const EyeLine& eye, const RayLight& light, const Vec2& u,
                                      const LineContext& context) {
    if (std::int32_t(light.depth) > eye.max_depth) return std::nullopt;
    const auto on_light = sample_on_light(light, eye, u.x);
    if (!on_light) return std::nullopt;
    const Vec3d y = light.line.at(on_light->position);
    const auto on_eye = sample_on_eye(eye.line, light.line, y, u.y);
    if (!on_eye) return std::nullopt;
    const Vec3d x = eye.line.at(on_eye->position);
    const Towards towards(x, y);
    if (!(towards.distance > 0.0)) return std::nullopt;
    const Rgb at_light = light.line.scattering(on_light->position, context.rng, context.counters);
    if (is_black(at_light)) return std::nullopt;
    const Rgb at_eye = eye.line.scattering(on_eye->position, context.rng, context.counters);
    const double density = on_light->pdf_distance * on_eye->pdf_distance;
    const Rgb value = eye.throughput * at_eye * eye.line.phase(towards.direction) * light.power * at_light *
                      light.line.phase(-towards.direction) *
                      float(1.0 / (towards.distance_squared * density));
    if (!(max_component(value) > 0.0f)) return std::nullopt;
    return LineConnection{value, Vec3(x), Vec3(y)};
}

std::optional<LineConnection> connect(const ReceiverLanes& receivers, int lane, const RayLight& light,
                                      float u, float bound, const LineContext& context) {
    if (std::int32_t(light.depth) > receivers.max_vpl_depth[lane]) return std::nullopt;
    const ScatteringVertex* vertex = receivers.directional[lane];
    const MediumLine& line = light.line;
    const Vec3d x(vertex ? vertex->position : receivers.position(lane));
    std::optional<Range> range = Range{0.0, double(line.length)};
    if (!vertex && receivers.in_medium[lane] == 0.0f) {  // nothing comes from below a diffuse surface
        range = range_above(line, x, receivers.geometric_normal(lane));
        if (!range) return std::nullopt;
    }
    CellWeights weights;
    const auto by = weights_towards(line, x, weights);
    const auto on_light = sample_line(around(line, x, 1.0f / std::sqrt(bound)), range->begin, range->end,
                                      double(line.length), by, u);
    if (!on_light) return std::nullopt;
    const Vec3d y = line.at(on_light->position);
    const Towards towards(x, y);
    if (!(towards.distance > 0.0)) return std::nullopt;
    Rgb value(receivers.weight_r[lane], receivers.weight_g[lane], receivers.weight_b[lane]);
    Vec3 from(x);
    float cosine = 1.0f;
    if (vertex) {
        value *= vertex->eval(towards.direction, TransportMode::radiance);
        cosine = vertex->shading_cosine(towards.direction);
        from = vertex->ray_origin(towards.direction);
    } else if (receivers.in_medium[lane] == 0.0f) {
        const Vec3 shading(receivers.shading_x[lane], receivers.shading_y[lane], receivers.shading_z[lane]);
        const bool above = glm::dot(receivers.geometric_normal(lane), towards.direction) > 0.0f;
        cosine = above ? std::fmax(0.0f, glm::dot(shading, towards.direction)) : 0.0f;
    }
    value *=
        std::fmin(cosine * inverse_square(towards.distance_squared), bound) / float(on_light->pdf_distance);
    if (!(max_component(value) > 0.0f)) return std::nullopt;
    value *= light.power * line.scattering(on_light->position, context.rng, context.counters) *
             line.phase(-towards.direction);
    if (!(max_component(value) > 0.0f)) return std::nullopt;
    return LineConnection{value, from, Vec3(y)};
}

std::optional<LineConnection> connect(const EyeLine& eye, const VplSet& vpls, const VirtualPointLight& vpl,
                                      float u, const LineContext& context) {
    if (std::int32_t(vpl.depth) > eye.max_depth) return std::nullopt;
    const VplDetail* detail =
        vpl.detail == VirtualPointLight::no_detail ? nullptr : &vpls.details[vpl.detail];
    const MediumLine& line = eye.line;
    const Vec3d y(detail ? detail->vertex.position : vpl.position);
    std::optional<Range> range = Range{0.0, double(line.length)};
    if (!detail) {  // it shines to one side
        range = range_above(line, y, vpl.normal);
        if (!range) return std::nullopt;
    }
    CellWeights weights;
    const auto by = weights_towards(line, y, weights);
    const auto on_eye =
        sample_line(around(line, y, 0.0f), range->begin, range->end, double(line.length), by, u);
    if (!on_eye) return std::nullopt;
    const Vec3d x = line.at(on_eye->position);
    const Towards towards(x, y);
    if (!(towards.distance > 0.0)) return std::nullopt;
    Rgb value = vpl.intensity;
    Vec3 to(y);
    if (detail) {
        value *= detail->eval(-towards.direction) * detail->vertex.geometric_cosine(towards.direction);
        to = detail->vertex.ray_origin(-towards.direction);
    } else {
        value *= glm::dot(vpl.shading_normal, towards.direction) < 0.0f
                     ? std::fmax(0.0f, -glm::dot(vpl.normal, towards.direction))
                     : 0.0f;
    }
    if (!(max_component(value) > 0.0f)) return std::nullopt;
    value *= eye.throughput * line.scattering(on_eye->position, context.rng, context.counters) *
             line.phase(towards.direction) * float(1.0 / (towards.distance_squared * on_eye->pdf_distance));
    if (!(max_component(value) > 0.0f)) return std::nullopt;
    return LineConnection{value, Vec3(x), to};
}

}  // namespace mote::lights
