/// Man pages and shell completions, made from the command line's own definition.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>

namespace recald::daemon {

/// A page for man(1) in troff: `app` alone lists the commands; a command has its options.
[[nodiscard]] std::string man_page(const CLI::App& command, std::string_view version);

/// A script for "bash", "zsh" or "fish" that completes commands, options, their values and files.
/// Empty for another shell.
[[nodiscard]] std::string completion_script(const CLI::App& app, std::string_view shell);

}  // namespace recald::daemon
