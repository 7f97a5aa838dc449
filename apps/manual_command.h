// mote manual: man pages and completions, all from the options that the command declares.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace mote::apps {

/// Gives each command its examples, as the last lines of its --help.
void add_examples(CLI::App& app);
/// Writes man/man1, bash-completion/completions and zsh/site-functions below `folder`. Throws InputError.
int manual_command(const CLI::App& app, const std::string& folder);

}  // namespace mote::apps
