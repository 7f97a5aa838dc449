// Parsing the command line, and turning what went wrong into one line and an exit code.
#include "apps/command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <functional>
#include <limits>
#include <new>

#include "apps/denoise/denoise_command.h"
#include "apps/interruption.h"
#include "apps/manual_command.h"
#include "apps/options.h"
#include "apps/ssbc_command.h"
#include "apps/subcommands.h"
#include "apps/tev_viewer.h"
#include "apps/trade_command.h"
#include "core/formats/xml/faults.h"
#include "core/objects/error.h"
#include "core/objects/memory_error.h"
#include "session/borrowed_arena.h"

namespace mote::apps {

namespace {

void print_error(const std::string& message) {
    // One write, so that lines of several threads or processes do not mix.
    std::string line = "mote: " + message;
    for (char& c : line)
        if (c == '\n' || c == '\r') c = ' ';
    std::fflush(stdout);
    std::fputs((line + "\n").c_str(), stderr);
}

constexpr std::size_t max_printed_errors = 20;

void print_errors(const core::SceneErrors& errors) {
    const std::size_t n = errors.all().size(), printed = n > max_printed_errors ? max_printed_errors : n;
    for (std::size_t i = 0; i < printed; ++i) print_error(errors.all()[i].what());
    if (printed < n) print_error("... and " + std::to_string(n - printed) + " more errors");
}

void add_lenient(CLI::App& command, bool& lenient) {
    command.add_flag("--lenient", lenient,
                     "Leave out or approximate what is wrong or unknown in the scene, and say what");
}

void add_defines(CLI::App& command, std::vector<std::string>& defines, const std::string& description) {
    add_repeatable(command, "-D,--define", defines, description)->type_name("NAME=VALUE");
}

void add_plugins(CLI::App& command, std::vector<std::string>& plugins) {
    add_repeatable(command, "--plugin", plugins,
                   "Load types from this shared library (repeatable; MOTE_PLUGINS: for every command)")
        ->type_name("FILE");
}

void add_scene_options(CLI::App& command, SceneArguments& arguments) {
    command.add_option("SCENE", arguments.scene, "The scene file")->required();
    add_lenient(command, arguments.lenient);
    command.add_option("--integrator", arguments.integrator, "Render with this type instead of the scene's")
        ->type_name("TYPE");
    add_defines(command, arguments.defines,
                "Set a $parameter of the scene file, or a value such as integrator.paths (repeatable)");
    add_plugins(command, arguments.plugins);
}

void add_render(CLI::App& app, RenderArguments& a, std::function<int()>& action) {
    CLI::App& command = *app.add_subcommand("render", "Render a scene into a layered EXR and a PNG preview");
    add_scene_options(command, a.scene);
    command.add_option(
        "-o,--output", a.output,
        "The EXR file to write, or the PNG beside it (default: the scene's name). frames/####.exr: one "
        "for every value of the -D that runs (t=0:47, t=0:0.5:10, t=1,2,5)");
    command
        .add_option("--passes", a.passes, "Stop after this many passes (default: the scene's sample_count)")
        ->check(whole_number(1, std::uint64_t(1) << 30));
    command.add_option("--time", a.seconds, "Stop after this many seconds, loading and building included")
        ->check(number_above_0());
    command.add_option("--noise", a.noise, "Stop when the noise is this, such as 0.02 (see docs/testing.md)")
        ->check(number_above_0());
    command
        .add_option(
            "--error", a.error,
            "Stop when the error, bias of filters included, is below this, such as 0.03: the upper end of "
            "its interval (see docs/testing.md)")
        ->check(number_above_0());
    command.add_option("--seed", a.seed, "Another seed gives another, independent picture")
        ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()));
    add_threads(command, a.threads);
    command.add_flag("--resume", a.resume, "Continue from the checkpoint of an interrupted render");
    command.add_option("--checkpoint-every", a.checkpoint_every, "Seconds between checkpoints (default: 60)")
        ->check(number_from_0());
    command.add_option("--stats", a.stats, "Write statistics to this JSON file");
    add_exposure(command, a.exposure);
    command
        .add_option(
            "--pass-range", a.pass_range,
            "Render passes A to B - 1 alone, into a partial film for 'mote merge' (docs/howto/cluster.md)")
        ->type_name("A:B");
    command.add_flag("--identity", a.identity,
                     "Render nothing: print as JSON what partial films must have in common to be merged");
    add_half(command, a.half);
    command.add_flag("--auxiliary", a.auxiliary,
                     "Also write what is seen: positions, normals, depth, albedo, with variances");
    command
        .add_flag(
            "--denoise{oidn}", a.denoise,
            "Add a denoised picture, for the eye, and show it in the preview: by OpenImageDenoise, where it "
            "is installed; --denoise=bmfr: by regression on features, which needs nothing else")
        ->check(CLI::IsMember({"oidn", "bmfr"}));
    command.add_flag(fmt::format("--tev{{{}}}", TevViewer::default_address), a.tev,
                     "Show the picture so far in the viewer tev, which may run elsewhere (--tev=HOST:PORT)");
    command.add_flag("--quiet", a.quiet, "No progress, no warnings, no previews of the first half minute");
    command.add_flag("-v,--verbose", a.verbose, "Also print the plan and where the time went");
    command.callback([&a, &action] {
        if (a.error) a.scene.defines.emplace_back("film.interval=true");
        action = [&a] { return render_sequence(a); };
    });
}

void add_merge(CLI::App& app, MergeArguments& a, std::function<int()>& action) {
    CLI::App& command = *app.add_subcommand("merge", "Add up partial films of 'mote render --pass-range'");
    command.add_option("PART", a.parts, "The partial films, in any order")->required();
    command
        .add_option("-o,--output", a.output,
                    "The EXR file to write, or the PNG beside it; a .film is a partial film again")
        ->required();
    command.add_option("--scene", a.scene,
                       "The scene file, where it is not where the parts were rendered from");
    add_threads(command, a.threads);
    command.add_option("--stats", a.stats, "Write statistics to this JSON file");
    add_exposure(command, a.exposure);
    add_half(command, a.half);
    command.add_flag("--quiet", a.quiet, "No progress, no warnings");
    command.callback([&a, &action] { action = [&a] { return merge_command(a); }; });
}

void add_compare(CLI::App& app, CompareArguments& a, std::function<int()>& action) {
    CLI::App& command = *app.add_subcommand("compare", "Measure the error of a picture against a reference");
    command.add_option("IMAGE", a.image, "The picture")->required();
    command.add_option("REFERENCE", a.reference, "The picture that is taken for right")->required();
    command.add_option("--second", a.second,
                       "A reference of another seed: error and bias then hold none of the noise of either");
    command.add_option(
        "--layer", a.layer,
        "Compare this layer of two EXR files instead of the beauty, or A:B, layers of different names");
    command.add_option("--map", a.map, "Write a picture of the relative error to this PNG file");
    command
        .add_option("--difference", a.difference,
                    "Write image, reference and their difference, amplified, side by side into a PNG file")
        ->type_name("xFACTOR");
    command.add_option("-o,--output", a.output, "Of --difference (default: IMAGE_difference.png)");
    command.add_flag("--json", a.json, "Print JSON");
    command.callback([&a, &action] { action = [&a] { return compare_command(a); }; });
}

void add_export(CLI::App& app, ExportArguments& a, std::function<int()>& action) {
    CLI::App& command = *app.add_subcommand("export", "Write a scene and its files for another renderer");
    add_scene_options(command, a.scene);
    command.add_option("--to", a.target, "The renderer: mitsuba3")
        ->required()
        ->check(CLI::IsMember({"mitsuba3"}));
    command.add_option("-o,--output", a.output, "The folder to write")->required();
    command
        .add_option("--max-grid", a.max_grid_megabytes,
                    "Refuse dense grids of more than this many megabytes (default: 2000)")
        ->check(whole_number(1, 1'000'000));
    command.callback([&a, &action] { action = [&a] { return export_command(a); }; });
}

void add_view(CLI::App& app, ViewArguments& a, std::function<int()>& action) {
    CLI::App& command = *app.add_subcommand("view", "Show a scene, or pictures, in the browser");
    command.add_option("FILE", a.files, "A scene file, or EXR files")->required();
    add_lenient(command, a.scene.lenient);
    command.add_option("--integrator", a.scene.integrator, "Render with this type instead of the scene's")
        ->type_name("TYPE");
    add_defines(command, a.scene.defines,
                "Set a $parameter of the scene file, or a value such as integrator.paths (repeatable)");
    add_plugins(command, a.scene.plugins);
    command.add_option("--reference", a.reference,
                       "An EXR file that is taken for right: the view draws error against time");
    command.add_option("--passes", a.passes, "Passes of a picture (default: the scene's sample_count)")
        ->check(whole_number(1, std::uint64_t(1) << 30));
    command.add_option("--seed", a.seed, "Another seed gives another, independent picture")
        ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()));
    add_threads(command, a.threads);
    command.add_option("--port", a.port, "Listen on this port (default: one that is free)")
        ->check(whole_number(0, 65535));
    command.add_option("--bind", a.bind, "Listen on this address instead of 127.0.0.1; needs --token");
    command.add_option("--token", a.token, "Part of the address (default: a random one)");
    command.add_flag("--no-browser", a.no_browser, "Print the address, and open no browser");
    command.callback([&a, &action] { action = [&a] { return view_command(a); }; });
}

// Nearest command or option to one that is not there, else the message of CLI11.
std::string usage_message(const CLI::App& app, int argc, char** argv, const CLI::ParseError& error) {
    if (argc < 2) return error.what();
    const std::string first = argv[1];
    std::vector<std::string> names;
    const CLI::App* command = nullptr;
    for (const CLI::App* c : app.get_subcommands({})) {
        names.push_back(c->get_name());
        if (c->get_name() == first) command = c;
    }
    if (!command)
        return first.starts_with('-')
                   ? error.what()
                   : "there is no command '" + core::printable(first) + "'" + core::suggestion(first, names);
    std::vector<std::string> options;
    for (const CLI::Option* option : command->get_options())
        for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
    for (int i = 2; i < argc && std::string(argv[i]) != "--"; ++i) {
        const std::string word = std::string(argv[i]).substr(0, std::string(argv[i]).find('='));
        if (!word.starts_with("--") || std::find(options.begin(), options.end(), word) != options.end())
            continue;
        const std::string near = core::nearest_name(word, options);
        return "'mote " + first + "' has no option '" + core::printable(word) + "'" +
               (near.empty() ? "" : " (did you mean '" + near + "'?)");
    }
    return error.what();
}

int parse_and_run(int argc, char** argv) {
    CLI::App app("mote: many-light rendering and participating media");
    app.name("mote");
    app.set_version_flag("--version", std::string("mote ") + MOTE_VERSION);
    app.require_subcommand(1);
    std::function<int()> action;

    RenderArguments render;
    for (int i = 0; i < argc; ++i) render.command_line.emplace_back(argv[i]);
    add_render(app, render, action);

    SceneArguments plan;
    CLI::App& plan_app = *app.add_subcommand("plan", "Print what a scene requires, and what will run");
    add_scene_options(plan_app, plan);
    plan_app.callback([&] { action = [&] { return plan_command(plan); }; });

    InfoArguments info;
    CLI::App& info_app =
        *app.add_subcommand("info", "Describe a scene, mesh, picture or volume in a few lines");
    info_app.add_option("FILE", info.file, "The file")->required();
    add_lenient(info_app, info.lenient);
    add_plugins(info_app, info.plugins);
    info_app.callback([&] { action = [&] { return info_command(info); }; });

    ConvertArguments convert;
    CLI::App& convert_app =
        *app.add_subcommand("convert", "Convert a picture to EXR or PNG, or a glTF or pbrt scene to XML");
    convert_app
        .add_option("IN", convert.input,
                    "EXR, PNG, JPEG, HDR, PNM, PFM, BMP or TGA; or a scene: glTF, GLB, pbrt")
        ->required();
    convert_app
        .add_option(
            "OUT", convert.output,
            "A file that ends in .exr or .png; in .xml for a scene; for frames/####.exr in .mp4, .webm, .mov "
            "or .gif (needs ffmpeg)")
        ->required();
    convert_app.add_option("--rate", convert.rate, "Frames a second of a film (default: 24)")
        ->check(number_between(0.1, 1000.0));
    add_lenient(convert_app, convert.lenient);
    add_defines(convert_app, convert.defines, "For a scene: camera=NAME, or emission=FACTOR (repeatable)");
    convert_app.add_option("--exposure", convert.exposure, "Brighten by this many stops")
        ->check(number_between(-100.0, 100.0));
    convert_app
        .add_option_function<std::string>(
            "--tone",
            [&](const std::string& name) {
                convert.tone = name == "filmic" ? core::filmic_tone : core::linear_tone;
            },
            "Curve of a PNG file or a film: linear (default), or filmic, which keeps the shape of highlights")
        ->check(CLI::IsMember({"linear", "filmic"}));
    convert_app.add_option("--layer", convert.layer, "This layer of an EXR instead of the beauty");
    add_half(convert_app, convert.half);
    convert_app.callback([&] { action = [&] { return convert_command(convert); }; });

    TradeArguments trade;
    trade.settings.command_line = render.command_line;
    add_trade(app, trade, action);

    MergeArguments merge;
    merge.command_line = render.command_line;
    add_merge(app, merge, action);

    CompareArguments compare;
    add_compare(app, compare, action);

    DenoiseArguments denoise;
    add_denoise(app, denoise, action);

    SsbcArguments ssbc;
    add_ssbc(app, ssbc, action);

    ExportArguments export_arguments;
    add_export(app, export_arguments, action);

    ViewArguments view;
    add_view(app, view, action);

    CLI::App& formats_app = *app.add_subcommand("formats", "Print the scene language as Markdown");
    std::vector<std::string> format_plugins;
    add_plugins(formats_app, format_plugins);
    formats_app.callback([&] { action = [&] { return formats_command(format_plugins); }; });

    CLI::App& manual_app = *app.add_subcommand("manual", "Write man pages, and completions for bash and zsh");
    std::string share;
    manual_app.add_option("FOLDER", share, "The folder to write them below, such as ~/.local/share")
        ->required();
    manual_app.callback([&] { action = [&] { return manual_command(app, share); }; });
    add_examples(app);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == int(CLI::ExitCodes::Success))
            return app.exit(error);  // --help, --version
        throw UsageError(usage_message(app, argc, argv, error));
    }
    const int code = action();
    // A full disk under a pipe is noticed here at the latest.
    if (std::fflush(stdout) != 0 || std::ferror(stdout))
        throw core::InputError(std::string("the standard output cannot be written: ") + std::strerror(errno));
    return code;
}

// An exception that no thread caught, or a second one while the first is on its way.
[[noreturn]] void terminate_quietly() {
    static const char message[] = "mote: internal error: an exception could not be handled\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message, sizeof(message) - 1);
    ::_exit(exit_internal);
}

}  // namespace

int run_command(int argc, char** argv) {
    std::set_terminate(terminate_quietly);
    ignore_file_size_signal();
    session::settle_arithmetic();
    try {
        return parse_and_run(argc, argv);
    } catch (const UsageError& error) {
        print_error(std::string(error.what()) + " (see 'mote --help')");
        return exit_usage;
    } catch (const core::SceneErrors& errors) {
        print_errors(errors);
        return exit_input;
    } catch (const core::InputError& error) {
        print_error(error.what());
        return exit_input;
    } catch (const core::OutOfMemory& error) {
        print_error(std::string("there is not enough memory for ") + error.what());
        return exit_internal;
    } catch (const std::bad_alloc&) {
        print_error("there is not enough memory for this");
        return exit_internal;
    } catch (const std::exception& error) {
        print_error(std::string("internal error: ") + error.what());
        return exit_internal;
    } catch (...) {
        print_error("internal error");
        return exit_internal;
    }
}

}  // namespace mote::apps
