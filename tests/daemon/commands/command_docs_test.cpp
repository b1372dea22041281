/// What is made of the command line's own definition: help, manual pages, completions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>

#include "daemon/commands/console.hpp"
#include "daemon/commands/line/command_pages.hpp"
#include "daemon/version.hpp"
#include "tests/daemon/command_line.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::run;

/// Standard output of a shell command, line by line.
std::vector<std::string> lines_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe{::popen(command.c_str(), "r"), ::pclose};
  std::vector<std::string> lines;
  std::array<char, 4096> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), pipe.get()) != nullptr) {
    lines.emplace_back(buffer.data());
    if (!lines.back().empty() && lines.back().back() == '\n') lines.back().pop_back();
  }
  return lines;
}

TEST(CommandDocs, HelpGroupsCommandsByWhatPeopleDo) {
  const std::string help = run({"--help"}).out;
  std::size_t at = 0;
  for (const char* words : {"Set up a site:", "  check ", "Run on a gateway:", "Look at readings:",
                            "Calibrate and forecast:", "  calibrate ",
                            "Find what the model is missing:", "  diagnose "}) {
    const auto found = help.find(words);
    ASSERT_NE(found, std::string::npos) << words;
    if (std::string_view{words}.front() != ' ') {
      EXPECT_GE(found, at) << words;
      at = found;
    }
  }
  EXPECT_THAT(help, Not(HasSubstr("Subcommands:")));
}

TEST(CommandDocs, VersionHasAShortFlag) {
  EXPECT_EQ(run({"-V"}).out, std::string{kVersion} + "\n");
}

TEST(CommandDocs, AManualPageHasEveryOption) {
  const std::string page = run({"man", "diagnose"}).out;
  EXPECT_THAT(page, HasSubstr(".TH recald-diagnose 1"));
  EXPECT_THAT(page, HasSubstr("\\fB\\-\\-apply\\fR"));
  EXPECT_THAT(page, HasSubstr("\\fB\\-\\-seed\\fR"));
  EXPECT_THAT(page, HasSubstr("(default 1)"));
  EXPECT_THAT(run({"man"}).out, HasSubstr(".SS Calibrate and forecast"));
  EXPECT_EQ(run({"man", "nosuch"}).exit_code, kUsage);
  EXPECT_EQ(run({"man", "calibrte"}).err,
            "recald: there is no command 'calibrte'; did you mean 'calibrate'?\n");
}

/// Words that lead to each command, "model list", by what the completion of bash has.
std::vector<std::string> all_commands() {
  std::vector<std::string> commands;
  std::istringstream script{run({"completion", "bash"}).out};
  for (std::string line; std::getline(script, line);) {
    if (line.find("flags=\"") == std::string::npos) continue;
    commands.push_back(line.substr(5, line.find('"', 5) - 5));
  }
  return commands;
}

/// As a shell splits them, up to where it sends the output elsewhere.
std::vector<std::string> shell_words(std::string_view line) {
  std::vector<std::string> words{""};
  bool quoted = false;
  for (const char c : line.substr(0, line.find_first_of("|>"))) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ' ' && !quoted) {
      if (!words.back().empty()) words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

TEST(ManualPages, EveryCommandHasOneAndNoOtherHas) {
  const std::vector<std::string> commands = all_commands();
  ASSERT_GT(commands.size(), 40u);
  EXPECT_EQ(command_pages().size(), commands.size());
  for (const std::string& command : commands) {
    SCOPED_TRACE(command);
    const CommandPage* page = find_command_page(command);
    ASSERT_NE(page, nullptr);
    EXPECT_FALSE(page->examples.empty());
    EXPECT_TRUE(page->description.ends_with('.')) << page->description;
    std::vector<std::string> words = shell_words("man " + command);
    const std::string text = run(words).out;
    for (const char* section : {"NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXAMPLES", "FILES",
                                "EXIT STATUS", "SEE ALSO"}) {
      EXPECT_THAT(text, HasSubstr(std::string{".SH "} + section + "\n"));
    }
    for (const char* code : {"0", "1", "2", "130", "143"}) {
      EXPECT_THAT(text, HasSubstr(std::string{".B "} + code + "\n"));
    }
  }
}

// An example that does not run is worse than none.
TEST(ManualPages, ExamplesAreCommandLines) {
  for (const CommandPage& page : command_pages()) {
    for (const CommandExample& example : page.examples) {
      SCOPED_TRACE(example.line);
      std::vector<std::string> words = shell_words(example.line);
      ASSERT_EQ(words.front(), "recald");
      words.erase(words.begin());
      EXPECT_EQ(wrong_usage_of(words), "");
      if (!page.command.empty()) {
        EXPECT_TRUE(example.line.substr(7).starts_with(page.command)) << page.command;
      }
    }
  }
  EXPECT_THAT(wrong_usage_of({"check", "site.toml", "--metres"}), HasSubstr("'--meters'"));
}

TEST(ManualPages, GroffHasNothingToSay) {
  if (std::system("command -v groff >/dev/null 2>&1") != 0) GTEST_SKIP() << "groff is not there";
  const recald::testing::TemporaryFolder folder;
  for (const std::string& command : all_commands()) {
    SCOPED_TRACE(command);
    recald::testing::write_text(folder / "page.1", run(shell_words("man " + command)).out);
    EXPECT_THAT(lines_of("groff -man -Tutf8 -Kutf8 -ww -rLL=100n '" + (folder / "page.1").string() +
                         "' 2>&1 >/dev/null"),
                IsEmpty());
  }
}

TEST(ManualPages, OfCommandsBelowOthersAreFoundByEitherName) {
  const std::string page = run({"man", "model", "list"}).out;
  EXPECT_THAT(page, HasSubstr(".TH recald-model-list 1"));
  EXPECT_EQ(run({"man", "recald-model-list"}).out, page);
  EXPECT_EQ(run({"man", "model-list"}).out, page);
}

class BashCompletion : public ::testing::Test {
 protected:
  BashCompletion() {
    recald::testing::write_text(folder_ / "recald.bash", run({"completion", "bash"}).out);
    recald::testing::write_text(folder_ / "site.toml", "");
  }
  /// What bash offers for the last word. @param words  Separated by blanks.
  [[nodiscard]] std::vector<std::string> offered(const std::string& words) const {
    return lines_of("cd '" + folder_.path().string() + "' && bash -c 'source ./recald.bash; " +
                    "COMP_WORDS=(" + words + "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); " +
                    "_recald; printf \"%s\\n\" \"${COMPREPLY[@]}\"' | sort");
  }
  recald::testing::TemporaryFolder folder_;
};

TEST_F(BashCompletion, OffersCommandsOptionsValuesAndFiles) {
  EXPECT_THAT(offered("recald diag"), ElementsAre("diagnose"));
  EXPECT_THAT(offered("recald model re"), ElementsAre("revert"));
  EXPECT_THAT(offered("recald diagnose site.toml --as"), ElementsAre("--assume"));
  EXPECT_THAT(offered("recald calibrate --model ep"), ElementsAre("epc"));
  EXPECT_THAT(offered("recald calibrate site"), ElementsAre("site.toml"));
}

TEST(CommandDocs, OtherShellsGetTheirScripts) {
  const std::string fish = run({"completion", "fish"}).out;
  EXPECT_THAT(fish, HasSubstr("complete -c recald -n '__fish_use_subcommand' -f -a diagnose -d "));
  EXPECT_THAT(fish, HasSubstr("-l model -x -a 'epc hourly"));
  EXPECT_THAT(run({"completion", "zsh"}).out, HasSubstr("'--apply:Add the effect"));
  EXPECT_EQ(run({"completion", "csh"}).exit_code, kUsage);
}

TEST(TimeLeft, IsSaidOnceItCanBeKnown) {
  EXPECT_THAT(time_left_text(0.5, 0.5), IsEmpty());
  EXPECT_THAT(time_left_text(10.0, 0.01), IsEmpty());
  EXPECT_EQ(time_left_text(10.0, 0.5), "10 s");
  EXPECT_EQ(time_left_text(60.0, 0.2), "4 min");
  EXPECT_EQ(time_left_text(3600.0, 0.25), "3.0 h");
}

}  // namespace
}  // namespace recald::daemon
