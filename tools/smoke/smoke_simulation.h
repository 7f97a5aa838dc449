// Hot smoke rising from a small source: incompressible flow with buoyancy on a grid of cells.
//
// The classical method of computer graphics (Fedkiw, Stam and Jensen 2001): forces, then projection onto the
// divergence-free fields, then advection backwards along the flow, here with MacCormack's correction (Selle
// et al. 2008), which keeps the swirls that plain interpolation blurs. Velocity, temperature and density all
// live at cell centres. A given seed gives the same bits on any number of threads.
#pragma once

#include <cstdint>

#include "tools/smoke/dense_grid.h"
#include "tools/smoke/noise.h"
#include "tools/smoke/pressure_solver.h"

namespace mote::tools {

struct SmokeSettings {
    GridSize size{160, 112, 192};         ///< cells
    float cell = 0.026f;                  ///< edge of a cell [m]
    BoxSides sides{false, false};         ///< walls all around
    float time_step = 1.0f / 24.0f;       ///< [s]
    core::Vec3 source{0.5f, 0.3f, 0.5f};  ///< centre, as a fraction of the box
    float source_radius = 0.12f;          ///< [m]
    float source_temperature = 1.0f;      ///< relative: 1 is what `buoyancy` speaks of
    float jitter = 14.0f;                 ///< random acceleration at the source [m/s^2]
    float buoyancy = 5.0f;                ///< upward acceleration at temperature 1 [m/s^2]
    float cooling = 0.35f;                ///< share of the temperature lost per second
    float confinement = 0.35f;            ///< strength of vorticity confinement
    float haze = 0.0f;                    ///< mean density of the air at the start; the source emits 1
    std::uint64_t seed = 1;
};

class SmokeSimulation {
  public:
    explicit SmokeSimulation(const SmokeSettings& settings);

    /// Advances by one time step.
    void step();

    const std::vector<float>& density() const { return density_; }
    const SmokeSettings& settings() const { return settings_; }
    /// Root mean square of the divergence left in the flow [1/s].
    double divergence_norm();
    /// Largest speed anywhere [m/s].
    float max_speed() const;

  private:
    /// Velocity [m/s] in xyz and temperature in w: one lookup fetches what moves together.
    using Flow = glm::vec4;

    void fill_with_haze();
    void emit();
    void add_forces();
    void find_vorticity();
    void project();
    void find_divergence();
    void advect();
    void correct(int i, int j, int k, float kept_heat);
    core::Vec3 displacement(int i, int j, int k) const;
    core::Vec3 pressure_gradient(int i, int j, int k) const;

    SmokeSettings settings_;
    GridSize size_;
    Noise noise_;
    PressureSolver solver_;
    float time_ = 0.0f;
    std::vector<Flow> flow_, predicted_flow_, next_flow_;
    std::vector<float> density_, predicted_density_, next_density_;
    std::vector<Flow> vorticity_;           ///< curl in xyz, its length in w
    std::vector<core::Vec3> displacement_;  ///< of the last step [cells]
    std::vector<float> divergence_, pressure_;
};

}  // namespace mote::tools
