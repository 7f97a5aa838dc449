// Pixel filters as distributions of offsets (filter importance sampling, Ernst et al. 2006).
//
// All three are products of one function per axis and nowhere negative, so that every sample has the same
// weight.
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/objects/error.h"
#include "core/render/render_driver.h"

namespace mote::core {

namespace {

class BoxFilter final : public PixelFilter {
  public:
    explicit BoxFilter(float radius) : radius_(radius) {}
    Vec2 sample_offset(const Vec2& u) const override { return (2.0f * u - 1.0f) * radius_; }
    /// Half open, as the offsets are: neighbouring boxes of radius 1/2 share no point.
    float pdf_area(const Vec2& offset) const override {
        const auto inside = [&](float x) { return x >= -radius_ && x < radius_; };
        return inside(offset.x) && inside(offset.y) ? 1.0f / sqr(2.0f * radius_) : 0.0f;
    }
    float radius() const override { return radius_; }

  private:
    float radius_;
};

class TentFilter final : public PixelFilter {
  public:
    explicit TentFilter(float radius) : radius_(radius) {}
    Vec2 sample_offset(const Vec2& u) const override { return radius_ * Vec2(invert(u.x), invert(u.y)); }
    float pdf_area(const Vec2& offset) const override { return density(offset.x) * density(offset.y); }
    float radius() const override { return radius_; }

  private:
    float density(float x) const { return std::fmax(0.0f, 1.0f - std::fabs(x) / radius_) / radius_; }
    // Inverse of the distribution function of the density 1 - |x| on [-1, 1].
    static float invert(float u) {
        return u < 0.5f ? std::sqrt(2.0f * u) - 1.0f : 1.0f - std::sqrt(2.0f * (1.0f - u));
    }
    float radius_;
};

// exp(-x^2 / (2 stddev^2)) minus its value at the radius, as Mitsuba 3 has it. Sampled from a
// piecewise-linear density of 512 cells, exactly: the density is then right to about 1e-5 of its peak.
class GaussianFilter final : public PixelFilter {
  public:
    GaussianFilter(double radius, double stddev) : radius_(radius), cell_(2.0 * radius / cells) {
        const double alpha = -1.0 / (2.0 * stddev * stddev);
        const double floor = std::exp(alpha * radius * radius);
        density_.resize(cells + 1), cdf_.resize(cells + 1, 0.0);
        for (int i = 0; i <= cells; ++i) {
            const double x = -radius + cell_ * i;
            density_[std::size_t(i)] = std::fmax(0.0, std::exp(alpha * x * x) - floor);
        }
        for (std::size_t i = 0; i < cells; ++i)
            cdf_[i + 1] = cdf_[i] + 0.5 * cell_ * (density_[i] + density_[i + 1]);
        for (std::size_t k = 0; k < starts; ++k)
            start_[k] = std::uint16_t(cell_from(0, double(k) / starts * cdf_.back()));
    }
    Vec2 sample_offset(const Vec2& u) const override { return {float(invert(u.x)), float(invert(u.y))}; }
    float pdf_area(const Vec2& offset) const override {
        return float(density(double(offset.x)) * density(double(offset.y)));
    }
    float radius() const override { return float(radius_); }

  private:
    static constexpr int cells = 512;
    static constexpr std::size_t starts = 1024;

    /// The cell that holds the target of the distribution function, at `i` or behind it.
    std::size_t cell_from(std::size_t i, double target) const {
        while (i + 1 < cells && cdf_[i + 1] <= target) ++i;
        return i;
    }

    /// Value of the table, so that it is exactly what invert() samples by.
    double density(double x) const {
        const double at = (x + radius_) / cell_;
        if (!(at >= 0.0 && at < double(cells))) return 0.0;
        const auto i = std::size_t(at);
        return (density_[i] + (at - double(i)) * (density_[i + 1] - density_[i])) / cdf_.back();
    }

    double invert(double u) const {
        const double target = u * cdf_.back();
        const std::size_t i = cell_from(start_[std::size_t(u * starts)], target);
        // Area up to the fraction f of a trapezoid: cell (a f + (b - a) f^2 / 2) = rest, in the form of the
        // quadratic formula that does not cancel where a and b are nearly equal.
        const double a = density_[i], b = density_[i + 1], rest = (target - cdf_[i]) / cell_;
        const double root = a + std::sqrt(std::fmax(0.0, a * a + 2.0 * (b - a) * rest));
        const double f = root > 0.0 ? std::fmin(1.0, 2.0 * rest / root) : 0.0;
        return -radius_ + cell_ * (double(i) + f);
    }

    double radius_, cell_;
    std::vector<double> density_, cdf_;
    std::array<std::uint16_t, starts> start_{};  ///< where the search begins for u from k / starts on
};

}  // namespace

std::unique_ptr<PixelFilter> make_pixel_filter(const std::string& name, float radius, float stddev) {
    if (!(radius > 0.0f) || radius > 1000.0f)
        throw InputError("the radius of a pixel filter must lie above 0 and be at most 1000 pixels");
    if (name == "box") return std::make_unique<BoxFilter>(radius);
    if (name == "tent") return std::make_unique<TentFilter>(radius);
    if (name == "gaussian") {
        if (!(stddev > 0.0f)) throw InputError("the stddev of a Gaussian pixel filter must be above 0");
        // Below a 64th of the radius the table would be coarser than the filter; nothing is lost by cutting
        // it at 16 standard deviations.
        const double cut = std::fmin(double(radius), 16.0 * double(stddev));
        return std::make_unique<GaussianFilter>(cut, stddev);
    }
    const std::vector<std::string> known{"box", "gaussian", "tent"};
    throw InputError("unknown pixel filter '" + printable(name) + "'" + suggestion(name, known));
}

}  // namespace mote::core
