#include "adapters/toml/toml_reader.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace recald::toml_reader_test {
namespace {

using std::chrono::days;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(ParseDuration, TakesACountAndAUnit) {
  EXPECT_EQ(parse_duration("20s"), seconds{20});
  EXPECT_EQ(parse_duration("15m"), minutes{15});
  EXPECT_EQ(parse_duration("72h"), hours{72});
  EXPECT_EQ(parse_duration("5d"), days{5});
  EXPECT_EQ(parse_duration("0s"), seconds{0});  // "never", where a run has a longest length
}

TEST(ParseDuration, RefusesAnythingElse) {
  for (const char* text : {"", "m", "15", "15 m", " 15m", "15min", "1.5h", "-1h", "+1h", "15M",
                           "1w", "2000000000s", "99999999999999999999h"}) {
    EXPECT_EQ(parse_duration(text), std::nullopt) << text;
  }
}

// Its parts are tables in each other, which the parser and whoever lets them go recurse over.
TEST(ParseToml, AKeyMayHaveAHundredParts) {
  const auto dotted = [](int parts) {
    std::string key = "a";
    for (int i = 1; i < parts; ++i) key += i % 3 == 0 ? " . \"b.c\"" : ".d";
    return key;
  };
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      (void)parse_toml(text, "a.toml");
      return "read";
    } catch (const toml::parse_error& error) {
      return syntax_problem("a.toml", error);
    }
  };
  EXPECT_EQ(refusal("x = 1\n" + dotted(101) + " = 1\n"), "read");
  for (const int parts : {102, 1'000, 100'000}) {
    for (const char* form : {"{} = 1\n", "[{}]\n", "[[{}]]\n", "y = {{ {} = 1 }}\n"}) {
      EXPECT_EQ(refusal("x = 1\n# a comment\n" + fmt::format(fmt::runtime(form), dotted(parts))),
                "a.toml:3: not valid TOML: a key has more than 100 parts")
          << parts << form;
    }
  }
  const std::string dots(100'000, '.');
  for (const std::string& fine : {"x = \"" + dots + "\"\n", "x = '" + dots + "'\n",
                                  "# " + dots + "\nx = 1\n", "x = \"\"\"\n" + dots + "\n\"\"\"\n",
                                  "x = '''" + dots + "'''\n", "x = \"a\\\"" + dots + "\"\n"}) {
    EXPECT_EQ(refusal(fine), "read") << fine.substr(0, 20);
  }
  std::string numbers = "x = [";
  for (int i = 0; i < 10'000; ++i) numbers += "1.5, ";
  EXPECT_EQ(refusal(numbers + "2.5]\n"), "read");
}

/// A text as one table, and what reading it found wrong.
class Reading {
 public:
  explicit Reading(std::string_view text)
      : table_{toml::parse(text)}, reader{table_, "a.toml", "", problems} {}

 private:
  toml::table table_;

 public:
  Problems problems;
  TomlReader reader;
};

TEST(TomlReader, AbsentKeysAreNothingAndNoProblem) {
  Reading r{"x = 1"};
  EXPECT_EQ(r.reader.text("a"), std::nullopt);
  EXPECT_EQ(r.reader.number("b"), std::nullopt);
  EXPECT_EQ(r.reader.boolean("c"), std::nullopt);
  EXPECT_EQ(r.reader.texts("d"), std::nullopt);
  EXPECT_EQ(r.reader.numbers("e", 2), std::nullopt);
  EXPECT_FALSE(r.reader.table("f").has_value());
  EXPECT_TRUE(r.reader.tables("g").empty());
  EXPECT_EQ(r.reader.number_or("h", 3.5), 3.5);
  EXPECT_EQ(r.reader.whole_number_or("i", 7, {}), 7);
  EXPECT_FALSE(r.reader.has("a"));
  EXPECT_TRUE(r.reader.has("x"));
  EXPECT_THAT(r.problems, IsEmpty());
}

TEST(TomlReader, ReadsValuesOfEachType) {
  Reading r{R"(text = "t"
number = 2.5
whole = 3
yes = true
span = "2h"
month = "2021-05"
pair = [1, 2.5]
words = ["a", "b"])"};
  EXPECT_EQ(r.reader.text("text"), "t");
  EXPECT_EQ(r.reader.number("number"), 2.5);
  EXPECT_EQ(r.reader.number("whole"), 3.0);
  EXPECT_EQ(r.reader.whole_number_or("whole", 1, {}), 3);
  EXPECT_EQ(r.reader.boolean("yes"), true);
  EXPECT_EQ(r.reader.duration("span"), hours{2});
  EXPECT_EQ(r.reader.month("month"), std::chrono::year{2021} / std::chrono::May);
  EXPECT_EQ(r.reader.numbers("pair", 2), (std::vector{1.0, 2.5}));
  EXPECT_EQ(r.reader.texts("words"), (std::vector<std::string>{"a", "b"}));
  r.reader.finish();
  EXPECT_THAT(r.problems, IsEmpty());
}

TEST(TomlReader, ShortWaitsAreInMilliseconds) {
  Reading r{"a = \"200ms\"\nb = \"5s\"\nc = \"ms\"\nd = \"1.5ms\"\ne = \"-1ms\"\n"};
  EXPECT_EQ(r.reader.milliseconds("a"), std::chrono::milliseconds{200});
  EXPECT_EQ(r.reader.milliseconds("b"), std::chrono::seconds{5});
  for (const std::string_view key : {"c", "d", "e", "f"}) {
    EXPECT_EQ(r.reader.milliseconds(key), std::nullopt) << key;
  }
  EXPECT_EQ(r.problems.size(), 3u);
}

TEST(TomlReader, WrongTypesNameLineAndKey) {
  Reading r{"a = 1\nb = \"1\"\nc = 1\nd = [\"a\", 2]\ne = [1, \"b\"]\nf = 1\ng = 1\n"};
  (void)r.reader.text("a");
  (void)r.reader.number("b");
  (void)r.reader.boolean("c");
  (void)r.reader.texts("d");
  (void)r.reader.numbers("e", 2, {0.0, 1.0});
  (void)r.reader.table("f");
  (void)r.reader.tables("g");
  EXPECT_THAT(r.problems,
              ElementsAre("a.toml:1: 'a' must be text in quotes", "a.toml:2: 'b' must be a number",
                          "a.toml:3: 'c' must be true or false",
                          "a.toml:4: 'd' must be a list of texts in quotes",
                          "a.toml:5: 'e' must be a list of 2 numbers between 0 and 1",
                          "a.toml:6: 'f' must be a table, written [f]",
                          "a.toml:7: 'g' must be a list of tables, each headed [[g]]"));
}

TEST(TomlReader, RangesAreInclusiveAndNamedInWords) {
  Reading r{"low = 0\nhigh = 1.5\nzero = 0.0\nminus = -1\nblank = nan\nendless = inf\n"};
  EXPECT_EQ(r.reader.number("low", kShare), 0.0);
  (void)r.reader.number("high", kShare);
  (void)r.reader.number("zero", kPositive);
  (void)r.reader.number("minus", kNotNegative);
  (void)r.reader.number("blank", kShare);
  (void)r.reader.number("endless");
  EXPECT_THAT(r.problems, ElementsAre("a.toml:2: 'high' is 1.5; it must be between 0 and 1",
                                      "a.toml:3: 'zero' is 0; it must be greater than 0",
                                      "a.toml:4: 'minus' is -1; it must be at least 0",
                                      "a.toml:5: 'blank' is nan; it must be between 0 and 1",
                                      "a.toml:6: 'endless' is inf; it must be a finite number"));
}

TEST(TomlReader, TablesKnowTheirPlace) {
  Reading r{"[a.b]\nx = 1\n[[a.c]]\ny = 1\n"};
  auto a = r.reader.table("a");
  ASSERT_TRUE(a.has_value());
  auto b = a->table("b");
  ASSERT_TRUE(b.has_value());
  b->finish();
  auto c = a->tables("c");
  ASSERT_EQ(c.size(), 1u);
  c.front().finish();
  c.front().problem("of the table");
  EXPECT_THAT(r.problems,
              ElementsAre("a.toml:2: [a.b] unknown key 'x'", "a.toml:4: [a.c] unknown key 'y'",
                          "a.toml:3: [a.c] of the table"));
}

TEST(TomlReader, FinishSuggestsTheNearestOfTheKeysThatWereAskedFor) {
  Reading r{"altitud_m = 3\nzzz = 1\n"};
  (void)r.reader.number("altitude_m");
  (void)r.reader.number("latitude_deg");
  r.reader.finish();
  EXPECT_THAT(r.problems,
              ElementsAre("a.toml:1: unknown key 'altitud_m'; did you mean 'altitude_m'?",
                          "a.toml:2: unknown key 'zzz'"));
}

}  // namespace
}  // namespace recald::toml_reader_test
