#include "integrators/upbp/upbp_passes.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "core/render/camera_ray.h"
#include "integrators/upbp/merge_schedule.h"

namespace mote::integrators {

using namespace core;

namespace {

constexpr std::uint32_t light_path_stream = 0x75706270u, thinning_stream = 0x7468696eu;

}  // namespace

template <bool Media>
UpbpPasses<Media>::UpbpPasses(const Scene& scene, const RenderOptions& options, const UpbpSettings& settings,
                              const PixelLattice& lattice)
    : scene_(scene), options_(options), settings_(settings), lattice_(lattice), ends_(scene) {
    settings_.limits.wanted = options.cells;
}

template <bool Media>
BidirectionalSettings UpbpPasses<Media>::settings_of(std::uint32_t pass, const PerTechnique& efforts) const {
    BidirectionalSettings s;
    s.limits = settings_.limits, s.heuristic = settings_.heuristic;
    s.all_connections = settings_.all_connections, s.connections = settings_.connections;
    s.merging = merges_of_pass(settings_, pass, double(scene_.bounds().radius()), lattice_.pixels(),
                               lattice_.size(), Media);
    s.merging.light_beams = possible_length(scene_, settings_.light_beams);
    s.merging.eye_beams = possible_length(scene_, settings_.query_beams);
    s.merging.effort = efforts;
    return s;
}

template <bool Media>
bool UpbpPasses<Media>::trace_light_paths(const PassContext& context, const BidirectionalSettings& settings,
                                          UpbpLights& lights) {
    lights.paths.resize(std::size_t(lattice_.columns()));  // of the first row, until all have room
    lights.beams_of_row.resize(std::size_t(lattice_.rows()));
    lights.splats.resize(std::size_t(lattice_.rows()));
    const auto rows = [&](int begin, int end) {
        tbb::parallel_for(begin, end, [&](int row) {
            if (!context.cancelled) trace_row(context, settings, row, lights);
        });
    };
    rows(0, 1);
    require_memory(lights);
    lights.paths.resize(lattice_.size());
    rows(1, lattice_.rows());
    if (context.cancelled) return false;
    const auto rng = [&](std::uint32_t stream) {
        return Rng(hash_keys(options_.seed, context.index, thinning_stream, stream));
    };
    lights.vertices = LightVertices(lights.paths, settings.merging, rng(0));
    if (settings.merging.uses(Merge::beam_beam_1d))
        lights.beams = LightBeams(lights.paths, lights.beams_of_row, settings.merging,
                                  double(scene_.bounds().radius()), rng(1));
    return true;
}

/// Evenly spread.
template <bool Media>
bool UpbpPasses<Media>::has_beams(std::size_t path) const {
    const std::size_t paths = lattice_.size(), count = paths_with_beams(paths);
    return (path + 1) * count / paths > path * count / paths;
}

/// By the vertices and beams of the first row.
template <bool Media>
void UpbpPasses<Media>::require_memory(const UpbpLights& lights) const {
    double first_row = 0.0;
    for (const Subpath& path : lights.paths)
        first_row += double(path.size()) * LightVertices::bytes_per_vertex;
    for (const LightBeam& b : lights.beams_of_row[0]) first_row += LightBeams::bytes_of(b);
    const double each = double(sizeof(Subpath)) + first_row / lattice_.columns();
    options_.memory.require(
        each * double(lattice_.size()), fmt::format("the vertices of {} light subpaths", lattice_.size()),
        [each](double bytes) { return fmt::format("{:.0f} subpaths fit", std::floor(bytes / each)); });
}

template <bool Media>
void UpbpPasses<Media>::trace_row(const PassContext& context, const BidirectionalSettings& settings, int row,
                                  UpbpLights& lights) {
    WalkContext walk;
    walk.cancelled = context.cancelled;
    Strategies<Media> strategies(scene_, ends_, settings, lattice_.pixels(), context.filter.radius(), walk);
    for (int x = 0, y = row * lattice_.n; x < options_.width; x += lattice_.n) {
        const auto pixel = std::uint32_t(pixel_key(options_, x, y));
        const std::size_t path = lattice_.index_of(x, y);
        Sampler sampler(options_.sampler, options_.seed, pixel, context.index, light_path_stream);
        walk.rng = Rng(hash_keys(options_.seed, context.index, pixel, light_path_stream));
        const auto splat = [&](const Contribution& c, const Vec2& film) {
            lights.splats[std::size_t(row)].push_back({film, c.light, std::uint32_t(c.layer)});
        };
        const auto after_step = [&](SubpathWalk<Media>& edge) {
            if (!has_beams(path)) return;
            for (Beam& beam : edge.beams())
                lights.beams_of_row[std::size_t(row)].push_back(
                    {std::uint32_t(path), strategies.light_start(), std::move(beam)});
        };
        strategies.trace_light_path(sampler, splat, after_step);
        lights.paths[path] = strategies.light_path();
    }
    counters_.add(walk.rays, walk.tracking);
}

template class UpbpPasses<true>;
template class UpbpPasses<false>;

}  // namespace mote::integrators
