#include "simulators/footprint/footprint_figures.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "simulators/footprint/effect_figure.hpp"
#include "simulators/footprint/meter_key.hpp"
#include "simulators/footprint/showcase.hpp"
#include "simulators/footprint/svg.hpp"
#include "tests/simulators/footprint/well_formed.hpp"

namespace recald::simulators::footprint_figures_test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

metering::LocalCalendar new_york() { return *metering::LocalCalendar::open("America/New_York"); }

constexpr std::size_t kDays = 120;

/// 120 days from 1 February 2022: both half-years, all days of the week.
MeterFootprint meter_of(Utility utility, std::string name, double plain_kW, double added_kW) {
  return {utility, std::move(name), std::vector<double>(kDays * 96, plain_kW),
          std::vector<double>(kDays * 96, added_kW)};
}

Footprint hand_made(const EffectKind& kind) {
  return {show_choice(kind),
          "Hut, 12 m²",
          std::chrono::sys_days{std::chrono::year{2022} / 2 / 1} + std::chrono::hours{5},
          {meter_of(Utility::cooling, "chilled water", 10.0, 0.5),
           meter_of(Utility::electricity, "electricity", 20.0, -0.05),
           meter_of(Utility::heat, "heating", 30.0, 0.0)}};
}

class Folder {
 public:
  Folder() : path_(fs::path(::testing::TempDir()) / unique_name()) { fs::remove_all(path_); }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  static std::string unique_name() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    return std::string("footprints_") + test->name();
  }
  fs::path path_;
};

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(FootprintFigures, SharesAreOfTheMetersYear) {
  EXPECT_EQ(share_text(meter_of(Utility::heat, "gas", 10.0, 0.5)), "gas +5.0 %");
  EXPECT_EQ(share_text(meter_of(Utility::heat, "gas", 20.0, -0.05)), "gas \u22120.25 %");
  EXPECT_EQ(share_text(meter_of(Utility::heat, "gas", 20.0, 0.0)), "gas unchanged");
  EXPECT_EQ(share_text(meter_of(Utility::heat, "gas", 0.0, 1.0)), "gas \u00b10 %");

  MeterFootprint shifted = meter_of(Utility::heat, "gas", 10.0, 1.0);
  for (std::size_t slot = 0; slot < shifted.added_kW.size(); slot += 2) {
    shifted.added_kW[slot] = -1.0;
  }
  EXPECT_EQ(share_text(shifted), "gas \u00b10 %");
}

TEST(FootprintFigures, StrengthIsToldWithUnitAndDates) {
  const EffectKind* vacancy = find_effect_kind("vacancy");
  const EffectKind* sun = find_effect_kind("solar_gain_change");
  ASSERT_TRUE(vacancy && sun);
  HiddenChoice away = show_choice(*vacancy);
  away.strength = 0.5;
  HiddenChoice shaded = show_choice(*sun);
  shaded.strength = -1.0 / 3.0;

  EXPECT_EQ(strength_text(away), fmt::format("Strength 0.5: {}; from 2022-02-01 to 2022-10-31.",
                                             vacancy->strength.unit));
  EXPECT_EQ(strength_text(shaded), fmt::format("Strength \u22120.333: {}.", sun->strength.unit));
}

TEST(FootprintFigures, EveryEffectCanBeShownWhereItIsShown) {
  for (const EffectKind& kind : effect_kinds()) {
    Scenario scenario = show_scenario(show_building_of(kind));
    scenario.effects.push_back(show_choice(kind));
    const auto checked = check_effects(scenario);
    EXPECT_TRUE(checked.has_value()) << kind.id << ": " << checked.error().message;
    EXPECT_FALSE(kind.needs.timetable && scenario.drawings.core_runs_always) << kind.id;
    EXPECT_TRUE(scenario.drawings.economiser_limit_C || !kind.needs.economiser) << kind.id;
  }
}

TEST(FootprintFigures, EveryCaptionHasItsNumbers) {
  const auto calendar = new_york();
  for (const EffectKind& kind : effect_kinds()) {
    SCOPED_TRACE(kind.id);
    const Footprint footprint = hand_made(kind);

    const std::string figure = effect_figure(footprint, calendar);

    EXPECT_TRUE(is_plain_xml(figure));
    EXPECT_LT(figure.size(), 12'000U);
    EXPECT_THAT(figure, HasSubstr(">" + escape_xml(kind.title) + "</text>"));
    EXPECT_THAT(figure, HasSubstr(">" + std::string(kind.id) + "</text>"));
    EXPECT_THAT(figure, HasSubstr(">chilled water +5.0 %</text>"));
    EXPECT_THAT(figure, HasSubstr(">electricity \u22120.25 %</text>"));
    EXPECT_THAT(figure, HasSubstr(">heating unchanged</text>"));
    EXPECT_THAT(figure, HasSubstr(fmt::format(
                            ">Strength {}{:.3g}: ", kind.strength.typical < 0.0 ? "\u2212" : "",
                            std::abs(kind.strength.typical))));
    for (const std::string& line : wrap_text(kind.sentence, 13.0, 856.0)) {
      EXPECT_THAT(figure, HasSubstr(escape_xml(line)));
    }
    EXPECT_THAT(figure, HasSubstr("Hut, 12 m²"));
    EXPECT_THAT(figure, Not(ContainsRegex("[= \"M]-?(nan|inf)[ \"]")));
  }
}

// 8 kW from 1 May on, nothing before: the mean day of an effect that begins then has 8 kW. Over
// April and May together it has 4. The marks of the scale tell.
TEST(FootprintFigures, TheMeanDayIsThatOfDaysWithTheEffect) {
  const EffectKind* kind = find_effect_kind("equipment_step");
  ASSERT_TRUE(kind);
  Footprint footprint = hand_made(*kind);
  footprint.meters = {meter_of(Utility::electricity, "electricity", 1.0, 8.0)};
  constexpr std::ptrdiff_t days_before_may = 28 + 31 + 30;
  const auto first = footprint.meters[0].added_kW.begin();
  std::fill(first, first + days_before_may * 96, 0.0);

  footprint.effect.from = std::chrono::year{2022} / 5 / 1;
  EXPECT_THAT(effect_figure(footprint, new_york()), HasSubstr(">8</text>"));
  footprint.effect.from.reset();
  EXPECT_THAT(effect_figure(footprint, new_york()), Not(HasSubstr(">8</text>")));
}

// 8 kW on warm days, which is every third: means by temperature have 8 kW, mean days have fewer.
// The marks of the scale tell.
TEST(FootprintFigures, WhatDependsOnTheTemperatureIsSeenByIt) {
  const EffectKind* kind = find_effect_kind("equipment_step");
  ASSERT_TRUE(kind);
  Footprint footprint = hand_made(*kind);
  footprint.meters = {meter_of(Utility::electricity, "electricity", 1.0, 0.0)};
  std::vector<double>& added_kW = footprint.meters[0].added_kW;
  for (std::size_t i = 0; i < added_kW.size(); ++i) {
    const bool is_warm = (i / 96) % 3 == 0;
    footprint.outdoor_C.push_back(is_warm ? 25.0 : 10.0);
    added_kW[i] = is_warm ? 8.0 : 0.0;
  }
  const std::string figure = effect_figure(footprint, new_york());
  EXPECT_TRUE(is_plain_xml(figure));
  EXPECT_THAT(figure, HasSubstr("By outdoor temperature"));
  EXPECT_THAT(figure, HasSubstr(">8</text>"));
  footprint.outdoor_C.clear();
  EXPECT_THAT(effect_figure(footprint, new_york()), Not(HasSubstr(">8</text>")));
}

TEST(FootprintFigures, MetersAreToldApart) {
  const std::set<std::string_view> colours{colour_of(Utility::electricity),
                                           colour_of(Utility::cooling), colour_of(Utility::heat)};
  EXPECT_EQ(colours.size(), 3U);
}

// Two kinds and a week of each use, twice.
TEST(FootprintFigures, DrawsTheSameFilesAgain) {
  std::vector<EffectKind> kinds{*find_effect_kind("weekend_operation"),
                                *find_effect_kind("phase_lost")};
  const Folder folder;
  const auto first = draw_footprints(folder.path() / "one", kinds);
  const auto second = draw_footprints(folder.path() / "two", kinds);
  ASSERT_TRUE(first.has_value()) << first.error().message;
  ASSERT_TRUE(second.has_value()) << second.error().message;
  EXPECT_EQ(*first, 2U + kUses.size());

  const std::string list = text_of(folder.path() / "one" / "README.md");
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder.path() / "one")) {
    SCOPED_TRACE(entry.path());
    const std::string text = text_of(entry.path());
    EXPECT_FALSE(text.empty());
    EXPECT_EQ(text, text_of(folder.path() / "two" / entry.path().filename()));
    ++files;
    if (entry.path().extension() != ".svg") continue;
    EXPECT_TRUE(is_plain_xml(text));
    EXPECT_THAT(list, HasSubstr("(" + entry.path().filename().string() + ")"));
  }
  EXPECT_EQ(files, 3U + kUses.size());
  EXPECT_THAT(list, HasSubstr("## schedules"));
  EXPECT_THAT(list, HasSubstr("chilled water unchanged, electricity \u2212"));
}

TEST(FootprintFigures, AFolderThatCannotBeMadeIsToldInOneSentence) {
  const Folder folder;
  fs::create_directories(folder.path());
  std::ofstream(folder.path() / "file") << "in the way";

  const auto drawn = draw_footprints(folder.path() / "file" / "figures");

  ASSERT_FALSE(drawn.has_value());
  EXPECT_EQ(drawn.error().code, ErrorCode::io_failed);
  EXPECT_EQ(drawn.error().message, "cannot make the folder " +
                                       (folder.path() / "file" / "figures").string() +
                                       ": Not a directory; choose another with --out");
}

TEST(FootprintFigures, AFileThatCannotBeWrittenIsToldInOneSentence) {
  const Folder folder;
  fs::create_directories(folder.path() / "week_office.svg");

  const auto drawn = draw_footprints(folder.path());

  ASSERT_FALSE(drawn.has_value());
  EXPECT_EQ(drawn.error().code, ErrorCode::io_failed);
  EXPECT_EQ(drawn.error().message,
            "cannot write " + (folder.path() / "week_office.svg").string() +
                ": Is a directory; choose a folder with --out that can be written");
}

}  // namespace
}  // namespace recald::simulators::footprint_figures_test
