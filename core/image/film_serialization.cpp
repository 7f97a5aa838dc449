// The bits of a film as bytes: header, sums, checksum. Little-endian, as every machine this runs on.
//
// Before the first block is complete all totals are zero, and right after a block the open one is: zeros are
// not written, for a film takes hundreds of megabytes.
#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "core/image/checksum.h"
#include "core/image/film.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

struct Header {
    std::array<char, 8> magic = {'m', 'o', 't', 'e', 'f', 'i', 'l', 'm'};
    std::uint32_t version = 2;
    std::uint32_t width = 0, height = 0, layers = 0, all_squares = 0, passes = 0;
    std::uint64_t non_finite = 0;
};
static_assert(sizeof(Header) == 40, "the header has no padding whose bytes could vary");

bool has_totals(std::uint32_t passes) { return passes >= Film::block_size; }
bool has_blocks(std::uint32_t passes) { return passes % Film::block_size != 0; }

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

std::vector<const Film::Sums*> Film::all_sums() const {
    std::vector<const Sums*> all;
    for (const Sums& sums : sums_) all.push_back(&sums);
    for (const Sums& sums : layer_squares_) all.push_back(&sums);
    all.push_back(&beauty_squares_);
    all.push_back(&block_squares_);
    return all;
}

std::size_t Film::serialized_size(std::uint32_t passes) const {
    const std::size_t copies = (has_totals(passes) ? 1u : 0u) + (has_blocks(passes) ? 1u : 0u);
    std::size_t size = sizeof(Header) + sizeof(std::uint64_t);
    for (const Sums* sums : all_sums()) size += copies * sums->total.size() * sizeof(double);
    return size;
}

std::vector<std::byte> Film::serialize() const {
    Header header;
    header.width = std::uint32_t(width_), header.height = std::uint32_t(height_);
    header.layers = std::uint32_t(layers_.size()), header.all_squares = all_squares_ ? 1 : 0;
    header.passes = passes_, header.non_finite = non_finite_;

    Writer writer(serialized_size(passes_));
    writer.write(&header, sizeof(header));
    for (const Sums* sums : all_sums()) {
        const std::size_t bytes = sums->total.size() * sizeof(double);
        if (has_totals(passes_)) writer.write(sums->total.data(), bytes);
        if (has_blocks(passes_)) writer.write(sums->block.data(), bytes);
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
    if (header.layers != layers_.size() || (header.all_squares != 0) != all_squares_)
        throw InputError("the film has other layers");
    const std::size_t expected = serialized_size(header.passes);
    if (bytes.size() != expected) throw InputError("the film is damaged: its length is wrong");
    std::uint64_t sum;
    std::memcpy(&sum, bytes.data() + expected - sizeof(sum), sizeof(sum));
    if (sum != checksum(bytes.first(expected - sizeof(sum))))
        throw InputError("the film is damaged: its checksum is wrong");

    const std::byte* from = bytes.data() + sizeof(header);
    const auto read = [&from](std::vector<double>& values, bool present) {
        const std::size_t size = present ? values.size() * sizeof(double) : 0;
        if (size > 0) std::memcpy(values.data(), from, size);
        if (!present) std::fill(values.begin(), values.end(), 0.0);
        from += size;
    };
    const auto read_sums = [&](Sums& sums) {
        read(sums.total, has_totals(header.passes)), read(sums.block, has_blocks(header.passes));
    };
    for (Sums& sums : sums_) read_sums(sums);
    for (Sums& sums : layer_squares_) read_sums(sums);
    read_sums(beauty_squares_);
    read_sums(block_squares_);
    passes_ = header.passes, non_finite_ = header.non_finite;
    for (auto& replaced : replaced_means_) replaced.clear();
}

}  // namespace mote::core
