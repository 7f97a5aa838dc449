#include "core/materials/texels.h"

#include <algorithm>
#include <bit>
#include <optional>

namespace mote::core {

namespace {

/// The numbers of an image and their indices, by an open hash table of their bits.
class ValueTable {
  public:
    static constexpr std::size_t most = 65536;  ///< values

    /// Nothing where there are more values than `most`.
    std::optional<std::uint32_t> index_of(float value) {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        for (std::size_t slot = (bits * 0x9e3779b1u) >> 15;; slot = (slot + 1) % slots) {
            std::uint32_t& entry = entries_[slot];
            if (entry != 0 && std::bit_cast<std::uint32_t>(values_[entry - 1]) == bits) return entry - 1;
            if (entry != 0) continue;
            if (values_.size() == most) return std::nullopt;
            values_.push_back(value);
            entry = std::uint32_t(values_.size());
            return entry - 1;
        }
    }
    std::vector<float>& values() { return values_; }

  private:
    static constexpr std::size_t slots = std::size_t(1) << 17;
    std::vector<std::uint32_t> entries_ = std::vector<std::uint32_t>(slots);  ///< index + 1; 0: free
    std::vector<float> values_;
};

bool is_grey(const Rgb& c) {
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
    return bits(c.x) == bits(c.y) && bits(c.x) == bits(c.z);
}

}  // namespace

Texels::Texels(const Bitmap& bitmap)
    : width_(std::size_t(bitmap.width)), grey_(std::ranges::all_of(bitmap.pixels, is_grey)) {
    const int channels = grey_ ? 1 : 3;
    const std::size_t count = bitmap.pixels.size() * std::size_t(channels);
    ValueTable table;
    const auto index_all = [&](auto& indices, std::size_t most) {
        indices.reserve(count);
        for (const Rgb& pixel : bitmap.pixels)
            for (int c = 0; c < channels; ++c) {
                const auto index = table.index_of(pixel[c]);
                if (!index || *index >= most) return false;
                indices.push_back(static_cast<typename std::decay_t<decltype(indices)>::value_type>(*index));
            }
        return true;
    };
    if (index_all(bytes_, 256)) {
        values_ = std::move(table.values());
    } else if (bytes_ = {}; index_all(words_, ValueTable::most)) {
        values_ = std::move(table.values());
    } else {
        words_ = {};
        values_.reserve(count);
        for (const Rgb& pixel : bitmap.pixels)
            for (int c = 0; c < channels; ++c) values_.push_back(pixel[c]);
    }
}

std::size_t Texels::bytes() const {
    return values_.size() * sizeof(float) + bytes_.size() + words_.size() * sizeof(std::uint16_t);
}

}  // namespace mote::core
