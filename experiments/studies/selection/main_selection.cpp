// Error and cost of selecting virtual point lights, at tiles of pixels drawn from a picture: CSV, a line a
// method. All methods have the same VPLs, the same eye paths and the same points along them, so the error is
// that of the selection alone; it is held against many lights drawn by the hierarchy (`reference`), whose own
// variance is taken off, or against all of them (`--brute`).
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <ctime>
#include <iostream>

#include "core/loading/scene_loader.h"
#include "core/render/render_driver.h"
#include "integrators/eye_path/eye_ray.h"
#include "integrators/register_integrators.h"
#include "integrators/virtual_point_lights/vpl_eye_tile.h"
#include "integrators/virtual_point_lights/vpl_matrix.h"
#include "lights/register_lights.h"
#include "lights/selection/vertex_bounds.h"
#include "media/register_media.h"

namespace {

using namespace mote;
using namespace mote::integrators;
using Kind = SelectionSettings::Kind;

struct Arguments {
    std::string scene;
    std::vector<std::string> methods;
    std::uint32_t paths = 1000, tiles = 60, reference = 16384;
    int width = 512, height = 512, points = 2;
    float bound = 1.0f;
    bool brute = false;
};

/// Processor time of this thread, or of all.
double now(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

lights::MatrixSettings matrix_of(const std::vector<std::string>& words) {
    using Rows = lights::RowVisibilitySettings::Kind;
    lights::MatrixSettings m;
    m.rows = std::uint32_t(std::stoul(words[1])), m.columns = std::uint32_t(std::stoul(words[2]));
    if (!words[3].empty()) m.slices = std::uint32_t(std::stoul(words[3]));
    if (words[4] == "maps") m.visibility.kind = Rows::shadow_maps;
    if (words[4] == "imperfect") m.visibility.kind = Rows::imperfect;
    return m;
}

/// "lightcuts:THRESHOLD:MAX_CUT", "multidimensional:THRESHOLD:MAX_CUT", "stochastic:N", "tree:N",
/// "ris:CANDIDATES:SAMPLES:none|unbiased|biased:cut|tree|power",
/// "matrix:ROWS:COLUMNS:SLICES:VISIBILITY" (rays, maps, imperfect).
SelectionSettings settings_of(const std::string& text) {
    std::vector<std::string> words;
    std::istringstream stream(text);
    for (std::string word; std::getline(stream, word, ':');) words.push_back(word);
    words.resize(5);
    SelectionSettings s;
    if (words[0] == "ris") {
        using Proposal = ResamplingSettings::Proposal;
        using lights::SpatialReuse;
        s.kind = Kind::resampling, s.samples = std::uint32_t(std::stoul(words[2]));
        s.resampling = {std::uint32_t(std::stoul(words[1])),
                        words[4] == "power"  ? Proposal::power
                        : words[4] == "tree" ? Proposal::light_tree
                                             : Proposal::cut,
                        words[3] == "unbiased" ? SpatialReuse::unbiased
                        : words[3] == "biased" ? SpatialReuse::biased
                                               : SpatialReuse::none};
        return s;
    }
    s.kind = words[0] == "lightcuts"          ? Kind::lightcuts
             : words[0] == "multidimensional" ? Kind::multidimensional
             : words[0] == "stochastic"       ? Kind::stochastic
             : words[0] == "matrix"           ? Kind::matrix
                                              : Kind::light_tree;
    if (s.cuts())
        s.cut = {std::stof(words[1]), std::uint32_t(std::stoul(words[2]))};
    else if (s.by_matrix())
        s.matrix = matrix_of(words);
    else
        s.samples = std::uint32_t(std::stoul(words[1]));
    return s;
}

std::unique_ptr<core::Scene> load(const Arguments& a) {
    core::Registry registry;
    core::register_core(registry), media::register_media(registry);
    lights::register_lights(registry), integrators::register_integrators(registry);
    core::LoadOptions options;
    options.defines = {{"resx", std::to_string(a.width)}, {"resy", std::to_string(a.height)}};
    return core::load_scene(a.scene, registry, options);
}

/// The light of VPLs at the sixteen pixels of a tile.
using Pixels = std::array<double, 16>;

class Study {
  public:
    explicit Study(const Arguments& a) : arguments_(a), scene_(load(a)) {
        options_.seed = 1, options_.width = a.width, options_.height = a.height;
        settings_.eye.max_scatterings = 1;
        settings_.paths = a.paths, settings_.bound = a.bound, settings_.scattering_points = a.points;
        settings_.selection.kind = Kind::light_tree;  // nothing is shared out among points
        settings_.eye.wanted = wanted_transport(options_);
        double begin = now(CLOCK_PROCESS_CPUTIME_ID);
        vpls_ = lights::trace_light_paths(*scene_, settings_.light_paths(), 1, 0, core::SamplerKind::sobol);
        tracing = now(CLOCK_PROCESS_CPUTIME_ID) - begin;
        leaves_.emplace(vpls_);
        begin = now(CLOCK_PROCESS_CPUTIME_ID);
        hierarchy_.emplace(*leaves_, 1);
        power_.emplace(*hierarchy_);
        building = now(CLOCK_PROCESS_CPUTIME_ID) - begin;
        begin = now(CLOCK_PROCESS_CPUTIME_ID);
        tree_.emplace(*leaves_);
        planting = now(CLOCK_PROCESS_CPUTIME_ID) - begin;
        core::Rng rng(17);
        for (std::uint32_t t = 0; t < a.tiles; ++t) {
            const int x = int(rng.next_u32() % std::uint32_t(a.width / 4));
            tiles_.emplace_back(4 * x, 4 * int(rng.next_u32() % std::uint32_t(a.height / 4)));
        }
    }

    std::size_t tiles() const { return tiles_.size(); }
    std::size_t lights() const { return hierarchy_->size(); }
    double bytes_a_light(bool drawn) const {
        return double(vpls_.memory_bytes() + (drawn ? tree_->memory_bytes() : hierarchy_->memory_bytes())) /
               double(std::max<std::size_t>(vpls_.lights.size(), 1));
    }
    /// Rows and columns of a matrix, for the tiles to come, from all of the picture; nothing for others.
    void prepare(const SelectionSettings& selection) {
        preparing = 0.0;
        matrix_.reset();
        if (!selection.by_matrix()) return;
        core::WalkContext walk;
        const auto pixels =
            spread_pixels(options_.width, options_.height, eye_paths_for(selection.matrix), 1);
        VplSettings settings = settings_;
        settings.selection = selection;
        EyeTile<true> eye(*scene_, settings, arguments_.bound, vpls_, nullptr, *scratch_, walk);
        const std::atomic<bool> cancelled = false;
        const double begin = now(CLOCK_PROCESS_CPUTIME_ID);
        const auto receivers = find_receivers(*scene_, options_, {0, *filter_, cancelled}, pixels, eye);
        matrix_.emplace(*scene_, selection.matrix, 1);
        SharedCounters counters;
        matrix_->make(0, vpls_, receivers, arguments_.bound, 1, counters, {});
        preparing = now(CLOCK_PROCESS_CPUTIME_ID) - begin;
    }
    /// `seconds`: of gathering alone, without eye paths and direct light, which are the same for all.
    Pixels render(std::size_t tile, const SelectionSettings& selection, std::uint32_t key, double& seconds) {
        VplSettings settings = settings_;
        settings.selection = selection;
        core::WalkContext walk;
        EyeTile<true> eye(
            *scene_, settings, arguments_.bound, vpls_, nullptr, *scratch_, walk, {}, {},
            SelectedBy{&*hierarchy_, &*tree_, &*power_, matrix_ ? &matrix_->selection() : nullptr});
        const std::atomic<bool> cancelled = false;
        const core::PassContext pass{0, *filter_, cancelled};
        eye.draw_apart(key);  // eye paths have generators of their own
        const glm::ivec2 at = tiles_[tile];
        // What tiles reuse comes from those of the same task that were rendered before them.
        const bool reuses = selection.resampling.reuse != lights::SpatialReuse::none;
        const glm::ivec2 first = reuses ? at / task * task : at;
        int count = 0;
        const double begin = now(CLOCK_THREAD_CPUTIME_ID);
        for (int y = first.y; y <= at.y; y += 4)
            for (int x = first.x; x <= (y < at.y ? first.x + task - 4 : at.x); x += 4) {
                for (int lane = 0; lane < 16; ++lane)
                    eye.start(lane, make_eye_ray(*scene_, options_, pass, x + lane % 4, y + lane / 4));
                eye.run({}, 1.0f), eye.gather_collected();
                ++count;
            }
        seconds = (now(CLOCK_THREAD_CPUTIME_ID) - begin) / double(count);
        rays += double(walk.rays.occlusion) / double(count), cuts.add(eye.cut_counters());
        Pixels light;
        for (int lane = 0; lane < 16; ++lane) {
            TransportSum sum = eye.sum(lane).transport;
            light[std::size_t(lane)] =
                double(core::average(sum[Transport::indirect] + sum[Transport::multiple_scattering]));
        }
        return light;
    }

    double tracing = 0.0, building = 0.0, planting = 0.0, preparing = 0.0, rays = 0.0;
    lights::LightcutCounters cuts;

  private:
    Arguments arguments_;
    std::unique_ptr<core::Scene> scene_;
    core::RenderOptions options_;
    VplSettings settings_;
    lights::VplSet vpls_;
    std::optional<lights::VplLeaves> leaves_;
    std::optional<lights::LightHierarchy> hierarchy_;
    std::optional<lights::LightTree> tree_;
    std::optional<lights::PowerCandidates> power_;
    static constexpr int task = 16;  ///< pixels of VplEstimator
    std::optional<VplMatrix> matrix_;
    std::unique_ptr<core::PixelFilter> filter_ = core::make_pixel_filter("box", 0.5f, 0.5f);
    std::unique_ptr<lights::GatherScratch> scratch_ = std::make_unique<lights::GatherScratch>();
    std::vector<glm::ivec2> tiles_;
};

/// References of a tile, and the variance of their mean.
struct Reference {
    Pixels mean{}, variance{};
};

Reference reference_of(Study& study, std::size_t tile, const Arguments& a) {
    Reference r;
    double seconds = 0.0;
    if (a.brute) {
        r.mean = study.render(tile, settings_of("lightcuts:0:2000000000"), 1, seconds);
        return r;
    }
    constexpr int parts = 4;
    Pixels squares{};
    for (int k = 0; k < parts; ++k) {
        const auto part = study.render(tile, settings_of(fmt::format("tree:{}", a.reference / parts)),
                                       std::uint32_t(100 + k), seconds);
        for (std::size_t i = 0; i < 16; ++i)
            r.mean[i] += part[i] / parts, squares[i] += part[i] * part[i] / parts;
    }
    for (std::size_t i = 0; i < 16; ++i)
        r.variance[i] = std::max(0.0, squares[i] - r.mean[i] * r.mean[i]) / (parts - 1);
    return r;
}

void measure(Study& study, const std::vector<Reference>& references, const std::string& method,
             const Arguments& a) {
    double seconds = 0.0, nothing = 0.0, mean = 0.0, moved = 0.0, squares = 0.0, relative = 0.0, worst = 0.0;
    study.prepare(settings_of(method));
    study.rays = 0.0, study.cuts = {};
    for (std::size_t t = 0; t < study.tiles(); ++t)
        for (const double v : references[t].mean) mean += v / double(16 * study.tiles());
    std::vector<double> of_tiles;
    for (std::size_t t = 0; t < study.tiles(); ++t) {
        double own = 0.0, sum = 0.0;
        const Pixels light = study.render(t, settings_of(method), std::uint32_t(t), own);
        seconds += own;
        for (std::size_t i = 0; i < 16; ++i) {
            const double r = references[t].mean[i], d = light[i] - r;
            const double square = d * d - references[t].variance[i];
            moved += d, squares += square, sum += square / (r * r + 1e-4 * mean * mean);
            worst = std::max(worst, std::fabs(d) / (r + 0.01 * mean));
        }
        relative += sum, of_tiles.push_back(sum / 16.0);
    }
    const double n = double(16 * study.tiles());
    const double rel = relative / n;
    double spread = 0.0;  // of the mean square over tiles
    for (const double v : of_tiles) spread += (v - rel) * (v - rel);
    spread = std::sqrt(spread) / double(of_tiles.size());
    const double prepared = study.preparing;
    study.prepare(settings_of("tree:1"));
    // What eye paths and direct light take, which all methods have.
    for (std::size_t t = 0; t < study.tiles(); ++t) {
        double own = 0.0;
        const double before = study.rays;
        study.render(t, settings_of("tree:1"), 1, own);
        study.rays = before, nothing += own;
    }
    const double pixels = double(a.width) * double(a.height);
    const auto root = [](double x) { return x > 0.0 ? std::sqrt(x) : 0.0; };
    const double pairs = study.cuts.cuts > 0 ? double(study.cuts.pairs) / double(study.cuts.cuts) : 0.0;
    std::cout << fmt::format(
                     "{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.2f},{:.2f},{:.0f},{:.0f},{:.2f},{:.2f}\n",
                     method, study.lights(), 100.0 * root(rel),
                     rel > 0.0 ? 50.0 * spread / std::sqrt(rel) : 0.0, 100.0 * root(squares / n) / mean,
                     100.0 * moved / n / mean, 100.0 * worst, seconds / n * pixels,
                     (seconds - nothing) / n * pixels, study.rays / n, pairs,
                     study.cuts.cuts > 0 ? double(study.cuts.at_limit) / double(study.cuts.cuts) : 0.0,
                     prepared)
              << std::flush;
}

}  // namespace

int main(int argc, char** argv) {
    Arguments a;
    CLI::App app{"Error and cost of selecting virtual point lights, as CSV"};
    app.add_option("scene", a.scene, "scene file, with media")->required();
    app.add_option("methods", a.methods,
                   "lightcuts:T:N multidimensional:T:N stochastic:N tree:N "
                   "ris:CANDIDATES:SAMPLES:REUSE:BY matrix:ROWS:COLUMNS:SLICES:VISIBILITY")
        ->required();
    app.add_option("--paths", a.paths, "light paths");
    app.add_option("--tiles", a.tiles, "of 4 x 4 pixels");
    app.add_option("--points", a.points, "along each eye ray in media");
    app.add_option("--bound", a.bound, "on the geometry term [1/m^2]");
    app.add_option("--width", a.width, "of the picture"), app.add_option("--height", a.height, "");
    app.add_option("--reference", a.reference, "lights drawn for the reference");
    app.add_flag("--brute", a.brute, "all lights for the reference");
    CLI11_PARSE(app, argc, argv);
    Study study(a);
    std::cerr << fmt::format(
        "{} lights, {:.1f} bytes a light with the hierarchy, {:.1f} with the tree; traced in {:.2f} s, "
        "hierarchy in {:.2f} s, tree in {:.2f} s of the processor\n",
        study.lights(), study.bytes_a_light(false), study.bytes_a_light(true), study.tracing, study.building,
        study.planting);
    std::vector<Reference> references;
    double begin = now(CLOCK_THREAD_CPUTIME_ID);
    for (std::size_t t = 0; t < study.tiles(); ++t) references.push_back(reference_of(study, t, a));
    std::cerr << fmt::format("reference in {:.1f} s\n", now(CLOCK_THREAD_CPUTIME_ID) - begin);
    std::cout
        << "method,lights,relative_error_percent,its_standard_error,error_of_mean_percent,bias_percent,worst_"
           "percent,picture_seconds,gather_seconds,rays_a_pixel,groups_a_cut,at_limit,prepare_seconds\n";
    for (const std::string& method : a.methods) measure(study, references, method, a);
}
