#include "integrators/virtual_point_lights/plan_selection.h"

#include <fmt/format.h>

#include "core/scene/scene.h"
#include "integrators/virtual_point_lights/selection_memory.h"

namespace mote::integrators {

using namespace core;

namespace {

using Kind = SelectionSettings::Kind;

/// Nanoseconds of a shadow ray in a packet, as brute force spends them: for an estimate of its time.
constexpr double ray_nanoseconds = 60.0;
// Measured (docs/many_lights.md), each between two numbers of lights of which one was tried.
constexpr double few_lights = 500.0;   // a cut looks at as many
constexpr double some_lights = 1e4;    // rows of a matrix are a small part of the gather
constexpr double many_lights = 3e5;    // and now a large one: clusters are too large for their columns
constexpr double few_seconds = 1.0;    // of brute force: not worth an error
constexpr double media_decide = 0.45;  // optical depth: the smoke room has 0.57, the atrium 0.34

struct Advice {
    std::string best, why;
};

/// Media: which lights are near, surfaces: which are hidden.
Advice recommended(const GatherSize& size) {
    if (size.vpls < few_lights)
        return {"all", fmt::format("{:.0f} VPLs are fewer than a hierarchy would look at", size.vpls)};
    const double rays = size.vpls * size.receivers * size.points;
    const double seconds = rays * ray_nanoseconds * 1e-9;
    const std::string cost = fmt::format(
        "all of about {:.2g} VPLs at {:.2g} receivers are {:.2g} shadow rays, {:.2g} s of processor time",
        size.vpls, size.receivers * size.points, rays, seconds);
    if (seconds < few_seconds) return {"all", cost + ": a selection saves less than it errs"};
    if (size.filtered)
        return {"resampling, 16 of 256 candidates from a cut, with interleaving 4",
                cost + "; what is chosen for each pixel leaves noise of its own, which the filter takes out"};
    if (size.depth >= media_decide)
        return {"multidimensional_lightcuts, with shared_angle and shared_angle_in_media of 0.2",
                cost + fmt::format("; in media of optical depth {:.2g} most lights are seen and near ones "
                                   "count, which bounds know; points along a ray share a cut",
                                   size.depth)};
    if (size.vpls >= many_lights)
        return {"resampling, 32 of 256 candidates from a cut",
                cost + "; where surfaces hide most lights, rays go to those of many that would send most"};
    if (size.vpls >= some_lights)
        return {"matrix where shadows decide, else stochastic_lightcuts",
                cost + "; rows of some receivers know what is hidden, which no bound knows"};
    return {size.points > 1 ? "stochastic_lightcuts, or multidimensional_lightcuts for a picture of one pass"
                            : "stochastic_lightcuts, or lightcuts for a picture of one pass",
            cost};
}

/// Where lines are better lights than points.
void plan_ray_lights(Plan& plan, const GatherSize& size) {
    if (size.depth < media_decide) return;
    plan.run(
        "integrator for this medium", "mote_ray_lights",
        fmt::format("optical depth {:.2g}: segments of light paths need no bound in media; in {} they took "
                    "{} of the time of bounded VPLs with compensation to 5 % of error",
                    size.depth, size.homogeneous ? "homogeneous fog" : "smoke",
                    size.homogeneous ? "a tenth" : "a third"));
}

std::string chosen_by_resampling(const SelectionSettings& s) {
    using Proposal = ResamplingSettings::Proposal;
    const Proposal by = s.resampling.proposal;
    return fmt::format("resampling, {} of {} candidates {}, {} reuse", s.samples, s.resampling.candidates,
                       by == Proposal::cut      ? "from a cut"
                       : by == Proposal::groups ? "from the groups of a cut"
                       : by == Proposal::power  ? "drawn by power"
                                                : "drawn by the light hierarchy",
                       s.resampling.reuse == lights::SpatialReuse::none     ? "without"
                       : s.resampling.reuse == lights::SpatialReuse::biased ? "with biased"
                                                                            : "with unbiased");
}

std::string why_right_or_not(const SelectionSettings& s) {
    if (s.cuts()) return "biased by at most the threshold for each group; one cut a tile of 4 x 4";
    if (s.resamples() && s.resampling.reuse == lights::SpatialReuse::biased)
        return "biased: too dark where one pixel of a pair sees or faces a light and the other does not, "
               "since "
               "weights 1/M of reuse leave visibility and support of the neighbour out";
    if (s.resamples())
        return "unbiased; tiles of 4 x 4 look at the same candidates, each pixel chooses its own";
    return s.selects() ? "unbiased; the same lights for a tile of 4 x 4"
                       : "exact, time grows with the number of VPLs";
}

std::string chosen(const SelectionSettings& s) {
    const std::string cut =
        fmt::format("threshold {:g} %, at most {} groups", 100.0 * double(s.cut.threshold), s.cut.max_cut);
    switch (s.kind) {
        case Kind::all:
            return "all VPLs at every receiver";
        case Kind::lightcuts:
            return "lightcuts, " + cut;
        case Kind::multidimensional:
            return "multidimensional lightcuts, " + cut;
        case Kind::stochastic:
            return fmt::format("stochastic lightcuts, {} lights a tile", s.samples);
        case Kind::light_tree:
            return fmt::format("{} lights a tile, drawn by the light hierarchy", s.samples);
        case Kind::resampling:
            return chosen_by_resampling(s);
        case Kind::matrix:
            return fmt::format(
                "matrix row-column sampling, {} rows, {} columns for each of {} slices of receivers",
                s.matrix.rows_a_slice() * s.matrix.slices, s.matrix.columns, s.matrix.slices);
    }
    return "";
}

void plan_rows(Plan& plan, const lights::MatrixSettings& m, const GatherSize& size) {
    using Rows = lights::RowVisibilitySettings::Kind;
    const double rows = double(m.rows_a_slice() * m.slices);
    plan.run("rows of the matrix",
             m.visibility.kind == Rows::rays          ? "by rays"
             : m.visibility.kind == Rows::shadow_maps ? "by volumetric shadow maps of receivers"
                                                      : "by imperfect shadow maps of receivers",
             fmt::format(
                 "{:.2g} pairs a pass, of receivers on surfaces and in media; a picture's gather has {:.2g}",
                 rows * size.vpls, size.receivers * size.points * double(m.columns)));
}

void plan_memory(Plan& plan, const SelectionSettings& s, const GatherSize& size) {
    const std::size_t bytes = selection_bytes(s, std::size_t(size.vpls));
    plan.run(
        s.by_matrix() ? "memory of the matrix" : "memory of the light hierarchy",
        fmt::format("{:.1f} MB", double(bytes) * 1e-6),
        fmt::format("at most {:.0f} bytes a VPL while it is built, besides its own{}{}",
                    double(selection_bytes(s, 1000)) * 1e-3,
                    s.by_matrix()  ? "; one slice after the other"
                    : s.by_power() ? ", of them 12 for what draws by power"
                                   : "",
                    bytes > s.max_bytes ? fmt::format("; more than the {:.4g} MB of max_megabytes, refused",
                                                      double(s.max_bytes) * 1e-6)
                                        : ""));
}

/// Of lines through the box along an axis.
double depth_along(const Medium& medium, const Bounds3& box, int axis) {
    constexpr int side = 4;
    TrackingCounters counters;
    Ray ray;
    ray.direction = Vec3(0.0f), ray.direction[axis] = 1.0f, ray.t_max = box.diagonal()[axis];
    double sum = 0.0;
    for (int i = 0; i < side * side; ++i) {
        Vec3 u(0.0f);
        u[(axis + 1) % 3] = (float(i % side) + 0.5f) / float(side);
        u[(axis + 2) % 3] = (float(i / side) + 0.5f) / float(side);
        ray.origin = box.lower + u * box.diagonal();
        const Vec3d depth = medium.optical_depth_along(ray, 1.0f, counters);
        sum += (depth.x + depth.y + depth.z) / (3.0 * double(side * side));
    }
    return sum;
}

}  // namespace

double depth_of_media(const Scene& scene) {
    double sum = 0.0;
    for (const auto& medium : scene.media()) {
        if (!medium->traits().scattering || medium->traits().empty) continue;
        Bounds3 box = scene.medium_extent(*medium);
        const Bounds3 all = scene.bounds();
        box.lower = glm::max(box.lower, all.lower), box.upper = glm::min(box.upper, all.upper);
        if (glm::any(glm::lessThanEqual(box.diagonal(), Vec3(0.0f)))) continue;
        for (int axis = 0; axis < 3; ++axis) sum += depth_along(*medium, box, axis) / 3.0;
    }
    return sum;
}

void plan_selection(Plan& plan, const SelectionSettings& s, const GatherSize& size) {
    plan.run("selection", chosen(s), why_right_or_not(s));
    const auto [best, why] = recommended(size);
    plan.run("selection for this scene", best, why);
    plan_ray_lights(plan, size);
    if (s.resamples() && s.resampling.reuse == lights::SpatialReuse::biased)
        plan.miss("light at the ends of shadows", "reuse with weights 1/M takes a part of it",
                  "asked for: reuse 'unbiased' keeps it, and costs a second shadow ray for what arrives");
    if (s.selects()) plan_memory(plan, s, size);
    if (s.by_matrix()) plan_rows(plan, s.matrix, size);
}

}  // namespace mote::integrators
