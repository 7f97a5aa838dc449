// The bits of a film as bytes: header, a head for each part, sums, checksum. Little-endian, as every machine
// this runs on.
//
// Before the first block of a part is complete all totals are zero, and right after a block the open one is:
// zeros are not written, for a film takes hundreds of megabytes.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "core/image/checksum.h"
#include "core/image/film.h"
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

// Fills a buffer of known size from front to back.
class Writer {
  public:
    explicit Writer(std::size_t size) : bytes_(size) {}
    void write(const void* data, std::size_t size) {
        if (size == 0) return;  // data may be null then, which memcpy() forbids
        std::memcpy(bytes_.data() + position_, data, size);
        position_ += size;
    }
    std::span<const std::byte> written() const { return std::span(bytes_).first(position_); }
    std::vector<std::byte> take() { return std::move(bytes_); }

  private:
    std::vector<std::byte> bytes_;
    std::size_t position_ = 0;
};

}  // namespace

template <typename Self, typename Body>
void Film::for_each_sums(Self& film, const Body& body) {
    for (std::size_t i = 0; i < film.layers_.size(); ++i) body(film.sums_[i], film.layers_[i].part);
    for (std::size_t i = 0; i < film.layers_.size(); ++i) body(film.layer_squares_[i], film.layers_[i].part);
    for (std::size_t i = 0; i < film.parts_.size(); ++i) body(film.parts_[i].beauty_squares, i);
}

std::size_t Film::serialized_size(std::span<const std::uint32_t> passes) const {
    std::size_t size = sizeof(Header) + parts_.size() * sizeof(PartHeader) + sizeof(std::uint64_t);
    for_each_sums(*this, [&](const Sums& sums, std::size_t part) {
        const std::size_t copies =
            (has_totals(passes[part]) ? 1u : 0u) + (has_blocks(passes[part]) ? 1u : 0u);
        size += copies * sums.total.size() * sizeof(double);
    });
    for (const std::uint32_t n : passes)
        for (std::size_t k = 0; k < std::size_t(std::bit_width(n)); ++k)
            size += ((is_open(n, k) ? 1u : 0u) + (is_closed(n, k) ? 1u : 0u)) * pixels() * sizeof(float);
    return size;
}

std::vector<std::byte> Film::serialize() const {
    Header header;
    header.width = std::uint32_t(width_), header.height = std::uint32_t(height_);
    header.layers = std::uint32_t(layers_.size()), header.all_squares = all_squares_ ? 1 : 0;
    header.parts = std::uint32_t(parts_.size()), header.non_finite = non_finite_;

    std::vector<std::uint32_t> passes;
    for (const Part& part : parts_) passes.push_back(part.passes);
    Writer writer(serialized_size(passes));
    writer.write(&header, sizeof(header));
    for (const Part& part : parts_) {
        const PartHeader head{part.passes, part.work};
        writer.write(&head, sizeof(head));
    }
    for_each_sums(*this, [&](const Sums& sums, std::size_t part) {
        const std::size_t bytes = sums.total.size() * sizeof(double);
        if (has_totals(passes[part])) writer.write(sums.total.data(), bytes);
        if (has_blocks(passes[part])) writer.write(sums.block.data(), bytes);
    });
    for (const Part& part : parts_)
        for (std::size_t k = 0; k < part.halves.size(); ++k) {
            if (is_open(part.passes, k)) writer.write(part.halves[k].open.data(), pixels() * sizeof(float));
            if (is_closed(part.passes, k))
                writer.write(part.halves[k].squares.data(), pixels() * sizeof(float));
        }
    const std::uint64_t sum = checksum(writer.written());
    writer.write(&sum, sizeof(sum));
    return writer.take();
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
    const std::size_t heads = parts_.size() * sizeof(PartHeader);
    if (bytes.size() < sizeof(Header) + heads + sizeof(std::uint64_t))
        throw InputError("the film is damaged: its length is wrong");
    std::vector<PartHeader> part_headers(parts_.size());
    std::memcpy(part_headers.data(), bytes.data() + sizeof(header), heads);
    std::vector<std::uint32_t> passes;
    for (const PartHeader& head : part_headers) passes.push_back(std::uint32_t(head.passes));
    const std::size_t expected = serialized_size(passes);
    if (bytes.size() != expected) throw InputError("the film is damaged: its length is wrong");
    std::uint64_t sum;
    std::memcpy(&sum, bytes.data() + expected - sizeof(sum), sizeof(sum));
    if (sum != checksum(bytes.first(expected - sizeof(sum))))
        throw InputError("the film is damaged: its checksum is wrong");

    const std::byte* from = bytes.data() + sizeof(header) + heads;
    const auto read = [&from](std::vector<double>& values, bool present) {
        const std::size_t size = present ? values.size() * sizeof(double) : 0;
        if (size > 0) std::memcpy(values.data(), from, size);
        if (!present) std::fill(values.begin(), values.end(), 0.0);
        from += size;
    };
    for_each_sums(*this, [&](Sums& sums, std::size_t part) {
        read(sums.total, has_totals(passes[part])), read(sums.block, has_blocks(passes[part]));
    });
    const auto read_floats = [&from](std::vector<float>& values) {
        std::memcpy(values.data(), from, values.size() * sizeof(float));
        from += values.size() * sizeof(float);
    };
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        Part& part = parts_[i];
        part.passes = passes[i], part.work = part_headers[i].work;
        part.halves.assign(std::size_t(std::bit_width(part.passes)), {});
        for (std::size_t k = 0; k < part.halves.size(); ++k) {
            part.halves[k] = {std::vector<float>(pixels()), std::vector<float>(pixels(), 0.0f)};
            if (is_open(part.passes, k)) read_floats(part.halves[k].open);
            if (is_closed(part.passes, k)) read_floats(part.halves[k].squares);
        }
    }
    non_finite_ = header.non_finite;
    for (auto& replaced : replaced_means_) replaced.clear();
}

}  // namespace mote::core
