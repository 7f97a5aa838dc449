// Passes of `mote_upbp`: the sum over all connections of a pixel's light path with its eye path, and over all
// merges of its eye path with the light paths of every pixel, each by its MIS weight (Křivánek et al. 2014).
#pragma once

#include "integrators/bidirectional/splats.h"
#include "integrators/eye_path/counters.h"
#include "integrators/upbp/efforts.h"
#include "integrators/upbp/light_beams.h"
#include "integrators/upbp/light_vertices.h"
#include "integrators/upbp/merges.h"
#include "integrators/upbp/upbp_settings.h"

namespace mote::integrators {

/// Pixels that have an eye path and a light path: every n-th of every n-th row. Light paths that reach the
/// film count as if each pixel had one, so that n x n pixels have as much of such light as one of them should
/// have.
struct PixelLattice {
    int width = 0, height = 0;  ///< of the image
    int n = 1;

    int columns() const { return (width + n - 1) / n; }
    int rows() const { return (height + n - 1) / n; }
    std::uint32_t pixels() const { return std::uint32_t(width) * std::uint32_t(height); }  ///< of the image
    std::size_t size() const { return std::size_t(columns()) * std::size_t(rows()); }
    bool has(int x, int y) const { return x % n == 0 && y % n == 0; }
    std::size_t index_of(int x, int y) const {
        return std::size_t(y / n) * std::size_t(columns()) + std::size_t(x / n);
    }
};

/// The light subpaths of a pass, and where they are found.
struct UpbpLights {
    std::vector<Subpath> paths;  ///< of the lattice's pixels
    std::vector<std::vector<LightBeam>> beams_of_row;
    std::vector<std::vector<Splat>> splats;  ///< by rows
    LightVertices vertices;
    LightBeams beams;
};

template <bool Media>
class UpbpPasses {
  public:
    /// The scene must outlive it.
    UpbpPasses(const core::Scene& scene, const core::RenderOptions& options, const UpbpSettings& settings,
               const PixelLattice& lattice);

    /// The settings of a pass in which techniques have these efforts.
    BidirectionalSettings settings_of(std::uint32_t pass, const PerTechnique& efforts) const;
    /// Traces the light paths. False where the pass was cancelled. Throws OutOfMemory.
    bool trace_light_paths(const core::PassContext& context, const BidirectionalSettings& settings,
                           UpbpLights& lights);

    /// Traces the eye paths of pixels, which for_each_pixel(visit(x, y)) names, on the thread that calls:
    /// found(x, y, Contribution). Returns the work of merges and connections.
    template <typename ForEachPixel, typename Found>
    TechniqueWork trace_eye_paths(const core::PassContext& context, const BidirectionalSettings& settings,
                                  const UpbpLights& lights, core::WalkContext& walk,
                                  const ForEachPixel& for_each_pixel, const Found& found) const {
        Strategies<Media> strategies(scene_, ends_, settings, lattice_.pixels(), context.filter.radius(),
                                     walk);
        Merges<Media> merges(scene_, ends_, strategies, lights.vertices, lights.beams, settings, walk);
        for_each_pixel([&](int x, int y) {
            if (context.cancelled) return;
            strategies.take_light_path(lights.paths[lattice_.index_of(x, y)]);
            const EyeRay eye = make_eye_ray(scene_, options_, context, x, y);
            walk.rng = eye.rng;
            const auto here = [&](const Contribution& c) { found(x, y, c); };
            strategies.trace_eye_path(eye, here, [&](const SubpathWalk<Media>& edge, bool continues) {
                merges.after_step(edge, continues, here);
            });
        });
        TechniqueWork work = merges.work();
        work.add(strategies.connection_counts());
        return work;
    }
    SharedCounters& counters() { return counters_; }              ///< of light paths
    const SharedCounters& counters() const { return counters_; }  ///< see above

  private:
    bool has_beams(std::size_t path) const;
    void require_memory(const UpbpLights& lights) const;
    void trace_row(const core::PassContext& context, const BidirectionalSettings& settings, int row,
                   UpbpLights& lights);

    const core::Scene& scene_;
    core::RenderOptions options_;
    UpbpSettings settings_;
    PixelLattice lattice_;
    LightEnds ends_;
    SharedCounters counters_;
};

}  // namespace mote::integrators
