// Man pages (man 7 man) and completions for bash and zsh.
#include "apps/manual_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <span>
#include <vector>

#include "apps/command.h"
#include "core/files/atomic_file.h"
#include "core/objects/error.h"

namespace mote::apps {

namespace {

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
        text.replace(at, what.size(), by);
    return text;
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// The words that an option accepts, from a type name such as "TEXT:{oidn,bmfr}"; empty: any.
std::vector<std::string> choices(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    const std::size_t begin = type.find('{'), end = type.find('}');
    return begin == std::string::npos || end == std::string::npos
               ? std::vector<std::string>{}
               : CLI::detail::split(type.substr(begin + 1, end - begin - 1), ',');
}

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

std::vector<std::string> names(const CLI::Option& option) {
    std::vector<std::string> all;
    for (const std::string& name : option.get_snames()) all.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) all.push_back("--" + name);
    return all;
}

std::vector<const CLI::App*> commands(const CLI::App& app) {
    const auto found = app.get_subcommands([](const CLI::App*) { return true; });
    return {found.begin(), found.end()};
}

// ---- Man pages

std::string roff(std::string text) {
    text = replaced(replaced(std::move(text), "\\", "\\e"), "-", "\\-");
    return text.starts_with('.') || text.starts_with('\'') ? "\\&" + text : text;
}

std::string man_heading(const std::string& name, const std::string& description) {
    return fmt::format(".TH {} 1 \"\" \"mote {}\"\n.SH NAME\n{} \\- {}\n", name, MOTE_VERSION, roff(name),
                       roff(description));
}

std::string man_option(const CLI::Option& option) {
    std::string value = option.get_type_name();
    if (const auto words = choices(option); !words.empty()) value = fmt::format("{}", fmt::join(words, "|"));
    std::string shown;
    for (const std::string& name : names(option))
        shown += (shown.empty() ? "" : ", ") + ("\\fB" + roff(name) + "\\fR");
    if (takes_value(option)) shown += " \\fI" + roff(value) + "\\fR";
    return ".TP\n" + shown + "\n" + roff(option.get_description()) + "\n";
}

std::string man_page(const CLI::App& command) {
    std::string page = man_heading("mote-" + command.get_name(), command.get_description());
    std::string synopsis = ".SH SYNOPSIS\n\\fBmote " + command.get_name() + "\\fR [\\fIoptions\\fR]",
                operands, options;
    for (const CLI::Option* option : command.get_options()) {
        if (!names(*option).empty()) {
            options += man_option(*option);
            continue;
        }
        synopsis += " \\fI" + roff(option->get_name(true)) + "\\fR" +
                    (option->get_items_expected_max() > 1 ? " ..." : "");
        operands +=
            ".TP\n\\fI" + roff(option->get_name(true)) + "\\fR\n" + roff(option->get_description()) + "\n";
    }
    page += synopsis + "\n.SH OPTIONS\n" + operands + options;
    if (const std::string footer = command.get_footer(); !footer.empty())
        page += ".SH EXAMPLES\n.nf\n" + roff(footer.substr(footer.find('\n') + 1)) + "\n.fi\n";
    return page + ".SH SEE ALSO\n.BR mote (1)\n";
}

std::string man_page_of_all(const CLI::App& app) {
    std::string page = man_heading("mote", "many-light rendering and participating media");
    page += ".SH SYNOPSIS\n\\fBmote\\fR \\fIcommand\\fR [\\fIoptions\\fR]\n.SH COMMANDS\n";
    for (const CLI::App* c : commands(app))
        page += fmt::format(".TP\n.BR mote\\-{} (1)\n{}\n", c->get_name(), roff(c->get_description()));
    return page + fmt::format(
                      ".SH EXIT STATUS\n{} done, {} the input is at fault, {} wrong usage, {} an error of "
                      "mote, or no "
                      "memory; 128 and the signal's number where a render was interrupted.\n",
                      int(exit_ok), int(exit_input), int(exit_usage), int(exit_internal));
}

// ---- Completions

std::string bash_completion(const CLI::App& app) {
    std::string values, options, names_of_commands;
    for (const CLI::App* c : commands(app)) {
        names_of_commands += c->get_name() + " ";
        std::string words;
        for (const CLI::Option* option : c->get_options()) {
            if (names(*option).empty()) continue;
            words += joined(names(*option)) + " ";
            if (!takes_value(*option)) continue;
            const auto allowed = choices(*option);
            for (const std::string& name : names(*option))
                values += fmt::format(
                    "    \"{} {}\") {} ;;\n", c->get_name(), name,
                    allowed.empty()
                        ? "COMPREPLY=($(compgen -f -- \"$word\"))"
                        : fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$word\"))", joined(allowed)));
        }
        options += fmt::format("    {}) options='{}' ;;\n", c->get_name(), words);
    }
    return fmt::format(R"(# Completion of mote for bash; written by `mote manual`.
_mote() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} command=${{COMP_WORDS[1]}} options=
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W '{}--help --version' -- "$word"))
    return
  fi
  case "$command ${{COMP_WORDS[COMP_CWORD - 1]}}" in
{}    *)
      case $command in
{}      esac
      if [[ $word == -* ]]; then COMPREPLY=($(compgen -W "$options" -- "$word")); else COMPREPLY=($(compgen -f -- "$word")); fi ;;
  esac
}}
complete -o filenames -F _mote mote
)",
                       names_of_commands, values, replaced(options, "    ", "        "));
}

std::string zsh_quoted(std::string text) {
    for (const char* special : {"[", "]", ":"})
        text = replaced(std::move(text), special, std::string("\\") + special);
    return replaced(std::move(text), "'", "'\\''");
}

std::string zsh_completion(const CLI::App& app) {
    std::string described, cases;
    for (const CLI::App* c : commands(app)) {
        described += fmt::format("  '{}:{}'\n", c->get_name(), zsh_quoted(c->get_description()));
        cases += fmt::format("  {}) _arguments \\\n", c->get_name());
        for (const CLI::Option* option : c->get_options()) {
            if (names(*option).empty()) continue;
            const auto allowed = choices(*option);
            std::string value;
            if (takes_value(*option))
                value = ":value:" + (allowed.empty() ? "_files" : "(" + joined(allowed) + ")");
            for (const std::string& name : names(*option))
                cases +=
                    fmt::format("      '*{}[{}]{}' \\\n", name, zsh_quoted(option->get_description()), value);
        }
        cases += "      '*:file:_files' ;;\n";
    }
    return fmt::format(R"(#compdef mote
# Completion of mote for zsh; written by `mote manual`.
local -a commands
commands=(
{})
if ((CURRENT == 2)); then
  _describe command commands
  return
fi
local command=$words[2]
shift words
((CURRENT--))
case $command in
{}esac
)",
                       described, cases);
}

void write(const std::filesystem::path& file, const std::string& text) {
    std::error_code failed;
    std::filesystem::create_directories(file.parent_path(), failed);
    if (failed)
        throw core::InputError("cannot be made: " + failed.message(), {file.parent_path().string(), 0});
    core::write_file_atomically(file.string(), std::as_bytes(std::span(text)));
}

}  // namespace

int manual_command(const CLI::App& app, const std::string& folder) {
    const std::filesystem::path root = folder, pages = root / "man/man1";
    write(pages / "mote.1", man_page_of_all(app));
    for (const CLI::App* command : commands(app))
        write(pages / ("mote-" + command->get_name() + ".1"), man_page(*command));
    write(root / "bash-completion/completions/mote", bash_completion(app));
    write(root / "zsh/site-functions/_mote", zsh_completion(app));
    return exit_ok;
}

}  // namespace mote::apps
