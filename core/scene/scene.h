// A complete scene: shapes, lights, media, the ray tracer, and the queries of algorithms.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/geometry/ray_tracer.h"
#include "core/geometry/shape.h"
#include "core/materials/bsdf.h"
#include "core/math/distribution.h"
#include "core/scene/camera.h"
#include "core/scene/lit_scene.h"

namespace mote::core {

class Integrator;
class LightTree;
class ProbeRays;
struct Element;

/// Settings of the film of a scene file.
struct FilmSettings {
    int width = 768, height = 576;    ///< [pixels]
    bool half = false;                ///< write float16
    bool interval = false;            ///< keep halves of the passes, for Film::error()
    std::string filter = "gaussian";  ///< box, tent, gaussian
    float filter_radius = 2.0f;       ///< pixels
    float filter_stddev = 0.5f;       ///< gaussian only
    std::string sampler = "sobol";    ///< independent, sobol
    int sample_count = 16;            ///< passes when the command line does not say
};

/// RayQueries and lights by Embree; does not change once it is built.
class Scene final : public LitScene {
  public:
    /// Builds the ray tracer and the light tables. Throws InputError when there is nothing to see or no
    /// light.
    struct Parts {
        std::vector<std::shared_ptr<Shape>> shapes;         ///< in the order of the file
        std::vector<std::shared_ptr<Emitter>> emitters;     ///< all lights, those of shapes included
        std::vector<std::shared_ptr<Medium>> media;         ///< those of shapes and camera need not be listed
        std::shared_ptr<Camera> camera;                     ///< not null
        std::shared_ptr<Integrator> integrator;             ///< the one the file names, or null
        std::shared_ptr<const Element> integrator_element;  ///< its text, or null
        /// The texts of further integrators, each of another type: what the scene sets for these methods.
        std::vector<std::shared_ptr<const Element>> further_integrators;
        FilmSettings film;
        std::string file;                      ///< path of the scene file, or "" when built in code
        std::vector<std::string> input_files;  ///< every file read, for the content hash
        std::vector<std::string> warnings;
    };
    /// Throws InputError for parts that are missing.
    explicit Scene(Parts parts);
    ~Scene() override;

    /// In the order of the file.
    std::span<const std::shared_ptr<Shape>> shapes() const { return parts_.shapes; }
    std::span<const std::shared_ptr<Emitter>> emitters() const override { return parts_.emitters; }
    std::span<const std::shared_ptr<Medium>> media() const override { return parts_.media; }
    const Camera& camera() const { return *parts_.camera; }  ///< of the scene
    /// The one that the file names, or null.
    const Integrator* integrator() const { return parts_.integrator.get(); }
    const FilmSettings& film() const { return parts_.film; }  ///< settings of the file
    FilmSettings& film() { return parts_.film; }              ///< may be changed before a render
    const Parts& parts() const { return parts_; }             ///< what it was made of
    const RayTracer& rays() const { return *rays_; }          ///< its shapes in Embree

    std::optional<SurfaceHit> first_hit(const Ray& ray) const override;
    /// first_hit() of many rays; `coherent`: neighbours go the same way.
    void first_hits(std::span<const HitQuery> rays, bool coherent) const { rays_->closest(rays, coherent); }
    bool visible(const Ray& segment) const override;
    void find_occluded(std::span<ShadowPacket> packets) const override;
    bool attenuates() const override { return has_media() || has_panes(); }
    bool has_boundaries() const override;
    bool has_panes() const override;
    bool has_coloured_panes() const override;
    const Bounds3& open_space() const override { return open_space_; }
    void boundaries_along(const Ray& ray, std::vector<SurfaceHit>& hits) const override;
    void visit_boundaries(const Ray& ray, BoundaryVisitor visitor, const void* visit) const override;
    Bounds3 medium_extent(const Medium& medium) const override;
    Bounds3 bounds() const override { return bounds_; }
    const Emitter* environment() const override { return environment_; }

    /// By the light hierarchy; see scene_lights.cpp.
    LightChoice choose_light(const LightReceiver& receiver, float u) const override;
    float light_probability(const LightReceiver& receiver, const Emitter* emitter) const override;
    /// The light that choose_light() returns with certainty; null: there are several, or none.
    const Emitter* only_light() const { return only_light_; }
    const LightTree& light_tree() const { return *light_tree_; }  ///< the hierarchy of lights with a place
    /// Proportional to power.
    LightChoice choose_emitter_by_power(float u, float* remapped = nullptr) const override;
    float probability_by_power(const Emitter* emitter) const override;

    /// The medium that surrounds everything, of which all shapes that name it agree; null: vacuum.
    const Medium* outermost_medium() const { return outermost_; }
    /// The media around a point: found by casting rays against the medium boundaries, see medium_state.h.
    /// `declared`: what stands there says in which medium it is; counts where open walls part the outside.
    MediumState medium_state_at(const Vec3& p, const Medium* declared) const;
    /// Where an eye ray begins, at ray.t_min: what lies nearer is not seen.
    MediumState eye_medium_state(const Ray& ray) const;
    /// The media around the eye for the middle of the image.
    MediumState camera_medium_state() const { return camera_state_; }
    MediumState emitter_medium_state(const Emitter& emitter, const EmissionSample& sample) const override;

    Rgb transmittance(const Vec3& from, const Vec3& to, const MediumState& state, Rng& rng,
                      TrackingCounters& counters) const override;
    const Medium* connect(const Ray& ray, const MediumState& state, PathWeights& weights, Rng& rng,
                          TrackingCounters& counters) const override;

  private:
    void check() const;
    void collect_media();
    void find_bounds();
    void check_instances() const;
    void find_open_space();
    void add_medium_lights();
    void build_light_tables();
    float probability_of(std::size_t light, const LightReceiver& receiver) const;
    void find_boundaries();
    void find_outermost_medium();
    bool reaches_outside(const Shape& shape) const;
    const Medium* exterior_of_all_walls() const;
    bool names_outermost(const Medium* medium, const MediumState& here) const;
    Vec3 eye_start() const;
    void find_eye_states();
    void find_emitter_states();
    void check_light_from_infinity(const Emitter& emitter, const Medium* around) const;
    bool any_boundary_in(const Bounds3& box, const Shape* except) const;
    MediumState medium_state_near(const Vec3& p, const Medium* declared, const Shape* excluded) const;
    MediumState area_light_state(const Emitter& emitter, const Shape& shape, const Vec3& p,
                                 const Vec3& normal) const;
    const Medium* outside_medium(const MediumState& inside, const Vec3& p, ProbeRays& probes,
                                 const Shape* excluded) const;
    template <typename Segment, typename Pane>
    const Medium* for_each_segment(const Ray& ray, const MediumState& state, const Segment& segment,
                                   const Pane& pane) const;

    Parts parts_;
    std::unique_ptr<RayTracer> rays_;
    Bounds3 bounds_, open_space_;
    const Emitter* environment_ = nullptr;
    /// Probabilities of each light without the hierarchy, and the hierarchy as the last entry; of particles.
    Distribution1D direct_lights_, particle_lights_;
    const Emitter* only_light_ = nullptr;  ///< that receivers can choose; null: there are several, or none
    std::unique_ptr<const LightTree> light_tree_;
    static constexpr std::uint32_t no_tree = 0xffffffffu;
    std::vector<std::uint32_t> tree_lights_, tree_index_;  ///< light of the hierarchy to emitter, and back
    std::unordered_map<const Emitter*, std::size_t> emitter_index_;
    const Medium* outermost_ = nullptr;
    SourceLocation outermost_where_;  ///< where the scene file names it
    MediumState camera_state_;
    bool eyes_differ_ = false;  ///< a boundary passes through where eye rays begin
    /// Shapes with a medium on either side; a closed one whose normals point inwards (a room) is `inward`.
    struct Boundary {
        const Shape* shape;
        bool closed, inward;
    };
    std::vector<Boundary> boundaries_;
    bool outside_is_parted_ = false;  ///< by open boundaries
    /// Lights whose media are the same wherever on the light a particle starts.
    std::map<const Emitter*, MediumState> emitter_states_;
};

}  // namespace mote::core
