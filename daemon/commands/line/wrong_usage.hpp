/// What is wrong with a command line, in one sentence that says what was probably meant.
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace recald::daemon {

/// The command that the words lead to, whatever else stands among them.
[[nodiscard]] const CLI::App& command_at(const CLI::App& app, std::span<const std::string> words);

/// The first word that is no command or no option, with the nearest that there is; empty where
/// there is none. CLI11 would take the word after a misspelt option for a file, say first what
/// else is missing, and answer --help before it looks.
/// @param words  Without the program's name.
[[nodiscard]] std::string unknown_word(const CLI::App& app, std::span<const std::string> words);

/// CLI11's other complaints. @param error  Of `app`'s parse.
[[nodiscard]] std::string sentence_of(const CLI::App& app, const CLI::ParseError& error);

/// A value is one of these words; of another the nearest is named.
[[nodiscard]] CLI::Validator one_of(std::vector<std::string> words);

}  // namespace recald::daemon
