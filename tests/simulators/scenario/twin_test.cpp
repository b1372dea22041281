#include "simulators/scenario/twin.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "simulators/scenario/archetypes.hpp"

namespace recald::simulators::twin_test {
namespace {

using namespace std::chrono;

/// A building that has what the kind needs, one year at fifteen-minute steps.
Scenario suited_to(const EffectKind& kind) {
  Brief brief{.use = Use::office, .climate = ClimateKind::mixed, .storeys = 2};
  if (kind.needs.own_chiller) brief.cooling = CoolingPlant::chiller;
  if (kind.needs.heat_pump) brief.heating = HeatingPlant::heat_pump;
  if (kind.needs.fuel) brief.heating = HeatingPlant::boiler;
  if (kind.needs.skylight) {
    brief.skylight_share = 0.15;
    brief.climate = ClimateKind::cold;
  }
  Scenario scenario;
  scenario.drawings = draw_up(brief);
  scenario.period = {2022, 1};
  scenario.step = 900s;
  scenario.care = MeterCare::perfect;
  return scenario;
}

HiddenChoice chosen(const EffectKind& kind, double strength) {
  HiddenChoice choice{.kind = &kind, .strength = strength, .from = {}, .to = {}, .meter = {}};
  if (kind.dated) choice.from = 2022y / April / 1;
  if (kind.id == "vacancy") choice.to = 2022y / July / 31;
  if (kind.of_one_meter) choice.meter = Utility::electricity;
  return choice;
}

Simulated run(const Scenario& scenario, const metering::LocalCalendar& calendar) {
  auto simulated = simulate(scenario, 5, calendar);
  EXPECT_TRUE(simulated.has_value());
  return std::move(*simulated);
}

/// Sum over the meters of |footprint| as a share of each meter's sum.
double moved_share(const std::vector<std::vector<double>>& footprint_kW, const Simulated& twin) {
  const auto plates = plates_of(twin.building.truth().drawings);
  double moved = 0.0;
  for (std::size_t meter = 0; meter < plates.size(); ++meter) {
    double sum = 0.0;
    double whole = 0.0;
    for (std::size_t slot = 0; slot < twin.recording.power.size(); ++slot) {
      sum += std::abs(footprint_kW[meter][slot]);
      whole += twin.recording.power[slot][plates[meter].utility];
    }
    moved += sum / whole;
  }
  return moved;
}

/// A kind that is printed by its name.
struct NamedKind {
  const EffectKind* kind;
  friend void PrintTo(const NamedKind& named, std::ostream* out) { *out << named.kind->id; }
};

class EveryEffect : public ::testing::TestWithParam<NamedKind> {};

// A twin run differs through the effect alone: not at all at strength 0, the weather never, before
// its first day never, and more at its typical strength than at half of it.
TEST_P(EveryEffect, MovesTheMetersAndNothingElse) {
  const EffectKind& kind = *GetParam().kind;
  Scenario scenario = suited_to(kind);
  const auto calendar = metering::LocalCalendar::open(scenario.drawings.time_zone);
  ASSERT_TRUE(calendar.has_value());
  const Simulated twin = run(scenario, *calendar);
  const auto with = [&](double strength) {
    Scenario hidden = scenario;
    hidden.effects = {chosen(kind, strength)};
    const auto possible = check_effects(hidden);
    EXPECT_TRUE(possible.has_value()) << possible.error().message;
    return run(hidden, *calendar);
  };
  const auto none = footprint_kW(with(0.0), twin, *calendar);
  for (const auto& meter : none) {
    for (const double added_kW : meter) ASSERT_EQ(added_kW, 0.0);
  }
  const Simulated typical = with(kind.strength.typical);
  for (std::size_t slot = 0; slot < twin.recording.weather.size(); ++slot) {
    ASSERT_EQ(typical.recording.weather[slot].dry_bulb_C, twin.recording.weather[slot].dry_bulb_C);
    ASSERT_EQ(typical.recording.weather[slot].wind_speed_m_s,
              twin.recording.weather[slot].wind_speed_m_s);
  }
  const auto footprint = footprint_kW(typical, twin, *calendar);
  if (kind.dated) {
    const auto first = calendar->first_instant(2022y / April / 1, 0);
    for (const auto& meter : footprint) {
      for (std::size_t slot = 0; twin.recording.start_of(slot) < first; ++slot) {
        ASSERT_EQ(meter[slot], 0.0);
      }
    }
  }
  const double moved = moved_share(footprint, twin);
  EXPECT_GT(moved, 0.003);
  EXPECT_LT(moved, 3.0);
  const double half =
      moved_share(footprint_kW(with(0.5 * kind.strength.typical), twin, *calendar), twin);
  EXPECT_GT(moved, half);
  EXPECT_GT(half, 0.0);
}

std::vector<NamedKind> all_kinds() {
  std::vector<NamedKind> kinds;
  for (const EffectKind& kind : effect_kinds()) kinds.push_back({&kind});
  return kinds;
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryEffect, ::testing::ValuesIn(all_kinds()),
                         [](const auto& tested) { return std::string(tested.param.kind->id); });

TEST(Decoys, OfferAWindThatNeverBlewAndAMeterThatIsNotOurs) {
  Scenario scenario = suited_to(effect_kinds().front());
  const auto calendar = metering::LocalCalendar::open(scenario.drawings.time_zone);
  const Simulated simulated = run(scenario, *calendar);
  const Feeds plain = read_feeds(scenario, 5, simulated, *calendar);
  scenario.decoys = {Decoy::wind_of_another_year, Decoy::neighbour_meter};
  const Feeds decoyed = read_feeds(scenario, 5, simulated, *calendar);
  ASSERT_EQ(decoyed.meters.size(), plain.meters.size() + 1);
  EXPECT_EQ(decoyed.meters.back().plate.id, "neighbour");
  double product = 0.0;
  double plain_square = 0.0;
  double other_square = 0.0;
  constexpr double mean_m_s = 3.5;
  for (std::size_t slot = 0; slot < plain.weather.cells.size(); ++slot) {
    const double one = plain.weather.cells[slot].reading.wind_speed_m_s - mean_m_s;
    const double other = decoyed.weather.cells[slot].reading.wind_speed_m_s - mean_m_s;
    product += one * other;
    plain_square += one * one;
    other_square += other * other;
    ASSERT_EQ(plain.weather.cells[slot].reading.dry_bulb_C,
              decoyed.weather.cells[slot].reading.dry_bulb_C);
    ASSERT_EQ(plain.meters[0].cells[slot].value, decoyed.meters[0].cells[slot].value);
  }
  EXPECT_LT(product / std::sqrt(plain_square * other_square), 0.4);
}

}  // namespace
}  // namespace recald::simulators::twin_test
