// mote trade: its options, and what becomes of its reports.
#include "apps/trade_command.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>

#include "apps/command.h"
#include "apps/interruption.h"
#include "apps/options.h"
#include "apps/picture_file.h"
#include "apps/progress_line.h"
#include "apps/render_messages.h"
#include "core/objects/error.h"
#include "trade/folder.h"
#include "trade/trade.h"

namespace mote::apps {

namespace {

/// Progress and signals of a terminal.
class TerminalHost : public trade::Host {
  public:
    explicit TerminalHost(bool quiet) : quiet_(quiet) {}

    void note(const std::string& text) override { apps::note(text); }
    void remark(const std::string& text) override {
        if (!quiet_) apps::note(text);
    }
    void begin(const std::string& header) override { line_.emplace(header, quiet_); }
    void progress(const core::RenderProgress& p) override { line_->update(p); }
    void progress(const std::string& text, double seconds_left, bool urgent) override {
        line_->update(text + ", " + duration_text(seconds_left) + " left", urgent);
    }
    void end() override {
        if (line_) line_->end();
        line_.reset();
    }
    void idle_while(const char* phase, const char* why) override {
        interruption_.end_at_once_while(phase, why);
    }
    const std::atomic<bool>& interrupted() const override { return interruption_.flag(); }
    int exit_code() const { return 128 + interruption_.signal_number(); }

  private:
    bool quiet_;
    Interruption interruption_;
    std::optional<ProgressLine> line_;
};

void check_usage(const TradeArguments& a) {
    const auto require = [](bool given, const std::string& option) {
        if (!given) throw UsageError("mote trade needs " + option);
    };
    if (a.redraw) return require(!a.settings.output.empty(), "-o DIR");
    require(!a.settings.scene.empty(), "a SCENE");
    const trade::ReferenceSettings& r = a.make_reference;
    if (!r.path.empty() && extension_of(r.path) != ".exr")
        throw UsageError("the reference '" + core::printable(r.path) + "' does not end in .exr");
    if (r.path.empty() && !r.integrator.empty())
        throw UsageError("--integrator is for --make-reference; the methods name theirs");
}

int print_results(const std::string& path, bool quiet) {
    const trade::Folder folder = trade::Folder::existing(path);
    if (!quiet) std::fputs((folder.read("trade.txt") + "\n").c_str(), stdout);
    for (const char* name : {"trade.csv", "trade.svg", "trade.txt", "summary.json", "trade.html"})
        std::fputs((folder.file(name) + "\n").c_str(), stdout);
    return exit_ok;
}

}  // namespace

void add_trade(CLI::App& app, TradeArguments& a, std::function<int()>& action) {
    trade::Settings& s = a.settings;
    CLI::App& command =
        *app.add_subcommand("trade", "Measure error against time for several methods on a scene");
    command.add_option("SCENE", s.scene, "The scene file");
    command
        .add_option("--reference", s.reference,
                    "The picture that is taken for right (default: one is rendered)")
        ->type_name("EXR");
    command
        .add_option("--methods", s.methods,
                    "Integrators and settings (see docs/howto/trade.md; default: what suits the scene)")
        ->type_name("JSON");
    command.add_option("-o,--output", s.output, "The folder to write (default: SCENE_trade)")
        ->type_name("DIR");
    CLI::Option* make =
        command.add_option("--make-reference", a.make_reference.path, "Render a reference instead");
    make->type_name("EXR");
    command
        .add_option("--integrator", a.make_reference.integrator,
                    "Of the reference (default: volpath, or path)")
        ->type_name("TYPE");
    add_repeatable(command, "--setting", a.reference_settings,
                   "A value of the reference's integrator (repeatable)")
        ->type_name("NAME=VALUE");
    command.add_option("--resolve", s.resolve, "The smallest error that must be judged (default: 0.01)")
        ->check(number_above_0());
    command.add_option("--time", s.seconds, "Seconds for every method and seed, or for the reference")
        ->check(number_above_0());
    command.add_option("--passes", s.passes, "Passes for every method and seed, or for the reference")
        ->check(whole_number(1, std::uint64_t(1) << 30));
    command.add_option("--seeds", s.seeds, "Repetitions, each with a seed of its own")
        ->check(whole_number(1, 10000));
    add_repeatable(command, "-D,--define", a.defines, "As for render (repeatable)")->type_name("NAME=VALUE");
    add_repeatable(command, "--plugin", a.settings.changes.plugins, "As for render (repeatable)")
        ->type_name("FILE");
    add_threads(command, s.threads);
    command
        .add_option("--page-width", s.page_width, "Largest width of the pictures in the page (default: 640)")
        ->check(whole_number(8, 8192));
    command.add_option("--checkpoint-every", s.checkpoint_every, "Seconds between checkpoints (default: 60)")
        ->check(number_from_0());
    command.add_flag("--fresh", s.fresh, "Start anew instead of continuing");
    command.add_flag("--trust-reference", s.trust_reference,
                     "Take the reference as it is, whatever it lacks");
    command.add_flag("--force-reference", s.force_reference,
                     "Accept a reference of another version of the scene");
    CLI::Option* redraw_flag = command.add_flag("--redraw", a.redraw, "Draw the records in DIR again");
    redraw_flag->excludes(make);
    command.add_flag("--quiet", a.quiet, "No progress, no warnings");
    command.callback([&a, &action] { action = [&a] { return trade_command(a); }; });
}

int trade_command(const TradeArguments& a) {
    check_usage(a);
    if (a.redraw) {
        trade::redraw(a.settings.output, a.settings.page_width);
        return print_results(a.settings.output, a.quiet);
    }
    trade::Settings settings = a.settings;
    settings.changes.defines = split_defines(a.defines);
    if (settings.threads == 0) settings.threads = tbb::info::default_concurrency();
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    std::size_t(settings.threads));
    TerminalHost host(a.quiet);
    if (a.make_reference.path.empty())
        return trade::measure(settings, host) ? print_results(trade::folder_of(settings), a.quiet)
                                              : host.exit_code();
    trade::ReferenceSettings reference = a.make_reference;
    reference.settings = split_defines(a.reference_settings, "--setting");
    if (!trade::make_reference(settings, reference, host)) return host.exit_code();
    std::fputs((reference.path + "\n").c_str(), stdout);
    return exit_ok;
}

}  // namespace mote::apps
