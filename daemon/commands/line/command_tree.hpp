/// What CLI11 knows of the commands, in the words of a command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace recald::daemon {

/// Group of options that few people need: --help leaves them out, --help-all and manual pages do
/// not. CLI11's own group without a name is for what recald alone uses.
inline constexpr const char* kMoreOptions = "More options";

[[nodiscard]] std::vector<const CLI::App*> commands_of(const CLI::App& app);

/// Options, or what stands without a flag, without those for recald alone.
[[nodiscard]] std::vector<const CLI::Option*> options_of(const CLI::App& app, bool positional);

/// --json, -V
[[nodiscard]] std::vector<std::string> flags_of(const CLI::Option& option);

/// "recald model list"
[[nodiscard]] std::string full_name(const CLI::App& command, char between = ' ');

}  // namespace recald::daemon
