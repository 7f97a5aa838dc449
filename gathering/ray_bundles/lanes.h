// Numbers side by side, for short loops that compilers unroll before they look for such.
#pragma once

#include <cstdint>
#include <cstring>

namespace mote::gathering {

using Float8 = float __attribute__((vector_size(32)));
using Int8 = std::int32_t __attribute__((vector_size(32)));
using Double4 = double __attribute__((vector_size(32)));
using Long4 = std::int64_t __attribute__((vector_size(32)));

// By reference: how vectors are passed by value depends on the processor that is compiled for.
template <typename Lanes>
void load(const void* from, Lanes& lanes) {
    std::memcpy(&lanes, from, sizeof(Lanes));
}
template <typename Lanes>
void store(const Lanes& lanes, void* to) {
    std::memcpy(to, &lanes, sizeof(Lanes));
}

}  // namespace mote::gathering
