/// Help, and what is said of a command line that is wrong: one sentence with what was meant.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <sstream>

#include "tests/daemon/command_line.hpp"

namespace recald::daemon::usage_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::Outcome;
using testing::run;
using ::testing::StartsWith;

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream in{text};
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

/// Long options of each command, by the words that lead there, from the completion of bash.
std::map<std::string, std::vector<std::string>> long_options() {
  std::map<std::string, std::vector<std::string>> all;
  std::istringstream script{run({"completion", "bash"}).out};
  for (std::string line; std::getline(script, line);) {
    const auto flags = line.find("flags=\"");
    if (flags == std::string::npos) continue;
    const std::string command = line.substr(5, line.find('"', 5) - 5);
    for (const std::string& flag : split(line.substr(flags + 7, line.rfind('"') - flags - 7))) {
      if (flag.starts_with("--")) all[command].push_back(flag);
    }
  }
  return all;
}

/// Levenshtein (1966), written anew.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  std::iota(d[0].begin(), d[0].end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t k = 1; k <= b.size(); ++k) {
      d[i][k] = std::min(
          {d[i - 1][k] + 1, d[i][k - 1] + 1, d[i - 1][k - 1] + (a[i - 1] == b[k - 1] ? 0 : 1)});
    }
  }
  return d[a.size()][b.size()];
}

/// A letter lost, one too many, two swapped: at every place behind the hyphens.
std::vector<std::string> typos_of(const std::string& flag) {
  std::vector<std::string> typos;
  for (std::size_t i = 2; i < flag.size(); ++i) {
    typos.push_back(flag.substr(0, i) + flag.substr(i + 1));
    typos.push_back(flag.substr(0, i) + flag[i] + flag.substr(i));
    if (i + 1 == flag.size()) continue;
    typos.push_back(flag);
    std::swap(typos.back()[i], typos.back()[i + 1]);
  }
  std::erase_if(typos, [](const std::string& typo) { return typo.size() < 3; });
  return typos;
}

/// Of "…; did you mean '--out'?"
std::string named_in(const std::string& sentence) {
  const auto begin = sentence.find("did you mean '");
  if (begin == std::string::npos) return {};
  return sentence.substr(begin + 14, sentence.rfind('\'') - begin - 14);
}

TEST(WrongUsage, EveryTypoOfEveryOptionIsNamed) {
  const auto options = long_options();
  ASSERT_GT(options.size(), 40u);
  int tried = 0;
  for (const auto& [command, flags] : options) {
    std::vector<std::string> known = flags;
    const auto& of_all = options.at("");
    known.insert(known.end(), of_all.begin(), of_all.end());
    for (const std::string& flag : flags) {
      for (const std::string& typo : typos_of(flag)) {
        if (std::ranges::find(known, typo) != known.end()) continue;
        SCOPED_TRACE(command + " " + typo);
        std::vector<std::string> words = split(command);
        words.insert(words.end(), {typo, "x"});
        const std::string sentence = wrong_usage_of(words);
        const std::string start = command.empty() ? "recald" : "recald " + command;
        EXPECT_THAT(sentence, StartsWith(start + " has no option '" + typo + "'; "));
        const std::string named = named_in(sentence);
        EXPECT_LE(distance(typo, named), distance(typo, flag)) << sentence;
        EXPECT_NE(std::ranges::find(known, named), known.end()) << sentence;
        words.pop_back();
        words.back() += "=x";
        EXPECT_EQ(wrong_usage_of(words), sentence);  // --ouput=x is the same typo
        ++tried;
      }
    }
  }
  EXPECT_GT(tried, 2000);
}

TEST(WrongUsage, IsOneSentenceAndTheCodeTwo) {
  const std::map<std::vector<std::string>, std::string> sentences{
      {{"calibrate", "site.toml", "--ouput", "x"},
       "recald calibrate has no option '--ouput'; did you mean '--out'?"},
      {{"calibrate", "--ouput=x"},
       "recald calibrate has no option '--ouput'; did you mean '--out'?"},
      {{"--ouput", "x", "calibrate", "site.toml"},
       "recald calibrate has no option '--ouput'; did you mean '--out'?"},
      {{"--out", "x", "calibrate", "site.toml"},
       "recald: --out stands before its command; write recald calibrate --out"},
      {{"model", "--jsn", "list"},
       "recald model list has no option '--jsn'; did you mean '--json'?"},
      {{"replay", "-out", "x"}, "recald replay has no option '-out'; did you mean '--out'?"},
      {{"replay", "site.toml", "--quite"},
       "recald replay has no option '--quite'; did you mean '--quiet'?"},
      {{"replay", "--frobnicate", "--help"},
       "recald replay has no option '--frobnicate'; see recald replay --help"},
      {{"scan", "--bsu", "roof"}, "recald scan has no option '--bsu'; did you mean '--bus'?"},
      {{"replay", "-x"}, "recald replay has no option '-x'; see recald replay --help"},
      {{"--frobnicate"}, "recald has no option '--frobnicate'; see recald --help"},
      {{"calibrate", "s", "--model", "hurly"},
       "recald: --model: there is no 'hurly'; did you mean 'hourly'?"},
      {{"calibrate", "s", "--sampler", "NUT"},
       "recald: --sampler: there is no 'NUT'; did you mean 'nuts'?"},
      {{"calibrate", "s", "--sampler", "gibbs"},
       "recald: --sampler: there is no 'gibbs'; it is one of auto, nuts, dram, smc, seed_rwm"},
      {{"init", "x", "--epw", "y", "--area", "9", "--use", "ofice"},
       "recald: --use: there is no 'ofice'; did you mean 'office'?"},
      {{"completion", "bsh"}, "recald: shell: there is no 'bsh'; did you mean 'bash'?"},
      {{"calibrate", "s", "--hyper-prior", "scald"},
       "recald: 'scald' is not a hyper-prior profile; did you mean 'scaled'?"},
      {{"diagnose", "s", "--assume", "fowling"},
       "recald: --assume: there is no effect 'fowling'; did you mean 'fouling'?"},
      {{"calibrate", "s", "--draws", "10"},
       "recald: --draws: '10' is not a number from 100 to 100000000"},
      {{"calibrate", "s", "--seed", "many"},
       "recald: --seed: 'many' is not a number that it can be"},
      {{"calibrate", "s", "--seed"}, "recald: --seed needs a value; see recald calibrate --help"},
      {{"calibrate", "s", "--predictive"}, "recald: --predictive needs --out; add it"},
      {{"registers", "s", "--csv", "--json"},
       "recald: --csv cannot be given with --json; leave one of them out"},
      {{"replay"},
       "recald replay needs site (Site file (TOML), or a recording of recald run --record); see "
       "recald replay --help"},
      {{"replay", "a", "b"}, "recald replay has no use for 'b'; see recald replay --help"},
      {{"model"},
       "recald model needs a command: list, show, apply, revert; see recald model --help"},
      {{"-q"}, "recald needs a command; see recald --help"},
  };
  for (const auto& [words, sentence] : sentences) {
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.err, sentence + "\n");
    EXPECT_EQ(outcome.exit_code, kUsage) << sentence;
    EXPECT_THAT(outcome.out, IsEmpty());
  }
}

// What looks like an option behind one that takes a value is that value, and behind -- a file.
TEST(WrongUsage, ValuesMayLookLikeOptions) {
  EXPECT_EQ(wrong_usage_of({"import", "s", "f", "--reason", "--no reason"}), "");
  EXPECT_EQ(wrong_usage_of({"import", "s", "f", "--reason=--no reason"}), "");
  EXPECT_EQ(wrong_usage_of({"check", "--", "--site.toml"}), "");
  EXPECT_EQ(wrong_usage_of({"-qV"}), "");
  EXPECT_EQ(wrong_usage_of({"check", "calibrate"}), "");  // a file of that name
}

TEST(Help, IsWhatOneGetsWithoutACommand) {
  const Outcome outcome = run({});
  EXPECT_EQ(outcome.exit_code, kSuccess);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_EQ(outcome.out, run({"--help"}).out);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("Set up a site:"), HasSubstr("recald report export")));
}

std::ptrdiff_t options_in(const std::string& help) {
  std::ptrdiff_t count = 0;
  std::istringstream in{help.substr(0, help.find("Options of every command:"))};
  for (std::string line; std::getline(in, line);) count += line.starts_with("  -") ? 1 : 0;
  return count;
}

TEST(Help, ShowsTheUsualOptionsAndHelpAllTheRest) {
  const std::string usual = run({"calibrate", "--help"}).out;
  for (const char* flag : {"--model", "--doe", "--out", "--seed", "--json", "--quiet"}) {
    EXPECT_THAT(usual, HasSubstr(flag));
  }
  EXPECT_EQ(options_in(usual), 7);  // with --help and --help-all
  EXPECT_THAT(usual, AllOf(Not(HasSubstr("--burn-in")),
                           HasSubstr("recald calibrate --help-all shows 16 more options.")));
  const std::string all = run({"calibrate", "--help-all"}).out;
  EXPECT_EQ(options_in(all), 7 + 16);
  EXPECT_THAT(all, AllOf(HasSubstr("--burn-in"), HasSubstr("--hyper-prior")));
  // Everything else that is made of the options has them all.
  EXPECT_THAT(run({"man", "calibrate"}).out, HasSubstr("\\-\\-burn\\-in"));
  EXPECT_THAT(run({"completion", "fish"}).out, HasSubstr("-l burn-in"));
}

TEST(Help, OfNoCommandShowsMoreThanTenOptions) {
  for (const auto& [command, flags] : long_options()) {
    std::vector<std::string> words = split(command);
    words.emplace_back("--help");
    const Outcome help = run(words);
    EXPECT_EQ(help.exit_code, kSuccess) << command;
    EXPECT_LE(options_in(help.out), 10) << command;
    words.back() = "--help-all";
    const Outcome all = run(words);
    EXPECT_EQ(all.exit_code, kSuccess) << command;
    for (const std::string& flag : flags) EXPECT_THAT(all.out, HasSubstr(flag)) << command;
  }
}

}  // namespace
}  // namespace recald::daemon::usage_test
