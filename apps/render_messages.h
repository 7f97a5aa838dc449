// Messages of `mote render` on stderr besides its progress.
#pragma once

#include <string>

#include "apps/render_files.h"

namespace mote::apps {

/// "mote: TEXT", a line of its own.
void note(const std::string& text);

/// Warnings, and with --verbose the seconds of each phase.
void report_render(const RenderArguments& arguments, const Rendered& rendered);
/// "a.exr holds 12.5 % of its pixels, the others have alpha 0"
std::string finished_text(const RenderFiles& files, const Rendered& rendered);
/// Says how much there is, and how to continue. Returns the exit code.
int report_interruption(const RenderArguments& arguments, const RenderFiles& files, const Rendered& rendered,
                        int signal_number);

}  // namespace mote::apps
