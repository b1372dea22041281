#include "tests/blind/running/diagnosis_line.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/blind/running/made_up_diagnosis.hpp"
#include "tests/blind/running/strength_of_answer.hpp"

namespace recald::blind::diagnosis_line_test {
namespace {

using ::testing::HasSubstr;

const CaseRun kRun{"sealed-017", "recald", 21.5, 20.0, 140.0, "recald 0.1.0"};

/// The line, or an empty one with the error in the test's log.
Json line_of(const Json& diagnosis) {
  const auto line = diagnosis_line(diagnosis, kRun);
  EXPECT_TRUE(line.has_value()) << line.error().message;
  return line.value_or(Json::object());
}

TEST(DiagnosisLine, NamesWithTheirGapAndCost) {
  Json line = line_of(made_up::diagnosis());
  EXPECT_EQ(line["case"], "sealed-017");
  EXPECT_EQ(line["method"], "recald");
  EXPECT_EQ(line["outcome"], "named");
  EXPECT_EQ(line["named"], (Json{"scale_fault", "clock_offset"}));
  EXPECT_EQ(line["gap"]["before"]["electricity"], (Json{{"log_score", -60.0}, {"cvrmse", 0.2}}));
  EXPECT_EQ(line["gap"]["after"]["heating"], (Json{{"log_score", -51.0}, {"cvrmse", 0.12}}));
  EXPECT_EQ(line["wall_s"], 21.5);
  EXPECT_EQ(line["extra"]["cpu_s"], 20.0);
  EXPECT_EQ(line["peak_rss_MB"], 140.0);
  EXPECT_EQ(line["version"], "recald 0.1.0");
}

TEST(DiagnosisLine, MetersOfOneNameShareItsProbability) {
  Json line = line_of(made_up::diagnosis());
  EXPECT_DOUBLE_EQ(line["probabilities"]["scale_fault"].get<double>(), 0.8);
  EXPECT_DOUBLE_EQ(line["probabilities"]["none"].get<double>(), 0.15);
}

// The scorer wants a probability of all that was named; the first pass gave this one none.
TEST(DiagnosisLine, WhatOnlyALaterPassFoundHadNoProbability) {
  EXPECT_EQ(line_of(made_up::diagnosis())["probabilities"]["clock_offset"], 0.0);
}

TEST(DiagnosisLine, MetersAreLocatedOnceAndInOrder) {
  EXPECT_EQ(line_of(made_up::diagnosis())["located"],
            Json::array({{{"meter", "heating"}}, {{"meter", "electricity"}}}));
}

TEST(DiagnosisLine, HarmIsAskedOfTheMetersThatDidNotGainMost) {
  Json diagnosis = made_up::diagnosis();
  EXPECT_EQ(line_of(diagnosis)["other_meters_log_score_change"],
            (Json{{"heating", {{"mean", -7.0}, {"se", 2.0}}}}));
  diagnosis["gap"]["hourly"]["log_score_change"]["heating"]["se"] = 0.0;  // a single month
  EXPECT_EQ(line_of(diagnosis)["other_meters_log_score_change"], Json::object());
}

TEST(DiagnosisLine, TheFirstEffectsIntervalIsInTheAnswersTerms) {
  Json interval = line_of(made_up::diagnosis())["effect_parameter"];
  EXPECT_NEAR(interval["q05"].get<double>(), -0.1, 1e-12);  // a scale of 0.9 is 10 % too little
  EXPECT_NEAR(interval["q95"].get<double>(), -0.06, 1e-12);
  EXPECT_EQ(interval["unit"], "share above what is right, negative for below");
}

TEST(DiagnosisLine, ATurnedSignTurnsTheInterval) {
  Json diagnosis = made_up::diagnosis();
  diagnosis["additions"].erase(0);
  Json interval = line_of(diagnosis)["effect_parameter"];
  EXPECT_EQ(interval["q05"], -30.0);  // minutes fast
  EXPECT_EQ(interval["q95"], 60.0);
}

TEST(DiagnosisLine, AnotherQuantityKeepsItsUnit) {
  Json diagnosis = made_up::diagnosis();
  diagnosis["additions"][0] =
      made_up::addition("server_room", made_up::parameter("power", "kW", 3.0, 5.0));
  EXPECT_EQ(line_of(diagnosis)["effect_parameter"],
            (Json{{"q05", 3.0}, {"q95", 5.0}, {"unit", "kW"}}));
}

TEST(DiagnosisLine, BaseParametersIfTheyAreThere) {
  Json diagnosis = made_up::diagnosis();
  EXPECT_FALSE(line_of(diagnosis).contains("parameters_after"));
  Json posterior = made_up::parameter("cooling_setpoint", "degC", 23.0, 25.0);
  diagnosis["parameters_before"] = Json::array({posterior});
  posterior["mean"] = 23.9;
  diagnosis["parameters_after"] = Json::array({posterior});
  Json line = line_of(diagnosis);
  EXPECT_EQ(line["parameters_before"]["cooling_setpoint"]["mean"], 24.0);  // the mode
  EXPECT_EQ(line["parameters_after"]["cooling_setpoint"]["mean"], 23.9);
}

// With the gap of what was withdrawn the scorer would take the reverted model for the result.
TEST(DiagnosisLine, WhatWasTakenBackClosesNoGap) {
  Json diagnosis = made_up::diagnosis();
  diagnosis["outcome"] = "unknown";
  diagnosis["not_confirmed"] = true;
  diagnosis["added"] = Json::array();
  Json line = line_of(diagnosis);
  EXPECT_EQ(line["outcome"], "unknown");
  EXPECT_EQ(line["named"], Json::array());
  EXPECT_FALSE(line.contains("gap"));
  EXPECT_FALSE(line.contains("effect_parameter"));
  EXPECT_EQ(line["extra"]["taken_back"], (Json{"scale_fault", "clock_offset"}));
}

TEST(DiagnosisLine, AConfusableSetHasEachNameOnce) {
  Json diagnosis = made_up::empty_diagnosis();
  diagnosis["outcome"] = "confusable";
  diagnosis["confusable"] = {"scale_fault", "scale_fault", "phase_lost"};
  EXPECT_EQ(line_of(diagnosis)["confusable"], (Json{"scale_fault", "phase_lost"}));
}

TEST(DiagnosisLine, MetersWithoutFiguresAreLeftOutOfTheGap) {
  Json diagnosis = made_up::diagnosis();
  Json& hourly = diagnosis["gap"]["hourly"];
  hourly["after"]["heating"]["cvrmse"] = nullptr;
  Json line = line_of(diagnosis);
  EXPECT_TRUE(line["gap"]["before"].contains("electricity"));
  EXPECT_FALSE(line["gap"]["before"].contains("heating"));
  hourly["before"]["electricity"]["log_score"] = nullptr;
  EXPECT_FALSE(line_of(diagnosis).contains("gap"));
}

TEST(DiagnosisLine, WhatIsMissingIsNamed) {
  Json diagnosis = made_up::diagnosis();
  diagnosis.erase("candidates");
  const auto line = diagnosis_line(diagnosis, kRun);
  ASSERT_FALSE(line.has_value());
  EXPECT_EQ(line.error().code, ErrorCode::malformed);
  EXPECT_THAT(line.error().message, HasSubstr("candidates"));
}

TEST(DiagnosisLine, WhatTheScorerWouldRefuseIsNoLine) {
  Json diagnosis = made_up::diagnosis();
  diagnosis["added"] = Json::array();  // but the outcome is "named"
  const auto line = diagnosis_line(diagnosis, kRun);
  ASSERT_FALSE(line.has_value());
  EXPECT_THAT(line.error().message, HasSubstr("'outcome' is 'named' with 0 effects"));
}

TEST(OracleLine, ItsGapCountsEvenIfTakenBack) {
  Json diagnosis = made_up::diagnosis();
  diagnosis["outcome"] = "unknown";
  diagnosis["added"] = Json::array();
  const auto line = oracle_line(diagnosis, {"sealed-017", "oracle"}, {"scale_fault"});
  ASSERT_TRUE(line.has_value()) << line.error().message;
  EXPECT_EQ((*line)["outcome"], "named");
  EXPECT_EQ((*line)["named"], (Json{"scale_fault"}));
  EXPECT_EQ((*line)["gap"]["after"]["electricity"]["cvrmse"], 0.05);
}

TEST(OracleLine, WithoutAGapThereIsNone) {
  const auto line =
      oracle_line(made_up::empty_diagnosis(), {"sealed-017", "oracle"}, {"scale_fault"});
  ASSERT_FALSE(line.has_value());
  EXPECT_EQ(line.error().code, ErrorCode::not_found);
}

TEST(FailureLine, CountsAsNoneAndSaysWhy) {
  Json line = failure_line(kRun, "no diagnosis within 90 s");
  EXPECT_EQ(line["outcome"], "none");
  EXPECT_EQ(line["extra"]["failed"], "no diagnosis within 90 s");
  EXPECT_EQ(line["wall_s"], 21.5);
}

}  // namespace
}  // namespace recald::blind::diagnosis_line_test
