/// The program itself, with a shell script in the place of recald.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

#include "tests/blind/running/made_up_diagnosis.hpp"
#include "tests/blind/scoring/gap_scores.hpp"
#include "tests/blind/scoring/made_up.hpp"
#include "tests/blind/scoring/result_log.hpp"

namespace recald::blind::run_program_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// `diagnose CASE/site.toml --out DIR ...` notes its arguments, then does what the site file says.
constexpr const char* kFakeRecald = R"sh(#!/bin/sh
[ "$1" != --version ] || { echo 9.9; exit; }
here=$(dirname "$0")
echo "$(basename "$(dirname "$2")") $*" >> "$here/calls"
out=$4
. "$2"
)sh";

class BlindRun : public ::testing::Test {
 protected:
  BlindRun() {
    testing::write_text(folder_ / "recald", kFakeRecald);
    std::filesystem::permissions(folder_ / "recald", std::filesystem::perms::owner_all);
    testing::write_text(folder_ / "named.json", made_up::diagnosis().dump());
    testing::write_text(folder_ / "calls", "");
  }

  /// @param script  What the program does there; it may use $here and $out.
  void add_case(const std::string& name,
                const std::string& script = "cp \"$here/named.json\" \"$out/diagnosis.json\"") {
    std::filesystem::create_directories(folder_.path() / "cases" / name);
    testing::write_text(folder_.path() / "cases" / name / "site.toml", script + "\n");
  }

  /// Runs in the test's folder. @return the exit code; output and errors are in `said_`.
  int run(const std::string& options = "") {
    const std::string command = "cd '" + folder_.path().string() + "' && '" + BLIND_RUN_PROGRAM +
                                "' --population . --results r --recald ./recald " + options +
                                " > said 2>&1";
    const int status = std::system(command.c_str());
    said_ = testing::read_text(folder_ / "said");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  [[nodiscard]] std::vector<CaseResult> results() const {
    const std::filesystem::path file = folder_ / "r";
    const auto log = read_results({&file, 1}, Reruns::refuse);
    EXPECT_TRUE(log.has_value()) << log.error().message;
    return log ? log->results : std::vector<CaseResult>();
  }

  [[nodiscard]] Json line(std::size_t number) const {
    std::istringstream text(testing::read_text(folder_ / "r"));
    std::string found;
    for (std::size_t i = 0; i <= number; ++i) std::getline(text, found);
    return Json::parse(found);
  }

  [[nodiscard]] std::vector<std::string> cases_called() const {
    std::vector<std::string> names;
    std::istringstream calls(testing::read_text(folder_ / "calls"));
    for (std::string call; std::getline(calls, call);) {
      names.push_back(call.substr(0, call.find(' ')));
    }
    return names;
  }

  testing::TemporaryFolder folder_;
  std::string said_;
};

TEST_F(BlindRun, ALineForEachCase) {
  add_case("a");
  add_case("b");
  ASSERT_EQ(run("--jobs 1"), 0) << said_;
  EXPECT_THAT(said_, HasSubstr("recald: 2 of 2 cases have a line in r, 2 of them new; 0 of the "
                               "new without a diagnosis, 0 of these over 90 s\n"));
  const auto lines = results();
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[1].case_id, "b");
  EXPECT_THAT(lines[1].named, ElementsAre("scale_fault", "clock_offset"));
  EXPECT_GT(lines[1].peak_rss_MB.value_or(0.0), 0.0);
  EXPECT_THAT(testing::read_text(folder_ / "calls"), HasSubstr("--seed 1"));
}

TEST_F(BlindRun, ACalibrationInThePlaceOfADiagnosis) {
  add_case("a", R"sh(cat > "$out/calibration.json" <<'END'
{"before":    {"validation": {"gas_daily_kWh": {"cvrmse": 0.4}, "gas_peak_kW": {"cvrmse": 9},
                             "steam_daily_kWh": {"cvrmse": null}}},
 "after":     {"validation": {"gas_daily_kWh": {"cvrmse": 0.3}, "steam_daily_kWh": {"cvrmse": 1}}},
 "forecast":  {"validation": {"gas_daily_kWh": {"cvrmse": 0.1}}},
 "yardstick": {"validation": {"gas_daily_kWh": {"cvrmse": 0.2}, "steam_daily_kWh": null}}}
END)sh");
  add_case("b", "echo '{}' > \"$out/calibration.json\"");
  ASSERT_EQ(run("--jobs 1 --method calibrate"), 0) << said_;
  EXPECT_THAT(testing::read_text(folder_ / "calls"), HasSubstr("a calibrate "));
  const auto lines = results();
  ASSERT_EQ(lines.size(), 2u);
  ASSERT_EQ(lines[0].calibration.size(), 1u);
  EXPECT_DOUBLE_EQ(lines[0].calibration.at("gas").before, 0.4);
  EXPECT_DOUBLE_EQ(lines[0].calibration.at("gas").yardstick, 0.2);
  EXPECT_EQ(line(1)["extra"]["failed"], "calibration.json has no 'before' of unseen months");
}

TEST_F(BlindRun, MonthsFollowedInThePlaceOfADiagnosis) {
  add_case("a", R"sh(cat > "$out/drift.json" <<'END'
{"months": ["2021-01", "2021-02", "2021-03", "2021-04"], "learning_months": 2,
 "alarms": [{"month": "2021-04", "causes": [
   {"kind": "use", "subject": "electricity use", "probability": 0.7},
   {"kind": "nothing", "subject": null, "probability": 0.3}]},
  {"month": "2021-03", "causes": []}],
 "meter_changes": [{"meter": "gas", "kind": "unit", "since": "2021-02", "seen": "2021-03"},
                   {"meter": "steam", "kind": "readings", "since": "2021-01", "seen": "2021-02"}]}
END)sh");
  add_case("b", R"sh(echo '{"months": ["2021-01"], "learning_months": 1}' > "$out/drift.json")sh");
  ASSERT_EQ(run("--jobs 1 --method drift"), 0) << said_;
  EXPECT_THAT(testing::read_text(folder_ / "calls"), HasSubstr("a drift "));
  EXPECT_THAT(testing::read_text(folder_ / "calls"), HasSubstr("--threads 1"));
  const auto lines = results();
  ASSERT_EQ(lines.size(), 2u);
  ASSERT_TRUE(lines[0].drift);
  EXPECT_EQ(lines[0].drift->from, "2021-03");
  EXPECT_EQ(lines[0].drift->to, "2021-04");
  ASSERT_EQ(lines[0].drift->alarms.size(), 3u);
  EXPECT_EQ(lines[0].drift->alarms[0].kind, "use");
  EXPECT_EQ(lines[0].drift->alarms[1].kind, "nothing");
  EXPECT_EQ(lines[0].drift->alarms[2].kind, "meter");
  EXPECT_EQ(lines[0].drift->alarms[2].month, "2021-03");
  EXPECT_EQ(lines[0].drift->alarms[2].subject, "gas");
  EXPECT_FALSE(lines[1].drift);
  EXPECT_EQ(line(1)["extra"]["failed"], "drift.json watches no month");
}

TEST_F(BlindRun, GoesOnWhereItWasStopped) {
  for (const char* name : {"a", "b", "c", "d"}) add_case(name);
  ASSERT_EQ(run("--jobs 1 --cases 2-3"), 0) << said_;
  EXPECT_THAT(cases_called(), ElementsAre("b", "c"));
  const std::string text = testing::read_text(folder_ / "r");
  testing::write_text(folder_ / "r", text.substr(0, text.size() - 9));  // the power was cut
  ASSERT_EQ(run("--jobs 1"), 0) << said_;
  EXPECT_THAT(said_, HasSubstr("r line 2: torn"));
  EXPECT_THAT(said_, HasSubstr("4 of 4 cases have a line in r, 3 of them new"));
  EXPECT_THAT(cases_called(), ElementsAre("b", "c", "a", "c", "d"));
  ASSERT_EQ(run(), 0) << said_;
  EXPECT_EQ(cases_called().size(), 5u);
  EXPECT_EQ(results().size(), 4u);
}

TEST_F(BlindRun, AFailureIsALineThatSaysWhy) {
  add_case("a", "echo 'recald: no reading in 2016' >&2; echo; exit 1");
  add_case("b", "kill -SEGV $$");
  add_case("c", "exit 0");
  add_case("d", "echo '{' > \"$out/diagnosis.json\"");
  add_case("e", "echo '{}' > \"$out/diagnosis.json\"");
  ASSERT_EQ(run("--jobs 1"), 0) << said_;
  EXPECT_THAT(said_, HasSubstr("5 of the new without a diagnosis, 0 of these over 90 s"));
  ASSERT_EQ(results().size(), 5u);
  EXPECT_EQ(results()[0].outcome, Outcome::none);
  EXPECT_EQ(results()[0].version, "recald 9.9");
  EXPECT_EQ(line(0)["extra"]["failed"], "exit code 1: recald: no reading in 2016");
  EXPECT_EQ(line(1)["extra"]["failed"], "ended by signal 11");
  EXPECT_EQ(line(2)["extra"]["failed"], "exit code 0, but no diagnosis.json");
  EXPECT_EQ(line(3)["extra"]["failed"], "diagnosis.json is no JSON");
  EXPECT_THAT(line(4)["extra"]["failed"].get<std::string>(), HasSubstr("'outcome' not found"));
}

TEST_F(BlindRun, NoDiagnosisTakesLongerThanTheLimit) {
  add_case("a", "sleep 1000");
  ASSERT_EQ(run("--limit-s 0.2"), 0) << said_;
  EXPECT_THAT(said_, HasSubstr("1 of the new without a diagnosis, 1 of these over 0.2 s"));
  EXPECT_EQ(line(0)["outcome"], "none");
  EXPECT_EQ(line(0)["extra"]["failed"], "no diagnosis within 0.2 s");
}

TEST_F(BlindRun, WhatWouldSpoilEveryCaseEndsTheRun) {
  add_case("a", "echo 'recald: --assume: unknown option' >&2; exit 2");
  add_case("b");
  EXPECT_EQ(run("--jobs 1"), 1);
  EXPECT_THAT(said_, HasSubstr("a: the program refuses its arguments: recald: --assume"));
  EXPECT_THAT(cases_called(), ElementsAre("a"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "r"));
  std::filesystem::remove(folder_ / "recald");
  EXPECT_EQ(run(), 1);
  EXPECT_THAT(said_, HasSubstr("cannot start './recald'"));
}

TEST_F(BlindRun, WhoStopsItLosesNothing) {
  add_case("a");
  add_case("b", "kill -TERM $PPID; sleep 1000");
  EXPECT_EQ(run("--jobs 1"), 130);
  EXPECT_THAT(said_, HasSubstr("stopped; the same command goes on"));
  ASSERT_EQ(results().size(), 1u);
  EXPECT_EQ(results()[0].case_id, "a");
}

TEST_F(BlindRun, KeepsDiagnosesIfAsked) {
  add_case("a");
  ASSERT_EQ(run("--keep kept"), 0) << said_;
  EXPECT_EQ(testing::read_text(folder_.path() / "kept" / "a.json"),
            testing::read_text(folder_ / "named.json"));
}

TEST_F(BlindRun, TheOracleIsToldWhatIsHidden) {
  for (const char* name : {"a", "b", "c"}) add_case(name);
  std::filesystem::create_directories(folder_ / "answers");
  auto pair = made_up::answer_json("a");
  pair["block"] = "pair";
  pair["effects"].push_back(pair["effects"][0]);
  pair["effects"][1]["effect"] = "scale_fault";
  pair["effects"][1]["share_of_meter"] = {{"electricity", 0.01}, {"heating", -0.05}};
  auto outside = made_up::answer_json("b");
  outside["block"] = "out_of_catalogue";
  outside["effects"][0]["in_catalogue"] = false;
  auto nothing = made_up::answer_json("c");
  nothing["block"] = "no_effect";
  nothing["effects"] = nlohmann::json::array();
  for (const auto& answer : {pair, outside, nothing}) {
    testing::write_text(folder_.path() / "answers" / (answer["case"].get<std::string>() + ".json"),
                        answer.dump());
  }
  ASSERT_EQ(run("--method oracle --answers answers"), 0) << said_;
  EXPECT_THAT(said_, HasSubstr("oracle: 1 of 1 cases have a line"));
  EXPECT_THAT(cases_called(), ElementsAre("a"));
  EXPECT_THAT(testing::read_text(folder_ / "calls"),
              HasSubstr("--assume night_setback_missing --assume scale_fault:heating\n"));

  // And the scorer finds what it asks for.
  const OracleGaps gaps = oracle_gaps(results());
  ASSERT_TRUE(gaps.contains("a"));
  EXPECT_EQ(gaps.at("a").after.at("electricity").cvrmse, 0.05);
}

TEST_F(BlindRun, WhoHasNoUseForAnswersIsNotGivenThem) {
  add_case("a");
  EXPECT_EQ(run("--answers answers"), 2);
  EXPECT_THAT(said_, HasSubstr("--answers is for method oracle alone"));
  EXPECT_EQ(run("--method oracle"), 2);
  EXPECT_EQ(run("--cases 2"), 2);
  EXPECT_THAT(said_, HasSubstr("--cases 2: give one number or two with a dash, 1 to 1"));
  EXPECT_EQ(cases_called().size(), 0u);
}

}  // namespace
}  // namespace recald::blind::run_program_test
