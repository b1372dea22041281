#include "core/metering/months/data_quality.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "month_builder.hpp"

namespace recald::metering::data_quality_test {
namespace {

using std::chrono::hours;
using testing::calendar;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::kBlank;
using testing::kHour;
using testing::month;
using testing::month_reading;
using testing::utc;

constexpr auto kWarning = DataFinding::Grade::warning;
constexpr auto kNote = DataFinding::Grade::note;

/// Hourly, UTC, 5 kW in every slot.
MonthSlots plain(Month which) {
  return month_reading("UTC", which, kHour, [](int) { return 5.0; });
}

void mark(MonthSlots& slots, int from, int to, Validity validity, Reason reasons = Reason::none) {
  for (int slot = from; slot < to; ++slot) {
    slots.validity[static_cast<std::size_t>(slot)] = validity;
    slots.reasons[static_cast<std::size_t>(slot)] = reasons;
  }
}

std::vector<DataFinding> describe(const std::vector<Episode>& episodes,
                                  const std::vector<TimeSpan>& zero_runs = {},
                                  const std::vector<MonthlyFigure>& figures = {},
                                  const std::vector<LevelChange>& changes = {},
                                  const MeterCounts& counts = {}, const char* zone = "UTC") {
  return describe_data("steam", episodes, zero_runs, figures, changes, counts, calendar(zone));
}

MonthlyFigure figure(Month which, std::string unusable_because = "") {
  MonthlyFigure f{};
  f.month = which;
  f.slots = 24 * days_in(which);
  f.usable = unusable_because.empty();
  f.unusable_because = std::move(unusable_because);
  return f;
}

TEST(FindEpisodes, PlainMonthHasNone) {
  EXPECT_THAT(find_episodes(plain(month(2021, 1))), IsEmpty());
}

TEST(FindEpisodes, JoinsAlikeNeighboursAndPartsUnlikeOnes) {
  MonthSlots slots = plain(month(2021, 1));
  mark(slots, 10, 14, Validity::missing);
  mark(slots, 14, 16, Validity::suspect, Reason::stuck);
  mark(slots, 16, 17, Validity::suspect, Reason::spike);
  mark(slots, 40, 41, Validity::missing);
  EXPECT_THAT(
      find_episodes(slots),
      ElementsAre(Episode{{utc(2021, 1, 1, 10), utc(2021, 1, 1, 14)}, 4, false, Reason::none},
                  Episode{{utc(2021, 1, 1, 14), utc(2021, 1, 1, 16)}, 2, true, Reason::stuck},
                  Episode{{utc(2021, 1, 1, 16), utc(2021, 1, 1, 17)}, 1, true, Reason::spike},
                  Episode{{utc(2021, 1, 2, 16), utc(2021, 1, 2, 17)}, 1, false, Reason::none}));
}

// The sum of such slots is known from a register: nothing is lost.
TEST(FindEpisodes, ScaledSlotsAreNoEpisode) {
  MonthSlots slots = plain(month(2021, 1));
  mark(slots, 10, 14, Validity::scaled);
  EXPECT_THAT(find_episodes(slots), IsEmpty());
}

TEST(JoinEpisodes, AreOneAcrossTheMonthsEnd) {
  MonthSlots january = plain(month(2021, 1));
  MonthSlots february = plain(month(2021, 2));
  mark(january, january.slots() - 5, january.slots(), Validity::missing);
  mark(february, 0, 7, Validity::missing);
  mark(february, 100, 101, Validity::missing);
  std::vector<Episode> all = find_episodes(january);
  std::ranges::copy(find_episodes(february), std::back_inserter(all));
  const std::vector<Episode> joined = join_episodes(all);
  ASSERT_EQ(joined.size(), 2u);
  EXPECT_EQ(joined[0],
            (Episode{{utc(2021, 1, 31, 19), utc(2021, 2, 1, 7)}, 12, false, Reason::none}));
  EXPECT_EQ(joined[1].slots, 1);
}

TEST(JoinEpisodes, UnlikeOnesStayApart) {
  const TimeSpan before{utc(2021, 1, 31), utc(2021, 2, 1)};
  const TimeSpan after{utc(2021, 2, 1), utc(2021, 2, 2)};
  EXPECT_EQ(join_episodes({{before, 24, true, Reason::stuck}, {after, 24, true, Reason::zero_run}})
                .size(),
            2u);
  EXPECT_EQ(
      join_episodes({{before, 24, true, Reason::none}, {after, 24, false, Reason::none}}).size(),
      2u);
}

TEST(FindBelievedZeroRuns, TakesOnlyZerosThatCount) {
  MonthSlots slots = month_reading("UTC", month(2021, 1), kHour,
                                   [](int slot) { return slot >= 5 && slot < 20 ? 0.0 : 5.0; });
  mark(slots, 10, 12, Validity::suspect, Reason::zero_run);
  EXPECT_THAT(find_believed_zero_runs(slots),
              ElementsAre(TimeSpan{utc(2021, 1, 1, 5), utc(2021, 1, 1, 10)},
                          TimeSpan{utc(2021, 1, 1, 12), utc(2021, 1, 1, 20)}));
}

TEST(DescribeData, SilentWhereNothingIsToSay) {
  EXPECT_THAT(describe({}, {}, {figure(month(2021, 1))}), IsEmpty());
}

TEST(DescribeData, OneStretchWithoutReadingsIsANoteInLocalTime) {
  const TimeSpan gap{utc(2021, 1, 5, 14), utc(2021, 1, 5, 19)};
  const auto findings =
      describe({{gap, 5, false, Reason::none}}, {}, {}, {}, {}, "America/Chicago");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].meter, "steam");
  EXPECT_EQ(findings[0].sentence,
            "5 intervals without readings, in one stretch of 5 hours from 2021-01-05 08:00.");
  EXPECT_EQ(findings[0].grade, kNote);
  EXPECT_EQ(findings[0].span, gap);
  EXPECT_EQ(findings[0].slots, 5);
}

TEST(DescribeData, StretchesOfOneKindShareASentenceThatNamesTheLongest) {
  const auto findings = describe({
      {{utc(2021, 1, 5, 1), utc(2021, 1, 5, 2)}, 1, true, Reason::stuck},
      {{utc(2021, 2, 1), utc(2021, 2, 5)}, 96, true, Reason::stuck},
      {{utc(2021, 3, 1), utc(2021, 3, 1, 2)}, 2, true, Reason::stuck},
  });
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].sentence,
            "99 intervals frozen at one value, in 3 stretches, the longest of 4.0 days from "
            "2021-02-01 00:00.");
  EXPECT_EQ(findings[0].grade, kWarning);
  EXPECT_EQ(findings[0].span, (TimeSpan{utc(2021, 1, 5, 1), utc(2021, 3, 1, 2)}));
  EXPECT_EQ(findings[0].slots, 99);
}

// What was measured and is not believed comes before what never came.
TEST(DescribeData, EachKindHasItsOwnSentence) {
  const TimeSpan first{utc(2021, 1, 5, 1), utc(2021, 1, 5, 2)};
  const TimeSpan second{utc(2021, 1, 9, 1), utc(2021, 1, 9, 1) + std::chrono::minutes{15}};
  const auto findings = describe(
      {{first, 1, false, Reason::none}, {second, 1, true, Reason::negative | Reason::range}});
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].sentence,
            "1 interval negative, which this meter cannot be, beyond what this meter can measure, "
            "in one stretch of 15 minutes from 2021-01-09 01:00.");
  EXPECT_EQ(findings[1].sentence,
            "1 interval without readings, in one stretch of 1 hour from 2021-01-05 01:00.");
}

TEST(DescribeData, EveryReasonHasWordsForPeople) {
  const TimeSpan span{utc(2021, 1, 5), utc(2021, 1, 5, 2)};
  const auto words = [&](Reason reason) {
    return describe({{span, 2, true, reason}}).front().sentence;
  };
  using ::testing::HasSubstr;
  EXPECT_THAT(words(Reason::zero_run), HasSubstr("exactly zero for longer than this meter's load"));
  EXPECT_THAT(words(Reason::spike), HasSubstr("single values far above the rest of their day"));
  EXPECT_THAT(words(Reason::nan), HasSubstr("listed as blank by the source"));
  EXPECT_THAT(words(Reason::mismatch), HasSubstr("given twice with different values"));
  EXPECT_THAT(words(Reason::jump), HasSubstr("not counted after a jump of the register"));
  EXPECT_THAT(words(Reason::reset), HasSubstr("not counted around a reset of the register"));
  EXPECT_THAT(words(Reason::wrap), HasSubstr("the register may have rolled over"));
  EXPECT_THAT(words(Reason::sentinel), HasSubstr("sentinel"));
}

TEST(DescribeData, UnusableMonthsAreListedWithTheirReasons) {
  const auto findings = describe({}, {},
                                 {figure(month(2021, 1), "coverage 40 %"), figure(month(2021, 2)),
                                  figure(month(2021, 3), "a gap of 9 days")});
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].sentence,
            "Not used for calibration, too few readings: 2021-01 (coverage 40 %), 2021-03 (a gap "
            "of 9 days).");
  EXPECT_EQ(findings[0].grade, kWarning);
  EXPECT_EQ(findings[0].span, (TimeSpan{utc(2021, 1, 1), utc(2021, 4, 1)}));
  EXPECT_EQ(findings[0].slots, 2 * 31 * 24);
}

TEST(DescribeData, ManyUnusableMonthsFitALine) {
  std::vector<MonthlyFigure> figures;
  for (int i = 1; i <= 7; ++i) figures.push_back(figure(month(2021, i), "coverage 40 %"));
  EXPECT_EQ(
      describe({}, {}, figures).at(0).sentence,
      "Not used for calibration, too few readings: 2021-01 (coverage 40 %), 2021-02 (coverage "
      "40 %) and 5 more.");
}

TEST(DescribeData, LongRunsOfZerosAreQuestioned) {
  const TimeSpan long_run{utc(2021, 6, 1), utc(2021, 6, 4)};
  const TimeSpan short_run{utc(2021, 7, 1), utc(2021, 7, 3, 23)};
  const auto findings = describe({}, {long_run, short_run});
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].sentence,
            "Exactly zero for 3.0 days from 2021-06-01 00:00: treated as a load of zero. If it "
            "means no data, set zero_run_max.");
  EXPECT_EQ(findings[0].grade, kWarning);
}

TEST(DescribeData, ChangeOfLevelSpansItsMonths) {
  const std::vector<MonthlyFigure> figures = {figure(month(2021, 1)), figure(month(2021, 2)),
                                              figure(month(2021, 3)), figure(month(2021, 4))};
  LevelChange change{};
  change.since = month(2021, 2);
  change.back_since = month(2021, 4);
  change.words = "steam reads half of what it was";  // a finding has the name beside it
  auto findings = describe({}, {}, figures, {change});
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].sentence, "Reads half of what it was.");
  EXPECT_EQ(findings[0].span, (TimeSpan{utc(2021, 2, 1), utc(2021, 4, 1)}));
  EXPECT_EQ(findings[0].slots, (28 + 31) * 24);
  change.back_since.reset();
  findings = describe({}, {}, figures, {change});
  EXPECT_EQ(findings.at(0).span, (TimeSpan{utc(2021, 2, 1), utc(2021, 5, 1)}));
  EXPECT_EQ(findings.at(0).slots, (28 + 31 + 30) * 24);
}

TEST(DescribeData, CountsOfRefusedReadings) {
  MeterCounts counts;
  counts.accepted = 1000;
  counts.conflicts = 1;
  counts.duplicates = 2;
  counts.late = 3;
  counts.too_late = 4;
  counts.off_grid = 5;
  counts.stray = 6;
  std::vector<std::string> sentences;
  for (const DataFinding& finding : describe({}, {}, {}, {}, counts)) {
    sentences.push_back(finding.sentence);
  }
  EXPECT_THAT(
      sentences,
      ElementsAre("1 reading came again with another value (the first is kept and marked suspect).",
                  "2 readings came twice with the same value (counted once).",
                  "3 readings came after the month had closed (the month was reopened).",
                  "4 readings came for a month that is no longer open (refused).",
                  "5 readings did not start on a boundary of the meter's intervals (refused).",
                  "6 readings had a time stamp far from all others (refused)."));
}

}  // namespace
}  // namespace recald::metering::data_quality_test
