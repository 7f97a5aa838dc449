// One seed after the other, so that the films of one seed alone are in memory; within it, turns pass by pass.
#include "trade/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "core/film/film_image.h"
#include "core/formats/pictures/image_file.h"
#include "session/render_report.h"

namespace mote::trade {

using namespace session;

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

bool is_power_of_two(std::uint32_t n) { return n > 0 && (n & (n - 1)) == 0; }

// Time that is left, over all methods and seeds.
class Forecast {
  public:
    explicit Forecast(const Plan& plan) : plan_(plan) {}

    double seconds_left(const std::vector<std::unique_ptr<Contestant>>& running, std::size_t pending) const {
        double rest = 0.0, whole = 0.0;
        for (const auto& c : running) {
            if (!c) continue;
            const double all = total_seconds(*c);
            rest += std::max(0.0, all - c->tally().seconds()), whole = std::max(whole, all);
        }
        return rest + whole * double(pending);
    }

  private:
    // Seconds of this contestant at its end, by the speed so far.
    double total_seconds(const Contestant& c) const {
        double seconds = core::infinity;
        const Tally& t = c.tally();
        if (plan_.limits.seconds) seconds = *plan_.limits.seconds;
        if (plan_.limits.passes && t.passes > 0)
            seconds = std::min(seconds, t.build_wall + t.wall / t.passes * *plan_.limits.passes);
        return std::isfinite(seconds) ? seconds : 0.0;
    }
    const Plan& plan_;
};

class SeedRun {
  public:
    SeedRun(const Plan& plan, Folder& folder, std::size_t seed_index, Host& host)
        : plan_(plan),
          folder_(folder),
          seed_index_(seed_index),
          host_(host),
          cancelled_(host.interrupted()),
          errors_(plan.methods.size(), -1.0) {}

    /// Returns false when interrupted.
    bool run() {
        // Records and checkpoints of before are on the disk.
        host_.idle_while("building", "the same command continues");
        enter();
        host_.idle_while(nullptr);
        while (!running_.empty() &&
               std::any_of(running_.begin(), running_.end(), [](auto& c) { return !!c; })) {
            std::unique_ptr<Contestant>& turn = running_[next()];
            if (cancelled_ || !turn->run_pass(cancelled_)) return save_all();
            const bool done = turn->is_done(plan_.limits);
            if (done || is_power_of_two(turn->tally().passes)) record(*turn, done);
            show(*turn, done);
            if (done) leave(turn);
            if (seconds_since(saved_) >= plan_.checkpoint_every) save_all();
        }
        return true;
    }

  private:
    std::uint64_t seed() const { return plan_.seeds[seed_index_]; }

    /// Every method builds what it needs; the time counts.
    void enter() {
        running_.resize(plan_.methods.size());
        for (std::size_t i = 0; i < plan_.methods.size(); ++i) {
            const Method& method = plan_.methods[i];
            if (folder_.is_complete(method.name, seed())) continue;
            running_[i] =
                std::make_unique<Contestant>(plan_.scene, method, seed(), plan_.reference,
                                             folder_.checkpoint(method.slug, seed()), plan_.content);
            // Records after the checkpoint were lost with their film, and its seconds with it.
            folder_.drop_after(method.name, seed(), running_[i]->tally().passes);
        }
    }
    std::size_t next() const {
        std::vector<double> seconds;
        std::vector<bool> running;
        for (const auto& c : running_) {
            seconds.push_back(c ? c->tally().seconds() : 0.0);
            running.push_back(bool(c));
        }
        return next_turn(seconds, running);
    }
    void record(Contestant& c, bool done) {
        double wall = 0.0, cpu = 0.0;
        const core::Film picture = c.finished(wall, cpu);
        Record r = c.judge(picture, wall, cpu);
        r.final = done;
        errors_[std::size_t(&c.method() - plan_.methods.data())] = r.error;
        // The picture first: a final record has its picture.
        if (done && seed_index_ == 0) write_picture(c, picture, r);
        folder_.drop_after(r.method, r.seed, r.passes - 1);
        folder_.add(r);
    }
    void write_picture(const Contestant& c, core::Film picture, const Record& r) const {
        const core::Plan plan =
            c.method().integrator->plan(plan_.scene, core::find_requirements(plan_.scene));
        const core::RenderResult result{std::move(picture), c.statistics(), false, 0};
        std::vector<std::string> command = render_command_of(plan_, c.method(), c.seed());
        command.insert(command.end(), {"--passes", std::to_string(r.passes)});
        const RenderReport report{plan_.scene,   plan,     result,        plan_.content,
                                  plan_.content, c.seed(), plan_.threads, command};
        core::ImageChannels image = core::film_image(result.film);
        image.metadata = picture_metadata(report);
        image.metadata["error"] = fmt::format("{:.6g}", r.error);
        core::write_exr(folder_.file(c.method().slug + ".exr"), image);
    }
    static void leave(std::unique_ptr<Contestant>& c) {
        c->remove_checkpoint();
        c.reset();
    }
    /// Returns false, for callers that end.
    bool save_all() {
        for (const auto& c : running_)
            if (c) c->save();
        saved_ = Clock::now();
        return false;
    }
    void show(const Contestant& c, bool done) {
        std::size_t pending = 0;
        for (std::size_t s = seed_index_ + 1; s < plan_.seeds.size(); ++s)
            for (const Method& m : plan_.methods) pending += !folder_.is_complete(m.name, plan_.seeds[s]);
        std::string text = fmt::format("seed {}/{}, {}: pass {}", seed_index_ + 1, plan_.seeds.size(),
                                       c.method().name, c.tally().passes);
        if (const double error = errors_[std::size_t(&c.method() - plan_.methods.data())]; error >= 0.0)
            text += fmt::format(", error {:.3g} %", 100.0 * error);
        host_.progress(text, Forecast(plan_).seconds_left(running_, pending), done);
    }

    const Plan& plan_;
    Folder& folder_;
    std::size_t seed_index_;
    Host& host_;
    const std::atomic<bool>& cancelled_;
    std::vector<double> errors_;  ///< the last of each method
    std::vector<std::unique_ptr<Contestant>> running_;
    Clock::time_point saved_ = Clock::now();
};

}  // namespace

std::size_t next_turn(const std::vector<double>& seconds, const std::vector<bool>& running) {
    std::size_t best = seconds.size();
    for (std::size_t i = 0; i < seconds.size(); ++i)
        if (running[i] && (best == seconds.size() || seconds[i] < seconds[best])) best = i;
    if (best == seconds.size()) throw std::logic_error("no method is left to take a turn");
    return best;
}

std::vector<std::uint64_t> seeds_beside(const std::optional<std::uint64_t>& reference, std::uint32_t count) {
    std::vector<std::uint64_t> seeds;
    for (std::uint64_t seed = 1; seeds.size() < count; ++seed)
        if (!reference || seed != *reference) seeds.push_back(seed);
    return seeds;
}

std::vector<std::string> render_command_of(const Plan& plan, const Method& method, std::uint64_t seed) {
    std::vector<std::string> command = plan.render_command;
    const std::vector<std::string> options = method.render_options();
    command.insert(command.end(), options.begin(), options.end());
    command.insert(command.end(), {"--seed", std::to_string(seed), "-o", method.slug + ".exr"});
    return command;
}

bool run(const Plan& plan, Folder& folder, Host& host) {
    for (std::size_t i = 0; i < plan.seeds.size(); ++i)
        if (!SeedRun(plan, folder, i, host).run()) return false;
    return true;
}

}  // namespace mote::trade
