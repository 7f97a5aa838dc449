#include "experiments/studies/selection/study.h"

#include <algorithm>
#include <map>
#include <sstream>

#include "core/formats/xml/scene_loader.h"
#include "integrators/eye_path/eye_ray.h"
#include "integrators/virtual_point_lights/path_receivers.h"
#include "lights/selection/register_selection.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "session/registry.h"

namespace mote::studies {

double now(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

std::shared_ptr<const lights::Selection> selection_of(const std::string& text) {
    std::vector<std::string> words;
    std::istringstream stream(text);
    for (std::string word; std::getline(stream, word, ':');) words.push_back(word);
    using Names = std::vector<std::string>;
    const Names cut{"threshold", "max_cut", "error", "shared_angle"}, samples{"samples"};
    static const std::map<std::string, std::pair<std::string, Names>> types{
        {"all", {"all", {}}},
        {"uniform", {"uniform", samples}},
        {"lightcuts", {"lightcuts", cut}},
        {"multidimensional", {"multidimensional_lightcuts", cut}},
        {"stochastic", {"stochastic_lightcuts", samples}},
        {"tree", {"light_tree", samples}},
        {"ris", {"resampling", {"candidates", "samples"}}},
        {"matrix", {"matrix", {"rows", "columns", "slices", "row_visibility"}}}};
    const auto& [type, names] = types.at(words[0]);
    core::Properties properties;
    properties.category = core::Category::selection, properties.type = type;
    for (std::size_t i = 0; i < names.size() && i + 1 < words.size(); ++i) {
        const std::string& word = words[i + 1];
        const bool number = word.find_first_not_of("0123456789.") == std::string::npos;
        const bool whole = word.find('.') == std::string::npos;
        if (word.empty()) continue;
        auto& value = properties.values[names[i]].value;
        if (!number)
            value = word;
        else if (whole && cut.end() == std::find(cut.begin(), cut.end(), names[i]))
            value = std::int64_t(std::stoll(word));
        else if (names[i] == "max_cut")
            value = std::int64_t(std::stoll(word));
        else
            value = std::stod(word);
    }
    core::Registry registry;
    lights::register_selection(registry);
    return std::dynamic_pointer_cast<lights::Selection>(
        registry.factory(core::Category::selection, type)(properties));
}

namespace {

std::unique_ptr<core::Scene> load(const Arguments& a) {
    core::LoadOptions options;
    options.defines = {{"resx", std::to_string(a.width)}, {"resy", std::to_string(a.height)}};
    return core::load_scene(a.scene, session::make_registry(), options);
}

}  // namespace

Study::Study(const Arguments& a) : arguments_(a), scene_(load(a)) {
    options_.seed = 1, options_.width = a.width, options_.height = a.height;
    settings_.eye.max_scatterings = 1;
    settings_.paths = a.paths, settings_.bound = a.bound, settings_.scattering_points = a.points;
    settings_.eye.wanted = options_.cells;
    lights::LightPathSettings paths = settings_.light_paths();
    paths.keep_states = false;  // rays begin at receivers
    const double begin = now(CLOCK_PROCESS_CPUTIME_ID);
    vpls_ = lights::trace_light_paths(*scene_, paths, 1, 0, core::SamplerKind::sobol);
    tracing = now(CLOCK_PROCESS_CPUTIME_ID) - begin;
    core::Rng rng(17);
    for (std::uint32_t t = 0; t < a.tiles; ++t) {
        const int x = int(rng.next_u32() % std::uint32_t(a.width / 4));
        tiles_.emplace_back(4 * x, 4 * int(rng.next_u32() % std::uint32_t(a.height / 4)));
    }
}

Study::Method Study::prepare(const std::string& text) const {
    Method method{selection_of(text), nullptr,
                  !text.starts_with("all") && !text.starts_with("uniform") && !text.starts_with("matrix")};
    core::RayCounters rays;
    core::TrackingCounters tracking;
    core::Statistics statistics;
    core::WalkContext walk;
    const std::atomic<bool> cancelled = false;
    const auto receivers = sample_path_receivers<true>(*scene_, settings_, options_, {0, *filter_, cancelled},
                                                       method.selection->receiver_paths(), 1, walk);
    method.selector = method.selection->prepare(
        {*scene_, vpls_, arguments_.bound, 1, rays, tracking, statistics, {}, receivers});
    return method;
}

Pixels Study::render(std::size_t index, const Method& method, TileCost& cost) const {
    VplSettings settings = settings_;
    settings.selection = method.selection;
    core::WalkContext walk;
    EyePacket<true> packet(*scene_, EyeReceivers<true>::packet_settings(settings), walk);
    const auto visibility = lights::prepare_traced_visibility();
    compensation::PreparedResidual residual;
    VplGatherer<true> gatherer(*scene_, settings, {vpls_, method.selector, *visibility, residual}, packet);
    const std::atomic<bool> cancelled = false;
    const core::PassContext pass{0, *filter_, cancelled};
    const glm::ivec2 wanted = tiles_[index], task = wanted / 16 * 16;
    const auto render_tile = [&](const glm::ivec2& tile) {
        const double begin = now(CLOCK_THREAD_CPUTIME_ID);
        for (int lane = 0; lane < 16; ++lane)
            packet.start(lane, make_eye_ray(*scene_, options_, pass, tile.x + lane % 4, tile.y + lane / 4));
        gatherer.follow({}, 1.0f), gatherer.gather_copied();
        cost.seconds += now(CLOCK_THREAD_CPUTIME_ID) - begin, ++cost.tiles;
        Pixels light;
        for (int lane = 0; lane < 16; ++lane) {
            TransportSum& sum = packet[lane].sum;
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
        else if (method.learns && tile.x < arguments_.width && tile.y < arguments_.height)
            render_tile(tile);
    }
    cost.rays += double(walk.rays.occlusion);
    gatherer.add_statistics(cost.selection);
    return light;
}

}  // namespace mote::studies
