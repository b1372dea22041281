#include "daemon/site/setup/starter_building.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "daemon/site/config/site_config.hpp"
#include "tests/support/sample_site.hpp"

namespace recald::daemon {
namespace {

using metering::Utility;
using ::testing::HasSubstr;
using ::testing::Not;

StarterFacts office() {
  return {.use = "office",
          .floor_area_m2 = 7800.0,
          .storeys = 3,
          .built = 1995,
          .climate_zone = 5,
          .months = {std::chrono::year{2020} / 1, std::chrono::year{2021} / 12},
          .meters = {{"electricity", Utility::electricity}, {"district_heat", Utility::heating}}};
}

tl::expected<SiteConfig, std::vector<std::string>> site_with(const std::string& model) {
  return parse_site(
      std::string{recald::testing::kSampleMeters} + "[weather]\nfile = \"weather.csv\"\n" + model,
      "site.toml");
}

TEST(StarterBuilding, EveryUseVintageAndZoneMakesASiteFile) {
  for (const std::string_view use : starter_uses()) {
    for (const std::optional<int> built :
         {std::optional<int>{}, std::optional{1990}, std::optional{2015}}) {
      for (int zone = 1; zone <= 8; ++zone) {
        SCOPED_TRACE(std::string{use} + " in zone " + std::to_string(zone));
        StarterFacts facts = office();
        facts.use = use;
        facts.built = built;
        facts.climate_zone = zone;
        const auto model = starter_model(facts);
        ASSERT_TRUE(model.has_value()) << model.error().message;
        const auto site = site_with(*model);
        ASSERT_TRUE(site.has_value()) << site.error().front();
        EXPECT_EQ(site->building->floor_area_m2, 7800.0);
        EXPECT_EQ(site->model->parameters.size(), 5u);
        EXPECT_TRUE(site->building->chiller_cop.has_value());  // no chilled water is metered
      }
    }
  }
}

TEST(StarterBuilding, WallsAndFloorsAreThoseOfASquare) {
  const auto site = site_with(starter_model(office()).value());
  double upright_m2 = 0.0;
  for (const model::Surface& surface : site->building->surfaces) {
    if (surface.orientation.tilt_deg > 45.0) upright_m2 += surface.area_m2;
    if (surface.kind == model::SurfaceKind::roof) {
      EXPECT_NEAR(surface.area_m2, 2600.0, 1.0);
    }
  }
  EXPECT_NEAR(upright_m2, 4.0 * std::sqrt(2600.0) * 3 * 3.7, 25.0);  // three digits are written
}

TEST(StarterBuilding, LaterMonthsAreKeptWhereEnoughAreLeft) {
  EXPECT_THAT(starter_model(office()).value(),
              HasSubstr("calibration = { from = \"2020-01\", to = \"2021-06\" }\n"
                        "validation = { from = \"2021-07\", to = \"2021-12\" }"));
  StarterFacts few = office();
  few.months.last = std::chrono::year{2020} / 12;
  EXPECT_THAT(starter_model(few).value(), Not(HasSubstr("validation")));
}

TEST(StarterBuilding, GuessesAreMarked) {
  const std::string model = starter_model(office()).value();
  EXPECT_THAT(model, HasSubstr("# guess, a factor of 2: typical of an office"));
  EXPECT_THAT(model, HasSubstr("ASHRAE 90.1-1989, 1980 to 2004"));
  EXPECT_THAT(model, HasSubstr("# as given"));
}

TEST(StarterBuilding, DistrictCoolingHasNoChiller) {
  StarterFacts facts = office();
  facts.meters.emplace_back("chw", Utility::chilled_water);
  EXPECT_THAT(starter_model(facts).value(), Not(HasSubstr("chiller_cop")));
}

TEST(StarterBuilding, WhatCannotBeIsRefused) {
  const auto said = [](auto change) {
    StarterFacts facts = office();
    change(facts);
    const auto model = starter_model(facts);
    return model ? std::string{} : model.error().message;
  };
  EXPECT_THAT(said([](StarterFacts& f) { f.use = "ofice"; }), HasSubstr("did you mean 'office'?"));
  EXPECT_THAT(said([](StarterFacts& f) { f.floor_area_m2 = 2.0; }), HasSubstr("2 m2 cannot be"));
  EXPECT_THAT(said([](StarterFacts& f) { f.storeys = 0; }), HasSubstr("0 storeys cannot be"));
  EXPECT_THAT(said([](StarterFacts& f) { f.meters.erase(f.meters.begin()); }),
              HasSubstr("needs an electricity meter"));
}

weather::WeatherSeries constant_C(double dry_bulb_C, std::size_t days) {
  weather::WeatherSeries series;
  series.hours.assign(24 * days, {.dry_bulb_C = dry_bulb_C});
  return series;
}

TEST(ClimateZone, FollowsDegreeDays) {
  EXPECT_EQ(climate_zone_of(constant_C(26.0, 365)).value(), 1);
  EXPECT_EQ(climate_zone_of(constant_C(20.0, 365)).value(), 2);
  EXPECT_EQ(climate_zone_of(constant_C(17.0, 365)).value(), 3);
  EXPECT_EQ(climate_zone_of(constant_C(11.0, 365)).value(), 4);
  EXPECT_EQ(climate_zone_of(constant_C(9.0, 365)).value(), 5);
  EXPECT_EQ(climate_zone_of(constant_C(-3.0, 365)).value(), 8);
  EXPECT_THAT(climate_zone_of(constant_C(9.0, 100)).error().message, HasSubstr("has 100"));
}

}  // namespace
}  // namespace recald::daemon
