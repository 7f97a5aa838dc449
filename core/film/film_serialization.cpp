// The bits of a film as bytes: header, a head for each part, packed sums (packed_numbers.h), checksum.
// Little-endian, as every machine this runs on. Which blocks of passes there are follows from their numbers.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/files/checksum.h"
#include "core/files/packed_numbers.h"
#include "core/film/film.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

struct Header {
    std::array<char, 8> magic = {'m', 'o', 't', 'e', 'f', 'i', 'l', 'm'};
    std::uint32_t version = 7;
    std::uint32_t width = 0, height = 0, layers = 0, kept = 0, parts = 0;
    std::uint64_t non_finite = 0;
};
static_assert(sizeof(Header) == 40, "the header has no padding whose bytes could vary");
struct PartHeader {
    std::uint32_t first = 0, passes = 0;
    double work = 0.0;
};

/// Could these be sums of so many terms? Each adds less than 2^40 to a digit; of larger ones the sum of two
/// films would leave 64 bits.
bool can_be(const ExactSums& sums, std::uint32_t terms) {
    const std::int64_t most = std::int64_t(terms) << 40;
    bool fits = sums.places_exist();
    ExactSums::for_each_array(sums, [&](const auto& numbers) {
        if constexpr (std::is_same_v<std::decay_t<decltype(numbers[0])>, std::int64_t>)
            for (const std::int64_t digit : numbers) fits = fits && digit >= -most && digit <= most;
    });
    return fits;
}

/// A quarter may have several samples of one pass; all together are far fewer than a sum may have.
bool can_be(const FineSums& fine) {
    return can_be(fine.light(), ExactSums::max_terms) && std::ranges::all_of(fine.counts(), [](float count) {
               return count >= 0.0f && count <= float(ExactSums::max_terms) && count == std::floor(count);
           });
}

}  // namespace

/// Every array that the film has, in the order of the file.
template <typename AnyFilm, typename Body>
void Film::for_each_array(AnyFilm& film, const Body& body) {
    for (auto& sums : film.sums_) ExactSums::for_each_array(sums, body);
    for (auto& sums : film.layer_squares_) ExactSums::for_each_array(sums, body);
    for (auto& sums : film.odd_sums_) ExactSums::for_each_array(sums, body);
    for (auto& sums : film.odd_squares_) ExactSums::for_each_array(sums, body);
    for (auto& part : film.parts_) {
        ExactSums::for_each_array(part.beauty_squares, body);
        ExactSums::for_each_array(part.odd_beauty, body);
        ExactSums::for_each_array(part.odd_squares, body);
        for (auto& sums : part.groups) ExactSums::for_each_array(sums, body);
        PassBlocks::for_each_array(part.blocks, body);
    }
    for (auto& blocks : film.layer_blocks_) PassBlocks::for_each_array(blocks, body);
    for (auto& fine : film.fine_sums_) FineSums::for_each_array(fine, body);
}

std::vector<std::byte> Film::serialize(const MemoryBudget& memory) const {
    Header header;
    header.width = std::uint32_t(width_), header.height = std::uint32_t(height_);
    header.layers = std::uint32_t(layers_.size()), header.kept = kept().bits();
    header.parts = std::uint32_t(parts_.size()), header.non_finite = non_finite_;

    std::vector<PartHeader> heads;
    for (const Part& part : parts_) heads.push_back({part.first, part.passes, part.work});
    const std::size_t head_bytes = heads.size() * sizeof(PartHeader);
    std::vector<Packing> packings;
    std::size_t size = sizeof(header) + head_bytes + sizeof(std::uint64_t);
    for_each_array(*this, [&](const auto& numbers) {
        packings.push_back(packing_of(std::span(numbers)));
        size += packings.back().size;
    });
    memory.require(double(size), "the bytes of a film");
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
    if (header.layers != layers_.size() || header.kept != kept().bits() || header.parts != parts_.size())
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

    for (const PartHeader& head : heads)
        if (head.passes > max_passes || head.first > std::numeric_limits<std::uint32_t>::max() - max_passes)
            throw InputError("the film is damaged: it has too many passes");

    // Into a film of its own: this one is changed when all is known to be right. What it holds besides its
    // sums follows from the numbers of passes, which the length must allow before memory is allocated.
    std::uint64_t least = 0;
    const auto expect = [&](std::uint64_t numbers) {
        least += min_packed_size(numbers);
        if (least > content.size()) throw InputError("the film is damaged: its length is wrong");
    };
    Film read(width_, height_, layers_, all_squares_, split_);
    read.non_finite_ = header.non_finite;
    for (std::size_t i = 0; i < heads.size(); ++i) {
        Part& part = read.parts_[i];
        part.first = heads[i].first, part.passes = heads[i].passes, part.work = heads[i].work;
        part.blocks.allocate(part.range(), expect);
        for (const std::size_t layer : part.layers) read.layer_blocks_[layer].allocate(part.range(), expect);
    }
    std::vector<Packing> packings;
    auto rest = content.subspan(sizeof(header) + head_bytes);
    bool fits = true;
    for_each_array(read, [&](const auto& numbers) {
        auto packing = fits ? read_packing(rest, numbers.size(), sizeof(numbers[0])) : std::nullopt;
        fits = packing.has_value();
        if (!fits) return;
        rest = rest.subspan(packing->size);
        packings.push_back(std::move(*packing));
    });
    if (!fits || !rest.empty()) throw InputError("the film is damaged: its length is wrong");
    const std::byte* from = content.data() + sizeof(header) + head_bytes;
    auto packing = packings.begin();
    for_each_array(read, [&](auto& numbers) {
        unpack(from, *packing, std::span(numbers));
        from += packing++->size;
    });
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        const std::uint32_t passes = read.parts_[layers_[i].part].passes;
        for (const auto* sums : {&read.sums_, &read.layer_squares_, &read.odd_sums_, &read.odd_squares_})
            fits = fits && can_be((*sums)[i], passes);
        for (const ExactSums& sums : read.layer_blocks_[i].half_squares())
            fits = fits && can_be(sums, passes);
    }
    for (const Part& part : read.parts_) {
        for (const ExactSums* sums : {&part.beauty_squares, &part.odd_beauty, &part.odd_squares})
            fits = fits && can_be(*sums, part.passes);
        for (const ExactSums& sums : part.groups) fits = fits && can_be(sums, part.passes);
        for (const ExactSums& sums : part.blocks.half_squares()) fits = fits && can_be(sums, part.passes);
    }
    for (const FineSums& fine : read.fine_sums_) fits = fits && can_be(fine);
    if (!fits) throw InputError("the film is damaged: it holds a number that cannot be");
    *this = std::move(read);
}

}  // namespace mote::core
