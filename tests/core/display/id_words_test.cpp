#include "core/display/id_words.hpp"

#include <gtest/gtest.h>

namespace recald::display {
namespace {

TEST(IdWords, OutputsSayMeterAndFigure) {
  EXPECT_EQ(output_words("chilled_water_daily_kWh"), "chilled water, daily mean");
  EXPECT_EQ(output_words("chilled_water_peak_kW"), "chilled water, monthly peak");
  EXPECT_EQ(output_words("chw_daily_kwh"), "chw, daily mean");  // designs write small letters
  EXPECT_EQ(output_words("heat_use"), "heat use");
  EXPECT_EQ(meter_label("chilled_water"), "Chilled water");
  EXPECT_EQ(output_words("_daily_kWh"), " daily kWh");  // no meter is named
}

TEST(IdWords, ParametersAreCalledAsInTheLibrary) {
  EXPECT_EQ(parameter_words("cooling_setpoint"), "cooling set-point, occupied hours");
  EXPECT_EQ(parameter_words("u_factor_scale"), "U-factors, all surfaces");
  EXPECT_EQ(parameter_words("oa_ahu1"), "oa ahu1");
}

TEST(IdWords, HyperParametersAreSaid) {
  EXPECT_EQ(parameter_words("lambda_delta"), "precision of the model's discrepancy");
  EXPECT_EQ(parameter_words("lambda_eps"), "precision of the measurements");
  EXPECT_EQ(parameter_words("beta_dry_bulb_C"), "roughness along outdoor temperature");
  EXPECT_EQ(parameter_words("beta_drybulb"), "roughness along outdoor temperature");
  EXPECT_EQ(parameter_words("beta_out"), "roughness along the outputs");
  EXPECT_EQ(parameter_words("beta_snow_depth"), "roughness along snow depth");
}

TEST(IdWords, MonthsAreNamed) {
  EXPECT_EQ(month_words("2021-07"), "July 2021");
  EXPECT_EQ(month_words("7"), "month 7");
}

TEST(IdWords, SentencesBeginAndGoOn) {
  EXPECT_EQ(capitalised("chilled water"), "Chilled water");
  EXPECT_EQ(uncapitalised("Chilled water"), "chilled water");
  EXPECT_EQ(uncapitalised("AHU 1"), "AHU 1");
  EXPECT_EQ(uncapitalised("U-factors"), "U-factors");
  EXPECT_EQ(capitalised(""), "");
}

}  // namespace
}  // namespace recald::display
