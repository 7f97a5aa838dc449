// The bits of a film as bytes: header, a head for each part, packed sums (packed_numbers.h), checksum.
// Little-endian, as every machine this runs on.
//
// Before the first block of a part is complete all totals are zero, and right after a block the open one is:
// these are not written, for a film takes hundreds of megabytes.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>
#include <vector>

#include "core/image/checksum.h"
#include "core/image/film.h"
#include "core/image/packed_numbers.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

struct Header {
    std::array<char, 8> magic = {'m', 'o', 't', 'e', 'f', 'i', 'l', 'm'};
    std::uint32_t version = 3;
    std::uint32_t width = 0, height = 0, layers = 0, all_squares = 0, parts = 0;
    std::uint64_t non_finite = 0;
};
static_assert(sizeof(Header) == 40, "the header has no padding whose bytes could vary");
struct PartHeader {
    std::uint64_t passes = 0;
    double work = 0.0;
};

bool has_totals(std::uint32_t passes) { return passes >= Film::block_size; }
bool has_blocks(std::uint32_t passes) { return passes % Film::block_size != 0; }
// Of blocks of 2^(k+1) passes: is half of one there, and has one been complete?
bool is_open(std::uint32_t passes, std::size_t k) { return (passes >> k) % 2 == 1; }
bool is_closed(std::uint32_t passes, std::size_t k) { return std::uint64_t(passes) >> (k + 1) > 0; }

}  // namespace

/// Every array that the film of so many passes has, in the order of the file.
template <typename AnyFilm, typename Body>
void Film::for_each_array(AnyFilm& film, const Body& body) {
    const auto of_sums = [&](auto& sums, std::uint32_t passes) {
        if (has_totals(passes)) body(sums.total);
        if (has_blocks(passes)) body(sums.block);
    };
    const auto passes_of = [&](std::size_t layer) { return film.parts_[film.layers_[layer].part].passes; };
    for (std::size_t i = 0; i < film.layers_.size(); ++i) of_sums(film.sums_[i], passes_of(i));
    for (std::size_t i = 0; i < film.layers_.size(); ++i) of_sums(film.layer_squares_[i], passes_of(i));
    for (auto& part : film.parts_) {
        of_sums(part.beauty_squares, part.passes);
        for (std::size_t k = 0; k < part.halves.size(); ++k) {
            if (is_open(part.passes, k)) body(part.halves[k].open);
            if (is_closed(part.passes, k)) body(part.halves[k].squares);
        }
    }
}

std::vector<std::byte> Film::serialize() const {
    Header header;
    header.width = std::uint32_t(width_), header.height = std::uint32_t(height_);
    header.layers = std::uint32_t(layers_.size()), header.all_squares = all_squares_ ? 1 : 0;
    header.parts = std::uint32_t(parts_.size()), header.non_finite = non_finite_;

    std::vector<PartHeader> heads;
    for (const Part& part : parts_) heads.push_back({part.passes, part.work});
    const std::size_t head_bytes = heads.size() * sizeof(PartHeader);
    std::vector<Packing> packings;
    std::size_t size = sizeof(header) + head_bytes + sizeof(std::uint64_t);
    for_each_array(*this, [&](const auto& numbers) {
        packings.push_back(packing_of(std::span(numbers)));
        size += packings.back().size;
    });
    std::vector<std::byte> bytes(size);
    std::memcpy(bytes.data(), &header, sizeof(header));
    std::memcpy(bytes.data() + sizeof(header), heads.data(), head_bytes);
    std::byte* to = bytes.data() + sizeof(header) + head_bytes;
    auto packing = packings.begin();
    for_each_array(*this, [&](const auto& numbers) {
        pack(std::span(numbers), *packing, to);
        to += packing++->size;
    });
    const std::uint64_t sum = checksum(std::span(bytes).first(size - sizeof(sum)));
    std::memcpy(to, &sum, sizeof(sum));
    return bytes;
}

void Film::deserialize(std::span<const std::byte> bytes) {
    if (bytes.size() < sizeof(Header) + sizeof(std::uint64_t)) throw InputError("the film is cut short");

    Header header;
    std::memcpy(&header, bytes.data(), sizeof(header));
    if (header.magic != Header().magic) throw InputError("not a film");
    if (header.version != Header().version)
        throw InputError("the film has format " + std::to_string(header.version) + ", not " +
                         std::to_string(Header().version));
    if (header.width != std::uint32_t(width_) || header.height != std::uint32_t(height_))
        throw InputError("the film has " + std::to_string(header.width) + " x " +
                         std::to_string(header.height) + " pixels, not " + std::to_string(width_) + " x " +
                         std::to_string(height_));
    if (header.layers != layers_.size() || (header.all_squares != 0) != all_squares_ ||
        header.parts != parts_.size())
        throw InputError("the film has other layers");
    std::uint64_t sum;
    const auto content = bytes.first(bytes.size() - sizeof(sum));
    std::memcpy(&sum, bytes.data() + content.size(), sizeof(sum));
    if (sum != checksum(content)) throw InputError("the film is damaged: its checksum is wrong");

    std::vector<PartHeader> heads(parts_.size());
    const std::size_t head_bytes = heads.size() * sizeof(PartHeader);
    if (content.size() < sizeof(header) + head_bytes)
        throw InputError("the film is damaged: its length is wrong");
    std::memcpy(heads.data(), content.data() + sizeof(header), head_bytes);

    // Nothing is changed before it is known that all of it is there: but for passes and halves, which say
    // what `all` is, and are exchanged again where it is not.
    std::vector<std::pair<std::uint32_t, std::vector<Halves>>> states;
    for (const PartHeader& head : heads) {
        states.emplace_back(std::uint32_t(head.passes), 0);
        for (std::size_t k = 0; k < std::size_t(std::bit_width(states.back().first)); ++k)
            states.back().second.push_back(
                {std::vector<float>(pixels()), std::vector<float>(pixels(), 0.0f)});
    }
    const auto exchange_states = [&] {
        for (std::size_t i = 0; i < parts_.size(); ++i)
            std::swap(parts_[i].passes, states[i].first), std::swap(parts_[i].halves, states[i].second);
    };
    exchange_states();
    std::vector<Packing> packings;
    auto rest = content.subspan(sizeof(header) + head_bytes);
    bool fits = true;
    for_each_array(*this, [&](const auto& numbers) {
        auto packing = fits ? read_packing(rest, numbers.size(), sizeof(numbers[0])) : std::nullopt;
        fits = packing.has_value();
        if (!fits) return;
        rest = rest.subspan(packing->size);
        packings.push_back(std::move(*packing));
    });
    if (!fits || !rest.empty()) {
        exchange_states();
        throw InputError("the film is damaged: its length is wrong");
    }
    const auto clear_absent = [&](Sums& sums, std::uint32_t passes) {
        if (!has_totals(passes)) std::fill(sums.total.begin(), sums.total.end(), 0.0);
        if (!has_blocks(passes)) std::fill(sums.block.begin(), sums.block.end(), 0.0);
    };
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        clear_absent(sums_[i], parts_[layers_[i].part].passes);
        clear_absent(layer_squares_[i], parts_[layers_[i].part].passes);
    }
    for (std::size_t i = 0; i < parts_.size(); ++i)
        clear_absent(parts_[i].beauty_squares, parts_[i].passes), parts_[i].work = heads[i].work;
    const std::byte* from = content.data() + sizeof(header) + head_bytes;
    auto packing = packings.begin();
    for_each_array(*this, [&](auto& numbers) {
        unpack(from, *packing, std::span(numbers));
        from += packing++->size;
    });
    non_finite_ = header.non_finite;
    for (Replacement& replaced : replaced_) replaced = {};
}

}  // namespace mote::core
