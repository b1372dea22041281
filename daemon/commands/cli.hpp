/// The command line of `recald`.
#pragma once

#include "daemon/commands/console.hpp"

namespace recald::daemon {

/// Parses and runs. @return 0 success, 1 a failure explained in one line, 2 wrong usage.
int run_cli(int argc, const char* const* argv, const Console& console);

}  // namespace recald::daemon
