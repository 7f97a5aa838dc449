// Settings of `mote_upbp`.
#pragma once

#include "core/render/integrator.h"
#include "integrators/bidirectional/strategies.h"

namespace mote::integrators {

/// Probabilities with which techniques are tried (efforts.h).
enum class Efforts : std::uint8_t {
    automatic,  ///< by a trial
    equal       ///< all are 1
};

struct UpbpSettings {
    EyePathLimits limits;
    Heuristic heuristic = Heuristic::balance;
    bool connections = true, surface = true, point_point = true, point_beam = true, beam_beam = true;
    BeamLength light_beams = BeamLength::short_beam, query_beams = BeamLength::long_beam;
    double radius = 0.01;      ///< of the first pass, over the radius of the scene's bounds
    double alpha = 2.0 / 3.0;  ///< how fast kernels shrink
    bool all_connections = false;
    Efforts efforts = Efforts::automatic;

    /// Only weights of the balance heuristic are ratios of densities, and efforts are factors of these.
    bool efforts_by_trial() const {
        const bool merges = radius > 0.0 && (surface || point_point || point_beam || beam_beam);
        return efforts == Efforts::automatic && merges && heuristic == Heuristic::balance;
    }
};

/// Long where short beams are not possible in the scene (beam.h).
BeamLength possible_length(const core::Scene& scene, BeamLength wanted);

/// Passes of `mote_upbp`: a light subpath and an eye subpath for each pixel.
std::unique_ptr<core::Estimator> make_upbp_estimator(const core::Scene& scene,
                                                     const core::RenderOptions& options,
                                                     const UpbpSettings& settings);

}  // namespace mote::integrators
