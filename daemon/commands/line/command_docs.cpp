#include "daemon/commands/line/command_docs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "daemon/commands/line/command_pages.hpp"
#include "daemon/commands/line/command_tree.hpp"

namespace recald::daemon {
namespace {

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// What stands for the value in a help line: "FILE", "INT", "{epc,hourly}".
std::string value_name(const CLI::Option& option) {
  const std::string own = option.get_option_text();
  return own.empty() ? option.get_type_name() : own;
}

/// The words that an option may take, where they are fixed: CLI11 shows them as "{epc,hourly}".
std::vector<std::string> words_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const auto open = type.find('{');
  const auto close = type.find('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

/// Text as troff takes it: a line may not begin with a dot or a quote.
std::string troff(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else {
      escaped += c;
    }
  }
  if (!escaped.empty() && (escaped.front() == '.' || escaped.front() == '\'')) {
    escaped.insert(0, "\\&");
  }
  return escaped;
}

void add_option(const CLI::Option& option, std::string& page) {
  std::string head;
  if (option.get_positional()) {
    head = fmt::format("\\fI{}\\fR", troff(option.get_name(true)));
  } else {
    std::vector<std::string> flags;
    for (const std::string& flag : flags_of(option)) {
      flags.push_back("\\fB" + troff(flag) + "\\fR");
    }
    head = fmt::format("{}", fmt::join(flags, ", "));
    if (takes_value(option)) head += fmt::format(" \\fI{}\\fR", troff(value_name(option)));
  }
  page += ".TP\n" + head + "\n" + troff(option.get_description());
  if (!option.get_default_str().empty()) {
    page += fmt::format(" (default {})", troff(option.get_default_str()));
  }
  page += "\n";
}

std::string synopsis_of(const CLI::App& command) {
  std::string line = "\\fB" + full_name(command, ' ') + "\\fR";
  if (!commands_of(command).empty()) line += " \\fICOMMAND\\fR";
  for (const CLI::Option* option : options_of(command, true)) {
    const std::string name = troff(option->get_name(true));
    line += option->get_required() ? fmt::format(" \\fI{}\\fR", name)
                                   : fmt::format(" [\\fI{}\\fR]", name);
  }
  return line + " [\\fIOPTIONS\\fR]\n";
}

void add_commands(const CLI::App& app, std::string& page) {
  std::string group;
  for (const CLI::App* command : commands_of(app)) {
    if (command->get_group() != group) {
      group = command->get_group();
      page += ".SS " + troff(group) + "\n";
    }
    page += ".TP\n\\fB" + command->get_name() + "\\fR\n" + troff(command->get_description()) + "\n";
  }
}

struct Candidate {
  std::string word;
  std::string meaning;
};

std::vector<Candidate> candidates_of(const CLI::App& app) {
  std::vector<Candidate> all;
  for (const CLI::App* command : commands_of(app)) {
    all.push_back({command->get_name(), command->get_description()});
  }
  for (const CLI::Option* option : options_of(app, false)) {
    for (const std::string& flag : flags_of(*option)) {
      all.push_back({flag, option->get_description()});
    }
  }
  return all;
}

/// Calls `visit` with the app and every command below it, by the words that lead there.
template <class Visit>
void for_each_command(const CLI::App& app, const std::string& path, const Visit& visit) {
  visit(app, path);
  for (const CLI::App* command : commands_of(app)) {
    for_each_command(*command,
                     path.empty() ? command->get_name() : path + " " + command->get_name(), visit);
  }
}

std::vector<std::string> all_flags_of(const CLI::App& command) {
  std::vector<std::string> all;
  for (const CLI::Option* option : options_of(command, false)) {
    const auto flags = flags_of(*option);
    all.insert(all.end(), flags.begin(), flags.end());
  }
  return all;
}

/// Words typed so far that are commands lead to what may follow; where no command may, files do.
std::string bash_script(const CLI::App& app) {
  std::string lists;
  std::string values;
  std::vector<std::string> paths;
  for_each_command(app, "", [&](const CLI::App& command, const std::string& path) {
    if (!path.empty()) paths.push_back("\"" + path + "\"");
    std::vector<std::string> below;
    for (const CLI::App* one : commands_of(command)) below.push_back(one->get_name());
    lists += fmt::format("    \"{}\") commands=\"{}\" flags=\"{}\" ;;\n", path,
                         fmt::join(below, " "), fmt::join(all_flags_of(command), " "));
    for (const CLI::Option* option : options_of(command, false)) {
      const auto words = words_of(*option);
      if (words.empty()) continue;
      for (const std::string& flag : flags_of(*option)) {
        values +=
            fmt::format("    \"{} {}\") values=\"{}\" ;;\n", path, flag, fmt::join(words, " "));
      }
    }
  });
  return fmt::format(R"(# bash completion of recald
_recald() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}}
  local path= next= values= commands= flags= i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    next="${{path:+$path }}${{COMP_WORDS[i]}}"
    case "$next" in
    {}) path=$next ;;
    esac
  done
  case "$path $before" in
{}  esac
  case "$path" in
{}  esac
  if [[ -n $values ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$values" -- "$current")
  elif [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$flags" -- "$current")
  elif [[ -n $commands ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$current")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  fi
}}
complete -o filenames -F _recald recald
)",
                     fmt::join(paths, " | "), values, lists);
}

/// 'text' for a shell, within single quotes.
std::string quoted(std::string text) {
  for (std::size_t at = 0; (at = text.find('\'', at)) != std::string::npos; at += 4) {
    text.replace(at, 1, "'\\''");
  }
  return "'" + text + "'";
}

/// zsh's _describe takes "word:meaning".
std::string described(const Candidate& candidate) {
  std::string meaning = candidate.meaning;
  std::replace(meaning.begin(), meaning.end(), ':', ';');
  return quoted(candidate.word + ":" + meaning);
}

std::string zsh_script(const CLI::App& app) {
  std::string lists;
  std::vector<std::string> paths;
  for_each_command(app, "", [&](const CLI::App& command, const std::string& path) {
    std::vector<std::string> words;
    for (const Candidate& candidate : candidates_of(command)) words.push_back(described(candidate));
    lists += fmt::format("    \"{}\") choices=({}) ;;\n", path, fmt::join(words, " "));
    if (!path.empty()) paths.push_back("\"" + path + "\"");
  });
  return fmt::format(R"(#compdef recald
_recald() {{
  local -a choices
  local path_so_far= next i
  for ((i = 2; i < CURRENT; ++i)); do
    next="${{path_so_far:+$path_so_far }}${{words[i]}}"
    case "$next" in
    {}) path_so_far=$next ;;
    esac
  done
  case "$path_so_far" in
{}  esac
  _describe 'recald' choices
  _files
}}
_recald "$@"
)",
                     fmt::join(paths, "|"), lists);
}

std::string fish_script(const CLI::App& app) {
  std::string script = "# fish completion of recald\n";
  for_each_command(app, "", [&](const CLI::App& command, const std::string& path) {
    const std::string when = path.empty() ? "__fish_use_subcommand"
                                          : "__fish_seen_subcommand_from " + command.get_name();
    for (const CLI::App* below : commands_of(command)) {
      script += fmt::format("complete -c recald -n '{}' -f -a {} -d {}\n", when, below->get_name(),
                            quoted(below->get_description()));
    }
    for (const CLI::Option* option : options_of(command, false)) {
      std::string line = fmt::format("complete -c recald -n '{}'", when);
      for (const std::string& name : option->get_snames()) line += " -s " + name;
      for (const std::string& name : option->get_lnames()) line += " -l " + name;
      const auto words = words_of(*option);
      if (!words.empty()) {
        line += " -x -a " + quoted(fmt::format("{}", fmt::join(words, " ")));
      } else if (takes_value(*option)) {
        line += " -r";
      }
      script += line + " -d " + quoted(option->get_description()) + "\n";
    }
  });
  return script;
}

/// Its words without the program's: "model list", as pages are found by.
std::string page_name(const CLI::App& command) {
  return command.get_parent() == nullptr ? std::string{}
                                         : full_name(command).substr(std::string{"recald "}.size());
}

void add_page(const CommandPage& own, std::string& page) {
  page += ".SH EXAMPLES\n";
  for (const CommandExample& example : own.examples) {
    page +=
        fmt::format(".TP\n{}\n.nf\n\\fB{}\\fR\n.fi\n", troff(example.what), troff(example.line));
  }
  page += ".SH FILES\n";
  if (own.files.empty()) page += "None but what the options name.\n";
  for (const CommandFile& file : own.files) {
    page += fmt::format(".TP\n\\fI{}\\fR\n{}.\n", troff(file.name), troff(file.what));
  }
}

/// Commands beside it or below it, by their pages.
std::string see_also(const CLI::App& command) {
  std::vector<std::string> others;
  if (const CLI::App* parent = command.get_parent()) {
    others.push_back(fmt::format(".BR {} (1)", troff(full_name(*parent, '-'))));
  }
  for (const CLI::App* one : commands_of(command)) {
    others.push_back(fmt::format(".BR {} (1)", troff(full_name(*one, '-'))));
  }
  return fmt::format(".SH SEE ALSO\n{}\n", fmt::join(others, ",\n"));
}

constexpr const char* kExitStatus = R"(.SH EXIT STATUS
.TP
.B 0
Success.
.TP
.B 1
A failure that one sentence on standard error explains.
.TP
.B 2
Wrong usage: nothing was done.
.TP
.B 130
Ended by Ctrl\-C (SIGINT).
.TP
.B 143
Ended by SIGTERM.
)";

}  // namespace

std::string man_page(const CLI::App& command, std::string_view version) {
  const std::string name = full_name(command, '-');
  const CommandPage* own = find_command_page(page_name(command));
  std::string page = fmt::format(".TH {} 1 \"\" \"recald {}\" \"User Commands\"\n", name, version);
  page += fmt::format(".SH NAME\n{} \\- {}\n", troff(name), troff(command.get_description()));
  page += ".SH SYNOPSIS\n" + synopsis_of(command);
  if (own != nullptr) page += fmt::format(".SH DESCRIPTION\n{}\n", troff(own->description));
  if (!commands_of(command).empty()) {
    page += ".SH COMMANDS\n";
    add_commands(command, page);
  }
  page += ".SH OPTIONS\n";
  for (const bool positional : {true, false}) {
    for (const CLI::Option* option : options_of(command, positional)) add_option(*option, page);
  }
  if (own != nullptr) add_page(*own, page);
  return page + kExitStatus + see_also(command);
}

std::string completion_script(const CLI::App& app, std::string_view shell) {
  if (shell == "bash") return bash_script(app);
  if (shell == "zsh") return zsh_script(app);
  return shell == "fish" ? fish_script(app) : std::string{};
}

}  // namespace recald::daemon
