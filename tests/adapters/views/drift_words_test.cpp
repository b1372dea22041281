#include "adapters/views/drift/drift_words.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "adapters/views/frame/format.hpp"
#include "core/absent.hpp"

namespace recald::views {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

drift::Cause named(const std::string& effect, const std::string& title, double probability) {
  return {.kind = drift::CauseKind::effect,
          .probability = probability,
          .mean = kAbsent,
          .q05 = kAbsent,
          .q95 = kAbsent,
          .effect = effect,
          .title = title};
}

/// Two years, at the end of which chilled water rose; heat has been off since.
class DriftWords : public ::testing::Test {
 protected:
  DriftWords() {
    for (int month = 0; month < 24; ++month) {
      drift_.months.push_back(fmt::format("{}-{:02}", 2021 + month / 12, 1 + month % 12));
    }
    drift_.learning_months = 12;
    const auto output = [&](const char* meter, metering::Utility utility, double rest) {
      drift::FollowedOutput one{.name = std::string{meter} + "_daily_kWh",
                                .meter = meter,
                                .unit = "kWh/day",
                                .utility = utility,
                                .by_level = false,
                                .measured = std::vector<double>(24, 100.0),
                                .state = {}};
      for (int month = 18; month < 21; ++month)
        one.measured[static_cast<std::size_t>(month)] = rest;
      drift_.outputs.push_back(one);
    };
    output("chilled_water", metering::Utility::chilled_water, 130.0);
    output("heat", metering::Utility::heating, 5.0);
    alarm_.alarm = {.month = 19,
                    .output = 0,
                    .direction = 1,
                    .evidence = 1000.0,
                    .since = 18,
                    .since_earliest = 18,
                    .since_latest = 18,
                    .is_calibrated = true};
    alarm_.explained_until = 20;
  }

  [[nodiscard]] std::string said(std::vector<drift::Cause> causes) {
    alarm_.causes = std::move(causes);
    return explained_sentence(drift_, alarm_);
  }

  drift::SiteDrift drift_{};
  drift::ExplainedAlarm alarm_{};
};

TEST_F(DriftWords, AnOpenAlarmSaysWhatTellsItsCausesApartAndToWait) {
  const std::string words =
      said({named("outdoor_air_amount", "Minimum outdoor air too high or too low", 0.5),
            named("deep_drying", "Deep drying", 0.4)});
  EXPECT_THAT(words, HasSubstr("Likeliest cause (50 %): Minimum outdoor air too high or too low; "
                               "next (40 %): Deep drying."));
  EXPECT_THAT(words, HasSubstr("What tells them apart: Heat in winter"));
  EXPECT_THAT(words, HasSubstr("Wait until heating begins: its months will tell more."));
  EXPECT_THAT(words, Not(HasSubstr("cooling begins")));
}

TEST_F(DriftWords, ASettledOneDoesNot) {
  const std::string words =
      said({named("outdoor_air_amount", "Minimum outdoor air too high or too low", 0.9),
            named("deep_drying", "Deep drying", 0.1)});
  EXPECT_THAT(words, Not(HasSubstr("tells them apart")));
  EXPECT_THAT(words, Not(HasSubstr("Wait")));
}

TEST_F(DriftWords, APlantThatRunsIsNotWaitedFor) {
  drift_.outputs[1].measured.assign(24, 100.0);
  EXPECT_THAT(said({named("outdoor_air_amount", "Minimum outdoor air too high or too low", 0.5),
                    named("server_room", "Unlisted server room", 0.4)}),
              Not(HasSubstr("Wait")));
}

TEST_F(DriftWords, AMeterIsToldWithItsFactorAndWhatTheHoursCallIt) {
  const drift::Cause meter{.kind = drift::CauseKind::meter,
                           .index = 0,
                           .probability = 0.9,
                           .mean = 0.667,
                           .q05 = 0.65,
                           .q95 = 0.68,
                           .effect = "phase_lost",
                           .title = "Meter has lost or reversed a phase"};
  EXPECT_THAT(said({meter, named("vacancy", "Vacancy", 0.1)}),
              HasSubstr("the chilled water meter shows 0.667 times what it should (90 %: 0.65 to "
                        "0.68); by its hours: Meter has lost or reversed a phase"));
}

// Chilled water of a summer is no twelfth of its year.
TEST_F(DriftWords, AYearsCostFollowsTheSeasonAndSoFarIsTheSum) {
  drift::FollowedOutput& output = drift_.outputs[0];
  output.rates.per_kWh = 0.1;
  drift_.currency = "USD";
  drift_.record.clear();
  double year_kWh = 0.0;
  double so_far_kWh = 0.0;
  for (int month = 0; month < 21; ++month) {
    const double usual = 1000.0 * (1.0 + 0.95 * std::cos(0.5236 * (month % 12 - 6)));
    const bool has_changed = month >= 18;
    const double measured = has_changed ? 1.4 * usual : usual;
    output.measured[static_cast<std::size_t>(month)] = measured;
    const int month_days = metering::days_in(std::chrono::year{2022} / (1 + month % 12));
    if (month < 12) year_kWh += 0.4 * usual * month_days;
    if (month == 18 || month == 19) so_far_kWh += 0.4 * usual * month_days;
    if (month < 12) continue;
    drift::PrequentialMonth record{.month = month, .outputs = {std::nullopt, std::nullopt}};
    record.outputs[0] = drift::ForecastRecord{.q50 = usual, .measured = measured};
    drift_.record.push_back(record);
  }
  for (std::size_t month = 21; month < 24; ++month) output.measured[month] = kAbsent;
  const auto words = [&] { return alarm_cost_words(drift_, alarm_); };
  EXPECT_EQ(words(),
            fmt::format("It costs about {} USD so far. If it goes on, it costs about {} USD "
                        "a year.",
                        count_text(0.1 * so_far_kWh), count_text(0.1 * year_kWh)));
  // While a month of the calendar is not known, no year is.
  for (const std::size_t month : {0, 1, 2, 12, 13, 14}) output.measured[month] = kAbsent;
  drift_.record.erase(drift_.record.begin(), drift_.record.begin() + 3);
  EXPECT_EQ(words(), fmt::format("It costs about {} USD so far.", count_text(0.1 * so_far_kWh)));
  output.rates = {};
  EXPECT_EQ(words(), "");
}

TEST_F(DriftWords, AlarmsOfOneChangeHaveItsWholeCost) {
  drift_.outputs[0].rates.per_kWh = 0.1;
  drift_.currency = "USD";
  const auto day = [](const char* text) { return metering::parse_day(text).value(); };
  alarm_.alarm.days = drift::AlarmDays{.raised = day("2022-08-03"),
                                       .since = day("2022-07-11"),
                                       .since_earliest = day("2022-07-11"),
                                       .since_latest = day("2022-07-11"),
                                       .excess = 0.4};
  alarm_.excess = drift::Excess{.since = day("2022-07-11"),
                                .until = day("2022-09-30"),
                                .has_ended = false,
                                .so_far_kWh = 12'300.0,
                                .year_kWh = 20'000.0};
  EXPECT_EQ(alarm_cost_words(drift_, alarm_),
            "It costs about 1,230 USD so far. If it goes on, it costs about 2,000 USD a year.");
  alarm_.excess->since = day("2022-03-02");
  EXPECT_EQ(alarm_cost_words(drift_, alarm_),
            "It costs about 1,230 USD so far, since 2022-03-02. If it goes on, it costs about "
            "2,000 USD a year.");
  alarm_.excess->has_ended = true;
  alarm_.excess->year_kWh.reset();
  EXPECT_EQ(alarm_cost_words(drift_, alarm_),
            "It costs about 1,230 USD from 2022-03-02 to 2022-09-30.");
}

}  // namespace
}  // namespace recald::views
