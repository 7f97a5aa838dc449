#include "apps/sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>

#include "apps/command.h"
#include "apps/frame_files.h"
#include "apps/subcommands.h"
#include "core/formats/pictures/image_file.h"
#include "core/objects/error.h"
#include "session/reference_metadata.h"

namespace mote::apps {

namespace {

namespace fs = std::filesystem;

constexpr double max_frames = 1e6;

std::optional<double> number(const std::string& text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
}

/// The parts between separators as numbers, where there are at least two and all of them are.
std::vector<double> numbers_of(const std::string& text, char separator) {
    std::vector<double> values;
    for (std::size_t at = 0;;) {
        const std::size_t end = text.find(separator, at);
        const auto value = number(text.substr(at, end == std::string::npos ? end : end - at));
        if (!value) return {};
        values.push_back(*value);
        if (end == std::string::npos) break;
        at = end + 1;
    }
    return values.size() > 1 ? values : std::vector<double>{};
}

std::vector<double> range(const std::vector<double>& ends, const std::string& define) {
    const double first = ends.front(), last = ends.back();
    const double step = ends.size() == 3 ? ends[1] : last < first ? -1.0 : 1.0;
    if (ends.size() > 3 || step == 0.0 || (last - first) / step < 0.0)
        throw UsageError(
            "-D " + core::printable(define) +
            ": expected name=FIRST:LAST or name=FIRST:STEP:LAST, with a step that leads to the end");
    // A last value that rounding keeps from being met belongs to it.
    const double steps = std::floor((last - first) / step + 1e-9);
    if (steps + 1.0 > max_frames)
        throw UsageError("-D " + core::printable(define) + ": more than a million frames");
    std::vector<double> values;
    for (double i = 0.0; i <= steps; i += 1.0) values.push_back(first + i * step);
    return values;
}

RunningParameter running(std::size_t define, const std::vector<double>& values) {
    RunningParameter parameter;
    parameter.define = define;
    bool whole = true;
    for (const double v : values) whole &= v >= 0.0 && v == std::floor(v) && v < 1e9;
    for (const double v : values) {
        parameter.numbers.push_back(whole ? int(v) : int(parameter.numbers.size()));
        parameter.values.push_back(fmt::format("{:.12g}", v));
    }
    return parameter;
}

}  // namespace

std::optional<RunningParameter> running_parameter(const std::vector<std::string>& defines) {
    std::optional<RunningParameter> found;
    for (const char separator : {':', ','}) {
        for (std::size_t i = 0; i < defines.size(); ++i) {
            const std::size_t equals = defines[i].find('=');
            if (equals == std::string::npos) continue;
            const std::vector<double> values = numbers_of(defines[i].substr(equals + 1), separator);
            if (values.empty()) continue;
            if (found)
                throw UsageError("-D " + core::printable(defines[found->define]) + " and -D " +
                                 core::printable(defines[i]) + ": one parameter can run, not two");
            found = running(i, separator == ':' ? range(values, defines[i]) : values);
        }
        if (found) break;  // with a range, lists of numbers are colours and points
    }
    return found;
}

std::optional<FrameBefore> frame_before(SequenceFrame& sequence) {
    if (!sequence.previous) return std::nullopt;
    if (!sequence.before)
        sequence.before = LoadedScene::frame_of(load(*sequence.previous, sequence.registry));
    return FrameBefore{sequence.before, frame_before_settings(scene_changes(*sequence.previous))};
}

bool finished_before(const RenderArguments& arguments, const RenderFiles& files) {
    std::error_code ignored;
    if (!arguments.sequence || !arguments.resume || fs::exists(files.checkpoint, ignored) ||
        !fs::exists(files.picture, ignored))
        return false;
    try {
        const auto metadata = core::read_exr_metadata(files.picture);
        const auto entry = [&](const char* key) {
            const auto it = metadata.find(key);
            return it != metadata.end() ? it->second : std::string();
        };
        const std::vector<std::string> inputs = lines_of(entry(scene_files_key));
        if (inputs.empty() || metadata.contains("partOfFirstPass")) return false;
        std::vector<std::string> settings =
            render_settings(scene_changes(arguments.scene), entry("integrator"));
        if (arguments.auxiliary && arguments.sequence->previous)
            std::ranges::copy(frame_before_settings(scene_changes(*arguments.sequence->previous)),
                              std::back_inserter(settings));
        return entry("sceneHash") == core::content_hash(inputs, settings) &&
               entry("seed") == std::to_string(arguments.seed) &&
               (!arguments.passes || entry("passes") == std::to_string(*arguments.passes));
    } catch (const core::InputError&) {
        return false;  // damaged, or a file is gone: it is made anew
    }
}

int render_sequence(const RenderArguments& arguments) {
    const auto parameter = running_parameter(arguments.scene.defines);
    if (!parameter || !names_frames(arguments.output)) return render_command(arguments);
    if (!arguments.pass_range.empty())
        throw UsageError(
            "--pass-range is for one picture: frames of a sequence are shared out by their numbers");
    if (!arguments.stats.empty() && !names_frames(arguments.stats))
        throw UsageError("the statistics of a sequence need #### where the frame's number goes");
    const std::string& define = arguments.scene.defines[parameter->define];
    const std::size_t frames = parameter->values.size();
    SequenceFrame sequence{std::make_shared<const core::Registry>(make_registry(arguments.scene.plugins))};
    for (std::size_t i = 0; i < frames; ++i) {
        const int number = parameter->numbers[i];
        RenderArguments frame = arguments;
        frame.scene.defines[parameter->define] =
            define.substr(0, define.find('=') + 1) + parameter->values[i];
        frame.scene.frame = number;
        frame.output = frame_name(arguments.output, number);
        if (!arguments.stats.empty()) frame.stats = frame_name(arguments.stats, number);
        frame.seed =
            arguments.seed + std::uint64_t(number);  // noise that stands still would look like texture
        frame.sequence = &sequence;
        if (!arguments.quiet)
            std::fputs(fmt::format("mote: frame {} of {}: {}\n", i + 1, frames,
                                   core::printable(frame.scene.defines[parameter->define]))
                           .c_str(),
                       stderr);
        if (const int code = render_command(frame); code != exit_ok) {
            if (!arguments.quiet && i + 1 < frames)
                std::fputs(
                    fmt::format("mote: {} frames are left; --resume continues with this one\n", frames - i)
                        .c_str(),
                    stderr);
            return code;
        }
        sequence.previous = frame.scene;
        sequence.before.reset();
        // Also without motion: meshes that the next frame has as well are kept as long as they are referred
        // to.
        if (sequence.rendered) sequence.before = LoadedScene::frame_of(std::move(*sequence.rendered));
        sequence.rendered.reset();
    }
    return exit_ok;
}

}  // namespace mote::apps
