/// Which alarm a management system is told of, and as which number.
#include "daemon/gateway/registers/drift_facts.hpp"

#include <gtest/gtest.h>

namespace recald::daemon::drift_facts_test {
namespace {

OutputDrift output(const std::string& name, double log_evidence, double daily = kAbsent) {
  OutputDrift one{.output = name, .month = "2026-03"};
  one.log_evidence = log_evidence;
  one.log_threshold = 8.0;
  one.daily = DailyEvidence{.log_evidence = daily, .log_threshold = 10.0};
  return one;
}

DriftAlarm alarm(const std::string& output, const std::string& month, drift::CauseKind kind,
                 const std::string& subject) {
  DriftAlarm one;
  one.output = output;
  one.month = month;
  one.since = "2026-01";
  one.explained_until = "2026-03";
  one.consequence = drift::Consequence::none;
  one.causes.push_back({.kind = kind, .subject = subject, .probability = 0.8});
  return one;
}

TEST(DriftFacts, TheHighestEvidenceOfAMetersOutputsCounts) {
  DriftSummary drift;
  EXPECT_EQ(drift_of(drift, "main").state, DriftState::not_followed);
  drift.outputs = {output("main_daily_kWh", 2.0), output("main_peak_kW", -1.0, 3.9),
                   output("main_2_daily_kWh", 7.9)};
  EXPECT_EQ(drift_of(drift, "main").state, DriftState::as_forecast);
  EXPECT_DOUBLE_EQ(drift_of(drift, "main").evidence, 0.39);
  EXPECT_EQ(drift_of(drift, "main").alarm, AlarmCode::none);
  EXPECT_EQ(drift_of(drift, "main_2").state, DriftState::rising);
}

TEST(DriftFacts, AnOpenAlarmHasItsLikeliestCause) {
  DriftSummary drift;
  drift.outputs = {output("main_daily_kWh", 9.0)};
  drift.alarms = {
      alarm("main_daily_kWh", "2026-02", drift::CauseKind::effect, "damper_stuck_open")};
  const DriftFacts facts = drift_of(drift, "main");
  EXPECT_EQ(facts.state, DriftState::alarm);
  EXPECT_EQ(static_cast<int>(facts.alarm), 105);
  EXPECT_EQ(facts.since, std::chrono::year{2026} / 1);
  EXPECT_DOUBLE_EQ(facts.probability, 0.8);
  EXPECT_EQ(drift_of(drift, "cooling").state, DriftState::not_followed);
}

TEST(DriftFacts, AnAlarmIsOverWhenForecastsBeganAnewBeforeTheNewestMonth) {
  DriftSummary drift;
  drift.outputs = {output("main_daily_kWh", 1.0)};
  drift.alarms = {alarm("main_daily_kWh", "2026-02", drift::CauseKind::parameter, "infiltration")};
  drift.alarms.front().consequence = drift::Consequence::began_anew;
  EXPECT_EQ(drift_of(drift, "main").state, DriftState::as_forecast);
  EXPECT_EQ(drift_of(drift, "main").alarm, AlarmCode::none);
  drift.alarms.front().month = "2026-03";
  EXPECT_EQ(drift_of(drift, "main").state, DriftState::alarm);
  EXPECT_EQ(drift_of(drift, "main").alarm, AlarmCode::parameter);
  // Nothing has come of it, and nobody weighs it any longer.
  drift.alarms.front() = alarm("main_daily_kWh", "2025-02", drift::CauseKind::nothing, "");
  drift.alarms.front().explained_until = "2026-01";
  EXPECT_EQ(drift_of(drift, "main").state, DriftState::as_forecast);
}

TEST(DriftFacts, AMeterThatIsSetAsideStaysSo) {
  DriftSummary drift;
  drift.outputs = {output("main_daily_kWh", 1.0)};
  drift.alarms = {alarm("main_peak_kW", "2025-02", drift::CauseKind::meter, "main_peak_kW")};
  drift.alarms.front().consequence = drift::Consequence::meter_set_aside;
  EXPECT_EQ(drift_of(drift, "main").state, DriftState::set_aside);
  EXPECT_EQ(drift_of(drift, "main").alarm, AlarmCode::meter);
}

TEST(DriftFacts, AMeterMayChangeWithoutAModel) {
  DriftSummary drift;
  drift.outputs = {output("main_daily_kWh", 1.0)};
  drift.changed_meters = {{.meter = "main",
                           .kind = drift::MeterChangeKind::readings,
                           .since = "2026-02-14",
                           .seen = "2026-03"}};
  EXPECT_EQ(drift_of(drift, "main").alarm, AlarmCode::meter);
  EXPECT_EQ(drift_of(drift, "main").since, std::chrono::year{2026} / 2);
  drift.changed_meters.front().seen = "2025-11";
  EXPECT_EQ(drift_of(drift, "main").alarm, AlarmCode::none);
}

TEST(DriftFacts, WhatADiagnosisNamed) {
  EXPECT_EQ(static_cast<int>(named_in(R"({"added":["fouling","weekend_operation"]})")), 115);
  for (const char* nothing :
       {"", "{", "[]", "{}", R"({"added":[]})", R"({"added":null})", R"({"added":[7]})"}) {
    EXPECT_EQ(named_in(nothing), AlarmCode::none) << nothing;
  }
}

}  // namespace
}  // namespace recald::daemon::drift_facts_test
