#include "screenspace/upsampling/upsampling.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "screenspace/layer_filter/same_surface.h"

namespace mote::screenspace {

using namespace core;

namespace {

/// Smallest fraction of the bilinear weights that must fit: below it one far corner would decide the pixel.
constexpr float min_fraction = 1.0f / 16.0f;

float off_plane(const UpsamplingPoint& a, const UpsamplingPoint& b) {
    const Vec3 d = b.position - a.position;
    return max_of(std::fabs(glm::dot(d, a.normal)), std::fabs(glm::dot(d, b.normal)));
}

bool has_light(const UpsamplingPoint& p) { return max_component(p.modulation) > 0.0f; }

}  // namespace

Upsampling::Upsampling(int width, int height, const ShadedLattice& lattice, LayerKind kind,
                       std::span<const UpsamplingPoint> points)
    : width_(width), height_(height), lattice_(lattice), kind_(kind), points_(points) {
    const bool fits = width > 0 && height > 0 && points.size() == std::size_t(width) * std::size_t(height);
    const bool starts = lattice.spacing > 0 && lattice.column >= 0 && lattice.column < lattice.spacing &&
                        lattice.row >= 0 && lattice.row < lattice.spacing;
    if (!fits || !starts) throw std::invalid_argument("points and lattice of an upsampling do not fit");
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto pixel = std::size_t(y) * std::size_t(width) + std::size_t(x);
            if (lattice.holds(x, y) || !has_light(points[pixel])) continue;
            if (!points[pixel].shared || !fit(pixel, neighbours(x, y)))
                again_.push_back(std::uint32_t(pixel));
        }
}

/// The weights of layer_filter, for two points of a picture.
float Upsampling::alike(const UpsamplingPoint& a, const UpsamplingPoint& b) const {
    if (!b.shared || !has_light(b)) return 0.0f;
    if (kind_ == LayerKind::surface)
        return same_surface(off_plane(a, b), a.footprint, glm::dot(a.shading_normal, b.shading_normal));
    const float along = std::fabs(b.distance - a.distance);
    const float step = along < 0.5f * FilterFeatures::far ? min_of(off_plane(a, b), along) : along;
    const UpsamplingPoint& nearer = a.distance <= b.distance ? a : b;
    const float between = between_depths(step, nearer.distance, nearer.transmittance,
                                         std::log(max_of(nearer.transmittance, 1e-30f))) /
                          depth_tolerance;
    return tukey(between * between);
}

Upsampling::Neighbours Upsampling::neighbours(int x, int y) const {
    const int s = lattice_.spacing;
    const auto before = [s](int at, int first) {
        return first + (at - first + s) / s * s - s;
    };  // at > first - s
    const int x0 = before(x, lattice_.column), y0 = before(y, lattice_.row);
    const UpsamplingPoint& here = points_[std::size_t(y) * std::size_t(width_) + std::size_t(x)];
    Neighbours result;
    for (const int qy : {y0, y0 + s})
        for (const int qx : {x0, x0 + s}) {
            const float k =
                (1.0f - float(std::abs(qx - x)) / float(s)) * (1.0f - float(std::abs(qy - y)) / float(s));
            if (!(k > 0.0f) || qx < 0 || qy < 0 || qx >= width_ || qy >= height_) continue;
            const auto pixel = std::size_t(qy) * std::size_t(width_) + std::size_t(qx);
            const float weight = k * alike(here, points_[pixel]);
            result.all += k, result.fits += weight;
            if (weight > 0.0f) result.of[result.count++] = {pixel, weight};
        }
    return result;
}

Rgb Upsampling::modulation_of(const Neighbours& neighbours) const {
    Rgb sum(0.0f);
    for (int i = 0; i < neighbours.count; ++i)
        sum += neighbours.of[i].weight * points_[neighbours.of[i].pixel].modulation;
    return sum;
}

bool Upsampling::fit(std::size_t pixel, const Neighbours& n) const {
    const Rgb there = modulation_of(n), &here = points_[pixel].modulation;
    bool channels = true;
    for (int c = 0; c < 3; ++c) channels = channels && (there[c] > 0.0f || !(here[c] > 0.0f));
    return channels && n.fits > min_fraction * n.all;
}

void Upsampling::fill(std::span<Rgb> light) const {
    if (light.size() != points_.size()) throw std::invalid_argument("light and points differ in size");
    auto again = again_.begin();
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            const auto pixel = std::size_t(y) * std::size_t(width_) + std::size_t(x);
            if (again != again_.end() && *again == pixel) {
                ++again;
                continue;
            }
            if (lattice_.holds(x, y)) continue;
            Rgb sum(0.0f);
            const Neighbours n = neighbours(x, y);
            for (int i = 0; i < n.count; ++i) sum += n.of[i].weight * light[n.of[i].pixel];
            const Rgb of = modulation_of(n);
            const Rgb& m = points_[pixel].modulation;  // Eq. (1)
            for (int c = 0; c < 3; ++c) light[pixel][c] = of[c] > 0.0f ? m[c] * sum[c] / of[c] : 0.0f;
        }
}

}  // namespace mote::screenspace
