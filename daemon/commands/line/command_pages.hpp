/// What manual pages say beyond options: a description, examples, files.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace recald::daemon {

struct CommandExample {
  std::string_view line;  ///< As typed into a shell: "recald check site.toml".
  std::string_view what;  ///< What it is for, without a full stop.
};

struct CommandFile {
  std::string_view name;
  std::string_view what;  ///< A sentence without a full stop: who reads or writes it.
};

struct CommandPage {
  std::string_view command;  ///< "model list"; empty: recald itself.
  std::string_view description;
  std::vector<CommandExample> examples;
  std::vector<CommandFile> files;  ///< Empty: none but what the options name.
};

[[nodiscard]] std::span<const CommandPage> command_pages();

/// @return nullptr if no command has this name.
[[nodiscard]] const CommandPage* find_command_page(std::string_view command);

}  // namespace recald::daemon
