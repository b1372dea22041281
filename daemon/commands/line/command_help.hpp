/// --help of a command: its usual options. --help-all adds the rest.
#pragma once

#include <CLI/CLI.hpp>
#include <initializer_list>
#include <string>

namespace recald::daemon {

/// Layout of both; see `kMoreOptions`.
class CommandHelp : public CLI::Formatter {
 public:
  CommandHelp();
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  /// Without "Excludes": whoever gives two that exclude each other is told.
  std::string make_option_opts(const CLI::Option* option) const override;

 private:
  [[nodiscard]] std::string option_groups(const CLI::App& app, CLI::AppFormatMode mode) const;
};

/// Leaves all but these options, and what stands without a flag, to --help-all.
void show_first(CLI::App& command, std::initializer_list<const char*> flags);

}  // namespace recald::daemon
