// The halves of a film's passes, and the error that they show.
#include <algorithm>
#include <cmath>

#include "core/film/film.h"
#include "core/film/for_each_pixel.h"

namespace mote::core {

std::uint32_t Film::half_passes(std::size_t part, int half) const {
    const Part& p = parts_.at(part);
    const std::uint32_t odd = (p.first + p.passes) / 2 - p.first / 2;
    return half == 1 ? odd : p.passes - odd;
}

std::vector<Rgb> Film::half_of(std::span<const std::size_t> layers, const ExactSums& odd, int half) const {
    std::vector<Rgb> result(pixels(), Rgb(0.0f));
    if (layers.empty()) return result;
    const double n = half_passes(layers_[layers.front()].part, half);
    if (n == 0.0) return result;
    for_each_pixel(pixels(), [&](std::size_t p) {
        for (std::size_t c = 0; c < 3; ++c) {
            double sum = odd.at(3 * p + c);
            if (half == 0) {
                double all = 0.0;
                for (const std::size_t layer : layers) all += sums_[layer].at(3 * p + c);
                sum = all - sum;
            }
            result[p][int(c)] = float(sum / n);
        }
    });
    return result;
}

std::vector<Rgb> Film::half_mean(std::size_t layer, int half) const {
    if (!has_halves(layer)) throw std::logic_error("the film does not keep the halves of this layer");
    return half_of(std::span(&layer, 1), odd_sums_[layer], half);
}

std::vector<Rgb> Film::half_variance(std::span<const std::size_t> layers, const ExactSums& squares,
                                     const ExactSums& odd, const ExactSums& odd_squares, int half) const {
    std::vector<Rgb> result(pixels(), Rgb(0.0f));
    if (layers.empty()) return result;
    const double n = half_passes(layers_[layers.front()].part, half);
    if (n < 2.0) return result;
    for_each_pixel(3 * pixels(), [&](std::size_t i) {
        double sum = odd.at(i), square = odd_squares.at(i);
        if (half == 0) {
            double all = 0.0;
            for (const std::size_t layer : layers) all += sums_[layer].at(i);
            sum = all - sum, square = squares.at(i) - square;
        }
        const double mean = sum / n;
        result[i / 3][int(i % 3)] = float(std::fmax(0.0, (square / n - mean * mean) / (n - 1.0)));
    });
    return result;
}

std::vector<Rgb> Film::half_variance_of_mean(std::size_t layer, int half) const {
    if (!has_halves(layer)) throw std::logic_error("the film does not keep the halves of this layer");
    return half_variance(std::span(&layer, 1), layer_squares_[layer], odd_sums_[layer], odd_squares_[layer],
                         half);
}

Film::PartHalf Film::part_half(std::size_t index, int half) const {
    const Part& part = parts_.at(index);
    return {half_of(part.beauty_layers, part.odd_beauty, half),
            half_variance(part.beauty_layers, part.beauty_squares, part.odd_beauty, part.odd_squares, half)};
}

Film::HalfBeauty Film::half_beauty(int half) const {
    HalfBeauty result;
    for (auto* plane : {&result.passes, &result.shown, &result.variance}) plane->assign(pixels(), Rgb(0.0f));
    const auto add = [&](std::vector<Rgb>& to, const std::vector<Rgb>& more) {
        for (std::size_t p = 0; p < pixels(); ++p) to[p] += more[p];
    };
    for (std::size_t part = 0; part < parts(); ++part) {
        const PartHalf of_part = part_half(part, half);
        add(result.passes, of_part.mean), add(result.shown, of_part.mean);
        add(result.variance, of_part.variance);
        for (const std::size_t layer : parts_[part].beauty_layers) {
            const std::vector<Rgb>& shown = replaced_[layer].halves[std::size_t(half)];
            if (shown.empty()) continue;
            const std::vector<Rgb> own = half_mean(layer, half);
            for (std::size_t p = 0; p < pixels(); ++p) result.shown[p] += shown[p] - own[p];
        }
    }
    return result;
}

std::optional<PictureError> Film::error(const ControlPixels& controls) const {
    return split_ == PassSplit::halves   ? error_of_halves(controls)
           : split_ == PassSplit::groups ? error_of_groups()
                                         : std::nullopt;
}

std::optional<PictureError> Film::error_of_halves(const ControlPixels& controls) const {
    for (std::size_t i = 0; i < parts(); ++i)
        if (half_passes(i, 1) < 2 || half_passes(i, 0) < 2) return std::nullopt;
    for (std::size_t i = 0; i < layers_.size(); ++i)
        if (!layers_[i].auxiliary && !replaced_[i].mean.empty() && replaced_[i].halves[0].empty())
            return std::nullopt;
    HalfBeauty a = half_beauty(0), b = half_beauty(1);
    // The gain of Sobol points is pooled over the picture. Where rare bright paths make the noise there is
    // none.
    const auto gain = float(gain_and_noise().gain);
    for (auto* variance : {&a.variance, &b.variance})
        for (Rgb& v : *variance) v *= gain;
    const std::array halves{PictureHalf{a.passes, a.shown, a.variance},
                            PictureHalf{b.passes, b.shown, b.variance}};
    const RelativeWeights weights =
        relative_weights(mean_of_passes(), beauty_variance_of_mean(), width_, height_);
    BlockErrors errors = halves_error(halves, weights, width_, height_);
    SquaredError of_picture = with_controls(errors.sum(), control_estimate(controls, halves, weights));
    const double before = errors.sum().variance;
    add_variance_of_weights(errors, halves,
                            {relative_weights(a.passes, a.variance, width_, height_),
                             relative_weights(b.passes, b.variance, width_, height_)},
                            width_);
    of_picture.variance += errors.sum().variance - before;
    return error_interval(of_picture);
}

}  // namespace mote::core
