#include "adapters/csv/fields.hpp"

#include <gtest/gtest.h>

#include <charconv>
#include <clocale>
#include <locale>
#include <sstream>
#include <string>
#include <vector>

#include "core/random/rng.hpp"

namespace recald::csv::fields_test {
namespace {

using metering::Instant;
using metering::to_string;

std::vector<std::string> split(std::string_view line) {
  FieldSplitter splitter;
  const std::size_t count = splitter.split(line);
  std::vector<std::string> fields;
  for (std::size_t i = 0; i < std::min(count, FieldSplitter::kFieldsMax); ++i) {
    fields.emplace_back(splitter[i]);
  }
  return fields;
}

using Fields = std::vector<std::string>;

TEST(FieldSplitter, PlainFields) {
  EXPECT_EQ(split("a,b,c"), (Fields{"a", "b", "c"}));
  EXPECT_EQ(split("a,,"), (Fields{"a", "", ""}));
  EXPECT_EQ(split(""), (Fields{""}));
  EXPECT_EQ(split(","), (Fields{"", ""}));
}

TEST(FieldSplitter, QuotesAfterRfc4180) {
  EXPECT_EQ(split(R"("a,b",c)"), (Fields{"a,b", "c"}));
  EXPECT_EQ(split(R"(x,"say ""hi""",y)"), (Fields{"x", R"(say "hi")", "y"}));
  EXPECT_EQ(split(R"(x,"",y)"), (Fields{"x", "", "y"}));
  EXPECT_EQ(split(R"("a","b","c")"), (Fields{"a", "b", "c"}));
  EXPECT_EQ(split(R"(5" pipe,b)"), (Fields{R"(5" pipe)", "b"}));  // only a leading quote quotes
}

TEST(FieldSplitter, BrokenQuotesAreRefused) {
  FieldSplitter splitter;
  EXPECT_EQ(splitter.split(R"(a,"b)"), 0u);
  EXPECT_EQ(splitter.split(R"(a,"b"c,d)"), 0u);
  EXPECT_EQ(splitter.split(R"(")"), 0u);
}

TEST(FieldSplitter, TooManyFieldsAreCountedNotStored) {
  FieldSplitter splitter;
  EXPECT_EQ(splitter.split(std::string(FieldSplitter::kFieldsMax - 1, ',')),
            FieldSplitter::kFieldsMax);
  EXPECT_GT(splitter.split(std::string(5000, ',')), FieldSplitter::kFieldsMax);
  EXPECT_GT(splitter.split("\"\"" + std::string(5000, ',')), FieldSplitter::kFieldsMax);
}

TEST(ParseNumber, TakesTheWholeFieldOrNothing) {
  EXPECT_EQ(parse_number("12.5"), 12.5);
  EXPECT_EQ(parse_number("-0.25"), -0.25);
  EXPECT_EQ(parse_number("+7"), 7.0);
  EXPECT_EQ(parse_number("5"), 5.0);
  EXPECT_EQ(parse_number("1e3"), 1000.0);
  EXPECT_EQ(parse_number(".5"), 0.5);
  EXPECT_EQ(parse_number("123456789012345678"), 123456789012345678.0);
  for (const char* bad : {"", "-", "+", "+-5", "12,5", "12.5 kW", "1.2.3", "nan", "NaN", "inf",
                          "-infinity", "1e999", "0x10", "twelve", " 5", "5 "}) {
    EXPECT_FALSE(parse_number(bad).has_value()) << bad;
  }
}

// The short way for plain decimals must give from_chars' bits, or replays would differ by builds.
TEST(ParseNumber, ShortWayGivesTheSameBitsAsTheLongOne) {
  Rng rng{7};
  for (int i = 0; i < 200'000; ++i) {
    std::string text = std::to_string(rng.below(1'000'000'000));
    const std::uint64_t decimals = rng.below(8);
    if (decimals > 0) text += "." + std::to_string(rng.below(10'000'000)).substr(0, decimals);
    if (rng.below(2) == 0) text.insert(0, "-");
    double expected = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), expected);
    ASSERT_EQ(parse_number(text), expected) << text;
  }
}

struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
};

/// A process whose streams, and where such a locale is installed its C functions, expect a comma.
class CommaLocale {
 public:
  CommaLocale()
      : cpp_{std::locale::global(std::locale{std::locale::classic(), new DecimalComma})},
        c_{std::setlocale(LC_ALL, nullptr)} {
    for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "nl_NL.UTF-8"}) {
      if (std::setlocale(LC_ALL, name) != nullptr) break;
    }
  }
  ~CommaLocale() {
    std::locale::global(cpp_);
    std::setlocale(LC_ALL, c_.c_str());
  }

 private:
  std::locale cpp_;
  std::string c_;
};

TEST(ParseNumber, NeverAsksTheLocale) {
  const CommaLocale comma;
  std::ostringstream stream;
  stream << 12.5;
  ASSERT_EQ(stream.str(), "12,5");  // the locale is in force
  EXPECT_EQ(parse_number("12.5"), 12.5);
  EXPECT_EQ(parse_number("12.5e0"), 12.5);  // through from_chars
  EXPECT_FALSE(parse_number("12,5").has_value());
}

TEST(NumberProblem, NamesADecimalComma) {
  EXPECT_EQ(number_problem("value", "12,5"), "value '12,5' has a decimal comma; write 12.5");
  EXPECT_NE(number_problem("value", "NaN").find("'NaN' is not a finite number"), std::string::npos);
}

Instant parsed(std::string_view text) {
  const auto instant = parse_timestamp(text);
  EXPECT_TRUE(instant.has_value()) << text;
  return instant.value_or(Instant{});
}

TEST(ParseTimestamp, Iso8601WithAnOffset) {
  EXPECT_EQ(to_string(parsed("2016-03-13T02:15:00Z")), "2016-03-13T02:15:00Z");
  EXPECT_EQ(to_string(parsed("2016-03-13T02:15:00-06:00")), "2016-03-13T08:15:00Z");
  EXPECT_EQ(to_string(parsed("2016-03-13 02:15+0530")), "2016-03-12T20:45:00Z");
  EXPECT_EQ(to_string(parsed("2016-03-13T02:15:00.000+01")), "2016-03-13T01:15:00Z");
  EXPECT_EQ(to_string(parsed("2016-02-29T24:00:00Z")), "2016-03-01T00:00:00Z");
  EXPECT_EQ(to_string(parsed("2015-12-31T23:30:00-10:00")), "2016-01-01T09:30:00Z");
}

TEST(ParseTimestamp, EverythingElseIsRefusedWithItsReason) {
  const auto message = [](std::string_view text) {
    const auto instant = parse_timestamp(text);
    return instant ? std::string{"accepted"} : instant.error().message;
  };
  EXPECT_NE(message("2016-03-13T02:15:00").find("has no offset from UTC"), std::string::npos);
  EXPECT_NE(message("2016-02-30T00:00:00Z").find("no date and time of the calendar"),
            std::string::npos);
  EXPECT_NE(message("2016-03-13T25:00:00Z").find("calendar"), std::string::npos);
  EXPECT_NE(message("13.03.2016 02:15").find("not ISO 8601"), std::string::npos);
  EXPECT_NE(message("").find("not ISO 8601"), std::string::npos);
  EXPECT_NE(message("2016-03-13T02:15:00+15:00").find("offset"), std::string::npos);
  EXPECT_NE(message("2016-03-13T02:15:00Zulu").find("offset"), std::string::npos);
  EXPECT_NE(message("2016-03-13T02:15:0").find("calendar"), std::string::npos);
  EXPECT_EQ(parse_timestamp("2101-01-01T00:00:00Z").error().code, ErrorCode::out_of_range);
  EXPECT_EQ(parse_timestamp("1969-12-31T23:00:00Z").error().code, ErrorCode::out_of_range);
}

}  // namespace
}  // namespace recald::csv::fields_test
