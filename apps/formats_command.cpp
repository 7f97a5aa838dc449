// mote formats: the scene language, from the manual pages that the program itself uses.
#include <cstdio>
#include <string>
#include <vector>

#include "apps/command.h"
#include "apps/subcommands.h"
#include "core/formats/xml/scene_format.h"

namespace mote::apps {

int formats_command(const std::vector<std::string>& plugins) {
    std::fputs(core::scene_format_markdown(make_registry(plugins)).c_str(), stdout);
    return exit_ok;
}

}  // namespace mote::apps
