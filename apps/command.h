// The `mote` command line: subcommands, exit codes, and the one place where errors become lines of text.
#pragma once

namespace mote::apps {

/// Fixed for scripts: 0 done, 1 the input is at fault, 2 wrong usage, 3 our fault (or no memory). A render
/// that was interrupted and saved ends with 128 + the signal's number, as shells expect.
enum ExitCode : int { exit_ok = 0, exit_input = 1, exit_usage = 2, exit_internal = 3 };

/// Runs the command line. Never throws; an error is one line on stderr.
int run_command(int argc, char** argv);

}  // namespace mote::apps
