#include "daemon/commands/line/command_help.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "daemon/commands/line/command_tree.hpp"

namespace recald::daemon {
namespace {

using ListedOptions = std::vector<const CLI::Option*>;

ListedOptions options_in(const CLI::App& app, std::string_view group) {
  ListedOptions listed;
  for (const CLI::Option* option : options_of(app, false)) {
    if (option->get_group() == group) listed.push_back(option);
  }
  return listed;
}

/// -q and -v, which may stand behind any command.
ListedOptions of_every_command(const CLI::App& command) {
  const CLI::App* root = &command;
  while (root->get_parent() != nullptr) root = root->get_parent();
  if (root == &command) return {};
  ListedOptions listed = options_of(*root, false);
  std::erase_if(listed, [&](const CLI::Option* option) {
    return option == root->get_help_ptr() || option == root->get_help_all_ptr() ||
           option == root->get_version_ptr();
  });
  return listed;
}

}  // namespace

CommandHelp::CommandHelp() { label("SUBCOMMAND", "COMMAND"); }

std::string CommandHelp::make_help(const CLI::App* app, std::string name,
                                   CLI::AppFormatMode mode) const {
  if (mode == CLI::AppFormatMode::Sub) return make_expanded(app);
  return make_description(app) + make_usage(app, std::move(name)) + make_positionals(app) +
         option_groups(*app, mode) + make_subcommands(app, mode) + "\n" + make_footer(app);
}

std::string CommandHelp::option_groups(const CLI::App& app, CLI::AppFormatMode mode) const {
  std::string text;
  const auto add = [&](const std::string& name, const ListedOptions& options) {
    if (!options.empty()) text += make_group(name, false, options);
  };
  for (const std::string& group : app.get_groups()) {
    if (group != kMoreOptions) add(group, options_in(app, group));
  }
  const ListedOptions more = options_in(app, kMoreOptions);
  if (mode == CLI::AppFormatMode::All) add(kMoreOptions, more);
  add("Options of every command", of_every_command(app));
  if (mode == CLI::AppFormatMode::Normal && !more.empty()) {
    text += fmt::format("\n{} --help-all shows {} more options.\n", full_name(app), more.size());
  }
  return text;
}

std::string CommandHelp::make_option_opts(const CLI::Option* option) const {
  if (!option->get_option_text().empty()) return " " + option->get_option_text();
  std::string text;
  if (option->get_type_size() != 0) {
    if (!option->get_type_name().empty()) text += " " + get_label(option->get_type_name());
    if (!option->get_default_str().empty()) text += "=" + option->get_default_str();
    if (option->get_expected_max() == CLI::detail::expected_max_vector_size) text += " ...";
    if (option->get_required()) text += " " + get_label("REQUIRED");
  }
  for (const CLI::Option* needed : option->get_needs()) text += " Needs: " + needed->get_name();
  return text;
}

void show_first(CLI::App& command, std::initializer_list<const char*> flags) {
  for (const char* flag : flags) command.get_option(flag);  // throws where there is none
  for (CLI::Option* option : command.get_options({})) {
    const bool is_shown =
        option->get_positional() || option->get_group().empty() ||
        option == command.get_help_ptr() || option == command.get_help_all_ptr() ||
        std::ranges::any_of(flags, [&](const char* flag) { return option->check_name(flag); });
    if (!is_shown) option->group(kMoreOptions);
  }
  command.set_help_all_flag("--help-all", "Print this help with all options and exit");
}

}  // namespace recald::daemon
