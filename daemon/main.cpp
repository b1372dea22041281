#include <unistd.h>

#include <exception>
#include <iostream>

#include "daemon/commands/cli.hpp"

int main(int argc, char** argv) {
  const recald::daemon::Console console{std::cout, std::cerr, ::isatty(STDERR_FILENO) == 1};
  try {
    return recald::daemon::run_cli(argc, argv, console);
  } catch (const std::exception& error) {
    // Nothing of ours throws; what arrives here is memory or a library at its end.
    return console.fail(error.what());
  }
}
