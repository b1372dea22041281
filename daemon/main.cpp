#include <unistd.h>

#include <csignal>
#include <exception>
#include <iostream>

#include "daemon/commands/line/cli.hpp"
#include "daemon/commands/line/terminal_text.hpp"

int main(int argc, char** argv) {
  // Whoever reads the output may end before it does (| head): the results are written all the same.
  std::signal(SIGPIPE, SIG_IGN);
  const bool is_somebody_there = ::isatty(STDIN_FILENO) == 1 && ::isatty(STDOUT_FILENO) == 1;
  // A file or a program gets what is written as it is.
  const bool is_shown = ::isatty(STDOUT_FILENO) == 1;
  recald::daemon::TerminalText seen{*std::cout.rdbuf()};
  recald::daemon::TerminalText seen_errors{*std::cerr.rdbuf()};
  std::ostream out{is_shown ? &seen : std::cout.rdbuf()};
  std::ostream errors{&seen_errors};
  errors << std::unitbuf;
  const recald::daemon::Console console{out, errors, ::isatty(STDERR_FILENO) == 1,
                                        recald::daemon::Console::Detail::usual,
                                        is_somebody_there ? &std::cin : nullptr};
  try {
    return recald::daemon::run_cli(argc, argv, console);
  } catch (const std::exception& error) {
    // Nothing of ours throws; what arrives here is memory or a library at its end.
    return console.fail(error.what());
  }
}
