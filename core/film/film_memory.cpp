// Counts what Film, PassImage and film_image() allocate; film_memory_test.cpp compares it with them.
#include "core/film/film_memory.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/math/sampler.h"

namespace mote::core {

namespace {
constexpr std::uint32_t unknown_passes = 1023;
}  // namespace

FilmMemory::FilmMemory(int width, int height, std::span<const Layer> layers, bool all_squares,
                       std::optional<std::uint32_t> passes, PassSplit split)
    : width_(width), height_(height), layers_(layers.size()) {
    const double pixels = double(width) * double(height);
    constexpr double sum = 2.0 * sizeof(std::int64_t) + 1.0;  // of ExactSums
    double parts = 1.0, kept = 0.0, in_blocks = 0.0, fine = 0.0;
    double planes = 4.0;  // beauty and its variance, and two while they are found
    for (const Layer& layer : layers) {
        const bool squares = all_squares || layer.squares;
        parts = std::max(parts, double(layer.part) + 1.0);
        kept += !squares ? 1.0 : splits_layer(split, layer) ? 4.0 : 2.0;
        planes += layer.auxiliary && squares ? 2.0 : 1.0;
        if (keeps_blocks(split, layer)) in_blocks += 1.0;
        if (keeps_fine(split, layer)) fine += 1.0;
    }
    // 2^k passes have k differences of blocks; a block that waits for its other half is one of these in
    // floats.
    const double levels = double(std::bit_width(passes.value_or(unknown_passes)));
    const double blocks = levels * sizeof(float) + std::max(0.0, levels - 1.0) * sum;
    const double of_beauty = split == PassSplit::halves   ? 3.0
                             : split == PassSplit::groups ? 1.0 + double(pass_group_count)
                                                          : 1.0;
    begin_ =
        pixels * 3.0 * sum * (kept + of_beauty * parts) + 4.0 * pixels * (3.0 * sum + sizeof(float)) * fine;
    sums_ = begin_ + pixels * (parts * blocks + in_blocks * (levels + 1.0) * sizeof(float));
    pass_ =
        pixels * (double(layers.size()) * sizeof(Rgb) + parts + (fine == 0.0 ? 0.0 : sizeof(std::uint32_t)));
    // Picture, variances, and their squares while they are smoothed, beside the image of the last pass.
    pass_ += pixels * (4.0 * sizeof(Rgb) + 6.0 * sizeof(double));
    if (split == PassSplit::halves)
        pass_ += pixels * 8.0 * sizeof(Rgb);  // means, what is shown of them, variances
    if (split == PassSplit::groups)           // means, deviations from them, squares without noise
        pass_ += pixels * double(pass_group_count) * (2.0 * sizeof(Rgb) + sizeof(double)) +
                 pixels * (6.0 * sizeof(Rgb) + 2.0 * sizeof(double));
    picture_ = pixels * planes * sizeof(Rgb);
}

double FilmMemory::peak() const { return sums_ + std::max(pass_, picture_); }

std::string FilmMemory::purpose() const {
    return "a film of " + std::to_string(width_) + " x " + std::to_string(height_) + " pixels and " +
           std::to_string(layers_) + (layers_ == 1 ? " layer" : " layers");
}

void FilmMemory::require(const MemoryBudget& memory, double more) const {
    const double needed = peak() + more;
    memory.require(needed, purpose(), [&](double available) {
        const double scale = std::sqrt(available / needed);
        return "at most " + std::to_string(int(scale * width_)) + " x " +
               std::to_string(int(scale * height_)) + " pixels of this shape fit";
    });
}

}  // namespace mote::core
