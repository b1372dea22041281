#include "tests/layout/include_rules.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace recald::layout {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(IncludeRules, HoldForThisTree) {
  const Includes includes = read_includes(RECALD_SOURCE_DIR);
  ASSERT_GT(includes.size(), 500u) << "the sources were not found";
  EXPECT_THAT(forbidden_arrows(includes), IsEmpty());
  EXPECT_THAT(circles(includes), IsEmpty());
  EXPECT_THAT(crowded(includes), IsEmpty());
}

TEST(IncludeRules, ArrowsPointDownTheWingsAndTheirRooms) {
  EXPECT_THAT(forbidden_arrows(
                  {{"daemon/gateway/run/gateway.cpp",
                    {"core/result.hpp", "adapters/ports/store.hpp",
                     "daemon/site/config/site_config.hpp", "daemon/gateway/serve/api/served.hpp"}},
                   {"daemon/main.cpp", {"daemon/commands/line/cli.hpp"}}}),
              IsEmpty());
  EXPECT_THAT(forbidden_arrows(
                  {{"daemon/gateway/serve/api/served.hpp", {"daemon/gateway/run/gateway.hpp"}}}),
              ElementsAre("daemon/gateway/serve/api/served.hpp must not include "
                          "daemon/gateway/run/gateway.hpp"));
  EXPECT_EQ(forbidden_arrows({{"daemon/site/model/a.cpp", {"daemon/site/results/b.hpp"}},
                              {"daemon/site/results/b.cpp", {"daemon/gateway/poll/c.hpp"}},
                              {"adapters/csv/d.cpp", {"daemon/site/config/e.hpp"}},
                              {"core/drift/f.cpp", {"adapters/ports/clock.hpp"}}})
                .size(),
            4u);
}

TEST(IncludeRules, AFolderWithoutAPlaceInTheOrderIsRefused) {
  EXPECT_EQ(forbidden_arrows({{"daemon/site/cellar/a.cpp", {"core/result.hpp"}}}).size(), 1u);
}

TEST(IncludeRules, OneRoomKnowsWhatKeepsAStore) {
  EXPECT_THAT(
      forbidden_arrows({{"adapters/stores/open.cpp", {"adapters/sqlite/sqlite_store.hpp"}},
                        {"adapters/sqlite/backup.cpp", {"adapters/sqlite/tables/handles.hpp"}},
                        {"adapters/energyplus/a.cpp", {"adapters/sqlite/tables/database.hpp"}}}),
      IsEmpty());
  EXPECT_EQ(forbidden_arrows({{"daemon/gateway/run/a.cpp", {"adapters/sqlite/sqlite_store.hpp"}},
                              {"adapters/models/b.cpp", {"adapters/sqlite/tables/database.hpp"}}})
                .size(),
            2u);
}

TEST(IncludeRules, SimulatorsHaveNothingOfTheModelsTheyTest) {
  EXPECT_THAT(forbidden_arrows({{"simulators/building/a.cpp",
                                 {"core/metering/reading.hpp", "simulators/climate/sky.hpp"}}}),
              IsEmpty());
  EXPECT_EQ(forbidden_arrows({{"simulators/building/a.cpp",
                               {"core/weather/psychrometrics.hpp", "adapters/modbus/frame.hpp"}}})
                .size(),
            2u);
}

TEST(IncludeRules, CirclesAreFoundAroundACornerToo) {
  EXPECT_THAT(circles({{"core/a/x.cpp", {"core/b/y.hpp"}},
                       {"core/b/y.hpp", {"core/c/z.hpp"}},
                       {"core/c/z.cpp", {"core/a/x.hpp"}},
                       {"core/d/w.cpp", {"core/a/x.hpp", "core/d/v.hpp"}}}),
              ElementsAre("core/a core/b core/c"));
}

TEST(IncludeRules, CirclesOfRoomsAreFoundWhereTheirFoldersHaveNone) {
  const Includes of_rooms{{"core/a/deep/x.cpp", {"core/b/y.hpp"}},
                          {"core/b/y.hpp", {"core/a/z.hpp"}}};
  EXPECT_THAT(circles(of_rooms), ElementsAre("core/a core/b"));
}

TEST(IncludeRules, AFolderOfMoreThanThirtyFilesIsCrowded) {
  Includes many;
  for (int i = 0; i < 31; ++i) {
    many["core/a/" + std::to_string(i) + ".cpp"];
    many["core/b/effects/" + std::to_string(i) + ".cpp"];
  }
  EXPECT_THAT(crowded(many), ElementsAre("core/a"));
}

/// Where what begins at `at` ends, if it is a comment, a text or a character; `at` if it is none.
std::size_t end_of_words(std::string_view source, std::size_t at) {
  const auto past = [&](std::string_view end, std::size_t from) {
    return std::min(source.find(end, from), source.size() - end.size()) + end.size();
  };
  const std::string_view rest = source.substr(at);
  if (rest.starts_with("//")) return std::min(source.find('\n', at), source.size());
  if (rest.starts_with("/*")) return past("*/", at + 2);
  if (rest.starts_with("R\"")) {
    const std::string_view mark = rest.substr(2, rest.find('(') - 2);
    return past(")" + std::string{mark} + "\"", at + 2);
  }
  const char quote = rest.front();
  const bool is_separator =  // 1'000
      quote == '\'' && at > 0 && std::isalnum(static_cast<unsigned char>(source[at - 1])) != 0;
  if ((quote != '"' && quote != '\'') || is_separator) return at;
  std::size_t end = at + 1;
  while (end < source.size() && source[end] != quote && source[end] != '\n') {
    end += source[end] == '\\' ? 2 : 1;
  }
  return std::min(end + 1, source.size());
}

/// C++ with blanks for all that is in comments, texts and characters.
std::string without_words(const std::string& source) {
  std::string bare = source;
  for (std::size_t at = 0; at < bare.size();) {
    const std::size_t end = end_of_words(source, at);
    for (std::size_t i = at; i < end; ++i) bare[i] = bare[i] == '\n' ? '\n' : ' ';
    at = std::max(end, at + 1);
  }
  return bare;
}

/// A source as what it takes to tell where its names come from.
struct Source {
  std::set<std::string> included;
  std::set<std::string> words;
  std::set<std::string> of;      ///< Our namespaces, without those around them: "metering".
  std::set<std::string> opened;  ///< Those and others, such as for a class before its header.
  /// What it calls by a namespace: {"metering", "month_of"}.
  std::set<std::pair<std::string, std::string>> names;
};
using Sources = std::map<std::string, Source>;

Source parse_source(const std::string& text, std::set<std::string> included) {
  const std::string bare = without_words(text);
  const auto is_of_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
  Source source{.included = std::move(included)};
  bool opens_namespace = false;
  std::string around;  // what the word before was, if :: joins them
  std::string root;    // the first of words that :: joins
  for (std::size_t at = 0; at < bare.size();) {
    if (!is_of_word(bare[at])) {
      if (bare[at++] == '{') opens_namespace = false;
      continue;
    }
    const auto end =
        std::find_if_not(bare.begin() + static_cast<std::ptrdiff_t>(at), bare.end(), is_of_word);
    std::string word{bare.begin() + static_cast<std::ptrdiff_t>(at), end};
    at += word.size();
    const bool is_around = bare.compare(at, 2, "::") == 0;
    if (around.empty()) root = word;
    const bool is_ours = root == "recald";
    if (opens_namespace) {
      if (!is_around) source.opened.insert(word);
      if (!is_around && is_ours && !around.empty()) source.of.insert(word);
    } else if (!around.empty() && (is_ours || root == around)) {  // boost::asio::post is not ours
      source.names.emplace(around, word);
    }
    source.words.insert(word);
    opens_namespace = word == "namespace" || (opens_namespace && is_around);
    around = is_around ? std::move(word) : std::string{};
  }
  return source;
}

std::set<std::string> reached_from(const std::string& file, const Sources& sources) {
  std::set<std::string> reached;
  std::vector<std::string> next{file};
  while (!next.empty()) {
    const auto source = sources.find(next.back());
    next.pop_back();
    if (source == sources.end()) continue;
    for (const std::string& other : source->second.included) {
      if (reached.insert(other).second) next.push_back(other);
    }
  }
  return reached;
}

/// Names of other rooms that a file uses without a header that declares them.
std::vector<std::string> names_from_nowhere(const Sources& sources) {
  std::map<std::string, std::vector<std::string>> headers;  // by namespace
  for (const auto& [file, source] : sources) {
    if (!file.ends_with(".hpp")) continue;
    for (const std::string& space : source.of) headers[space].push_back(file);
  }
  std::vector<std::string> found;
  for (const auto& [file, source] : sources) {
    std::set<std::string> reached = reached_from(file, sources);
    reached.insert(file);
    for (const auto& [space, name] : source.names) {
      const auto has_it = [&, &name = name](const std::string& header) {
        return sources.at(header).words.contains(name);
      };
      if (std::ranges::none_of(headers[space], has_it)) continue;  // not ours
      const bool is_declared =
          std::ranges::any_of(reached, [&, &space = space](const std::string& other) {
            const auto known = sources.find(other);
            return known != sources.end() && known->second.opened.contains(space) && has_it(other);
          });
      if (is_declared) continue;
      found.push_back(file + " uses " + space + "::" + name);
    }
  }
  return found;
}

// Files are compiled together, where one has what another includes. Alone, as in the everyday
// build, it would not compile.
TEST(Names, OfAnotherRoomComeWithAHeaderThatDeclaresThem) {
  const std::filesystem::path root{RECALD_SOURCE_DIR};
  Sources sources;
  for (auto& [file, included] : read_includes(root.string())) {
    std::ostringstream text;
    text << std::ifstream{root / file}.rdbuf();
    sources[file] = parse_source(text.str(), std::move(included));
  }
  ASSERT_GT(sources.size(), 500u) << "the sources were not found";
  EXPECT_THAT(names_from_nowhere(sources), IsEmpty());
}

TEST(Names, FromNowhereAreFound) {
  const Sources sources{
      {"core/a/a.hpp", parse_source("namespace recald::a {\nint f();\n}", {})},
      {"core/b/b.hpp", parse_source("", {"core/a/a.hpp"})},
      {"core/c/c.cpp", parse_source("int g() { return a::f(); }", {"core/b/b.hpp"})},
      {"core/c/d.cpp", parse_source("int g() { return a::f() + std::f(); }", {})},
      {"core/c/e.cpp", parse_source("// a::f\nconst char* g() { return \"a::f\"; }", {})}};
  EXPECT_THAT(names_from_nowhere(sources), ElementsAre("core/c/d.cpp uses a::f"));
}

/// Arguments of the call whose parenthesis opens at `open`.
int argument_count(std::string_view bare, std::size_t open) {
  int depth = 0;
  int count = 1;
  for (const char c : bare.substr(open)) {
    depth += static_cast<int>(std::string_view{"([{"}.find(c) != std::string_view::npos);
    depth -= static_cast<int>(std::string_view{")]}"}.find(c) != std::string_view::npos);
    if (depth == 0) break;
    count += static_cast<int>(depth == 1 && c == ',');
  }
  return count;
}

/// The lines of a test at which cases get no names.
std::vector<std::ptrdiff_t> lines_of_nameless_cases(const std::string& source) {
  constexpr std::string_view macro = "INSTANTIATE_TEST_SUITE_P(";
  const std::string bare = without_words(source);
  std::vector<std::ptrdiff_t> lines;
  for (std::size_t at = bare.find(macro); at != std::string::npos; at = bare.find(macro, at + 1)) {
    if (argument_count(bare, at + macro.size() - 1) >= 4) continue;
    lines.push_back(1 +
                    std::count(bare.begin(), bare.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
  }
  return lines;
}

// A list of tests names each case, and so does a failure: not by its bytes or by where it stands.
TEST(CaseNames, AreGivenByEveryTest) {
  const std::filesystem::path root{RECALD_SOURCE_DIR};
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator{root / "tests"}) {
    if (entry.path().extension() != ".cpp") continue;
    ++files;
    std::ostringstream source;
    source << std::ifstream{entry.path()}.rdbuf();
    for (const std::ptrdiff_t line : lines_of_nameless_cases(source.str())) {
      ADD_FAILURE() << entry.path().lexically_relative(root).generic_string() << ':' << line
                    << ": INSTANTIATE_TEST_SUITE_P needs a fourth argument, which names each case";
    }
  }
  EXPECT_GT(files, 300) << "the tests were not found";
}

TEST(CaseNames, AreTheFourthArgumentWhateverTheCasesAre) {
  EXPECT_THAT(lines_of_nameless_cases("// one\nINSTANTIATE_TEST_SUITE_P(A, B, Values(1, 2));\n"),
              ElementsAre(2));
  EXPECT_THAT(lines_of_nameless_cases("INSTANTIATE_TEST_SUITE_P(A, B, Values(1'000, 2), name);"),
              IsEmpty());
  EXPECT_THAT(lines_of_nameless_cases(R"(INSTANTIATE_TEST_SUITE_P(A, B,
      Values(C{"a), b", '"', {1, 2}}, C{"", ')', {}}));)"),
              ElementsAre(1));
  EXPECT_THAT(lines_of_nameless_cases("INSTANTIATE_TEST_SUITE_P(A, B, v /* , n */);  // , n"),
              ElementsAre(1));
  EXPECT_THAT(lines_of_nameless_cases("f(R\"x(\")x\");\nINSTANTIATE_TEST_SUITE_P(A, B, v);"),
              ElementsAre(2));
  EXPECT_THAT(lines_of_nameless_cases("// as in INSTANTIATE_TEST_SUITE_P(A, B, v)"), IsEmpty());
}

}  // namespace
}  // namespace recald::layout
