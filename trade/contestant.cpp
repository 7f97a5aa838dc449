// Passes under two clocks, and checkpoints of film and clocks that belong together.
#include "trade/contestant.h"

#include <cmath>
#include <filesystem>
#include <limits>

#include "core/film/film_memory.h"
#include "core/metrics/metrics.h"
#include "core/metrics/relative_error.h"
#include "core/objects/error.h"
#include "core/render/cpu_clock.h"
#include "session/output_files.h"
#include "session/render_report.h"

namespace mote::trade {

using namespace session;

namespace {

using core::Rgb;
using nlohmann::json;

/// Wall time and processor time of all threads since its construction.
class Clocks {
  public:
    double wall() const { return core::read_clock(CLOCK_MONOTONIC) - wall_; }
    double cpu() const { return core::process_cpu_seconds() - cpu_; }

  private:
    double wall_ = core::read_clock(CLOCK_MONOTONIC), cpu_ = core::process_cpu_seconds();
};

json to_json(const Tally& t) {
    json spreads = json::array();
    for (const Tally::Spread& s : t.spreads)
        spreads.push_back({{"passes", s.passes}, {"mean", s.mean}, {"squares", s.squares}});
    return {{"passes", t.passes}, {"build_wall", t.build_wall}, {"build_cpu", t.build_cpu}, {"wall", t.wall},
            {"cpu", t.cpu},       {"spreads", spreads}};
}

Tally tally_from(const json& j) {
    Tally t;
    t.passes = j.at("passes").get<std::uint32_t>();
    t.build_wall = j.at("build_wall").get<double>(), t.build_cpu = j.at("build_cpu").get<double>();
    t.wall = j.at("wall").get<double>(), t.cpu = j.at("cpu").get<double>();
    for (const json& s : j.at("spreads"))
        t.spreads.push_back(
            {s.at("passes").get<std::uint32_t>(), s.at("mean").get<double>(), s.at("squares").get<double>()});
    return t;
}

/// The tallies of a file; none where it holds something else.
std::vector<Tally> read_tallies(const std::string& path) {
    std::vector<Tally> tallies;
    try {
        for (const json& j : json::parse(read_text(path))) tallies.push_back(tally_from(j));
        return tallies;
    } catch (const json::exception&) {
        return {};
    }
}

/// The tally that was taken with this number of passes.
Tally read_tally(const std::string& path, std::uint32_t passes) {
    for (const Tally& t : read_tallies(path))
        if (t.passes == passes) return t;
    throw core::InputError("damaged: the trade cannot be continued, --fresh starts anew", {path, 0});
}

// The bias of one pass, Eq. (3) of core/metrics/relative_error.h, plus 1; of a part, its contribution to
// that. The film's rule: a pixel that is not finite in some layer adds nothing.
double projection(const core::PassImage& image, const core::Film& film, std::size_t part,
                  const Reference& reference) {
    const std::span<const std::size_t> layers = film.layers_of(part);
    double total = 0.0;
    for (std::size_t p = 0; p < film.pixels(); ++p) {
        Rgb sum(0.0f);
        bool finite = true;
        for (std::size_t layer = 0; layer < image.layers(); ++layer) {
            finite = finite && core::is_finite(image.layer(layer)[p]);
            if (!film.layers()[layers[layer]].auxiliary) sum += image.layer(layer)[p];
        }
        if (finite) total += reference.weights.weight[p] * core::mean_product(reference.pixels[p], sum);
    }
    return total / reference.weights.norm;
}

/// Throws core::OutOfMemory where its passes and the picture have no room.
core::Film make_film(const core::Scene& scene, const core::Integrator& integrator) {
    const core::FilmSettings& film = scene.film();
    std::vector<core::Layer> layers = integrator.layers(scene);
    const core::PassSplit split = core::pass_split(scene, integrator);
    core::FilmMemory(film.width, film.height, layers, false, {}, split).require({});
    return {film.width, film.height, std::move(layers), false, split};
}

}  // namespace

Contestant::Contestant(const core::Scene& scene, const Method& method, std::uint64_t seed,
                       const Reference& reference, std::string checkpoint, const std::string& content_hash)
    : method_(method),
      reference_(reference),
      seed_(seed),
      checkpoint_(std::move(checkpoint)),
      key_{content_hash + " " + method.type + " " + method.settings_text(), seed},
      film_(make_film(scene, *method.integrator)),
      floor_(reference.floor()) {
    restore();
    const Clocks clocks;
    runner_ = std::make_unique<core::PassRunner>(scene, *method.integrator, seed, film_);
    // A continued trade builds again; the time was counted before.
    if (tally_.passes == 0) tally_.build_wall = clocks.wall(), tally_.build_cpu = clocks.cpu();
}

bool Contestant::is_done(const Limits& limits) const {
    if (!film_.has_passes(1)) return false;
    if (limits.passes && tally_.passes >= *limits.passes) return true;
    // One more pass would end farther from the limit than none.
    return limits.seconds && tally_.seconds() + 0.5 * tally_.wall / tally_.passes >= *limits.seconds;
}

bool Contestant::run_pass(const std::atomic<bool>& cancelled) {
    const Clocks clocks;
    if (!runner_->run_pass(cancelled)) return false;
    tally_.wall += clocks.wall(), tally_.cpu += clocks.cpu();
    ++tally_.passes;
    add_to_spread(runner_->last_pass(), runner_->last_part());
    return true;
}

void Contestant::add_to_spread(const core::PassImage& image, std::size_t part) {
    tally_.spreads.resize(film_.parts());
    Tally::Spread& spread = tally_.spreads.at(part);
    const double value = projection(image, film_, part, reference_), before = value - spread.mean;
    spread.mean += before / ++spread.passes;
    spread.squares += before * (value - spread.mean);
}

double Tally::bias_standard_error() const {
    double variance = 0.0;
    for (const Spread& s : spreads) {
        if (s.passes < 2) return std::numeric_limits<double>::quiet_NaN();
        variance += s.squares / (s.passes - 1.0) / s.passes;
    }
    return std::sqrt(variance);
}

core::Film Contestant::finished(double& wall, double& cpu) const {
    core::Film picture = film_;
    const Clocks clocks;
    runner_->estimator().finish(picture, {});
    wall = clocks.wall(), cpu = clocks.cpu();
    return picture;
}

Record Contestant::judge(const core::Film& picture, double finish_wall, double finish_cpu) const {
    const std::vector<Rgb> beauty = picture.beauty();
    const core::ImageMetrics m =
        core::compare_images(beauty, reference_.pixels, film_.width(), film_.height());
    const core::RelativeError e =
        core::relative_error(beauty, reference_.pixels, reference_.weights, {}, reference_.variance);
    Record r;
    r.method = method_.name, r.integrator = method_.type, r.settings = method_.settings_text();
    r.seed = seed_, r.passes = tally_.passes;
    r.wall = tally_.seconds() + finish_wall, r.cpu = tally_.build_cpu + tally_.cpu + finish_cpu;
    r.build = tally_.build_wall;
    r.relmse = m.rel_mse, r.relmse_trimmed = m.rel_mse_trimmed;
    r.error = e.error, r.bias = e.bias;
    if (reference_.noise) r.error_se = e.error_standard_error;
    if (const auto stated = picture.error(); stated && std::isfinite(stated->high))
        r.stated_low = stated->low, r.stated_high = stated->high;
    const double bias_se = tally_.bias_standard_error();
    if (std::isfinite(bias_se)) r.bias_se = bias_se;
    r.non_finite = film_.non_finite();
    r.peak_memory_mb = double(peak_memory_bytes()) * 1e-6;
    r.below_reference = r.error < floor_;
    return r;
}

core::Statistics Contestant::statistics() const {
    core::Statistics s;
    s.seconds["build"] = tally_.build_wall, s.seconds["render"] = tally_.wall;
    return s;
}

// The film is replaced after the tally, which therefore keeps the last two states: whenever the power fails,
// one of them belongs to the film.
void Contestant::save() {
    if (tally_.passes == saved_.passes) return;
    json states = json::array({to_json(tally_)});
    if (saved_.passes > 0) states.push_back(to_json(saved_));
    const std::string text = states.dump();
    write_text(checkpoint_ + ".json", text);
    core::write_checkpoint(checkpoint_ + ".film", key_, film_);
    saved_ = tally_;
}

void Contestant::restore() {
    const std::string tallies = checkpoint_ + ".json";
    if (!core::read_checkpoint(checkpoint_ + ".film", key_, film_)) {
        std::error_code ignored;
        if (std::filesystem::exists(tallies, ignored) && read_tallies(tallies).empty())
            throw core::InputError("is no checkpoint of a trade, and is not replaced: move or remove it",
                                   {tallies, 0});
        return;
    }
    tally_ = saved_ = read_tally(tallies, film_.pass_count());
}

void Contestant::remove_checkpoint() const {
    core::remove_checkpoint(checkpoint_ + ".film", key_.content_hash);
    std::error_code ignored;
    std::filesystem::remove(checkpoint_ + ".json", ignored);
}

}  // namespace mote::trade
