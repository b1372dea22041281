/// The command line of `recald`.
#pragma once

#include <string>
#include <vector>

#include "daemon/commands/console.hpp"

namespace recald::daemon {

/// Parses and runs. @return 0 success, 1 a failure explained in one line, 2 wrong usage.
int run_cli(int argc, const char* const* argv, const Console& console);

/// What `run_cli` would say of these words in the place of running them, by their form alone;
/// empty: it would run them. Runs nothing.
/// @param words  Without the program's name.
[[nodiscard]] std::string wrong_usage_of(const std::vector<std::string>& words);

}  // namespace recald::daemon
