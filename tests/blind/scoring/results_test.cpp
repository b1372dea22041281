#include <gtest/gtest.h>

#include <functional>
#include <ostream>

#include "tests/blind/scoring/case_result.hpp"
#include "tests/blind/scoring/made_up.hpp"
#include "tests/blind/scoring/result_log.hpp"
#include "tests/blind/scoring/seal.hpp"

namespace recald::blind::results_test {
namespace {

using nlohmann::json;

std::string line(const std::string& case_id, const std::string& method = "recald") {
  json result = made_up::result_json(case_id);
  result["method"] = method;
  return result.dump() + "\n";
}

TEST(CaseResults, ALineIsReadWhole) {
  const auto result = parse_case_result(made_up::result_json("sealed-017").dump(), "f line 1");
  ASSERT_TRUE(result.has_value()) << result.error().message;
  EXPECT_EQ(result->case_id, "sealed-017");
  EXPECT_EQ(result->method, "recald");
  EXPECT_EQ(result->outcome, Outcome::named);
  EXPECT_EQ(result->named, std::vector<std::string>{"night_setback_missing"});
  EXPECT_EQ(result->probabilities.at("none"), 0.06);
  EXPECT_EQ(result->gap->before.at("steam").log_score, -2.0);
  EXPECT_EQ(result->gap->oracle->at("steam").cvrmse, 0.2);
  EXPECT_EQ(result->other_meters.at("electricity").se, 0.1);
  EXPECT_EQ(result->parameters_before.at("cooling_setpoint_C").mean, 24.0);
  EXPECT_EQ(result->parameters_after.at("cooling_setpoint_C").q95, 25.0);
  EXPECT_EQ(result->effect_parameter->q05, 2.0);
  EXPECT_EQ(result->located, std::vector<std::string>{"steam"});
  EXPECT_EQ(result->wall_s, 12.5);
  EXPECT_EQ(result->peak_rss_MB, 80.0);
  EXPECT_EQ(result->version, "recald 0.1.0");
}

TEST(CaseResults, AMethodThatOnlySaysNoneIsComplete) {
  const auto result = parse_case_result(
      R"({"case":"a","method":"refit_only","outcome":"none","named":[],"extra":{"x":[1]}})", "f");
  ASSERT_TRUE(result.has_value()) << result.error().message;
  EXPECT_TRUE(result->probabilities.empty());
  EXPECT_FALSE(result->gap);
  EXPECT_FALSE(result->located);
  EXPECT_FALSE(result->wall_s);
}

struct Mistake {
  std::string name;
  std::function<void(json&)> make;
  std::string message;
  friend void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }
};

class ResultMistakes : public ::testing::TestWithParam<Mistake> {};

TEST_P(ResultMistakes, AreNamedInOneSentence) {
  json text = made_up::result_json("sealed-017");
  GetParam().make(text);
  const auto result = parse_case_result(text.dump(), "sealed.jsonl line 7");
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, ErrorCode::malformed);
  EXPECT_EQ(result.error().message, "sealed.jsonl line 7, case sealed-017: " + GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Each, ResultMistakes,
    ::testing::Values(
        Mistake{"SumAboveOne", [](json& r) { r["probabilities"]["none"] = 0.16; },
                "'probabilities' sum to 1.1, must sum to 1"},
        Mistake{"SumBelowOne", [](json& r) { r["probabilities"].erase("none"); },
                "'probabilities' sum to 0.94, must sum to 1"},
        Mistake{"NegativeProbability", [](json& r) { r["probabilities"]["none"] = -0.06; },
                "'probabilities.none' is -0.06, must be from 0 to 1"},
        Mistake{"ProbabilityAboveOne", [](json& r) { r["probabilities"]["unknown"] = 1.5; },
                "'probabilities.unknown' is 1.5, must be from 0 to 1"},
        Mistake{"NoProbabilityOfNamed",
                [](json& r) {
                  r["probabilities"] = {{"none", 0.5}, {"unknown", 0.5}};
                },
                "'named' has 'night_setback_missing', to which 'probabilities' gives none"},
        Mistake{"NamedWithoutName", [](json& r) { r["named"] = json::array(); },
                "'outcome' is 'named' with 0 effects in 'named'; it is 'named' exactly if an "
                "effect was added"},
        Mistake{"NameWithoutNamed", [](json& r) { r["outcome"] = "unknown"; },
                "'outcome' is 'unknown' with 1 effects in 'named'; it is 'named' exactly if an "
                "effect was added"},
        Mistake{"UnknownOutcome", [](json& r) { r["outcome"] = "maybe"; },
                "'outcome' is \"maybe\", must be one of named, confusable, unknown, none"},
        Mistake{"NoneAsName", [](json& r) { r["named"] = {"none"}; },
                "'none' is not the name of an effect"},
        Mistake{"NamedTwice",
                [](json& r) {
                  r["named"] = {"a", "a"};
                },
                "'named' is [\"a\",\"a\"], must be a list without repetition"},
        Mistake{
            "MisspeltKey", [](json& r) { r["wal_s"] = 1.0; },
            "key 'wal_s' is not known here; known are case, method, outcome, named, "
            "confusable, probabilities, gap, other_meters_log_score_change, "
            "parameters_before, parameters_after, effect_parameter, calibration, drift, located, "
            "wall_s, peak_rss_MB, version, extra"},
        Mistake{"OtherMetersAfter",
                [](json& r) {
                  r["gap"]["after"] = {{"water", r["gap"]["before"]["steam"]}};
                },
                "'gap' has different meters before, after and for the oracle"},
        Mistake{"NoMeterInGap",
                [](json& r) {
                  r["gap"] = {{"before", json::object()}, {"after", json::object()}};
                },
                "'gap.before' has no meter"},
        Mistake{"FitWithoutLogScore",
                [](json& r) { r["gap"]["before"]["steam"].erase("log_score"); },
                "'gap.before.steam.log_score' is missing"},
        Mistake{"NegativeError",
                [](json& r) { r["other_meters_log_score_change"]["electricity"]["se"] = -1; },
                "'other_meters_log_score_change.electricity.se' is -1, must be at least 0"},
        Mistake{"CrossedQuantiles",
                [](json& r) { r["parameters_after"]["cooling_setpoint_C"]["q05"] = 26; },
                "'parameters_after.cooling_setpoint_C' has q05 above q95"},
        Mistake{"CrossedInterval", [](json& r) { r["effect_parameter"]["q05"] = 5; },
                "'effect_parameter' has q05 above q95"},
        Mistake{"LocatedAsText", [](json& r) { r["located"] = {"steam"}; },
                "'located.0' is \"steam\", must be an object"},
        Mistake{"NegativeTime", [](json& r) { r["wall_s"] = -1; },
                "'wall_s' is -1, must be at least 0"}),
    [](const auto& instance) { return instance.param.name; });

TEST(CaseResults, RoundedProbabilitiesAreTaken) {
  json text = made_up::result_json("a");
  text["probabilities"]["none"] = 0.0615;
  EXPECT_TRUE(parse_case_result(text.dump(), "f").has_value());
  text["probabilities"]["none"] = 0.0625;
  EXPECT_FALSE(parse_case_result(text.dump(), "f").has_value());
}

TEST(CaseResults, NumbersBeyondADoubleAreNotTaken) {
  const auto result = parse_case_result(
      R"({"case":"a","method":"m","outcome":"none","named":[],"wall_s":1e999})", "f line 3");
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().message, "f line 3: not valid JSON");
}

// Whatever a byte turns into: a result, or one sentence that begins with the place.
TEST(CaseResults, AnyChangedByteIsReadOrNamed) {
  const std::string text = made_up::result_json("a").dump();
  int read = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    for (const char other : {'\0', '"', '}', '9', '-', '\xff'}) {
      std::string changed = text;
      changed[at] = other;
      const auto result = parse_case_result(changed, "f line 1");
      read += result.has_value();
      if (!result) {
        ASSERT_TRUE(result.error().message.starts_with("f line 1"));
      }
    }
  }
  EXPECT_GT(read, 0);
}

// A power cut may leave any prefix. The lines before the cut count, the torn one is reported with
// its size, and nothing else happens.
TEST(ResultLogs, TornAtEveryByteKeepTheWholeLines) {
  const std::vector<std::string> lines{line("a"), line("b"), line("c")};
  const std::string text = lines[0] + lines[1] + lines[2];
  for (std::size_t size = 0; size <= text.size(); ++size) {
    SCOPED_TRACE(size);
    std::size_t whole = 0;
    std::size_t end_of_whole = 0;
    while (whole < lines.size() && end_of_whole + lines[whole].size() <= size) {
      end_of_whole += lines[whole++].size();
    }
    const auto log = parse_results(std::string_view(text).substr(0, size), "f", Reruns::refuse);
    ASSERT_TRUE(log.has_value()) << log.error().message;
    EXPECT_EQ(log->results.size(), whole);
    EXPECT_EQ(log->hash, hash_of(text.substr(0, end_of_whole)));
    if (size == end_of_whole) {
      EXPECT_TRUE(log->torn.empty());
    } else {
      ASSERT_EQ(log->torn.size(), 1u);
      EXPECT_EQ(log->torn.front(),
                fmt::format("f line {}: torn after {} bytes, ignored; the case runs again",
                            whole + 1, size - end_of_whole));
    }
  }
}

// The runner goes on after the power cut: whatever was torn, the file ends up whole.
TEST(ResultLogs, AppendingAfterATearAtEveryByteMendsTheFile) {
  const testing::TemporaryFolder folder;
  const auto file = folder / "sealed.jsonl";
  const auto short_line = [](const char* case_id) {
    return fmt::format("{{\"case\":\"{}\",\"method\":\"m\",\"outcome\":\"none\",\"named\":[]}}\n",
                       case_id);
  };
  const std::string text = short_line("a") + short_line("b");
  for (std::size_t size = 0; size < text.size(); ++size) {
    SCOPED_TRACE(size);
    testing::write_text(file, text.substr(0, size));
    const bool has_first = size >= short_line("a").size();
    const auto appended = append_result(file, short_line(has_first ? "b" : "a"), Reruns::refuse);
    ASSERT_TRUE(appended.has_value()) << appended.error().message;
    ASSERT_EQ(testing::read_text(file), has_first ? text : short_line("a"));
  }
}

TEST(ResultLogs, AMalformedLineBeforeTheLastIsAnError) {
  const auto log =
      parse_results(line("a") + "{\"case\":\"b\",\"me" + line("c"), "f.jsonl", Reruns::refuse);
  ASSERT_FALSE(log.has_value());
  EXPECT_EQ(log.error().code, ErrorCode::malformed);
  EXPECT_EQ(log.error().message, "f.jsonl line 2: not valid JSON");
}

TEST(ResultLogs, RerunsAreRefusedWithBothLines) {
  const auto log =
      parse_results(line("a") + line("b") + line("a", "aic") + line("a"), "f", Reruns::refuse);
  ASSERT_FALSE(log.has_value());
  EXPECT_EQ(log.error().code, ErrorCode::invalid_value);
  EXPECT_EQ(log.error().message,
            "case a has two results of method recald: f line 1 and f line 4; give --allow-rerun to "
            "let the later one count");
}

TEST(ResultLogs, AllowedRerunsReplaceAndAreCounted) {
  json later = made_up::result_json("a");
  later["wall_s"] = 99.0;
  const auto log = parse_results(line("a") + line("b") + later.dump() + "\n", "f", Reruns::replace);
  ASSERT_TRUE(log.has_value()) << log.error().message;
  ASSERT_EQ(log->results.size(), 2u);
  EXPECT_EQ(log->results[0].wall_s, 99.0);
  EXPECT_EQ(log->replaced, 1);
}

TEST(ResultLogs, SeveralFilesAreReadAsOne) {
  const testing::TemporaryFolder folder;
  const std::vector files{folder / "recald.jsonl", folder / "aic.jsonl"};
  testing::write_text(files[0], line("a"));
  testing::write_text(files[1], line("a", "aic"));
  const auto log = read_results(files, Reruns::refuse);
  ASSERT_TRUE(log.has_value()) << log.error().message;
  EXPECT_EQ(log->results.size(), 2u);

  testing::write_text(files[1], line("a"));
  const auto twice = read_results(files, Reruns::refuse);
  ASSERT_FALSE(twice.has_value());
  EXPECT_NE(twice.error().message.find("recald.jsonl line 1 and"), std::string::npos);
  EXPECT_NE(twice.error().message.find("aic.jsonl line 1;"), std::string::npos);
}

TEST(ResultLogs, AppendingChecksBeforeItWrites) {
  const testing::TemporaryFolder folder;
  const auto file = folder / "sealed.jsonl";
  ASSERT_TRUE(append_result(file, line("a"), Reruns::refuse).has_value());

  const auto malformed = append_result(file, "{}", Reruns::refuse);
  ASSERT_FALSE(malformed.has_value());
  EXPECT_EQ(malformed.error().message, "the result to append: 'case' is missing");
  const auto two = append_result(file, line("b") + line("c"), Reruns::refuse);
  ASSERT_FALSE(two.has_value());
  EXPECT_EQ(two.error().message, "the result to append: more than one line");
  const auto again = append_result(file, line("a"), Reruns::refuse);
  ASSERT_FALSE(again.has_value());
  EXPECT_EQ(again.error().code, ErrorCode::invalid_value);
  EXPECT_EQ(testing::read_text(file), line("a"));

  ASSERT_TRUE(append_result(file, line("a"), Reruns::replace).has_value());
  EXPECT_EQ(testing::read_text(file), line("a") + line("a"));
}

TEST(ResultLogs, AppendingWhereNothingCanBeWrittenIsNamed) {
  const testing::TemporaryFolder folder;
  const auto appended = append_result(folder / "absent" / "f.jsonl", line("a"), Reruns::refuse);
  ASSERT_FALSE(appended.has_value());
  EXPECT_EQ(appended.error().code, ErrorCode::io_failed);
  EXPECT_EQ(appended.error().message, "cannot append to '" +
                                          (folder / "absent" / "f.jsonl").string() +
                                          "': No such file or directory");
}

TEST(ResultLogs, PendingAreTheCasesWithoutAWholeLineOfTheMethod) {
  const testing::TemporaryFolder folder;
  for (const char* name : {"b", "a", "c"}) {
    std::filesystem::create_directories(folder.path() / "population" / name);
    testing::write_text(folder.path() / "population" / name / "site.toml", "");
  }
  std::filesystem::create_directories(folder / "population/no_case");
  const auto file = folder / "sealed.jsonl";
  const auto pending = [&](const std::string& method) {
    return pending_cases(folder / "population", file, method).value().cases;
  };
  EXPECT_EQ(pending("recald"), (std::vector<std::string>{"a", "b", "c"}));

  testing::write_text(file, line("b") + line("a", "aic") + line("c").substr(0, 40));
  EXPECT_EQ(pending("recald"), (std::vector<std::string>{"a", "c"}));
  EXPECT_EQ(pending("aic"), (std::vector<std::string>{"b", "c"}));
  EXPECT_EQ(pending_cases(folder / "population", file, "recald").value().torn,
            std::vector<std::string>{file.string() +
                                     " line 3: torn after 40 bytes, ignored; the case runs again"});
}

TEST(ResultLogs, APopulationWithoutCasesIsNamed) {
  const testing::TemporaryFolder folder;
  const auto pending = pending_cases(folder.path(), folder / "f.jsonl", "recald");
  ASSERT_FALSE(pending.has_value());
  EXPECT_EQ(pending.error().code, ErrorCode::not_found);
  EXPECT_EQ(pending.error().message,
            "no case (a folder with a site.toml) in '" + folder.path().string() + "'");
}

}  // namespace
}  // namespace recald::blind::results_test
