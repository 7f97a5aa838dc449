// Settings of `mote_vpl_ray_bundles`.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/render/integrator.h"
#include "gathering/eye_bundles/eye_bundles.h"
#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/eye_path/light_path_limits.h"

namespace mote::integrators {

/// Treatment of glossy receivers.
enum class GlossyTreatment : std::uint8_t {
    own_rays,  ///< a ray of their own, by the BSDF
    lines,     ///< none: lines and virtual point lights alone, as in the paper
    clamping   ///< lobes widened to the density of lights (Tokuyoshi & Ogaki 2012, Sec. 5)
};

/// Techniques of the paths that VPLs and bundles can both make.
enum class BundleTechniques : std::uint8_t {
    combined,
    vpls,
    bundles,
    reused_bundles  ///< bundles alone, whose paths take the pass's own lines instead of joined VPLs
};

struct VplBundleSettings {
    /// Virtual point lights joined to a point that a bundle found. Errors of bundles alone are 71 and 65 %
    /// with 4, 37 and 36 % with 16 in 1.14 times the time; combined, the paths are few that lack others
    /// (docs/design.md, "Virtual point lights and bundles from the eye").
    static constexpr std::uint32_t joined = 4;
    /// c, the chance of a bundle's path to continue: 1/2 takes 1.36 times as long for the same error, 0
    /// leaves 5 times the error in the atrium (ibid.).
    static constexpr float continuation = 0.25f;

    EyePathLimits eye;  ///< max_depth counts the whole path from light to eye
    std::uint32_t paths = 64;
    std::uint32_t directions = 8;  ///< of a pass
    BundleTechniques choice = BundleTechniques::combined;
    std::optional<float> bound;  ///< b [1/m^2] of paths of two bounces and more; nothing: weighted
    bool sky = false;            ///< direct light of the sky by bundles
    GlossyTreatment glossy = GlossyTreatment::own_rays;
    bool imperfect_links = false;  ///< bundles are discs around points, kept and looked up
    int interleaving = 1;          ///< n: a pixel of n x n has every n^2-th VPL, and directions of its own
    bool filters = false;

    gathering::Techniques techniques() const {
        return choice == BundleTechniques::combined ? gathering::Techniques::combined
               : choice == BundleTechniques::vpls   ? gathering::Techniques::vpls
                                                    : gathering::Techniques::bundles;
    }
    bool reuses_lines() const { return choice == BundleTechniques::reused_bundles; }
    /// Eye paths a pixel and pass whose direct light counts, in the mean: as many as make the error of a pass
    /// smallest where one path has as much of it in its direct light as in its indirect light, the root of
    /// how many times as much work the latter is. Times are those of the atrium of scenes/, of which only
    /// ratios matter: rays one by one, and in packets.
    int direct_paths() const {
        constexpr float one_ray = 1.0f, packet_ray = 0.05f, eye_path = 3.0f * one_ray, vertices = 2.5f;
        const float vpls = float(paths) * vertices / float(interleaving * interleaving);
        const float along = has_bundles() ? float(directions) / (1.0f - continuation_of_pass()) : 0.0f;
        const float other =
            vpls * packet_ray + along * (2.0f * one_ray + float(joined_lights()) * packet_ray);
        return std::clamp(int(std::lround(std::sqrt(other / eye_path))), 1, 64);
    }
    std::uint32_t joined_lights() const { return bounces() > 0 || paths == 0 ? 0 : joined; }
    /// Bounces of paths along the pass's own lines; 0: they join VPLs instead.
    int bounces() const {
        if (!reuses_lines()) return 0;
        const int lines = int(directions);
        return eye.max_depth < 0 ? lines : std::clamp(eye.max_depth - 2, 1, std::max(lines, 1));
    }
    /// c, where there are techniques to weight such paths against.
    float continuation_of_pass() const {
        return choice == BundleTechniques::combined && !bound ? continuation : 0.0f;
    }
    bool has_bundles() const { return choice != BundleTechniques::vpls && directions > 0; }
    lights::LightPathSettings light_paths(const core::MemoryBudget& memory = {}) const {
        lights::LightPathSettings s = light_path_settings(paths, eye, memory);
        s.keep_starts = true;
        return s;
    }
};

/// The passes of `mote_vpl_ray_bundles`: fresh light paths and directions each, which all pixels share, or
/// all pixels of one place in blocks of n x n. Precondition: the scene has no media.
std::unique_ptr<core::Estimator> make_vpl_bundle_estimator(const core::Scene& scene,
                                                           const core::RenderOptions& options,
                                                           const VplBundleSettings& settings);

}  // namespace mote::integrators
