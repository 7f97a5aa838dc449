// Walk of a subpath, vertex by vertex: the same from both ends.
#pragma once

#include <span>

#include "core/math/sampler.h"
#include "core/scene/russian_roulette.h"
#include "integrators/bidirectional/beam.h"
#include "integrators/eye_path/transport_layers.h"

namespace mote::integrators {

struct SubpathLimits {
    int max_vertices = -1;       ///< after the first; -1: no limit
    int rr_depth = 5;            ///< Russian roulette after this many of them
    bool passes_lights = false;  ///< the first edge continues behind area lights, and sees no environment
};

template <bool Media>
class SubpathWalk {
  public:
    /// `path` holds its first vertex. `ray` is the first edge, sampled with `density`: per solid angle, or,
    /// if `parallel`, per area across it. `connection`: PathVertex::connection of the second vertex is found
    /// by the caller. Keeps references.
    SubpathWalk(const core::RayQueries& scene, core::TransportMode mode, const SubpathLimits& limits,
                Subpath& path, core::Sampler& sampler, core::WalkContext& context)
        : scene_(scene), mode_(mode), limits_(limits), path_(path), sampler_(sampler), context_(context) {}

    void start(const core::Ray& ray, double density, bool parallel, const core::PathWeights& weights,
               const core::MediumState& state) {
        ray_ = ray, density_ = density, parallel_ = parallel, weights_ = weights, state_ = state;
        first_ = channel_throughput();
    }

    /// Continues to the next vertex. Returns false where the path ends; an eye path that leaves the scene
    /// gets a last vertex, which is `infinite`.
    bool advance();

    /// Emission of media on the last edge, with the weight of the path, whether or not there is a vertex at
    /// its end; and the layer of an eye path that it belongs to.
    const core::Rgb& emitted() const { return emitted_; }
    Transport emission_layer() const { return transport_layer(scatterings_, surface_first_); }

    /// The last edge as beams, also where no vertex was made; kept where this end's beams are merged. More
    /// than one where the first edge passes lights.
    std::span<Beam> beams() { return beams_; }
    std::span<const Beam> beams() const { return beams_; }

  private:
    bool scatter();
    bool survives(std::size_t vertex);
    core::WalkEvent go();
    void append(const core::WalkEvent& event, const core::MediumState& start);
    bool keeps_beams() const;
    void begin_beam();
    core::Rgb channel_throughput() const {
        return Media ? weights_.throughput / core::average(weights_.unidirectional) : weights_.throughput;
    }

    const core::RayQueries& scene_;
    core::TransportMode mode_;
    SubpathLimits limits_;
    Subpath& path_;
    core::Sampler& sampler_;
    core::WalkContext& context_;
    core::Ray ray_;
    core::PathWeights weights_;
    core::MediumState state_;
    core::Rgb emitted_{0.0f}, first_{0.0f};
    std::vector<Beam> beams_;
    double density_ = 0.0;
    float eta_ = 1.0f;
    bool parallel_ = false;
    int scatterings_ = 0;  ///< before the last edge, without those at leading mirrors and glass
    bool surface_first_ = true;
};

extern template class SubpathWalk<true>;
extern template class SubpathWalk<false>;

}  // namespace mote::integrators
