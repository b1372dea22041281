#include "daemon/gateway/run/job_events.hpp"

#include <gmock/gmock.h>

namespace recald::daemon::job_events_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const metering::Instant kEnded = std::chrono::sys_days{std::chrono::year{2026} / 2 / 1};

StoredJob ended(JobState state, bool accepted, const std::string& message) {
  StoredJob job{.number = 7, .kind = JobKind::calibration, .state = state};
  job.ended = kEnded;
  job.accepted = accepted;
  job.message = message;
  return job;
}

StoredJob with_alarm(const std::string& output, const std::string& since) {
  StoredJob job = ended(JobState::done, true, "");
  DriftAlarm alarm;
  alarm.output = output;
  alarm.since = since;
  alarm.since_earliest = "2025-08";
  alarm.since_latest = "2025-10";
  alarm.sentence = "Main has been more than forecast. Likeliest cause (62 %): plugs.";
  job.result.drift.emplace();
  job.result.drift->alarms.push_back(std::move(alarm));
  return job;
}

std::vector<std::string> told(const std::vector<StoreEvent>& events) {
  std::vector<std::string> words;
  for (const StoreEvent& event : events) {
    EXPECT_EQ(event.time, kEnded);
    words.push_back(event.kind + ": " + event.text);
  }
  return words;
}

TEST(JobEvents, OfAJobWithoutAUsableResult) {
  EXPECT_THAT(told(events_of(ended(JobState::failed, false, "too few months"), false, {})),
              ElementsAre("calibration_failed: calibration 7 failed: too few months"));
  EXPECT_THAT(told(events_of(ended(JobState::done, false, "no convergence"), false, {})),
              ElementsAre("calibration_rejected: calibration 7 was not accepted: no convergence"));
  EXPECT_THAT(events_of(ended(JobState::cancelled, false, ""), false, {}), IsEmpty());
  EXPECT_THAT(events_of(ended(JobState::done, true, ""), false, {}), IsEmpty());
}

TEST(JobEvents, OfADiagnosisThatNamedSomething) {
  StoredJob job = ended(JobState::done, true, "named Runs on weekends (97 %)");
  job.kind = JobKind::diagnosis;
  EXPECT_THAT(told(events_of(job, true, {})),
              ElementsAre("cause_named: diagnosis 7 named Runs on weekends (97 %)"));
  EXPECT_THAT(events_of(job, false, {}), IsEmpty());
}

TEST(JobEvents, AnAlarmIsTheSameAMonthLater) {
  const StoredJob now = with_alarm("main_daily_kWh", "2025-09");
  EXPECT_THAT(told(events_of(now, false, {})),
              ElementsAre("drift_alarm: Main has been more than forecast. Likeliest cause (62 %): "
                          "plugs."));
  EXPECT_THAT(events_of(now, false, with_alarm("main_daily_kWh", "2025-08")), IsEmpty());
  EXPECT_EQ(events_of(now, false, with_alarm("steam_daily_kWh", "2025-09")).size(), 1);
  EXPECT_EQ(events_of(with_alarm("main_daily_kWh", "2026-01"), false, now).size(), 1);
}

TEST(JobEvents, AMeterThatHasChangedIsToldOnce) {
  StoredJob now = ended(JobState::done, true, "");
  now.result.drift.emplace();
  now.result.drift->changed_meters.push_back({.meter = "main",
                                              .kind = drift::MeterChangeKind::unit,
                                              .since = "2025-09",
                                              .sentence = "main counts half."});
  const auto events = events_of(now, false, {});
  EXPECT_THAT(told(events), ElementsAre("drift_alarm: main counts half."));
  EXPECT_EQ(events.at(0).subject, "main");
  EXPECT_THAT(events_of(now, false, now), IsEmpty());
}

}  // namespace
}  // namespace recald::daemon::job_events_test
