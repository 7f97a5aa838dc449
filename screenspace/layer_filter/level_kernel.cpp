#include "screenspace/layer_filter/level_kernel.h"

#include <algorithm>
#include <cstring>

#include "screenspace/layer_filter/same_surface.h"

namespace mote::screenspace {

using namespace core;

namespace {

constexpr float spline[5] = {1.0f / 16, 4.0f / 16, 6.0f / 16, 4.0f / 16, 1.0f / 16};
constexpr int middle = 12;
/// Added to the variance of places, in squared steps, so that taps on a line have a covariance to divide by.
/// A slope loses this fraction of itself at most where taps spread over a step.
constexpr float ridge = 1e-5f;

}  // namespace

LevelKernel::LevelKernel(const FilterPlanes& planes, int step, int y, int x0, int x1)
    : planes_(planes), step_(step), y_(y), x0_(x0), count_(x1 - x0) {
    std::memset(mean_, 0, sizeof mean_);
    for (int tap = 0; tap < taps; ++tap) {
        const int dx = tap % 5 - 2, dy = tap / 5 - 2;
        const float k = spline[dx + 2] * spline[dy + 2];
        if (planes.kind == LayerKind::surface)
            weight_by_surface(tap, k);
        else
            weight_by_volume(tap, k);
    }
    normalise();
}

bool LevelKernel::reach(int tap, int& first, int& last, std::ptrdiff_t& shift) const {
    const int dx = (tap % 5 - 2) * step_, dy = (tap / 5 - 2) * step_;
    if (y_ + dy < 0 || y_ + dy >= planes_.height) return false;
    first = std::max(0, -dx - x0_), last = std::min(count_, planes_.width - dx - x0_);
    shift = std::ptrdiff_t(y_ + dy) * planes_.width + x0_ + dx;
    return first < last;
}

void LevelKernel::weight_by_surface(int tap, float k) {
    int first, last;
    std::ptrdiff_t shift;
    if (!reach(tap, first, last, shift)) return;
    const FilterPlanes& p = planes_;
    const std::ptrdiff_t here = std::ptrdiff_t(y_) * p.width + x0_;
    const float *px = p.px.data(), *py = p.py.data(), *pz = p.pz.data(), *nx = p.nx.data(), *ny = p.ny.data(),
                *nz = p.nz.data(), *sx = p.sx.data(), *sy = p.sy.data(), *sz = p.sz.data(),
                *fp = p.footprint.data(), *wt = p.weight.data(), *ch = p.channels.data();
    float* out = mean_[tap];
    MOTE_INDEPENDENT_LANES
    for (int i = first; i < last; ++i) {
        const std::ptrdiff_t a = here + i, b = shift + i;
        const float dx = px[b] - px[a], dy = py[b] - py[a], dz = pz[b] - pz[a];
        const float own = std::fabs(dx * nx[a] + dy * ny[a] + dz * nz[a]);
        const float other = std::fabs(dx * nx[b] + dy * ny[b] + dz * nz[b]);
        const float cosine = sx[a] * sx[b] + sy[a] * sy[b] + sz[a] * sz[b];
        const float same = same_surface(max_of(own, other), fp[a], cosine);
        const float both = wt[a] > 0.0f && ch[a] == ch[b] ? wt[b] : 0.0f;
        out[i] = k * same * both;
    }
}

void LevelKernel::weight_by_volume(int tap, float k) {
    int first, last;
    std::ptrdiff_t shift;
    if (!reach(tap, first, last, shift)) return;
    const FilterPlanes& p = planes_;
    const std::ptrdiff_t here = std::ptrdiff_t(y_) * p.width + x0_;
    const float *px = p.px.data(), *py = p.py.data(), *pz = p.pz.data(), *nx = p.nx.data(), *ny = p.ny.data(),
                *nz = p.nz.data(), *t = p.distance.data(), *tr = p.transmittance.data(),
                *ln = p.log_transmittance.data(), *wt = p.weight.data(), *ch = p.channels.data();
    float* out = mean_[tap];
    MOTE_INDEPENDENT_LANES
    for (int i = first; i < last; ++i) {
        const std::ptrdiff_t a = here + i, b = shift + i;
        const float dx = px[b] - px[a], dy = py[b] - py[a], dz = pz[b] - pz[a];
        const float own = std::fabs(dx * nx[a] + dy * ny[a] + dz * nz[a]);
        const float other = std::fabs(dx * nx[b] + dy * ny[b] + dz * nz[b]);
        const float along = std::fabs(t[b] - t[a]);
        const float step = along < 0.5f * FilterFeatures::far ? min_of(max_of(own, other), along) : along;
        const bool nearer = t[a] <= t[b];
        const float between =
            between_depths(step, nearer ? t[a] : t[b], nearer ? tr[a] : tr[b], nearer ? ln[a] : ln[b]) *
            (1.0f / depth_tolerance);
        const float both = wt[a] > 0.0f && ch[a] == ch[b] ? wt[b] : 0.0f;
        out[i] = k * tukey(between * between) * both;
    }
}

void LevelKernel::normalise() {
    float sum[max_pixels] = {};
    for (int tap = 0; tap < taps; ++tap)
        for (int i = 0; i < count_; ++i) sum[i] += mean_[tap][i];
    for (int i = 0; i < count_; ++i)
        if (!(sum[i] > 0.0f)) mean_[middle][i] = sum[i] = 1.0f;  // takes no part: stays as it is
    for (int i = 0; i < count_; ++i) sum[i] = 1.0f / sum[i];
    for (int tap = 0; tap < taps; ++tap)
        for (int i = 0; i < count_; ++i) mean_[tap][i] *= sum[i];
}

void LevelKernel::place(int tap, Taps& x, Taps& y) const {
    const int dx = tap % 5 - 2, dy = tap / 5 - 2;
    if (planes_.kind == LayerKind::volume) {
        std::fill_n(x[tap], count_, float(dx)), std::fill_n(y[tap], count_, float(dy));
        return;
    }
    std::fill_n(x[tap], count_, 0.0f), std::fill_n(y[tap], count_, 0.0f);
    int first, last;
    std::ptrdiff_t shift;
    if (!reach(tap, first, last, shift)) return;
    const std::ptrdiff_t here = std::ptrdiff_t(y_) * planes_.width + x0_;
    const float *px = planes_.px.data(), *py = planes_.py.data(), *pz = planes_.pz.data();
    const PixelFrame* frame = planes_.frame->data() + here;
    const float scale = 1.0f / float(step_);
    for (int i = first; i < last; ++i) {
        const std::ptrdiff_t a = here + i, b = shift + i;
        const Vec3 d = Vec3(px[b] - px[a], py[b] - py[a], pz[b] - pz[a]) * scale;
        x[tap][i] = glm::dot(frame[i].along_x, d), y[tap][i] = glm::dot(frame[i].along_y, d);
    }
}

void LevelKernel::make_linear() {
    Taps xs, ys;
    float mx[max_pixels] = {}, my[max_pixels] = {}, xx[max_pixels] = {}, yy[max_pixels] = {},
          xy[max_pixels] = {};
    for (int tap = 0; tap < taps; ++tap) {
        place(tap, xs, ys);
        const float *w = mean_[tap], *x = xs[tap], *y = ys[tap];
        MOTE_INDEPENDENT_LANES
        for (int i = 0; i < count_; ++i) {
            const float wx = w[i] * x[i], wy = w[i] * y[i];
            mx[i] += wx, my[i] += wy, xx[i] += wx * x[i], yy[i] += wy * y[i], xy[i] += wx * y[i];
        }
    }
    // Eq. (3): (a, b) = M^-1 mu.
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < count_; ++i) {
        const float cxx = xx[i] - mx[i] * mx[i] + ridge, cyy = yy[i] - my[i] * my[i] + ridge;
        const float cxy = xy[i] - mx[i] * my[i];
        const float scale = 1.0f / max_of(cxx * cyy - cxy * cxy, ridge * ridge);
        xx[i] = (cyy * mx[i] - cxy * my[i]) * scale, yy[i] = (cxx * my[i] - cxy * mx[i]) * scale;
    }
    for (int tap = 0; tap < taps; ++tap) {
        const float *w = mean_[tap], *x = xs[tap], *y = ys[tap];
        float* out = linear_[tap];
        MOTE_INDEPENDENT_LANES
        for (int i = 0; i < count_; ++i)
            out[i] = w[i] * (1.0f - (x[i] - mx[i]) * xx[i] - (y[i] - my[i]) * yy[i]);
    }
}

void LevelKernel::apply(const Taps& weights, std::span<const float> plane, float* out) const {
    std::fill_n(out, count_, 0.0f);
    for (int tap = 0; tap < taps; ++tap) {
        int first, last;
        std::ptrdiff_t shift;
        if (!reach(tap, first, last, shift)) continue;
        const float *w = weights[tap], *from = plane.data();
        MOTE_INDEPENDENT_LANES
        for (int i = first; i < last; ++i) out[i] += w[i] * from[shift + i];
    }
}

}  // namespace mote::screenspace
