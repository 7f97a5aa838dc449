#include "apps/render_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/progress_line.h"
#include "core/objects/error.h"
#include "session/render_report.h"

namespace mote::apps {

namespace {

/// A second is not always enough for what comes after the last pass.
std::string unfinished_text(const Rendered& rendered) {
    const std::uint32_t passes = *rendered.finished_for;
    return fmt::format(
        "filters or compensation of the whole picture take too long to wait for and are {}; with '--resume "
        "--passes {}' they are made now",
        passes > 0 ? fmt::format("those of the preview after pass {}", passes) : "left out", rendered.passes);
}

void report_continuation(const RenderArguments& arguments, const RenderFiles& files,
                         const Rendered& rendered) {
    std::vector<std::string> command = arguments.command_line;
    if (!arguments.resume) command.emplace_back("--resume");
    note(arguments.pass_range.empty()
             ? fmt::format("interrupted after {} passes: {} holds the picture so far", rendered.passes,
                           files.picture)
             : fmt::format("interrupted after {} passes of the range: {} is not written", rendered.passes,
                           files.picture));
    note("continue with: " + quoted(command));
    if (rendered.finished_for) note(unfinished_text(rendered));
}

}  // namespace

void note(const std::string& text) { std::fputs(fmt::format("mote: {}\n", text).c_str(), stderr); }

void report_render(const RenderArguments& arguments, const Rendered& rendered) {
    const core::Statistics& counts = rendered.counts;
    if (!arguments.quiet)
        for (const std::string& warning : rendered.warnings) note("warning: " + warning);
    if (!arguments.quiet && rendered.error && std::isfinite(rendered.error->high)) {
        const std::string noise =
            std::isfinite(rendered.noise) ? fmt::format(", noise {:.2g} %", 100.0 * rendered.noise) : "";
        note(error_text(*rendered.error) + noise);
    }
    if (!arguments.quiet && arguments.verbose) {
        for (const auto& [name, seconds] : counts.seconds)
            std::fputs(fmt::format("  {:12} {:9.3f} s\n", name, seconds).c_str(), stderr);
        std::fputs(
            fmt::format("  {:12} {:9.1f} MB\n", "peak memory", double(peak_memory_bytes()) * 1e-6).c_str(),
            stderr);
    }
    if (counts.non_finite_samples > 0)  // a defect of ours: also with --quiet
        note(fmt::format(
            "WARNING: {} pixel samples were NaN or infinite and count as black; please report this scene",
            counts.non_finite_samples));
    if (arguments.denoise.empty() || rendered.image.names.empty()) return;
    if (!rendered.finished_pixels.empty() || !rendered.missing_layers.empty())
        note("a part of a picture is not denoised");
}

std::string finished_text(const RenderFiles& files, const Rendered& rendered) {
    return fmt::format("{} holds {:.1f} % of its pixels, the others have alpha 0", files.picture,
                       100.0 * finished_fraction(rendered.finished_pixels));
}

int report_interruption(const RenderArguments& arguments, const RenderFiles& files, const Rendered& rendered,
                        int signal_number) {
    const std::string passes = fmt::format("interrupted after {} passes: ", rendered.passes);
    if (!rendered.finished_pixels.empty()) {
        note("interrupted in the first pass: " + finished_text(files, rendered) +
             "; there is nothing to resume");
    } else if (rendered.passes == 0) {
        note("interrupted before the first pixel was complete: there is nothing to write");
    } else if (arguments.pass_range.empty() && !rendered.missing_layers.empty()) {
        note(fmt::format("interrupted before every layer had a pass: {} holds the picture without {}",
                         files.picture, fmt::join(rendered.missing_layers, ", ")));
    } else {
        if (!arguments.denoise.empty() && arguments.pass_range.empty())
            note(fmt::format("not denoised: 'mote denoise {}{}' does it",
                             arguments.denoise == "bmfr" ? "--method bmfr " : "",
                             core::printable(files.picture, 300)));
        if (!rendered.checkpoint_problem.empty())
            note(passes + fmt::format("{} holds the picture so far, but it cannot be resumed ({})",
                                      files.picture, rendered.checkpoint_problem));
        else
            report_continuation(arguments, files, rendered);
    }
    return 128 + signal_number;
}

}  // namespace mote::apps
