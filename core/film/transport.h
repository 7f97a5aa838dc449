// The cells of the transport: light sorted by where its path first scatters as seen from the eye, and how
// often.
//
//   emission               seen directly, through delta surfaces too, and emission of media in view
//   direct                 one scattering, on a surface
//   single_scattering      one scattering, in a medium
//   indirect               more scatterings, the first on a surface
//   multiple_scattering    more scatterings, the first in a medium
// Scatterings are counted from the first vertex that is not a delta reflection or refraction. Engelhardt 2013
// has the last two in Eq. 10.6, direct light and single scattering in Eq. 10.7, and their sum in Eq. 10.8.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/objects/error.h"

namespace mote::core {

enum class Transport : std::uint8_t { emission, direct, indirect, single_scattering, multiple_scattering };
inline constexpr std::size_t transport_count = 5;

/// Number of cells in a scene with or without media: those of media come last.
constexpr std::size_t transport_layer_count(bool media) { return media ? transport_count : 3; }

/// Cell of light that scattered `scatterings` times, first on a surface or in a medium as seen from the eye.
constexpr Transport transport_layer(int scatterings, bool surface_first) {
    if (scatterings == 0) return Transport::emission;
    if (scatterings == 1) return surface_first ? Transport::direct : Transport::single_scattering;
    return surface_first ? Transport::indirect : Transport::multiple_scattering;
}

/// Set of cells. Single scattering has two elements, since methods can fill them apart: light of lights with
/// a position, and of all others.
class TransportSet {
  public:
    constexpr TransportSet() = default;  ///< empty
    constexpr TransportSet(Transport cell) : bits_(std::uint8_t(1u << unsigned(cell))) {
        if (cell == Transport::single_scattering) bits_ |= other_bit;
    }
    /// All cells of a scene with or without media.
    static constexpr TransportSet all(bool media = true) { return bits(media ? 0b111111 : 0b000111); }
    static constexpr TransportSet positional_scattering() {
        return bits(1u << unsigned(Transport::single_scattering));
    }
    static constexpr TransportSet other_scattering() { return bits(other_bit); }

    constexpr bool empty() const { return bits_ == 0; }
    constexpr bool contains(TransportSet other) const { return (other.bits_ & ~bits_) == 0; }
    constexpr bool operator[](Transport cell) const { return contains(cell); }
    constexpr bool operator==(const TransportSet&) const = default;
    constexpr TransportSet operator|(TransportSet other) const { return bits(bits_ | other.bits_); }
    constexpr TransportSet operator&(TransportSet other) const { return bits(bits_ & other.bits_); }
    constexpr TransportSet operator-(TransportSet other) const { return bits(bits_ & ~other.bits_); }

  private:
    static constexpr unsigned other_bit = 1u << transport_count;
    static constexpr TransportSet bits(unsigned value) {
        TransportSet set;
        set.bits_ = std::uint8_t(value);
        return set;
    }
    std::uint8_t bits_ = 0;
};

constexpr TransportSet operator|(Transport a, Transport b) { return TransportSet(a) | TransportSet(b); }

/// Names as in scene files and layers, in the order of Transport: "direct"; an element of single scattering
/// without the other is "single_scattering_positional" or "single_scattering_other".
std::vector<std::string> transport_names(TransportSet cells);
std::string transport_name(TransportSet cells);  ///< the same in one text: "direct, indirect"
/// Inverse of transport_name(); names are separated by commas or spaces. Throws InputError for other names.
TransportSet read_transport(const std::string& names, const SourceLocation& where = {});

}  // namespace mote::core
