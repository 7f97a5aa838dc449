// The groups of a film's passes, and the error that they show.
#include <algorithm>

#include "core/film/film.h"
#include "core/film/for_each_pixel.h"
#include "core/metrics/group_error.h"
#include "core/metrics/neighbourhood.h"
#include "core/metrics/reference_pair.h"

namespace mote::core {

namespace {

/// Mean of both halves without most of its noise: over the pixels around each that are alike. Over all of
/// them, the edge of a cloud against the sky would lose light, and the error be relative to less of it.
std::vector<Rgb> smoothed_mean(const PictureHalf& a, const PictureHalf& b, int width, int height) {
    const PairMean mean = mean_of({a.passes, b.passes, a.variance, b.variance});
    std::vector<Rgb> result(mean.picture.size());
    for_each_pixel(result.size(), [&](std::size_t p) {
        const int x = int(p % std::size_t(width)), y = int(p / std::size_t(width));
        const AlikeNeighbours near = alike_neighbours(mean.picture, mean.variance, x, y, width, height);
        result[p] = Rgb((near.sum + glm::dvec3(mean.picture[p])) / (near.count + 1.0));
    });
    return result;
}

}  // namespace

std::vector<PassGroup> Film::groups_of_passes() const {
    const Part& part = parts_.front();
    std::vector<PassGroup> groups;
    for (std::uint32_t g = 0; g < pass_group_count; ++g) {
        // Passes first .. first + passes - 1, of which every eighth is of the group.
        const std::uint32_t before =
            (g + pass_group_count - part.first % pass_group_count) % pass_group_count;
        const double n = (part.passes - before + pass_group_count - 1) / pass_group_count;
        PassGroup& group = groups.emplace_back(PassGroup{n, std::vector<Rgb>(pixels())});
        for_each_pixel(3 * pixels(), [&](std::size_t i) {
            group.mean[i / 3][int(i % 3)] = float(part.groups[g].at(i) / n);
        });
    }
    return groups;
}

std::optional<PictureError> Film::error_of_groups() const {
    const bool processed =
        std::any_of(replaced_.begin(), replaced_.end(), [](const Replacement& r) { return !r.mean.empty(); });
    if (parts_.front().passes < pass_group_count || processed) return std::nullopt;
    const std::vector<PassGroup> groups = groups_of_passes();
    std::vector<Rgb> picture = beauty(), variance = beauty_variance_of_mean(), light;
    std::vector<std::vector<Rgb>> planes;
    std::vector<PictureHalf> missing;
    for (std::size_t layer = 0; layer < layers_.size(); ++layer) {
        if (!layers_[layer].missing) continue;
        for (const int half : {0, 1})
            planes.push_back(half_mean(layer, half)), planes.push_back(half_variance_of_mean(layer, half));
        missing = {{planes[0], {}, planes[1]}, {planes[2], {}, planes[3]}};
        light = smoothed_mean(missing[0], missing[1], width_, height_);
        for (std::size_t p = 0; p < pixels(); ++p) picture[p] += light[p];
    }
    const auto error_by = [&](const RelativeWeights& weights) {
        return group_error(groups, missing, weights);
    };
    return PictureError::of_all({error_by(relative_weights(picture, variance, width_, height_)),
                                 error_by(weights_of_groups(groups, light, width_, height_)),
                                 error_by(lower_weights(picture, variance, width_, height_))});
}

}  // namespace mote::core
