#include "daemon/commands/line/wrong_usage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/text/ascii.hpp"
#include "core/text/nearest.hpp"
#include "core/text/printable.hpp"
#include "daemon/commands/line/command_tree.hpp"

namespace recald::daemon {
namespace {

using TypedWords = std::span<const std::string>;

const CLI::App* subcommand_named(const CLI::App& app, const std::string& name) {
  for (const CLI::App* one : commands_of(app)) {
    if (one->get_name() == name) return one;
  }
  return nullptr;
}

/// Of the command itself or of one that it belongs to: recald check site.toml -q.
const CLI::Option* option_named(const CLI::App& command, const std::string& flag) {
  for (const CLI::App* app = &command; app != nullptr; app = app->get_parent()) {
    if (const CLI::Option* option = app->get_option_no_throw(flag)) return option;
  }
  return nullptr;
}

std::vector<std::string> flags_for_people(const CLI::App& command) {
  std::vector<std::string> flags;
  for (const CLI::App* app = &command; app != nullptr; app = app->get_parent()) {
    for (const CLI::Option* option : options_of(*app, false)) {
      for (std::string& flag : flags_of(*option)) flags.push_back(std::move(flag));
    }
  }
  return flags;
}

std::string_view nearest_of(std::string_view word, const std::vector<std::string>& words) {
  const std::vector<std::string_view> views(words.begin(), words.end());
  return nearest_name(word, views);
}

/// @param rest  The words behind the flag.
std::string unknown_option(const CLI::App& app, const std::string& flag, TypedWords rest) {
  const CLI::App& command = command_at(app, rest);
  const std::string words = full_name(command);
  if (&command != &app && option_named(command, flag) != nullptr) {
    return fmt::format("{} stands before its command; write {} {}", flag, words, flag);
  }
  const std::vector<std::string> flags = flags_for_people(command);
  // -out has a hyphen too few, which is not all that may be wrong with it.
  const std::string as_long = flag.starts_with("--") || flag.size() < 3 ? flag : "-" + flag;
  // Every letter is as near to -q as any other.
  const std::string_view nearest = flag.size() < 3 ? "" : nearest_of(as_long, flags);
  return fmt::format("{} has no option '{}'; {}", words, printable(flag),
                     nearest.empty() ? fmt::format("see {} --help", words)
                                     : fmt::format("did you mean '{}'?", nearest));
}

std::string unknown_command(const CLI::App& app, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* one : commands_of(app)) names.push_back(one->get_name());
  const std::string_view nearest = nearest_of(to_lower(word), names);
  const std::string above = app.get_parent() == nullptr ? "" : app.get_name() + " ";
  return fmt::format("there is no command '{}{}'; {}", above, printable(word),
                     nearest.empty() ? fmt::format("see {} --help", full_name(app))
                                     : fmt::format("did you mean '{}'?", nearest));
}

/// How many words behind its flag an option takes at least.
std::size_t words_taken(const CLI::Option& option) {
  return static_cast<std::size_t>(
      std::max(0, std::min(option.get_type_size_min(), option.get_items_expected_min())));
}

/// -qv are two flags. @param taken  Becomes how many of the words behind belong to it.
std::string unknown_letter(const CLI::App& command, const std::string& word, TypedWords rest,
                           std::size_t& taken) {
  for (std::size_t i = 1; i < word.size(); ++i) {
    const CLI::Option* option = option_named(command, std::string{"-"} + word[i]);
    if (option == nullptr) return unknown_option(command, word, rest);
    if (words_taken(*option) == 0) continue;
    if (i + 1 == word.size()) taken = words_taken(*option);
    break;  // what follows is its value
  }
  return {};
}

/// @param taken  As above.
std::string unknown_flag(const CLI::App& command, const std::string& word, TypedWords rest,
                         std::size_t& taken) {
  const auto equals = word.find('=');
  const std::string flag = word.substr(0, equals);
  const CLI::Option* option = option_named(command, flag);
  if (option == nullptr) return unknown_option(command, flag, rest);
  if (equals == std::string::npos || equals + 1 == word.size()) taken = words_taken(*option);
  return {};
}

const CLI::App& parsed_command(const CLI::App& app) {
  const std::vector<CLI::App*> below = app.get_subcommands();
  return below.empty() ? app : parsed_command(*below.front());
}

std::string missing_words(const CLI::App& command, const std::string& what) {
  const std::string words = full_name(command);
  const std::string name = what.substr(0, what.find(" is required"));
  if (const CLI::Option* option = command.get_option_no_throw(name)) {
    return fmt::format("{} needs {} ({}); see {} --help", words, name, option->get_description(),
                       words);
  }
  if (command.get_parent() == nullptr) return "recald needs a command; see recald --help";
  std::vector<std::string> names;
  for (const CLI::App* one : commands_of(command)) names.push_back(one->get_name());
  return fmt::format("{} needs a command: {}; see {} --help", words, fmt::join(names, ", "), words);
}

template <class Kind>
bool is_a(const CLI::ParseError& error) {
  return dynamic_cast<const Kind*>(&error) != nullptr;
}

/// The two sides of `verb` in CLI11's sentence.
std::pair<std::string, std::string> sides_of(const std::string& what, std::string_view verb) {
  const auto at = what.find(verb);
  if (at == std::string::npos) return {what, ""};
  return {what.substr(0, at), what.substr(at + verb.size())};
}

/// "--draws: Value 3 not in range 100 to 200"
std::string value_words(const std::string& what) {
  const auto [flag, rest] = sides_of(what, ": Value ");
  const auto [value, range] = sides_of(rest, " not in range ");
  if (range.empty()) return what;  // ours, see one_of
  const auto [least, most] = sides_of(range, " to ");
  return fmt::format("{}: '{}' is not a number from {} to {}", flag, printable(value), least, most);
}

}  // namespace

const CLI::App& command_at(const CLI::App& app, TypedWords words) {
  const CLI::App* command = &app;
  for (const std::string& word : words) {
    if (const CLI::App* below = subcommand_named(*command, word)) command = below;
  }
  return *command;
}

std::string unknown_word(const CLI::App& app, TypedWords words) {
  const CLI::App* command = &app;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    const TypedWords rest = words.subspan(i + 1);
    std::size_t taken = 0;
    std::string why;
    if (word == "--") break;  // files follow, whatever they are called
    if (word.starts_with("--")) {
      why = unknown_flag(*command, word, rest, taken);
    } else if (word.size() > 1 && word.front() == '-') {
      why = unknown_letter(*command, word, rest, taken);
    } else if (!commands_of(*command).empty()) {
      const CLI::App* below = subcommand_named(*command, word);
      if (below == nullptr) return unknown_command(*command, word);
      command = below;
    }
    if (!why.empty()) return why;
    i += taken;
  }
  return {};
}

std::string sentence_of(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = parsed_command(app);
  const std::string what = error.what();
  if (is_a<CLI::RequiredError>(error)) return missing_words(command, what);
  if (is_a<CLI::ValidationError>(error)) return value_words(what);
  if (is_a<CLI::ExtrasError>(error)) {
    const std::vector<std::string> extras = app.remaining(true);
    return fmt::format("{} has no use for '{}'; see {} --help", full_name(command),
                       printable(extras.empty() ? "" : extras.front()), full_name(command));
  }
  if (is_a<CLI::RequiresError>(error)) {
    const auto [one, other] = sides_of(what, " requires ");
    return fmt::format("{} needs {}; add it", one, other);
  }
  if (is_a<CLI::ExcludesError>(error)) {
    const auto [one, other] = sides_of(what, " excludes ");
    return fmt::format("{} cannot be given with {}; leave one of them out", one, other);
  }
  if (is_a<CLI::ConversionError>(error)) {
    const auto [flag, value] = sides_of(sides_of(what, "Could not convert: ").second, " = ");
    return fmt::format("{}: '{}' is not a number that it can be", flag, printable(value));
  }
  if (is_a<CLI::ArgumentMismatch>(error) && what.ends_with(" missing")) {
    return fmt::format("{} needs a value; see {} --help", sides_of(what, ": ").first,
                       full_name(command));
  }
  return fmt::format("{}; see {} --help", what, full_name(command));
}

CLI::Validator one_of(std::vector<std::string> words) {
  const std::string all = fmt::format("{{{}}}", fmt::join(words, ","));
  const auto why_not = [words = std::move(words)](const std::string& given) -> std::string {
    if (std::ranges::find(words, given) != words.end()) return {};
    const std::string_view nearest = nearest_of(to_lower(given), words);
    return nearest.empty()
               ? fmt::format("there is no '{}'; it is one of {}", printable(given),
                             fmt::join(words, ", "))
               : fmt::format("there is no '{}'; did you mean '{}'?", printable(given), nearest);
  };
  return CLI::Validator{why_not, all};
}

}  // namespace recald::daemon
