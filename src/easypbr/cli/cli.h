// The command line: `easypbr COMMAND ...`.
#pragma once

namespace easypbr::cli {

/// Runs one command line, argv[0] included. Returns the exit code: 0; 1 when the job failed; 2 when the
/// command is wrong. Results go to stdout, one line per error or warning to stderr. Never throws. The
/// process-wide log and progress sinks are replaced while it runs, and silent afterwards.
int run(int argc, const char* const* argv);

}  // namespace easypbr::cli
