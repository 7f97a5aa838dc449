#include "experiments/studies/selection/study.h"

#include <sstream>

#include "core/formats/xml/scene_loader.h"
#include "integrators/eye_path/eye_ray.h"
#include "integrators/register_integrators.h"
#include "lights/register_lights.h"
#include "media/register_media.h"

namespace mote::studies {

using Kind = SelectionSettings::Kind;

double now(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

namespace {

lights::MatrixSettings matrix_of(const std::vector<std::string>& words) {
    using Rows = lights::RowVisibilitySettings::Kind;
    lights::MatrixSettings m;
    m.rows = std::uint32_t(std::stoul(words[1])), m.columns = std::uint32_t(std::stoul(words[2]));
    if (!words[3].empty()) m.slices = std::uint32_t(std::stoul(words[3]));
    if (words[4] == "maps") m.visibility.kind = Rows::shadow_maps;
    if (words[4] == "imperfect") m.visibility.kind = Rows::imperfect;
    return m;
}

ResamplingSettings resampling_of(const std::vector<std::string>& words) {
    using Proposal = ResamplingSettings::Proposal;
    using lights::SpatialReuse;
    return {std::uint32_t(std::stoul(words[1])),
            words[4] == "power"    ? Proposal::power
            : words[4] == "tree"   ? Proposal::light_tree
            : words[4] == "groups" ? Proposal::groups
                                   : Proposal::cut,
            words[3] == "unbiased" ? SpatialReuse::unbiased
            : words[3] == "biased" ? SpatialReuse::biased
                                   : SpatialReuse::none};
}

}  // namespace

SelectionSettings settings_of(const std::string& text) {
    std::vector<std::string> words;
    std::istringstream stream(text);
    for (std::string word; std::getline(stream, word, ':');) words.push_back(word);
    const bool plain = text.ends_with(":plain");
    words.resize(6);
    SelectionSettings s;
    s.kind = words[0] == "all"                ? Kind::all
             : words[0] == "lightcuts"        ? Kind::lightcuts
             : words[0] == "multidimensional" ? Kind::multidimensional
             : words[0] == "stochastic"       ? Kind::stochastic
             : words[0] == "matrix"           ? Kind::matrix
             : words[0] == "ris"              ? Kind::resampling
                                              : Kind::light_tree;
    if (s.cuts())
        s.cut = {std::stof(words[1]),
                 std::uint32_t(std::stoul(words[2])),
                 std::stof("0" + words[3]),
                 {std::stof("0" + words[4]), std::stof("0" + words[5])}};
    else if (s.by_matrix())
        s.matrix = matrix_of(words);
    else if (s.resamples())
        s.resampling = resampling_of(words), s.samples = std::uint32_t(std::stoul(words[2]));
    else if (s.by_hierarchy())
        s.samples = std::uint32_t(std::stoul(words[1]));
    s.learning = !plain;
    return s;
}

namespace {

std::unique_ptr<core::Scene> load(const Arguments& a) {
    core::Registry registry;
    core::register_core(registry), media::register_media(registry);
    lights::register_lights(registry), integrators::register_integrators(registry);
    core::LoadOptions options;
    options.defines = {{"resx", std::to_string(a.width)}, {"resy", std::to_string(a.height)}};
    return core::load_scene(a.scene, registry, options);
}

}  // namespace

Study::Study(const Arguments& a) : arguments_(a), scene_(load(a)) {
    options_.seed = 1, options_.width = a.width, options_.height = a.height;
    settings_.eye.max_scatterings = 1;
    settings_.paths = a.paths, settings_.bound = a.bound, settings_.scattering_points = a.points;
    settings_.selection.kind = Kind::light_tree;  // lights keep nothing that only other ways need
    settings_.eye.wanted = options_.cells;
    double begin = now(CLOCK_PROCESS_CPUTIME_ID);
    vpls_ = lights::trace_light_paths(*scene_, settings_.light_paths(), 1, 0, core::SamplerKind::sobol);
    tracing = now(CLOCK_PROCESS_CPUTIME_ID) - begin;
    leaves_.emplace(vpls_);
    begin = now(CLOCK_PROCESS_CPUTIME_ID);
    hierarchy_.emplace(*leaves_);
    building = now(CLOCK_PROCESS_CPUTIME_ID) - begin;
    power_.emplace(*hierarchy_);
    begin = now(CLOCK_PROCESS_CPUTIME_ID);
    tree_.emplace(*leaves_);
    planting = now(CLOCK_PROCESS_CPUTIME_ID) - begin;
    core::Rng rng(17);
    for (std::uint32_t t = 0; t < a.tiles; ++t) {
        const int x = int(rng.next_u32() % std::uint32_t(a.width / 4));
        tiles_.emplace_back(4 * x, 4 * int(rng.next_u32() % std::uint32_t(a.height / 4)));
    }
}

double Study::bytes_a_light(bool drawn) const {
    return double(vpls_.memory_bytes() + (drawn ? tree_->memory_bytes() : hierarchy_->memory_bytes())) /
           double(std::max<std::size_t>(vpls_.lights.size(), 1));
}

std::unique_ptr<VplMatrix> Study::prepare(const SelectionSettings& selection) const {
    if (!selection.by_matrix()) return nullptr;
    core::WalkContext walk;
    const auto pixels = spread_pixels(options_.width, options_.height, eye_paths_for(selection.matrix), 1);
    VplSettings settings = settings_;
    settings.selection = selection;
    const auto scratch = std::make_unique<lights::GatherScratch>();
    EyeTile<true> eye(*scene_, settings, arguments_.bound, vpls_, nullptr, *scratch, walk);
    const std::atomic<bool> cancelled = false;
    const auto receivers = find_receivers(*scene_, options_, {0, *filter_, cancelled}, pixels, eye);
    auto matrix = std::make_unique<VplMatrix>(*scene_, selection.matrix, 1);
    SharedCounters counters;
    matrix->make(0, vpls_, receivers, arguments_.bound, 1, counters, {});
    return matrix;
}

Pixels Study::render(std::size_t index, const SelectionSettings& selection, TileCost& cost,
                     const VplMatrix* matrix) const {
    VplSettings settings = settings_;
    settings.selection = selection;
    core::WalkContext walk;
    const auto scratch = std::make_unique<lights::GatherScratch>();
    EyeTile<true> eye(*scene_, settings, arguments_.bound, vpls_, nullptr, *scratch, walk, {},
                      SelectedBy{&*hierarchy_, &*tree_, &*power_, matrix ? &matrix->selection() : nullptr});
    const bool learns = selection.cuts() ||
                        ((selection.draws() || (selection.resamples() && selection.resampling.by_tree())) &&
                         selection.learning) ||
                        selection.resampling.reuse != lights::SpatialReuse::none;
    const std::atomic<bool> cancelled = false;
    const core::PassContext pass{0, *filter_, cancelled};
    const glm::ivec2 wanted = tiles_[index], task = wanted / 16 * 16;
    const auto render_tile = [&](const glm::ivec2& tile) {
        const double begin = now(CLOCK_THREAD_CPUTIME_ID);
        for (int lane = 0; lane < 16; ++lane)
            eye.start(lane, make_eye_ray(*scene_, options_, pass, tile.x + lane % 4, tile.y + lane / 4));
        eye.run({}, 1.0f), eye.gather_collected();
        cost.seconds += now(CLOCK_THREAD_CPUTIME_ID) - begin, ++cost.tiles;
        Pixels light;
        for (int lane = 0; lane < 16; ++lane) {
            TransportSum sum = eye.sum(lane).transport;
            light[std::size_t(lane)] =
                double(core::average(sum[Transport::indirect] + sum[Transport::multiple_scattering]));
        }
        return light;
    };
    Pixels light{};
    for (int t = 0; t < 16; ++t) {
        const glm::ivec2 tile = task + 4 * glm::ivec2(t % 4, t / 4);
        if (tile == wanted)
            light = render_tile(tile);
        else if (learns && tile.x < arguments_.width && tile.y < arguments_.height)
            render_tile(tile);
    }
    cost.rays += double(walk.rays.occlusion), cost.cuts.add(eye.cut_counters());
    return light;
}

}  // namespace mote::studies
