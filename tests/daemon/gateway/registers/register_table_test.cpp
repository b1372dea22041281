/// The one table: that its registers lie beside each other, that numbers keep their meaning, and
/// that the page says what is served.
#include "daemon/gateway/registers/register_table.hpp"

#include <gmock/gmock.h>

#include <bit>
#include <cstring>
#include <set>

#include "core/diagnosis/effects/support/effect.hpp"
#include "daemon/gateway/registers/register_page.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::register_table_test {
namespace {

using ::testing::HasSubstr;

template <class Facts>
void expect_side_by_side(std::span<const RegisterEntry<Facts>> entries, int end) {
  int free_from = 0;
  std::set<std::string_view> names;
  for (const auto& entry : entries) {
    // In order of address, but for those that fill a gap between two.
    EXPECT_GE(entry.at, free_from) << entry.name;
    free_from = entry.at + registers_of(entry.type);
    // A float on an odd address is what some clients cannot read.
    if (entry.type != RegisterType::u16) {
      EXPECT_EQ(entry.at % 2, 0) << entry.name;
    }
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    EXPECT_FALSE(entry.meaning.empty()) << entry.name;
    EXPECT_EQ(entry.type == RegisterType::f32, !entry.unit.empty() && entry.unit != "s")
        << entry.name;
  }
  EXPECT_LE(free_from, end);
}

float float_at(const std::vector<std::uint16_t>& values, int at) {
  const auto i = static_cast<std::size_t>(at);
  return std::bit_cast<float>(static_cast<std::uint32_t>(values[i]) << 16 | values[i + 1]);
}

std::uint32_t whole_at(const std::vector<std::uint16_t>& values, int at) {
  const auto i = static_cast<std::size_t>(at);
  return static_cast<std::uint32_t>(values[i]) << 16 | values[i + 1];
}

TEST(RegisterTable, RegistersLieSideBySide) {
  expect_side_by_side(site_registers(), kFirstMeterAt);
  expect_side_by_side(meter_registers(), kMeterBlock);
}

// What a management system was set up with must not move or mean something else.
TEST(RegisterTable, AddressesAndCodesStayWhatTheyAre) {
  const auto names = [](auto entries) {
    std::string text;
    for (const auto& entry : entries) {
      text += std::to_string(entry.at) + entry.name.data() + ":" + name_of(entry.type).data() + " ";
    }
    return text;
  };
  EXPECT_EQ(names(site_registers()),
            "0map_version:u16 1meters:u16 2uptime:u32 4time:u32 6quality:u16 7clock_ok:u16 "
            "8store_ok:u16 9meters_silent:u16 10drift_state:u16 11alarm_code:u16 12alarms:u16 "
            "13alarm_meter:u16 14alarm_since:u32 16alarm_probability:f32 18model_age:f32 "
            "20named_effect:u16 ");
  EXPECT_EQ(names(meter_registers()),
            "0state:u16 1quality:u16 2power:f32 4interval_mean:f32 6interval_start:u32 "
            "8expected_q05:f32 10expected_q50:f32 12expected_q95:f32 14month:u32 "
            "16month_daily_average:f32 18month_peak:f32 20month_coverage:f32 "
            "22month_forecast_q05:f32 24month_forecast_q50:f32 26month_forecast_q95:f32 "
            "28closed_month:u32 30closed_daily_average:f32 32closed_peak:f32 "
            "34closed_coverage:f32 36closed_usable:u16 38closed_forecast_q05:f32 "
            "40closed_forecast_q50:f32 42closed_forecast_q95:f32 44drift_state:u16 "
            "45alarm_code:u16 46alarm_since:u32 48alarm_probability:f32 50drift_evidence:f32 "
            "52expected_hour:u32 ");
  EXPECT_EQ(alarm_code(drift::CauseKind::effect, "after_hours"), AlarmCode{100});
  EXPECT_EQ(alarm_code(drift::CauseKind::effect, "damper_stuck_open"), AlarmCode{105});
  EXPECT_EQ(alarm_code(drift::CauseKind::effect, "wind_infiltration"), AlarmCode{139});
}

TEST(AlarmCodes, EveryEffectOfTheCatalogueHasItsOwn) {
  std::set<std::uint16_t> numbers;
  for (const EffectCode& code : effect_codes()) {
    EXPECT_GE(code.number, 100) << code.effect;
    EXPECT_TRUE(numbers.insert(code.number).second) << code.effect;
  }
  for (const diagnosis::Effect& effect : diagnosis::catalogue()) {
    EXPECT_GE(static_cast<int>(alarm_code(drift::CauseKind::effect, effect.id)), 100)
        << effect.id << " needs the next number in alarm_codes.cpp";
  }
  EXPECT_EQ(alarm_code(drift::CauseKind::effect, "ghosts"), AlarmCode::unknown);
  EXPECT_EQ(alarm_code(drift::CauseKind::nothing, ""), AlarmCode::nothing);
  EXPECT_EQ(alarm_code(drift::CauseKind::parameter, "infiltration"), AlarmCode::parameter);
  EXPECT_EQ(alarm_code(drift::CauseKind::direction, "electricity use"), AlarmCode::use);
  EXPECT_EQ(alarm_code(drift::CauseKind::meter, "main_daily_kWh"), AlarmCode::meter);
  EXPECT_EQ(alarm_code(drift::CauseKind::unknown, ""), AlarmCode::unknown);
}

TEST(RegisterValues, AreBigEndianAndNaNWhereThereIsNone) {
  SiteFacts site;
  site.uptime = std::chrono::seconds{70'000};
  site.model_age_days = 12.5;
  site.meters.resize(2);
  site.meters[1].power_kW = -61.25;
  site.meters[1].open.month = std::chrono::year{2026} / 3;
  site.meters[1].interval_mean_kW = 1e300;  // a float has no such number
  const auto values = register_values(site);
  ASSERT_EQ(values.size(), 228u);
  EXPECT_EQ(values[0], 1);
  EXPECT_EQ(values[1], 2);
  EXPECT_EQ(values[2], 1);
  EXPECT_EQ(values[3], 70'000 - 65'536);
  EXPECT_EQ(values[18], 0x4148);
  EXPECT_EQ(values[19], 0);
  EXPECT_EQ(float_at(values, 164 + 2), -61.25F);
  EXPECT_EQ(whole_at(values, 164 + 14), 202'603u);
  EXPECT_EQ(whole_at(values, 164 + 4), 0x7FC00000u);
  for (const auto& entry : meter_registers()) {
    if (entry.type != RegisterType::f32) continue;
    EXPECT_EQ(whole_at(values, 100 + entry.at), 0x7FC00000u) << entry.name;
  }
  for (const auto& entry : site_registers()) {
    if (entry.type != RegisterType::f32 || entry.name == "model_age") continue;
    EXPECT_EQ(whole_at(values, entry.at), 0x7FC00000u) << entry.name;
  }
}

TEST(RegisterValues, OfMoreMetersThanThereAreAddressesAreOfTheFirst) {
  SiteFacts site;
  site.meters.resize(1'030);
  const auto values = register_values(site);
  EXPECT_EQ(values[1], 1'022);
  EXPECT_EQ(values.size(), 65'508u);
}

TEST(RegisterPage, IsTheOneOfThisProgram) {
  EXPECT_EQ(recald::testing::read_text(RECALD_SOURCE_DIR "/daemon/gateway/registers/registers.md"),
            register_page())
      << "make it anew: recald registers > daemon/gateway/registers/registers.md";
}

TEST(RegisterPage, NamesEveryRegisterAndCode) {
  const std::string page = register_page();
  for (const auto& entry : site_registers()) EXPECT_THAT(page, HasSubstr(entry.name.data()));
  for (const auto& entry : meter_registers()) EXPECT_THAT(page, HasSubstr(entry.name.data()));
  EXPECT_THAT(page, HasSubstr("| 105 | "));
  EXPECT_THAT(page, HasSubstr("(`damper_stuck_open`)"));
}

}  // namespace
}  // namespace recald::daemon::register_table_test
