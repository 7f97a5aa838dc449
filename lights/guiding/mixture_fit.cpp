#include "lights/guiding/mixture_fit.h"

#include <algorithm>

#include "core/math/vectorize.h"

namespace mote::lights {

using core::Vec3, core::Vec3d;

namespace {

constexpr int lobe_count = VmfMixture::capacity;
constexpr int steps = 3;                 ///< of expectation and maximisation, for each batch
constexpr double weight_prior = 0.1;     ///< a: effective samples in every lobe
constexpr double direction_prior = 0.2;  ///< b: effective samples of all directions
constexpr double largest_share = 0.05;   ///< of the light, that one sample of many counts as

/// A direction and the inverse distance of what lies there.
struct Sight {
    Vec3 direction;
    float inverse_distance;
};

/// Moves the observer from `from` to `to`. Unchanged where the point that is seen lies at `to`.
Sight by_parallax(const Sight& s, const Vec3& from, const Vec3& to) {
    const Vec3 seen = s.direction + (from - to) * s.inverse_distance;
    const float length = glm::length(seen);
    return length > 1e-3f && std::isfinite(length) ? Sight{seen / length, s.inverse_distance / length} : s;
}

/// Posterior probability of each lobe for a direction, into g. The largest exponent is taken out: a direction
/// that no lobe reaches goes to the nearest.
void responsibilities(const VmfMixture& m, const Vec3& w, float (&g)[lobe_count]) {
    float exponent[lobe_count];
    MOTE_INDEPENDENT_LANES
    for (int k = 0; k < lobe_count; ++k) {
        const float dx = m.x[k] - w.x, dy = m.y[k] - w.y, dz = m.z[k] - w.z;
        exponent[k] = -0.5f * m.kappa[k] * (dx * dx + dy * dy + dz * dz);
    }
    const float largest = *std::max_element(exponent, exponent + lobe_count);
    float total = 0.0f;
    MOTE_INDEPENDENT_LANES
    for (int k = 0; k < lobe_count; ++k)
        g[k] = m.weight[k] * m.normalization[k] * exp_of_negative(exponent[k] - largest);
    for (const float v : g) total += v;
    for (float& v : g) v /= total;
}

/// Bound of weights with which no sample brings more than its share of the bounded light, or of few samples
/// twice what is even. Without it one path would draw all lobes to one direction, where they stay together.
double weight_bound(std::span<const GuidingSample> samples, double light_so_far) {
    double bound = 0.0, lit = 0.0;
    for (const GuidingSample& s : samples) bound = std::max(bound, double(s.weight)), lit += s.weight > 0.0f;
    const double share = std::max(largest_share, 2.0 / std::max(lit, 1.0));
    for (int step = 0; step < 32; ++step) {
        double light = light_so_far;
        for (const GuidingSample& s : samples) light += std::min(double(s.weight), bound);
        if (share * light >= 0.99 * bound) break;
        bound = share * light;
    }
    return bound;
}

}  // namespace

void MixtureFit::add(std::span<const GuidingSample> samples) {
    samples_ += double(samples.size());
    const double bound = weight_bound(samples, light());
    Sums sums[lobe_count];
    for (int step = 0; step < steps; ++step) {
        std::copy(sums_, sums_ + lobe_count, sums);
        expect(samples, bound, sums);
        maximise(sums);
    }
    std::copy(sums, sums + lobe_count, sums_);
}

void MixtureFit::expect(std::span<const GuidingSample> samples, double bound,
                        Sums (&sums)[lobe_count]) const {
    for (const GuidingSample& s : samples) {
        if (!(s.weight > 0.0f)) continue;
        const Sight seen = by_parallax({s.direction, s.inverse_distance}, s.position, pivot_);
        float g[lobe_count];
        responsibilities(mixture_, seen.direction, g);
        const double weight = std::min(double(s.weight), bound);
        for (int k = 0; k < lobe_count; ++k) {
            const double w = double(g[k]) * weight;
            sums[k].weight += w, sums[k].squares += w * weight;
            sums[k].inverse_distance += w * double(seen.inverse_distance);
            sums[k].direction += w * Vec3d(seen.direction);
        }
    }
}

void MixtureFit::maximise(const Sums (&sums)[lobe_count]) {
    double weight = 0.0, squares = 0.0;
    for (const Sums& s : sums) weight += s.weight, squares += s.squares;
    if (!(weight > 0.0) || !(squares > 0.0)) return;
    const double n = weight * (weight / squares);
    for (int k = 0; k < lobe_count; ++k) {
        const Sums& s = sums[k];
        VmfLobe lobe = mixture_.lobe(k);
        const double length = glm::length(s.direction);
        if (s.weight > 0.0 && s.squares > 0.0 && length > 0.0) {
            const double effective = s.weight * (s.weight / s.squares);
            const double cosine = std::min(1.0, length / s.weight);
            lobe.mean = Vec3(s.direction / length);
            lobe.kappa = kappa_of_mean_cosine(cosine * effective / (effective + direction_prior));
            distances_[k] = float(s.inverse_distance / s.weight);
        }
        mixture_.set(k, lobe,
                     float((n * s.weight / weight + weight_prior) / (n + double(lobe_count) * weight_prior)));
    }
}

void MixtureFit::scale(double factor) {
    samples_ *= factor;
    for (Sums& s : sums_) {
        s.weight *= factor, s.squares *= factor;
        s.inverse_distance *= factor, s.direction *= factor;
    }
}

MixtureFit MixtureFit::moved_to(const Vec3& pivot) const {
    MixtureFit moved = *this;
    moved.pivot_ = pivot;
    for (int k = 0; k < lobe_count; ++k) {
        VmfLobe lobe = mixture_.lobe(k);
        const Sight seen = by_parallax({lobe.mean, distances_[k]}, pivot_, pivot);
        lobe.mean = seen.direction, moved.distances_[k] = seen.inverse_distance;
        moved.mixture_.set(k, lobe, mixture_.weight[k]);
        moved.sums_[k].inverse_distance = sums_[k].weight * double(seen.inverse_distance);
        moved.sums_[k].direction = glm::length(sums_[k].direction) * Vec3d(lobe.mean);
    }
    moved.mixture_.empty = mixture_.empty;
    return moved;
}

VmfMixture MixtureFit::at(const Vec3& position) const {
    VmfMixture seen;
    if (mixture_.empty) return seen;
    seen = mixture_;
    // by_parallax() of each lobe, without a branch
    const Vec3 moved = pivot_ - position;
    MOTE_INDEPENDENT_LANES
    for (int k = 0; k < lobe_count; ++k) {
        const float x = seen.x[k] + moved.x * distances_[k], y = seen.y[k] + moved.y * distances_[k],
                    z = seen.z[k] + moved.z * distances_[k];
        const float squared = x * x + y * y + z * z;
        const bool apart = (squared > 1e-6f) & (squared < core::infinity);
        const float scale = 1.0f / std::sqrt(squared);
        seen.x[k] = apart ? x * scale : seen.x[k];
        seen.y[k] = apart ? y * scale : seen.y[k];
        seen.z[k] = apart ? z * scale : seen.z[k];
    }
    return seen;
}

double MixtureFit::light() const {
    double sum = 0.0;
    for (const Sums& s : sums_) sum += s.weight;
    return sum;
}

}  // namespace mote::lights
