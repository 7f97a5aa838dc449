// Injuries as files suffer them from transport, from bad programs, and from attempts to break a
// reader.
#include "tools/fuzz/mutate.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "core/math/random.h"

namespace mote::fuzz {

namespace {

class Injurer {
  public:
    Injurer(const std::vector<Bytes>& originals, const Format& format, std::uint64_t key)
        : originals_(originals), format_(format), rng_(key) {}

    Bytes run() {
        bytes_ = originals_[below(originals_.size())];
        // Half have one: what is hurt in many places is refused for the first of them.
        static constexpr std::array<std::size_t, 6> counts = {1, 1, 1, 2, 4, 8};
        const std::size_t injuries = counts[below(counts.size())];
        for (std::size_t i = 0; i < injuries; ++i) injure();
        // Half keep the checksums of the original, and are refused for them.
        if (format_.forge && below(2) == 0) format_.forge(bytes_);
        return std::move(bytes_);
    }

  private:
    // Every number is sampled in a statement of its own where the order matters: compilers evaluate operands
    // and arguments in different orders, and a case must be the same with all of them.
    std::size_t below(std::size_t n) { return n < 2 ? 0 : std::size_t(rng_.next_u32()) % n; }
    /// Where the injury is: anywhere, or within the head.
    std::size_t place() {
        const std::size_t end = format_.head > 0 ? std::min(format_.head, bytes_.size()) : bytes_.size();
        // Files are most easily hurt where they say how they are made.
        return below(3) == 0 ? below(std::min<std::size_t>(end, 256)) : below(end);
    }

    void injure() {
        if (bytes_.empty()) return insert(rng_.next_u32());
        if (format_.text && below(2) == 0) return injure_text();
        switch (below(9)) {
            case 0:
                bytes_[place()] ^= std::uint8_t(1u << below(8));
                break;
            case 1:
                bytes_[place()] = std::uint8_t(rng_.next_u32());
                break;
            case 2:
                put_number();
                break;
            case 3:
                put_float();
                break;
            case 4:
                if (format_.head == 0) bytes_.resize(below(bytes_.size()));
                break;
            case 5:
                remove(place());
                break;
            case 6:
                repeat(place());
                break;
            case 7:
                splice();
                break;
            default:
                insert(rng_.next_u32());
        }
    }
    void put(const void* value, std::size_t size) {
        const std::size_t at = place();
        std::memcpy(bytes_.data() + at, value, std::min(size, bytes_.size() - at));
    }
    void put_number() {
        static constexpr std::array<std::uint64_t, 12> extremes = {0,
                                                                   1,
                                                                   0x7f,
                                                                   0xff,
                                                                   0x7fff,
                                                                   0xffff,
                                                                   0x7fffffff,
                                                                   0xffffffff,
                                                                   0x80000000,
                                                                   0x10000,
                                                                   0x7fffffffffffffff,
                                                                   ~0ull};
        std::uint64_t value = extremes[below(extremes.size())];
        value += below(3);
        value -= 1;
        const std::size_t size = std::size_t(1) << below(4);
        std::array<std::uint8_t, 8> raw;
        std::memcpy(raw.data(), &value, 8);
        if (below(2) == 0) std::reverse(raw.begin(), raw.begin() + std::ptrdiff_t(size));
        put(raw.data(), size);
    }
    void put_float() {
        static constexpr std::array<float, 8> extremes = {
            0.0f, -0.0f, 1e30f, -1e30f, 1e-40f, 1e37f, __builtin_inff(), __builtin_nanf("")};
        const float value = extremes[below(extremes.size())];
        put(&value, sizeof(value));
    }
    void remove(std::size_t at) {
        const std::size_t count = 1 + below(64);
        const auto begin = bytes_.begin() + std::ptrdiff_t(at);
        bytes_.erase(begin, begin + std::ptrdiff_t(std::min(count, bytes_.size() - at)));
    }
    void repeat(std::size_t at) {
        const std::size_t count = 1 + below(64);
        const auto begin = bytes_.begin() + std::ptrdiff_t(at);
        const Bytes piece(begin, begin + std::ptrdiff_t(std::min(count, bytes_.size() - at)));
        for (std::size_t i = 0, n = 1 + below(4); i < n; ++i) insert_at(at, piece);
    }
    void splice() {
        const Bytes& other = originals_[below(originals_.size())];
        if (other.empty()) return;
        const std::size_t from = below(other.size());
        const auto begin = other.begin() + std::ptrdiff_t(from);
        const std::size_t at = place(), count = std::min(1 + below(128), other.size() - from);
        insert_at(at, Bytes(begin, begin + std::ptrdiff_t(count)));
    }
    void insert_at(std::size_t at, const Bytes& piece) {
        bytes_.insert(bytes_.begin() + std::ptrdiff_t(at), piece.begin(), piece.end());
    }
    void insert(std::uint32_t value) {
        const std::size_t at = bytes_.empty() ? 0 : place(), count = 1 + below(8);
        insert_at(at, Bytes(count, std::uint8_t(value)));
    }

    static bool is_word(std::uint8_t c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' ||
               c == '-' || c == '_';
    }
    /// A word becomes a number of the kind that is never written, or another word of the file.
    void injure_text() {
        const auto [begin, end] = word_at(place());
        static constexpr std::array<std::string_view, 20> words = {"0",
                                                                   "-1",
                                                                   "1e37",
                                                                   "1e-45",
                                                                   "nan",
                                                                   "inf",
                                                                   "-0",
                                                                   "4294967296",
                                                                   "99999999999999999999",
                                                                   "",
                                                                   "1e999",
                                                                   "2147483648",
                                                                   "-2147483649",
                                                                   "0x10",
                                                                   "\xff",
                                                                   "\"",
                                                                   "<",
                                                                   "}",
                                                                   "$size",
                                                                   "../.."};
        Bytes word;
        if (below(3) == 0) {
            const auto [b, e] = word_at(place());
            word.assign(bytes_.begin() + std::ptrdiff_t(b), bytes_.begin() + std::ptrdiff_t(e));
        } else {
            const std::string_view text = words[below(words.size())];
            word.assign(text.begin(), text.end());
        }
        bytes_.erase(bytes_.begin() + std::ptrdiff_t(begin), bytes_.begin() + std::ptrdiff_t(end));
        insert_at(begin, word);
    }
    std::pair<std::size_t, std::size_t> word_at(std::size_t at) const {
        std::size_t begin = at, end = at;
        while (begin > 0 && is_word(bytes_[begin - 1])) --begin;
        while (end < bytes_.size() && is_word(bytes_[end])) ++end;
        return {begin, end};
    }

    const std::vector<Bytes>& originals_;
    const Format& format_;
    core::Rng rng_;
    Bytes bytes_;
};

}  // namespace

Bytes mutate(const std::vector<Bytes>& originals, const Format& format, std::uint64_t key) {
    return Injurer(originals, format, key).run();
}

}  // namespace mote::fuzz
