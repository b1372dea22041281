#include <unistd.h>

#include <csignal>
#include <exception>
#include <iostream>

#include "daemon/commands/cli.hpp"

int main(int argc, char** argv) {
  // Whoever reads the output may end before it does (| head): the results are written all the same.
  std::signal(SIGPIPE, SIG_IGN);
  const recald::daemon::Console console{std::cout, std::cerr, ::isatty(STDERR_FILENO) == 1};
  try {
    return recald::daemon::run_cli(argc, argv, console);
  } catch (const std::exception& error) {
    // Nothing of ours throws; what arrives here is memory or a library at its end.
    return console.fail(error.what());
  }
}
