// The sums of a film, which take one pass at a time, or all those of another film.
#include "core/film/film.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>

#include "core/film/for_each_pixel.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

// Variance of a mean of n values from their sum and sum of squares: (sum of squares / n - mean^2) / (n - 1).
// Rounding can leave a tiny negative number where all values are equal.
double variance_from_sums(double sum, double squares, double n) {
    if (n < 2.0) return 0.0;
    const double mean = sum / n;
    return std::fmax(0.0, (squares / n - mean * mean) / (n - 1.0));
}

bool pixel_is_finite(const PassImage& image, std::size_t pixel) {
    for (std::size_t layer = 0; layer < image.layers(); ++layer)
        if (!is_finite(image.layer(layer)[pixel])) return false;
    return true;
}

}  // namespace

KeptSums KeptSums::from_bits(std::uint32_t bits) {
    if (bits > 5) throw std::invalid_argument("sums of an unknown kind");
    return {(bits & 1u) != 0, PassSplit(bits >> 1)};
}

Film::Film(int width, int height, std::vector<Layer> layers, bool all_squares, PassSplit split)
    : width_(width), height_(height), layers_(std::move(layers)), all_squares_(all_squares), split_(split) {
    if (width < 1 || height < 1) throw std::invalid_argument("a film needs at least one pixel");
    sums_.assign(layers_.size(), ExactSums(3 * pixels()));
    for (const Layer& layer : layers_)
        layer_squares_.emplace_back(all_squares_ || layer.squares ? 3 * pixels() : 0);
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        const std::size_t kept = has_squares(i) && splits_layer(split_, layers_[i]) ? 3 * pixels() : 0;
        odd_sums_.emplace_back(kept), odd_squares_.emplace_back(kept);
        layer_blocks_.emplace_back(keeps_blocks(split_, layers_[i]) ? pixels() : 0,
                                   PassBlocks::Keeps::largest);
        fine_sums_.push_back(keeps_fine(split_, layers_[i]) ? FineSums(width, height) : FineSums());
    }
    replaced_.resize(layers_.size());
    find_parts();
    find_where();
    if (split_ == PassSplit::groups && parts() > 1)
        throw std::invalid_argument("groups of passes of several parts");
}

void Film::find_parts() {
    std::size_t count = 1;
    for (const Layer& layer : layers_) count = std::max(count, layer.part + 1);
    if (count > layers_.size() && count > 1) throw std::invalid_argument("a part without layers");
    parts_.assign(count, Part(pixels(), split_));
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        Part& part = parts_[layers_[i].part];
        part.layers.push_back(i);
        if (!layers_[i].auxiliary) part.beauty_layers.push_back(i);
    }
    for (const Part& part : parts_)
        if (part.layers.empty() && count > 1) throw std::invalid_argument("a part without layers");
}

void Film::find_where() {
    std::map<std::string, std::size_t> index;
    for (std::size_t i = 0; i < layers_.size(); ++i)
        if (!index.emplace(layers_[i].name, i).second)
            throw std::invalid_argument("two layers are called '" + layers_[i].name + "'");
    for (const Layer& layer : layers_) {
        if (!layer.where.empty() &&
            (!index.contains(layer.where) || layers_[index[layer.where]].part != layer.part))
            throw std::invalid_argument("there is no layer '" + layer.where + "'");
        where_.push_back(layer.where.empty() ? layers_.size() : index[layer.where]);
    }
}

std::uint32_t Film::pass_count() const {
    std::uint32_t count = 0;
    for (const Part& part : parts_) count += part.passes;
    return count;
}

std::uint32_t Film::first_pass() const {
    std::uint32_t first = 0;
    for (const Part& part : parts_) first += part.first;
    return first;
}

void Film::begin_at(std::size_t part, std::uint32_t first) {
    if (pass_count(part) > 0) throw std::logic_error("the film has passes already");
    parts_.at(part).first = first;
}

bool Film::has_passes(std::uint32_t passes) const {
    return std::all_of(parts_.begin(), parts_.end(), [&](const Part& part) { return part.passes >= passes; });
}

std::vector<std::string> Film::layers_without_passes() const {
    std::vector<std::string> names;
    for (const Layer& layer : layers_)
        if (pass_count(layer.part) == 0) names.push_back(layer.name);
    return names;
}

double Film::passes_of(std::size_t layer, std::size_t pixel) const {
    const std::size_t where = where_[layer];
    return where < layers_.size() ? sums_[where].at(3 * pixel) : double(parts_[layers_[layer].part].passes);
}

float Film::add_pixel(const PassImage& image, Part& part, std::size_t pixel) {
    const bool odd = split_ != PassSplit::whole && part.odd_is_next();
    ExactSums* const group = part.groups.empty() ? nullptr : &part.groups[part.next_group()];
    double beauty[3] = {0.0, 0.0, 0.0};
    for (std::size_t of_image = 0; of_image < part.layers.size(); ++of_image) {
        const std::size_t layer = part.layers[of_image];
        const Rgb value = image.layer(of_image)[pixel];
        for (int c = 0; c < 3; ++c) {
            const double v = value[c];
            const std::size_t i = 3 * pixel + std::size_t(c);
            sums_[layer].add(i, v);
            if (has_squares(layer)) layer_squares_[layer].add(i, v * v);
            if (odd && has_halves(layer)) odd_sums_[layer].add(i, v), odd_squares_[layer].add(i, v * v);
            if (!layers_[layer].auxiliary) beauty[c] += v;
        }
    }
    for (int c = 0; c < 3; ++c) {
        const std::size_t i = 3 * pixel + std::size_t(c);
        part.beauty_squares.add(i, beauty[c] * beauty[c]);
        if (group) group->add(i, beauty[c]);
        if (odd && split_ == PassSplit::halves)
            part.odd_beauty.add(i, beauty[c]), part.odd_squares.add(i, beauty[c] * beauty[c]);
    }
    return float((beauty[0] + beauty[1] + beauty[2]) / 3.0);
}

void Film::check_room(const Part& part, std::uint32_t more) const {
    if (more > max_passes - part.passes)
        throw InputError("a film holds at most " + std::to_string(max_passes) + " passes");
}

void Film::add_pass(const PassImage& image, std::size_t index, double work) {
    Part& part = parts_.at(index);
    if (image.width() != width_ || image.height() != height_ || image.layers() != part.layers.size())
        throw std::invalid_argument("the pass does not fit the film");
    check_room(part, 1);
    for (Replacement& replaced : replaced_) replaced = {};

    PassBlocks::Next block(part.blocks, next_pass(index));
    struct OfLayer {
        std::span<const Rgb> light;
        PassBlocks::Next block;
    };
    std::vector<OfLayer> of_layers;
    for (std::size_t i = 0; i < part.layers.size(); ++i)
        if (PassBlocks& blocks = layer_blocks_[part.layers[i]]; blocks.pixels() > 0)
            of_layers.push_back({image.layer(i), {blocks, next_pass(index)}});
    // Pixels are independent of each other, so the order of tasks does not matter to any bit.
    non_finite_ += tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, pixels(), pixel_grain), std::uint64_t(0),
        [&](const auto& range, std::uint64_t dropped) {
            for (std::size_t pixel = range.begin(); pixel < range.end(); ++pixel) {
                const bool finite = pixel_is_finite(image, pixel);
                block.put(pixel, finite ? add_pixel(image, part, pixel) : 0.0f);
                for (OfLayer& of : of_layers)
                    of.block.put(pixel, finite ? of.light[pixel][block_channel(pixel)] : 0.0f);
                if (!finite) ++dropped;
            }
            return dropped;
        },
        std::plus<>());
    block.finish();
    for (OfLayer& of : of_layers) of.block.finish();
    for (std::size_t i = 0; i < part.layers.size(); ++i) fine_sums_[part.layers[i]].add(image, i);
    part.work += work, ++part.passes;
}

void Film::add(const Film& next) {
    bool fits = next.width_ == width_ && next.height_ == height_ && next.layers_.size() == layers_.size() &&
                next.parts() == parts() && next.all_squares_ == all_squares_ && next.split_ == split_;
    for (std::size_t i = 0; fits && i < layers_.size(); ++i)
        fits = layers_[i].name == next.layers_[i].name && layers_[i].part == next.layers_[i].part &&
               layers_[i].squares == next.layers_[i].squares &&
               layers_[i].auxiliary == next.layers_[i].auxiliary && layers_[i].fine == next.layers_[i].fine;
    for (std::size_t i = 0; fits && i < parts(); ++i) fits = next_pass(i) == next.first_pass(i);
    if (!fits) throw std::invalid_argument("the film does not continue this one");
    for (std::size_t i = 0; i < parts(); ++i) check_room(parts_[i], next.parts_[i].passes);
    for (Replacement& replaced : replaced_) replaced = {};

    const auto add_sums = [](ExactSums& sums, const ExactSums& more) {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, more.size(), 3 * pixel_grain),
                          [&](const auto& range) {
                              for (std::size_t i = range.begin(); i < range.end(); ++i) sums.add(i, more);
                          });
    };
    for (std::size_t i = 0; i < layers_.size(); ++i)
        add_sums(sums_[i], next.sums_[i]), add_sums(layer_squares_[i], next.layer_squares_[i]),
            add_sums(odd_sums_[i], next.odd_sums_[i]), add_sums(odd_squares_[i], next.odd_squares_[i]),
            fine_sums_[i].add(next.fine_sums_[i]);
    for (std::size_t i = 0; i < parts(); ++i) {
        Part& part = parts_[i];
        const Part& more = next.parts_[i];
        add_sums(part.beauty_squares, more.beauty_squares), add_sums(part.odd_beauty, more.odd_beauty);
        add_sums(part.odd_squares, more.odd_squares);
        for (std::size_t g = 0; g < part.groups.size(); ++g) add_sums(part.groups[g], more.groups[g]);
        for (const std::size_t layer : part.layers)
            layer_blocks_[layer].add(next.layer_blocks_[layer], part.range());
        part.passes = part.blocks.add(more.blocks, part.range()).count;
        part.work += more.work;
    }
    non_finite_ += next.non_finite_;
}

std::vector<Rgb> Film::mean(std::size_t layer) const {
    if (!replaced_.at(layer).mean.empty()) return replaced_[layer].mean;
    std::vector<Rgb> result(pixels(), Rgb(0.0f));
    const ExactSums& sums = sums_[layer];
    for_each_pixel(pixels(), [&](std::size_t p) {
        const double n = passes_of(layer, p);
        if (n == 0.0) return;
        for (int c = 0; c < 3; ++c) result[p][c] = float(sums.at(3 * p + std::size_t(c)) / n);
    });
    return result;
}

std::vector<Rgb> Film::beauty() const {
    std::vector<Rgb> result(pixels(), Rgb(0.0f));
    for (std::size_t layer = 0; layer < layers_.size(); ++layer) {
        if (layers_[layer].auxiliary) continue;
        const std::vector<Rgb> part = mean(layer);
        for_each_pixel(pixels(), [&](std::size_t p) { result[p] += part[p]; });
    }
    return result;
}

std::vector<Rgb> Film::variance_of_mean(std::span<const std::size_t> layers, const ExactSums& squares,
                                        double unit) const {
    std::vector<Rgb> result(pixels(), Rgb(0.0f));
    if (layers.empty()) return result;
    const double passes = parts_[layers_[layers.front()].part].passes;
    for_each_pixel(pixels(), [&](std::size_t p) {
        for (int c = 0; c < 3; ++c) {
            const std::size_t i = 3 * p + std::size_t(c);
            double sum = 0.0;
            for (const std::size_t layer : layers) sum += sums_[layer].at(i);
            const double n = layers.size() == 1 ? passes_of(layers.front(), p) : passes;
            result[p][c] = float(variance_from_sums(sum, squares.at(i), n) / (unit * unit));
        }
    });
    return result;
}

std::vector<Rgb> Film::part_variance_of_mean(std::size_t part, double unit) const {
    return variance_of_mean(parts_.at(part).beauty_layers, parts_.at(part).beauty_squares, unit);
}

std::vector<Rgb> Film::beauty_variance_of_mean(double unit) const {
    std::vector<Rgb> result = part_variance_of_mean(0, unit);
    for (std::size_t part = 1; part < parts_.size(); ++part) {
        const std::vector<Rgb> more = part_variance_of_mean(part, unit);
        for_each_pixel(pixels(), [&](std::size_t p) { result[p] += more[p]; });
    }
    return result;
}

std::vector<Rgb> Film::layer_variance_of_mean(std::size_t layer, double unit) const {
    if (!has_squares(layer)) throw std::logic_error("the film does not keep the squares of this layer");
    return variance_of_mean(std::span(&layer, 1), layer_squares_.at(layer), unit);
}

void Film::set_mean(std::size_t layer, std::span<const Rgb> values, std::span<const float> variance) {
    if ((!values.empty() && values.size() != pixels()) || (!variance.empty() && variance.size() != pixels()))
        throw std::invalid_argument("the layer does not fit the film");
    if (!variance.empty() && !has_squares(layer))
        throw std::invalid_argument("what is left of a variance that is not known");
    replaced_.at(layer) = {{values.begin(), values.end()}, {variance.begin(), variance.end()}, {}};
}

void Film::set_halves(std::size_t layer, std::array<std::vector<Rgb>, 2> values) {
    if (!has_halves(layer)) throw std::logic_error("the film does not keep the halves of this layer");
    if (values[0].size() != pixels() || values[1].size() != pixels())
        throw std::invalid_argument("the halves do not fit the film");
    const std::size_t part = layers_[layer].part;
    const float odd = float(half_passes(part, 1)) / float(std::max(1u, pass_count(part)));
    std::vector<Rgb> mean(pixels());
    std::vector<float> variance(pixels());
    for_each_pixel(pixels(), [&](std::size_t p) {
        mean[p] = (1.0f - odd) * values[0][p] + odd * values[1][p];
        const Rgb difference = values[0][p] - values[1][p];
        variance[p] = odd * (1.0f - odd) * average(difference * difference);
    });
    set_mean(layer, mean, variance);
    replaced_[layer].halves = std::move(values);
}

Film::Replacements Film::exchange_replaced(Replacements replaced) {
    replaced.resize(layers_.size());
    for (const Replacement& r : replaced)
        if (!r.mean.empty() && r.mean.size() != pixels())
            throw std::invalid_argument("the layer does not fit the film");
    std::swap(replaced, replaced_);
    return replaced;
}

}  // namespace mote::core
