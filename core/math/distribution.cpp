#include "core/math/distribution.h"

#include <algorithm>
#include <stdexcept>

namespace mote::core {

Distribution1D::Distribution1D(std::span<const float> weights) : weights_(weights.begin(), weights.end()) {
    cdf_.reserve(weights_.size());
    double sum = 0.0;
    for (const float w : weights_) {
        if (!(w >= 0.0f) || !std::isfinite(w))
            throw std::invalid_argument("a weight of a distribution is negative or not finite");
        cdf_.push_back(sum += double(w));
    }
}

Distribution1D::Discrete Distribution1D::sample_discrete(float u) const {
    const double target = double(u) * total();
    // The first entry whose cumulative sum exceeds the target: entries of weight zero are skipped by
    // construction.
    auto it = std::upper_bound(cdf_.begin(), cdf_.end(), target);
    if (it == cdf_.end()) it = std::lower_bound(cdf_.begin(), cdf_.end(), total());
    const auto index = std::size_t(it - cdf_.begin());
    const double below = index == 0 ? 0.0 : cdf_[index - 1];
    const double remapped = (target - below) / double(weights_[index]);
    return {index, probability(index), std::clamp(float(remapped), 0.0f, one_minus_epsilon)};
}

float Distribution1D::probability(std::size_t index) const {
    return empty() || index >= weights_.size() ? 0.0f : float(double(weights_[index]) / total());
}

Distribution1D::Continuous Distribution1D::sample_continuous(float u) const {
    const Discrete d = sample_discrete(u);
    const float n = float(size());
    return {std::min((float(d.index) + d.remapped) / n, one_minus_epsilon), d.probability * n};
}

float Distribution1D::pdf(float x) const {
    if (empty() || !(x >= 0.0f && x <= 1.0f)) return 0.0f;
    const auto index = std::min(std::size_t(x * float(size())), size() - 1);
    return probability(index) * float(size());
}

Distribution2D::Distribution2D(std::span<const float> values, std::size_t width, std::size_t height) {
    if (values.size() != width * height)
        throw std::invalid_argument("2D distribution: table and size disagree");
    std::vector<float> row_sums;
    for (std::size_t y = 0; y < height; ++y) {
        rows_.emplace_back(values.subspan(y * width, width));
        row_sums.push_back(float(rows_.back().total() / double(width)));
    }
    marginal_ = Distribution1D(row_sums);
}

Distribution2D::Sample Distribution2D::sample(const Vec2& u) const {
    const auto y = marginal_.sample_discrete(u.y);
    const auto x = rows_[y.index].sample_continuous(u.x);
    const float height = float(rows_.size());
    const float v = std::min((float(y.index) + y.remapped) / height, one_minus_epsilon);
    return {{x.x, v}, x.pdf * y.probability * height};
}

float Distribution2D::pdf(const Vec2& uv) const {
    if (empty() || !(uv.y >= 0.0f && uv.y <= 1.0f)) return 0.0f;
    const auto y = std::min(std::size_t(uv.y * float(rows_.size())), rows_.size() - 1);
    return rows_[y].pdf(uv.x) * marginal_.probability(y) * float(rows_.size());
}

}  // namespace mote::core
