// The conductors that have names.
#pragma once

#include <span>

namespace mote::core {

struct NamedConductor {
    const char* name;
    bool palik;          ///< known by the name with "_palik" at its end as well
    float eta[3], k[3];  ///< linear RGB
};

std::span<const NamedConductor> conductor_table();

}  // namespace mote::core
