// Settings of bias compensation: every simplification is a switch of its own, so that each can be measured
// alone (Engelhardt 2013, Sec. 10.2).
#pragma once

#include <cstdint>
#include <string>

namespace mote::compensation {

/// Vertices that a receiver makes, and the VPLs that they are joined to (Sec. 10.2.3).
enum class Strategy : std::uint8_t {
    one_to_n,   ///< one vertex, joined to all N VPLs (Raab et al. 2008)
    n_to_one,   ///< N vertices, each joined to one VPL
    one_to_one  ///< as n_to_one, and every VPL has a receiver of its own along the eye ray
};

/// Where the vertex lies along its ray.
enum class Placement : std::uint8_t {
    free_path,  ///< by free path sampling: it may fall outside of the bounding region, and is lost then
    in_region   ///< always inside, as if the medium were homogeneous there (Sec. 10.2.2)
};

/// Transmittance between the receiver and the vertex.
enum class LocalTransmittance : std::uint8_t {
    exact,
    mean  ///< from the mean extinction of the bounding region
};

struct CompensationSettings {
    bool surfaces = true, media = true;                            ///< of receivers on surfaces; in media
    Strategy strategy = Strategy::one_to_n;                        ///< how VPLs meet vertices
    Placement placement = Placement::free_path;                    ///< of vertices in media
    LocalTransmittance transmittance = LocalTransmittance::exact;  ///< between a receiver and its vertex
    /// Rays from receivers in media find surfaces and boundaries between media. Rays from receivers on
    /// surfaces always do: else they would find nothing that reflects light.
    bool local_visibility = true;
    int depth = -1;  ///< steps of the recursion; -1: no limit

    /// If true, the mean of the estimate is the whole light.
    bool exact() const {
        return surfaces && media && depth < 0 && local_visibility &&
               transmittance == LocalTransmittance::exact;
    }
    /// As in scene files.
    std::string strategy_name() const;
};

}  // namespace mote::compensation
