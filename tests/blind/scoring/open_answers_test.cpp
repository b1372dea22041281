#include "tests/blind/scoring/open_answers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/blind/scoring/made_up.hpp"
#include "tests/blind/scoring/seal.hpp"

namespace recald::blind {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

/// Three sealed singles, each with the effect night_setback_missing, and results that name it.
class OpeningAnswers : public ::testing::Test {
 protected:
  OpeningAnswers() {
    std::filesystem::create_directories(folder_ / "answers");
    for (const char* name : {"a", "b", "c"}) {
      testing::write_text(folder_ / "answers" / (std::string(name) + ".json"),
                          made_up::answer_json(name).dump());
    }
    whole_ = seal_answers(folder_ / "answers").value();
    write_results({"a", "b", "c"});
    request_.answers = folder_ / "answers";
    request_.results = {results()};
    request_.out = folder_ / "scores.json";
    request_.scorer_version = "recald test";
    request_.now = std::chrono::sys_seconds{std::chrono::hours{24 * 365}};
  }

  [[nodiscard]] std::filesystem::path results() const { return folder_ / "sealed.jsonl"; }
  [[nodiscard]] std::filesystem::path record() const { return folder_ / "answers/opened.json"; }

  void write_results(const std::vector<std::string>& cases, const std::string& tail = "") {
    std::string text;
    for (const std::string& name : cases) text += made_up::result_json(name).dump() + "\n";
    testing::write_text(results(), text + tail);
  }

  void expect_refused(const std::string& message) {
    const auto opened = open_answers(request_);
    ASSERT_FALSE(opened.has_value());
    EXPECT_EQ(opened.error().message, message);
    EXPECT_FALSE(std::filesystem::exists(request_.out));
    EXPECT_FALSE(std::filesystem::exists(record()));
  }

  std::string opened() {
    const auto said = open_answers(request_);
    EXPECT_TRUE(said.has_value()) << said.error().message;
    return said.value_or("");
  }

  [[nodiscard]] json scores() const { return json::parse(testing::read_text(request_.out)); }
  [[nodiscard]] std::string page() const { return testing::read_text(folder_ / "scores.md"); }

  testing::TemporaryFolder folder_;
  std::string whole_;
  OpenRequest request_;
};

TEST_F(OpeningAnswers, WritesScoresAPageAndARecord) {
  EXPECT_EQ(opened(),
            "3 of 3 cases right; wrote " + request_.out.string() + " and the page beside it\n");
  EXPECT_EQ(scores()["naming"]["right"]["hits"], 3);
  EXPECT_EQ(scores()["answers_sha256"], whole_);
  EXPECT_EQ(scores()["versions"]["recald 0.1.0"], 3);
  EXPECT_TRUE(scores()["warnings"].empty());
  EXPECT_THAT(page(), HasSubstr("Right answer: 3 of 3: 100 % (29 to 100)."));
  EXPECT_THAT(page(), HasSubstr("## Failures\n\nNone.\n"));

  const json record_read = json::parse(testing::read_text(record()));
  ASSERT_EQ(record_read.size(), 1u);
  EXPECT_EQ(record_read[0]["opened_at"], "1971-01-01T00:00:00Z");
  EXPECT_EQ(record_read[0]["scorer"], "recald test");
  EXPECT_EQ(record_read[0]["whole_sha256"], whole_);
  EXPECT_EQ(record_read[0]["results_sha256"], hash_of(testing::read_text(results())));
  EXPECT_EQ(record_read[0]["cases_of_version"]["recald 0.1.0"], 3);
}

TEST_F(OpeningAnswers, IsVisibleWhenItIsNotTheFirst) {
  (void)opened();
  (void)opened();
  EXPECT_THAT(opened(),
              HasSubstr("The answers were opened 2 times before, last at 1971-01-01T00:00:00Z\n"));
  EXPECT_THAT(page(), HasSubstr("**The answers were opened 2 times before"));
  EXPECT_EQ(scores()["warnings"].size(), 1u);
  EXPECT_EQ(json::parse(testing::read_text(record())).size(), 3u);
}

TEST_F(OpeningAnswers, RefusesAChangedAnswer) {
  json changed = made_up::answer_json("b");
  changed["effects"][0]["strength"] = 4.0;
  testing::write_text(folder_ / "answers/b.json", changed.dump());
  expect_refused((folder_ / "answers/b.json").string() +
                 ": the answer was changed after it was sealed; not opened");
}

TEST_F(OpeningAnswers, RefusesAnotherPublishedHash) {
  request_.published = std::string(64, 'a');
  expect_refused((folder_ / "answers/answers.sha256").string() + ": the whole is " + whole_ +
                 ", but " + std::string(64, 'a') + " was published; not opened");
}

TEST_F(OpeningAnswers, RefusesWhenCasesAreMissing) {
  write_results({"b"});
  expect_refused(
      "method recald: 2 of 3 cases have no result (a, c); run them, or give --partial; nothing was "
      "opened");
}

TEST_F(OpeningAnswers, RefusesWhenTheMethodHasNoResultAtAll) {
  request_.options.method = "reclad";
  expect_refused(
      "method reclad: 3 of 3 cases have no result (a, b, c); run them, or give --partial; nothing "
      "was opened");
}

TEST_F(OpeningAnswers, ScoresAPartAndSaysSoOnTop) {
  write_results({"b"}, made_up::result_json("c").dump().substr(0, 50));
  request_.partial = true;
  const std::string missing = "Partial: method recald: 2 of 3 cases have no result (a, c)";
  const std::string torn =
      results().string() + " line 2: torn after 50 bytes, ignored; the case runs again";
  EXPECT_THAT(opened(), HasSubstr(missing + "\n" + torn + "\n1 of 1 cases right"));
  EXPECT_TRUE(page().starts_with("# Blind test: what recald said\n\n**" + missing + ".**\n\n**" +
                                 torn + ".**\n\n1 of 3 cases scored"));
  EXPECT_EQ(scores()["cases"], 1);
  EXPECT_EQ(scores()["population_cases"], 3);
}

TEST_F(OpeningAnswers, PartOfNothingIsScoredToo) {
  testing::write_text(results(), "");
  request_.partial = true;
  EXPECT_THAT(opened(), HasSubstr("0 of 0 cases right"));
  EXPECT_TRUE(scores()["naming"]["right"].is_null());
}

TEST_F(OpeningAnswers, RefusesReruns) {
  write_results({"a", "b", "c", "a"});
  const std::string file = results().string();
  expect_refused("case a has two results of method recald: " + file + " line 1 and " + file +
                 " line 4; give --allow-rerun to let the later one count");
  request_.reruns = Reruns::replace;
  EXPECT_THAT(opened(), HasSubstr("1 results were replaced by later reruns\n3 of 3"));
}

TEST_F(OpeningAnswers, RefusesResultsOfAnotherPopulation) {
  write_results({"a", "b", "c", "training-001"});
  expect_refused(
      "the results of method recald name the case training-001, to which there is no answer; "
      "results of another population?");
}

TEST_F(OpeningAnswers, RefusesAnOutputWithoutJson) {
  request_.out = folder_ / "scores.md";
  expect_refused("--out is '" + request_.out.string() + "', must end in .json");
}

TEST_F(OpeningAnswers, RefusesListedClassesThatDisagree) {
  request_.classes = folder_ / "classes.json";
  testing::write_text(*request_.classes, R"({"night_setback_missing": "plant"})");
  expect_refused(
      "answer a: effect night_setback_missing is of class schedules, but of class plant elsewhere");
  testing::write_text(*request_.classes, R"({"night_setback_missing": 3})");
  expect_refused(request_.classes->string() + ": 'night_setback_missing' is 3, must be a text");
  testing::write_text(*request_.classes, "[]");
  expect_refused(request_.classes->string() + ": must be a JSON object, not []");
}

TEST_F(OpeningAnswers, ListedClassesJudgeNamesThatAreHiddenNowhere) {
  std::string text;
  for (const char* name : {"a", "b", "c"}) {
    json result = made_up::result_json(name);
    result["named"] = {"holiday_missing"};
    result["probabilities"] = {{"holiday_missing", 1.0}};
    text += result.dump() + "\n";
  }
  testing::write_text(results(), text);
  const auto class_hits = [&] {
    (void)opened();
    return scores()["naming"]["groups"][0]["class_right"]["hits"].get<int>();
  };
  EXPECT_EQ(class_hits(), 0);
  request_.classes = folder_ / "classes.json";
  testing::write_text(*request_.classes, R"({"holiday_missing": "schedules"})");
  EXPECT_EQ(class_hits(), 3);
}

TEST_F(OpeningAnswers, MixedVersionsAreMentioned) {
  json other = made_up::result_json("c");
  other["version"] = "recald 0.2.0";
  write_results({"a", "b"}, other.dump() + "\n");
  EXPECT_THAT(opened(), HasSubstr("The cases were run by 2 different versions of recald\n"));
}

TEST_F(OpeningAnswers, FailuresStandByCaseWithTruthAndWhatWasSaid) {
  json wrong = made_up::result_json("c");
  wrong["named"] = {"holiday_missing"};
  wrong["probabilities"] = {{"holiday_missing", 0.83}, {"none", 0.17}};
  write_results({"a", "b"}, wrong.dump() + "\n");
  (void)opened();
  EXPECT_THAT(page(), HasSubstr("| c | single | night_setback_missing, 3 K from 2022-03-01, "
                                "+1.0 % of electricity, +9.0 % of steam (moves 9.0 %) | "
                                "holiday_missing (P 0.83) |\n"));
  EXPECT_THAT(page(), Not(HasSubstr("| b | single |")));
  EXPECT_EQ(scores()["failures"][0]["case"], "c");
}

// Scores depend on what was said, not on when: the order of the lines and the clock leave no trace.
TEST_F(OpeningAnswers, SameResultsSameBytesWhateverTheirOrderAndTheHour) {
  const auto scores_in_order = [&](const std::vector<std::string>& cases) {
    std::string text;
    for (const std::string& name : cases) {
      json wrong = made_up::result_json(name);
      wrong["named"] = {"holiday_missing"};
      wrong["probabilities"] = {{"holiday_missing", 1.0}};
      text += wrong.dump() + "\n";
    }
    testing::write_text(results(), text);
    (void)opened();
    std::filesystem::remove(record());
    json found = scores();
    found.erase("results_sha256");  // of the bytes that were read
    return found.dump();
  };
  const std::string first = scores_in_order({"a", "b", "c"});
  request_.now += std::chrono::hours{5};
  EXPECT_EQ(scores_in_order({"c", "a", "b"}), first);
}

TEST_F(OpeningAnswers, ScoresThatCannotBeWrittenAreAnOpeningAllTheSame) {
  request_.out = folder_ / "absent/scores.json";
  const auto said = open_answers(request_);
  ASSERT_FALSE(said.has_value());
  EXPECT_EQ(said.error().code, ErrorCode::io_failed);
  EXPECT_TRUE(std::filesystem::exists(record()));
}

}  // namespace
}  // namespace recald::blind
