// Light of a lamp that one technique of mote_upbp finds at one distance of an eye ray, without noise: the
// light paths of the pass are the nodes of a quadrature. What is left is the bias of the kernel.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "integrators/upbp/merges.h"
#include "tests/integrators/kernel_nodes.h"
#include "tests/support/render_statistics.h"

namespace mote::tests {

/// The scene's outermost medium, named "air", is around a lamp; an eye ray passes it along z.
class KernelSlices {
  public:
    explicit KernelSlices(const std::string& medium)
        : scene_(scene_from(R"(<scene version="3.0.0">)" + medium + R"(<emitter type="point">
        <point name="position" x="-0.45" y="0.4" z="0.3"/></emitter><sensor type="orthographic"><ref id="air"/>
        <transform name="to_world"><lookat origin="0.5, 0.5, -2.2" target="0.5, 0.5, 0" up="0, 1, 0"/></transform>
        </sensor></scene>)")),
          ends_(*scene_),
          medium_(*scene_->media()[0]) {}

    /// Relative error of the light scattered once, per metre of the ray at z; of points with points that of
    /// a collision of the eye path near z.
    Vec3d bias(Merge technique, double radius, double z, BeamLength light_beams) const {
        BidirectionalSettings settings;
        settings.connections = false, settings.limits.max_depth = 2, settings.heuristic = Heuristic::balance;
        settings.merging.radius[std::size_t(technique)] = radius;
        settings.merging.light_subpaths.fill(KernelNodes::light_paths);
        settings.merging.light_beams = light_beams;
        for (std::uint32_t seed = 0; seed < 100000; ++seed)
            if (const auto found = try_bias(technique, radius, z, settings, seed)) return *found;
        return Vec3d(NAN);
    }

  private:
    static constexpr Vec3 origin_{0.5f, 0.5f, -2.2f};

    /// Nothing where the eye path has no collision where it is wanted.
    std::optional<Vec3d> try_bias(Merge technique, double radius, double z,
                                  const BidirectionalSettings& settings, std::uint32_t seed) const {
        WalkContext context;
        context.rng = Rng(seed);
        Strategies<true> strategies(*scene_, ends_, settings, 1, 0.5f, context);
        Sampler sampler(SamplerKind::independent, 38, 0, seed);
        const LampStart lamp = start(strategies, sampler);
        std::optional<Vec3d> result;
        const auto after_step = [&](const SubpathWalk<true>& walk, bool continues) {
            const Subpath& path = strategies.eye_path();
            if (path.size() > 2 || result) return;
            Vec3 at(origin_.x, origin_.y, float(z));
            Vec3d limit = transmitted(medium_, origin_, at) * Vec3d(medium_.coefficients(at).sigma_s);
            if (technique == Merge::point_point_3d) {
                if (!continues || path.vertices.back().infinite) return;
                at = path.vertices.back().scattering.position, limit = Vec3d(path.vertices.back().weight);
                if (std::fabs(double(at.z) - z) > 0.02) return;
            }
            KernelNodes nodes(medium_, lamp, settings.merging);
            if (technique == Merge::point_point_3d) nodes.fill_ball(at, radius);
            if (technique == Merge::point_beam_2d) nodes.fill_disc(at, radius);
            if (technique == Merge::beam_beam_1d) nodes.fill_fan(at, radius);
            const LightVertices vertices(nodes.paths, settings.merging, Rng(1));
            const LightBeams beams(nodes.paths, nodes.beams, settings.merging, 3.0, Rng(1));
            Merges<true> merges(*scene_, ends_, strategies, vertices, beams, settings, context);
            Vec3d sum(0.0);
            merges.after_step(walk, continues, [&](const Contribution& c) { sum += Vec3d(c.light); });
            result = sum / (limit * arriving(lamp.point.position, at)) - 1.0;
        };
        const EyeRay eye{{origin_, {0, 0, 1}}, {0.5f, 0.5f}, sampler, Rng(seed)};
        strategies.trace_eye_path(
            eye, [](const Contribution&) {}, after_step);
        return result;
    }
    static LampStart start(Strategies<true>& strategies, Sampler& sampler) {
        Beam first;
        const auto after_step = [&](SubpathWalk<true>& walk) {
            for (const Beam& beam : walk.beams())
                if (beam.index == 1) first = beam;
        };
        strategies.trace_light_path(
            sampler, [](const Contribution&, const Vec2&) {}, after_step);
        return {strategies.light_path().vertices[0], strategies.light_start(), first};
    }
    /// Light of the lamp scattered towards the eye at a point, as if sigma_s were 1.
    Vec3d arriving(const Vec3& lamp, const Vec3& at) const {
        const Vec3d d = Vec3d(lamp) - Vec3d(at);
        return transmitted(medium_, lamp, at) / squared(d) *
               Vec3d(medium_.phase().eval({0, 0, -1}, Vec3(glm::normalize(d))));
    }

    std::unique_ptr<Scene> scene_;
    LightEnds ends_;
    const Medium& medium_;
};

}  // namespace mote::tests
