// Paths on surfaces, all those of an image tile at once: each step advances every path that is alive by one
// segment (a wavefront).
//
// The estimator is that of trace_paths.h and uses the same random numbers. State lies in structures of
// arrays, and paths that ended are removed from them after each step, so that loops over paths become full
// vector instructions and packets of rays stay full. Where a surface is Lambertian, shading is such a loop;
// vertices of other materials, and lights that are no parallelogram, are evaluated one by one through their
// interfaces.
#pragma once

#include <memory>

#include "integrators/eye_path/eye_path.h"
#include "integrators/path_tracing/lambertian_shapes.h"
#include "integrators/path_tracing/trace_paths.h"
#include "lights/emitters/parallelogram_light.h"

namespace mote::integrators {

/// Scene, limits and tables that the wavefronts of a render have in common.
struct WavefrontScene {
    WavefrontScene(const core::Scene& s, const EyePathLimits& l);
    /// False where paths need what a wavefront does not have: panes, lights that eye rays pass, a bound.
    static bool suits(const core::Scene& scene, const PathSettings& settings);

    const core::Scene& scene;
    EyePathLimits limits;
    LambertianShapes lambertian;
    std::optional<lights::LitParallelogram> light;  ///< the only light, where it is one
};

class Wavefront {
  public:
    static constexpr int capacity = core::RayBatch::capacity;  ///< paths

    /// All must outlive it.
    Wavefront(const WavefrontScene& shared, core::WalkContext& context,
              const lights::ScatteringGuide& guide = lights::no_guide());
    /// Removes all paths.
    void clear() { rays_.count = 0; }
    /// Adds a path.
    void start(const EyeRay& eye);
    /// Follows all paths to their ends.
    void run();
    /// Radiance along an eye ray, by layer. Paths are numbered as they were started.
    const TransportSum& sum(int path) const { return sums_[std::size_t(path)]; }

  private:
    using Vectors = core::VecLanes<capacity>;
    struct alignas(64) Numbers {
        float value[capacity] = {};
        float& operator[](int i) { return value[i]; }
        float operator[](int i) const { return value[i]; }
    };

    // wavefront_guiding.cpp:
    void find_guides();
    void weight_guides_to_lights();
    void sample_guides();

    void arrive();
    core::Rgb found_light(int i) const;
    void make_vertex(int i);
    bool next_light_sample(int k);
    void connect();
    void sample_light_of(int i);
    void sample_parallelogram();
    void weight_lambertian();
    void connect_other(int i);
    void trace_shadow_rays();
    void sample_lambertian();
    void leave();
    bool sample_other(int i);
    bool survives(int i);
    bool wants_more(int i) const;
    void move(int from, int to);
    core::LightReceiver receiver(int i) const;
    const lights::VmfMixture& lobes(int i) const;
    float samples_of_lights(int i) const { return float(std::max(1, light_samples_[i])); }
    core::Vec3 wo(int i) const { return -rays_.direction.get(i); }
    Transport layer_of_connection(int i) const { return transport_layer(scatterings_[i] + 1, true); }

    const WavefrontScene& shared_;
    const core::Scene& scene_;
    const EyePathLimits& limits_;
    core::WalkContext& context_;
    const lights::ScatteringGuide& guide_;
    bool guided_;    ///< false: `guide_` guides nothing
    int depth_ = 0;  ///< edges of all paths so far

    // By path number:
    std::vector<core::Sampler> samplers_;
    std::vector<core::Rng> rngs_;
    std::vector<TransportSum> sums_;

    // By lane, of the paths that are alive:
    int path_[capacity];
    core::RayBatch rays_;
    Vectors throughput_;
    Numbers light_ratio_;  ///< samples of lights at `previous_` / density of the direction; 0: none finds it
    Numbers eta_;          ///< product of relative indices of refraction
    int scatterings_[capacity];
    core::LightReceiver previous_[capacity];

    // By lane, at the ends of the rays:
    enum class Kind : std::uint8_t { ended, lambertian, other };
    core::HitBatch hits_;
    Kind kind_[capacity];
    Vectors reflectance_;                         ///< of Lambertian surfaces
    core::ScatteringVertex vertex_;               ///< the one that the guide is queried for
    std::vector<core::ScatteringVertex> others_;  ///< on other materials; empty before the first of them
    bool any_other_ = false;
    Numbers u_lobe_, u_light_, u_light_x_, u_light_y_, u_scatter_x_, u_scatter_y_;
    int light_samples_[capacity];         ///< of next-event estimation; 0: it is not wanted
    LightNumbers first_light_[capacity];  ///< of the first of them
    bool connects_[capacity];             ///< one is taken now

    // By lane, of guided paths; without, as they are here:
    std::vector<lights::VmfMixture> lobes_;  ///< directions of the guide at the vertices
    Numbers guide_ratio_;                    ///< density of the path's directions over that without a guide
    Numbers own_probability_;                ///< of a direction by the BSDF; the rest are the guide's
    Numbers guide_to_light_;  ///< density of the guide's choice of the sampled light's direction
    Numbers next_weight_;     ///< density of the next direction by the BSDF over that of both

    // By lane, of connections:
    Vectors to_light_, radiance_;
    Numbers distance_, pdf_light_,
        finds_light_;                    ///< finds_light_: 1 where directions can hit the light, else 0
    Vectors shadow_origin_, connected_;  ///< connected_: light that arrives if nothing is in the way
    Numbers shadow_end_;

    // By lane, of the next segments:
    Vectors next_origin_, next_direction_;
    Numbers next_pdf_;
};

}  // namespace mote::integrators
