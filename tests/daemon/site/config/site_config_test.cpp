/// Site files: what a right one says, and one sentence for each mistake people make.
#include "daemon/site/config/site_config.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <locale>
#include <sstream>

#include <cstdlib>

#include "core/display/unit.hpp"
#include "core/model/parameter_library.hpp"
#include "tests/support/allocations.hpp"
#include "tests/support/sample_site.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::site_config_test {
namespace {

using recald::testing::edited;
using recald::testing::kSampleMeters;
using recald::testing::line_of;
using recald::testing::sample_site;
using recald::testing::TemporaryFolder;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class SiteFile {
 public:
  explicit SiteFile(const std::string& text) {
    recald::testing::write_text(path(), text);
    loaded_ = load_site(path());
  }
  [[nodiscard]] std::filesystem::path path() const { return folder_ / "site.toml"; }
  [[nodiscard]] std::filesystem::path folder() const { return folder_.path(); }
  /// @pre the file is right
  [[nodiscard]] const SiteConfig& config() const {
    if (!loaded_) throw std::runtime_error(loaded_.error().front());
    return *loaded_;
  }
  [[nodiscard]] std::vector<std::string> problems() const {
    return loaded_ ? std::vector<std::string>{} : loaded_.error();
  }

 private:
  TemporaryFolder folder_;
  tl::expected<SiteConfig, std::vector<std::string>> loaded_;
};

std::string with(std::string_view from, std::string_view to) {
  return edited(sample_site(), from, to);
}

TEST(SiteConfig, SaysWhatTheFileSays) {
  const SiteFile file{sample_site()};
  ASSERT_THAT(file.problems(), ElementsAre());
  const SiteConfig& site = file.config();
  EXPECT_EQ(site.id, "depot");
  EXPECT_EQ(site.name, "Tram depot");
  EXPECT_EQ(site.timezone, "Europe/Zurich");
  EXPECT_EQ(site.interval, std::chrono::minutes{15});
  EXPECT_EQ(site.closing.watermark, std::chrono::hours{72});
  EXPECT_EQ(site.location->altitude_m, 420.0);
  EXPECT_EQ(site.holidays.size(), 1u);
  EXPECT_EQ(site.closing.closing.fill.holidays.size(), 1u);
  ASSERT_EQ(site.meters.size(), 2u);
  EXPECT_EQ(site.meters[0].files, std::vector{file.folder() / "readings.csv"});
  EXPECT_EQ(site.meters[0].name_in_file, "electricity");
  EXPECT_EQ(site.meters[0].meter.rated_kW, 400.0);
  EXPECT_EQ(site.meters[1].name_in_file, "heat");
  EXPECT_EQ(site.meters[1].meter.utility, metering::Utility::heating);
  EXPECT_EQ(site.meter_index("district_heat"), 1u);
  EXPECT_EQ(site.meter_index("heat"), std::nullopt);
  EXPECT_EQ(metering::to_string(site.period->validation->first), "2021-10");
  EXPECT_EQ(site.model->weights.at("district_heat"), 0.8);
  ASSERT_EQ(site.model->parameters.size(), 2u);
  EXPECT_FALSE(site.model->parameters[0].prior);
  EXPECT_EQ(site.model->parameters[1].prior, (Prior{0.8, 2.0, 2.6}));
  EXPECT_EQ(site.building->surfaces.size(), 3u);
  EXPECT_EQ(site.building->surfaces[2].orientation, (weather::Orientation{0.0, 0.0}));
  EXPECT_EQ(site.building->occupied_fraction.at(model::DayType::workday, 7), 0.9);
  EXPECT_EQ(site.building->set_points.heating_occupied_C, 21.0);
}

TEST(SiteConfig, MetersAloneAreASite) {
  const SiteFile file{std::string{kSampleMeters}};
  ASSERT_THAT(file.problems(), ElementsAre());
  EXPECT_FALSE(file.config().model);
  EXPECT_FALSE(file.config().building);
}

// Electricity that is exactly zero for hours is a dead meter; heat in summer is not.
TEST(SiteConfig, GapsAreFilledByTheRuleItNames) {
  const auto rule_of = [](std::string_view more) {
    return SiteFile{with("watermark = \"72h\"", more)}.config().closing.closing.fill.rule;
  };
  EXPECT_EQ(rule_of(""), metering::FillRule::same_time);
  EXPECT_EQ(rule_of("fill = \"same_time\""), metering::FillRule::same_time);
  EXPECT_EQ(rule_of("fill = \"linear_short\""), metering::FillRule::linear_short);
}

TEST(SiteConfig, ZerosOfElectricityAreDoubtedUnlessTheFileSaysOtherwise) {
  const SiteFile file{with("rated_kW = 400", "rated_kW = 400\nstuck_max = \"5d\"")};
  EXPECT_EQ(file.config().meters[0].meter.zero_run_max, std::chrono::hours{2});
  EXPECT_EQ(file.config().meters[0].meter.stuck_max, std::chrono::days{5});
  EXPECT_EQ(file.config().meters[1].meter.zero_run_max, std::chrono::hours{96});
  const SiteFile plain{with("zero_run_max = \"96h\"\n", "")};
  EXPECT_EQ(plain.config().meters[1].meter.zero_run_max, std::nullopt);
}

/// Of a model that names none.
std::vector<std::string> usual_parameters(std::string text) {
  const std::size_t begin = text.find("[[model.parameter]]");
  text.erase(begin, text.find("[building]") - begin);
  const SiteFile file{text};
  std::vector<std::string> names;
  for (const ParameterConfig& parameter : file.config().model->parameters) {
    names.push_back(parameter.name);
  }
  return names;
}

TEST(SiteConfig, ModelWithoutParametersTakesThoseOfTheSeed) {
  EXPECT_THAT(usual_parameters(sample_site()), ::testing::ElementsAreArray(model::kSeedParameters));
}

TEST(SiteConfig, WhatTheDrawingsDoNotHaveIsNoUsualParameter) {
  const auto names =
      usual_parameters(edited(sample_site(), "outdoor_air_m3_s = 2.0\n", "outdoor_air_m3_s = 0\n"));
  EXPECT_THAT(names, ::testing::Not(::testing::Contains("outdoor_airflow")));
  EXPECT_EQ(names.size(), std::size(model::kSeedParameters) - 1);
}

TEST(SiteConfig, CounterIsInItsOwnUnit) {
  const SiteFile file{with("rated_kW = 400",
                           "rated_kW = 400\ncounter = { unit = \"MWh\", modulus = 1000, "
                           "resolution = 0.01 }")};
  const auto& counter = file.config().meters[0].counter;
  ASSERT_TRUE(counter.has_value());
  EXPECT_DOUBLE_EQ(counter->modulus_kWh, 1e6);
  EXPECT_DOUBLE_EQ(counter->resolution_kWh, 10.0);
  EXPECT_DOUBLE_EQ(counter->rated_kW, 400.0);
  EXPECT_TRUE(file.config().meters[0].meter.is_counted);
  EXPECT_FALSE(file.config().meters[1].meter.is_counted);
}

TEST(SiteConfig, EndUsesAndEndStamps) {
  const SiteFile file{
      with("name_in_file = \"heat\"", "stamps = \"end\"\nend_uses = [\"hot_water\", \"reheat\"]")};
  const MeterConfig& heat = file.config().meters[1];
  EXPECT_EQ(heat.stamps, csv::Stamps::end);
  EXPECT_EQ((*heat.end_uses)[model::EndUse::reheat], 1.0);
  EXPECT_EQ((*heat.end_uses)[model::EndUse::zone_heating], 0.0);
}

TEST(SiteConfig, PathMayBeginWithAVariable) {
  ::setenv("RECALD_TEST_FOLDER", "/srv/data", 1);
  const SiteFile file{with("\"weather.csv\"", "\"$RECALD_TEST_FOLDER/weather.csv\"")};
  ::unsetenv("RECALD_TEST_FOLDER");
  EXPECT_EQ(file.config().weather->files.front(), "/srv/data/weather.csv");
}

/// One edit of the sample site and the one sentence it earns.
struct Mistake {
  const char* name;
  std::string from;
  std::string to;
  std::string at;  ///< Words of the line that is named.
  std::string sentence;
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

class SiteMistake : public ::testing::TestWithParam<Mistake> {};

TEST_P(SiteMistake, IsNamedWithFileLineAndKey) {
  const Mistake& mistake = GetParam();
  const std::string text = with(mistake.from, mistake.to);
  const std::string place = "site.toml:" + std::to_string(line_of(text, mistake.at)) + ": ";
  EXPECT_THAT(SiteFile{text}.problems(), ElementsAre(place + mistake.sentence));
}

const Mistake kSiteMistakes[] = {
    {"MisspeltKey", "altitude_m", "altitud_m", "altitud_m",
     "[site] unknown key 'altitud_m'; did you mean 'altitude_m'?"},
    {"KeyFarFromAll", "altitude_m", "favourite_colour", "favourite_colour",
     "[site] unknown key 'favourite_colour'"},
    {"MisspeltTable", "[building.heating]", "[building.heatin]", "[building.heatin]",
     "[building] unknown key 'heatin'; did you mean 'heating'?"},
    {"MissingKey", "id = \"depot\"\n", "", "[site]", "[site] 'id' is missing"},
    {"MissingZone", "timezone = \"Europe/Zurich\"\n", "", "[site]", "[site] 'timezone' is missing"},
    {"NumberAsText", "altitude_m = 420", "altitude_m = \"420\"", "altitude_m",
     "[site] 'altitude_m' must be a number"},
    {"TextAsNumber", "name = \"Tram depot\"", "name = 12", "name = 12",
     "[site] 'name' must be text in quotes"},
    {"NumberBeyondItsRange", "latitude_deg = 47.4", "latitude_deg = 474", "474",
     "[site] 'latitude_deg' is 474; it must be between -90 and 90"},
    {"UnknownZone", "Europe/Zurich", "Europe/Zurick", "Zurick",
     "[site] time zone 'Europe/Zurick' is not in this system's zone files; did you mean "
     "'Europe/Zurich'?"},
    {"BadDuration", "\"72h\"", "\"3 days\"", "3 days",
     "[site] 'watermark' is \"3 days\"; write a duration such as \"15m\" or \"72h\""},
    {"IntervalThatDividesNoHour", "interval = \"15m\"", "interval = \"20m\"", "20m",
     "[site] 'interval' must be 1m, 5m, 10m, 15m, 30m or 60m (\"1h\")"},
    {"BadHoliday", "2021-12-25", "25.12.2021", "holidays",
     "[site] 'holidays': '25.12.2021' is not a date of 1971 to 2100; write YYYY-MM-DD"},
    {"CapitalsInId", "\"depot\"", "\"Depot\"", "Depot",
     "[site] 'id' is \"Depot\"; use 1 to 40 of a-z, 0-9, - and _"},
    {"UnknownFillRule", "watermark = \"72h\"", "fill = \"zero\"", "fill",
     "[site] 'fill' is \"zero\"; it must be one of same_time, linear_short"},
    {"WeatherAsList", "[weather]", "[[weather]]", "[[weather]]",
     "'weather' must be a table, written [weather]"},
    {"UnknownWeatherFormat", "file = \"weather.csv\"", "file = \"weather.csv\"\nformat = \"tmy\"",
     "tmy", "[weather] 'format' is \"tmy\"; it must be one of csv, epw"},
    {"VariableThatIsNotSet", "\"weather.csv\"", "\"$RECALD_NO_SUCH/weather.csv\"",
     "$RECALD_NO_SUCH",
     "[weather] 'file' begins with $RECALD_NO_SUCH, but the environment variable RECALD_NO_SUCH is "
     "not set; set it to the folder with the data"},
    {"UnknownUtility", "utility = \"heating\"", "utility = \"heat\"", "\"heat\"",
     "[meter] 'heat' is not a utility; use electricity, chilled_water, heating, steam, gas or "
     "water"},
    {"MissingUtility", "utility = \"heating\"\n", "", "[[meter]]\nid = \"district_heat\"",
     "[meter] 'utility' is missing"},
    {"UnknownEndUse", "rated_kW = 400", "end_uses = [\"lightning\"]", "lightning",
     "[meter] 'end_uses': unknown end use 'lightning'; known are lighting, plugs, exterior, fans, "
     "pumps, chiller, sensible_cooling, latent_cooling, zone_heating, reheat, preheat, "
     "humidification, hot_water, base_heat"},
    {"CounterWithoutRating", "zero_run_max = \"96h\"", "counter = { modulus = 1e6 }", "counter",
     "[meter.counter] a cumulative counter needs the meter's 'rated_kW', to tell a jump from a "
     "load"},
    {"CounterOfPower", "rated_kW = 400", "rated_kW = 400\ncounter = { unit = \"kW\" }", "counter",
     "[meter.counter] 'unit' is \"kW\"; a counter needs a unit of energy such as kWh or MWh"},
    {"UnknownPeakMethod", "rated_kW = 400", "peak = { method = \"sliding\" }", "sliding",
     "[meter.peak] 'method' is \"sliding\"; it must be one of block"},
    {"OverlappingPeriods", "from = \"2021-10\"", "from = \"2021-09\"", "[period]",
     "[period] calibration and validation overlap; a month used for calibration cannot serve for "
     "validation"},
    {"PeriodBackwards", "to = \"2021-12\"", "to = \"2021-08\"", "2021-08",
     "[period.validation] 'to' (2021-08) is before 'from' (2021-10)"},
    {"PeriodWithoutEnd", ", to = \"2021-12\"", "", "validation",
     "[period.validation] needs 'from' and 'to', each a month such as \"2021-01\""},
    {"BadMonth", "from = \"2021-10\"", "from = \"10/2021\"", "10/2021",
     "[period.validation] 'from': '10/2021' is not a month between 1971-01 and 2100-12; write "
     "YYYY-MM"},
    {"MissingCalibrationPeriod", "calibration = { from = \"2021-01\", to = \"2021-09\" }\n", "",
     "[period]", "[period] 'calibration' is missing: { from = \"2021-01\", to = \"2022-12\" }"},
    {"UnknownModel", "kind = \"epc\"", "kind = \"daily\"", "daily",
     "[model] 'kind' is \"daily\"; it must be one of epc, hourly, energyplus"},
    {"OutputThatIsNoMeter", "[\"electricity\", \"district_heat\"]", "[\"electricity\", \"heat\"]",
     "outputs", "[model] 'outputs' names 'heat', which is not the id of a [[meter]]"},
    {"OutputsAsText", "[\"electricity\", \"district_heat\"]", "\"electricity\"", "outputs",
     "[model] 'outputs' must be a list of texts in quotes"},
    {"NoOutput", "[\"electricity\", \"district_heat\"]", "[]", "outputs",
     "[model] 'outputs' is empty; list the ids of the meters to model"},
    {"MissingOutputs", "outputs = [\"electricity\", \"district_heat\"]\n", "", "[[model]]",
     "[model] 'outputs' is missing: the ids of the meters to model"},
    {"WeightOfNoMeter", "{ district_heat = 0.8 }", "{ heat = 0.8 }", "weights",
     "[model] 'weights' names 'heat', which is not the id of a [[meter]]"},
    {"WeightAboveOne", "district_heat = 0.8", "district_heat = 8", "weights",
     "[model.weights] 'district_heat' is 8; it must be between 1e-09 and 1"},
    {"MisspeltParameter", "\"occupancy_density\"", "\"occupancy_densty\"", "occupancy_densty",
     "[model.parameter] unknown parameter 'occupancy_densty'; did you mean 'occupancy_density'?"},
    {"ParameterOfAnotherModel", "\"occupancy_density\"", "\"visible_absorptance_scale\"",
     "visible_absorptance_scale",
     "[model.parameter] parameter 'visible_absorptance_scale': this model has no such quantity; a "
     "model in EnergyPlus may have it"},
    {"PriorOutOfOrder", "min = 0.8", "min = 2.2", "[[model.parameter]]\nname = \"outdoor_airflow\"",
     "[model.parameter] outdoor_airflow: a triangular prior needs min <= mode <= max and min < "
     "max, but min = 2.2, mode = 2, max = 2.6, or nothing to use the library's range"},
    {"PriorInPart", "mode = 2.0\n", "", "[[model.parameter]]\nname = \"outdoor_airflow\"",
     "[model.parameter] outdoor_airflow: a triangular prior needs min, mode and max, or nothing to "
     "use the library's range"},
    {"FractionOfAStorey", "storeys = 2", "storeys = 2.5", "storeys",
     "[building] 'storeys' is 2.5; it must be a whole number"},
    {"UnknownMass", "\"medium\"", "\"massive\"", "massive",
     "[building] 'mass' is \"massive\"; it must be one of very_light, light, medium, heavy, "
     "very_heavy"},
    {"UnknownSurface", "kind = \"roof\"", "kind = \"floor\"", "floor\"",
     "[building.surface] 'kind' is \"floor\"; it must be one of wall, roof, window, ground"},
    {"MissingKind", "kind = \"roof\"\n", "", "[[building.surface]]\nname = \"roof\"",
     "[building.surface] 'kind' is missing: wall, roof, window or ground"},
    {"WallThatFacesNowhere", "azimuth_deg = 180\n\n", "\n",
     "[[building.surface]]\nname = \"south wall\"",
     "[building.surface] 'azimuth_deg' is missing: the direction the surface faces, clockwise from "
     "north"},
    {"AzimuthBeyondTheCircle", "azimuth_deg = 180\n\n", "azimuth_deg = 480\n\n", "480",
     "[building.surface] 'azimuth_deg' is 480; it must be between 0 and 360"},
    {"WindowWithoutShgc", "shgc = 0.5\n", "", "[[building.surface]]\nname = \"south windows\"",
     "[building.surface] 'shgc' is missing"},
    {"AreaOfNothing", "area_m2 = 1200", "area_m2 = 0", "area_m2 = 0",
     "[building.surface] 'area_m2' is 0; it must be greater than 0"},
    {"NegativeLighting", "lighting_W_m2 = 8", "lighting_W_m2 = -8", "lighting",
     "[building.use] 'lighting_W_m2' is -8; it must be at least 0"},
    {"ScheduleOf23Values", "0.8, 0.4, 0.2, 0.1, 0, 0, 0]", "0.8, 0.4, 0.2, 0.1, 0, 0]", "workday",
     "[building.schedule] 'workday' must be a list of 24 numbers between 0 and 1"},
    {"ScheduleInPerCent", "0.5, 0.9, 1,", "50, 90, 100,", "workday",
     "[building.schedule] 'workday' must be a list of 24 numbers between 0 and 1"},
    {"ScheduleWithoutSunday",
     "sunday = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\n", "",
     "[building.schedule]",
     "[building.schedule] 'sunday' must list the occupied fraction of each hour 0 to 23"},
    {"HeatingAboveCooling", "heating_occupied_C = 21", "heating_occupied_C = 26",
     "[building.setpoint]",
     "[building.setpoint] the heating set-point 26 degC is not below the cooling set-point 25 "
     "degC; they would work against each other"},
    {"IdlePowerOfNoChiller", "[building.air]", "[building.cooling]\nidle_kW = 5\n[building.air]",
     "[building.cooling]",
     "[building.cooling] 'idle_kW' is that of an own chiller; give its 'chiller_cop' too"},
    {"SmallestFlowAboveDesign", "supply_flow_min_m3_s = 2.5", "supply_flow_min_m3_s = 7",
     "[building.air]",
     "[building.air] 'supply_flow_min_m3_s' is larger than 'supply_flow_design_m3_s'"},
};

INSTANTIATE_TEST_SUITE_P(SiteConfig, SiteMistake, ::testing::ValuesIn(kSiteMistakes),
                         [](const auto& mistake) { return mistake.param.name; });

/// The part of the sample site from `words` up to, but without, `until`.
std::string without(std::string_view words, std::string_view until) {
  std::string text = sample_site();
  const std::size_t begin = text.find(words);
  const std::size_t end = until.empty() ? text.size() : text.find(until, begin);
  return text.erase(begin, end - begin);
}

TEST(SiteConfig, TwoMetersOfOneId) {
  const std::string text =
      edited(std::string{kSampleMeters}, "id = \"district_heat\"", "id = \"electricity\"");
  EXPECT_THAT(SiteFile{text}.problems(),
              ElementsAre("site.toml:18: [meter] two meters have the id 'electricity'"));
}

TEST(SiteConfig, ModelNamesWhatItLacks) {
  const auto lacking = [](const std::string& text, const char* sentence) {
    EXPECT_THAT(SiteFile{text}.problems(),
                ElementsAre("site.toml:" + std::to_string(line_of(text, "[[model]]")) +
                            ": [model] " + sentence));
  };
  lacking(without("[building]", ""), "needs a [building]");
  lacking(without("[period]", "[[model]]"), "needs a [period]");
  lacking(without("[weather]", "[period]"),
          "needs [weather], or a [[meter]] with role = \"weather\"");
  lacking(without("latitude_deg", "altitude_m"), "needs latitude_deg and longitude_deg in [site]");
}

TEST(SiteConfig, UnitsInRoomsNeedNoLeastFlow) {
  std::string text = edited(sample_site(), "supply_flow_min_m3_s = 2.5", "reheat_boxes = false");
  text = edited(text, "[building.setpoint]", "[building.setpoint]\nsunday_occupied = true");
  const SiteFile units{text};
  ASSERT_THAT(units.problems(), ElementsAre());
  EXPECT_FALSE(units.config().building->air->has_reheat_boxes);
  EXPECT_TRUE(units.config().building->set_points.sunday_occupied);
  const SiteFile boxes{sample_site()};
  EXPECT_TRUE(boxes.config().building->air->has_reheat_boxes);
  EXPECT_FALSE(boxes.config().building->set_points.sunday_occupied);
}

TEST(SiteConfig, BuildingNamesWhatItLacks) {
  const auto lacking = [](const std::string& text, const char* sentence) {
    EXPECT_THAT(SiteFile{text}.problems(),
                ElementsAre("site.toml:" + std::to_string(line_of(text, "[building]")) +
                            ": [building] " + sentence));
  };
  lacking(without("[[building.surface]]", "[building.use]"),
          "a building needs at least one [[building.surface]]");
  lacking(without("[building.use]", "[building.schedule]"), "[building.use] is missing");
  lacking(without("[building.schedule]", "[building.setpoint]"), "[building.schedule] is missing");
}

TEST(SiteConfig, ModelsOfDifferentKindsAreCompared) {
  const std::string hourly = "\n[[model]]\nkind = \"hourly\"\noutputs = [\"district_heat\"]\n";
  const SiteConfig site = SiteFile{sample_site() + hourly}.config();
  EXPECT_EQ(site.model->kind, ModelKind::epc);
  ASSERT_EQ(site.other_models.size(), 1);
  EXPECT_EQ(site.other_models[0].kind, ModelKind::hourly);
}

TEST(SiteConfig, TwoModelsOfOneKindAreOneTooMany) {
  const std::string text =
      sample_site() + "\n[[model]]\nkind = \"epc\"\noutputs = [\"district_heat\"]\n";
  const std::string line = std::to_string(line_of(sample_site(), "efficiency = 0.95") + 3);
  EXPECT_THAT(SiteFile{text}.problems(),
              ElementsAre("site.toml:" + line +
                          ": [model] two [[model]] are of kind \"epc\"; models that are compared "
                          "are of different kinds"));
}

constexpr std::string_view kEnergyPlusModel = R"(
[[model]]
kind = "energyplus"
file = "office.epJSON"
outputs = ["district_heat"]
[model.reports]
district_heat = "HeatingCoils:EnergyTransfer"
[[model.parameter]]
name = "lighting"
targets = ["Lights/*/watts_per_floor_area"]
change = "scale"
prior = [0.7, 1.0, 1.4]
[[model.parameter]]
name = "occupancy_density"
)";

TEST(SiteConfig, EnergyPlusModelSaysWhatIsRunAndVaried) {
  const SiteFile file{sample_site() + std::string{kEnergyPlusModel}};
  const SiteConfig site = file.config();
  ASSERT_EQ(site.other_models.size(), 1);
  const ModelConfig& model = site.other_models[0];
  ASSERT_TRUE(model.energyplus.has_value());
  EXPECT_EQ(model.energyplus->file.filename(), "office.epJSON");
  EXPECT_EQ(model.energyplus->design.filename(), "site-doe");
  EXPECT_EQ(model.energyplus->runs, 200);
  EXPECT_THAT(model.energyplus->reports.at("district_heat"),
              ElementsAre("HeatingCoils:EnergyTransfer"));
  ASSERT_EQ(model.parameters.size(), 2);
  EXPECT_EQ(*model.parameters[0].prior, Prior(0.7, 1.0, 1.4));
  EXPECT_EQ(model.parameters[0].change, model::ChangeKind::scale);
  EXPECT_THAT(model.parameters[0].targets, ElementsAre("Lights/*/watts_per_floor_area"));
  EXPECT_FALSE(model.parameters[1].prior.has_value());
}

TEST(SiteConfig, MistakesInAnEnergyPlusModelAreNamed) {
  const auto problems_of = [](std::string_view what, std::string_view with) {
    return SiteFile{sample_site() + edited(std::string{kEnergyPlusModel}, what, with)}.problems();
  };
  EXPECT_THAT(problems_of("change = \"scale\"\n", ""),
              ElementsAre(HasSubstr("lighting: with 'targets' give 'change' (set, scale or add)")));
  EXPECT_THAT(problems_of("targets = [\"Lights/*/watts_per_floor_area\"]\n", ""),
              ElementsAre(HasSubstr("lighting: 'change' needs 'targets'")));
  EXPECT_THAT(problems_of("file = \"office.epJSON\"\n", ""),
              ElementsAre(HasSubstr("'file' is missing")));
  EXPECT_THAT(problems_of("district_heat = \"Heat", "heat = \"Heat"),
              ElementsAre(HasSubstr("unknown key 'heat'")));
  EXPECT_THAT(
      problems_of("prior = [0.7, 1.0, 1.4]", "prior = [0.7, 1.0, 1.4]\nmin = 0.5"),
      ElementsAre(HasSubstr("'prior' is short for min, mode and max"), HasSubstr("give 'change'")));
  EXPECT_THAT(problems_of("kind = \"energyplus\"", "kind = \"hourly\""),
              Contains(HasSubstr("'file' belongs to a model of kind \"energyplus\"")));
}

TEST(SiteConfig, PriorInShortIsMinModeMax) {
  const std::string text = sample_site();
  EXPECT_THAT(SiteFile{text + "\n[[model.parameter]]\nname = \"cooling_setpoint\"\n"
                              "prior = [21, 24, 27]\n"}
                  .config()
                  .model->parameters.back()
                  .prior,
              ::testing::Optional(Prior(21.0, 24.0, 27.0)));
}

TEST(SiteConfig, EmptyFileSaysWhatASiteIs) {
  EXPECT_THAT(SiteFile{""}.problems(),
              ElementsAre("site.toml:1: [site] is missing", "site.toml:1: there is no [[meter]]"));
}

TEST(SiteConfig, AllMistakesAreReportedAtOnce) {
  std::string text = edited(sample_site(), "altitude_m", "altitud_m");
  text = edited(text, "utility = \"heating\"", "utility = \"warmth\"");
  text = edited(text, "min = 0.8", "min = \"low\"");
  text = edited(text, "fan_design_kW = 9", "fan_design_W = 9000");
  EXPECT_THAT(
      SiteFile{text}.problems(),
      ::testing::UnorderedElementsAre(
          StartsWith("site.toml:7: [site] unknown key 'altitud_m'"),
          StartsWith("site.toml:20: [meter] 'warmth' is not a utility"),
          ::testing::HasSubstr("[model.parameter] 'min' must be a number"),
          ::testing::HasSubstr(
              "[model.parameter] outdoor_airflow: a triangular prior needs min, mode and max"),
          ::testing::HasSubstr("[building.air] 'fan_design_kW' is missing"),
          ::testing::HasSubstr("[building.air] unknown key 'fan_design_W'; did you mean "
                               "'fan_design_kW'?")));
}

TEST(SiteConfig, SyntaxErrorIsOneSentenceWithItsLine) {
  const std::string text = with("\"Europe/Zurich\"", "Europe/Zurich");
  EXPECT_THAT(SiteFile{text}.problems(), ElementsAre(StartsWith("site.toml:4: not valid TOML: ")));
}

class DecimalComma : public std::numpunct<char> {
  [[nodiscard]] char do_decimal_point() const override { return ','; }
};

// decimal_comma_locale: what a process is told about commas changes no number of a file, nor the
// one in a sentence about it.
TEST(SiteConfig, DecimalCommaLocale) {
  const std::locale before =
      std::locale::global(std::locale{std::locale::classic(), new DecimalComma});
  const SiteFile file{sample_site()};
  const SiteFile wrong{with("latitude_deg = 47.4", "latitude_deg = 247.4")};
  std::ostringstream stream;
  stream << 47.4;
  std::locale::global(before);
  ASSERT_EQ(stream.str(), "47,4");  // it was in force
  EXPECT_EQ(file.config().location->latitude_deg, 47.4);
  EXPECT_EQ(file.config().building->surfaces[1].u_W_m2K, 1.6);
  EXPECT_THAT(wrong.problems(), ElementsAre("site.toml:5: [site] 'latitude_deg' is 247.4; it must "
                                            "be between -90 and 90"));
}

TEST(SiteConfig, KeyGivenTwiceIsASyntaxError) {
  const std::string text = with("altitude_m = 420", "altitude_m = 420\naltitude_m = 421");
  EXPECT_THAT(SiteFile{text}.problems(), ElementsAre(StartsWith("site.toml:8: not valid TOML: ")));
}

TEST(SiteConfig, MissingFileAndFolderAreOneSentence) {
  const TemporaryFolder folder;
  const auto absent = load_site(folder / "absent.toml");
  ASSERT_FALSE(absent.has_value());
  EXPECT_THAT(absent.error(),
              ElementsAre("site file '" + (folder / "absent.toml").string() + "' does not exist"));
  const auto directory = load_site(folder.path());
  ASSERT_FALSE(directory.has_value());
  EXPECT_THAT(directory.error(), ElementsAre("site file '" + folder.path().string() +
                                             "' is a folder; name the TOML file in it"));
}

/// Modbus meters, two hundred a bus.
std::string portfolio(int meters) {
  constexpr int kMetersABus = 200;
  std::string text = "[site]\nid = \"x\"\ntimezone = \"UTC\"\n";
  for (int i = 0; i < meters; ++i) {
    const int bus = i / kMetersABus;
    if (i % kMetersABus == 0) {
      text += fmt::format("[bus.b{0}]\ntype = \"tcp\"\nhost = \"10.0.0.1\"\nport = {1}\n", bus,
                          bus + 1);
    }
    text += fmt::format(
        "[[meter]]\nid = \"m{}\"\nutility = \"electricity\"\nsource = \"modbus\"\n"
        "bus = \"b{}\"\nunit = {}\nmap = \"abb-b23\"\nrated_kW = 5\n",
        i, bus, i % kMetersABus + 1);
  }
  return text;
}

TEST(SiteConfig, PricesAreReadByUtilityAndPeriod) {
  const std::string prices = R"(
[tariff]
currency = "EUR"
[tariff.electricity]
per_kWh = 0.20
per_kW_month = 9
[[tariff.electricity.period]]
from = 22
to = 6
days = "weekend"
per_kWh = 0.12
[emissions]
heating = 0.2
)";
  const auto site = parse_site(std::string{kSampleMeters} + prices, "site.toml");
  ASSERT_TRUE(site.has_value()) << site.error().front();
  const auto& electricity = site->tariff.prices_of(metering::Utility::electricity);
  ASSERT_TRUE(electricity.has_value());
  EXPECT_DOUBLE_EQ(electricity->at(model::DayType::saturday, 23), 0.12);
  EXPECT_DOUBLE_EQ(electricity->at(model::DayType::workday, 23), 0.20);
  EXPECT_DOUBLE_EQ(electricity->per_kW_month, 9.0);
  EXPECT_FALSE(site->tariff.prices_of(metering::Utility::gas).has_value());
  EXPECT_EQ(site->tariff.emissions_of(metering::Utility::heating), 0.2);

  const auto wrong =
      parse_site(std::string{kSampleMeters} + edited(prices, "from = 22", "from = 6"), "site.toml");
  ASSERT_FALSE(wrong.has_value());
  EXPECT_THAT(
      wrong.error(),
      ElementsAre(::testing::HasSubstr("'from' and 'to' are the same hour; leave both out")));
}

TEST(SiteConfig, UnitsOfDisplayAreSiUnlessSaid) {
  const auto units = [](const std::string& line) {
    const auto site =
        parse_site(edited(std::string{kSampleMeters}, "[site]\n", "[site]\n" + line), "site.toml");
    if (!site) throw std::runtime_error(site.error().front());
    return site->units;
  };
  EXPECT_EQ(units(""), display::UnitSystem::si);
  EXPECT_EQ(units("units = \"SI\"\n"), display::UnitSystem::si);
  EXPECT_EQ(units("units = \"IP\"\n"), display::UnitSystem::ip);
  EXPECT_THROW((void)units("units = \"metric\"\n"), std::runtime_error);
}

TEST(SiteConfig, APriorOfNoneIsAProbability) {
  const auto prior = [](const std::string& table) {
    return parse_site(std::string{kSampleMeters} + table, "site.toml");
  };
  EXPECT_EQ(prior("")->prior_none, 0.5);
  EXPECT_EQ(prior("\n[diagnosis]\nprior_none = 0.9\n")->prior_none, 0.9);
  const auto wrong = prior("\n[diagnosis]\nprior_none = 1\n");
  ASSERT_FALSE(wrong.has_value());
  EXPECT_THAT(
      wrong.error(),
      ElementsAre(::testing::HasSubstr("'prior_none' is 1; it must be between 0.01 and 0.99")));
}

TEST(SiteConfig, NothingIsAppliedByItselfUnlessTheSiteSaysSo) {
  const auto read = [](const std::string& table) {
    return parse_site(std::string{kSampleMeters} + table, "site.toml");
  };
  EXPECT_FALSE(read("")->applies_itself);
  EXPECT_FALSE(read("\n[diagnosis]\napply = \"never\"\n")->applies_itself);
  EXPECT_TRUE(read("\n[diagnosis]\napply = \"auto\"\n")->applies_itself);
  EXPECT_FALSE(read("\n[diagnosis]\napply = \"always\"\n").has_value());
}

// Each meter is compared with those of its address alone, and a map is read once.
TEST(SiteConfig, ALargePortfolioIsReadOnceAndComparedLittle) {
  const auto allocations_for = [](int meters) {
    const std::string text = portfolio(meters);
    const long before = recald::testing::allocation_count();
    const auto site = parse_site(text, "site.toml");
    EXPECT_TRUE(site.has_value()) << site.error().front();
    return recald::testing::allocation_count() - before;
  };
  (void)allocations_for(200);  // what is made once
  const long few = allocations_for(500);
  EXPECT_LT(allocations_for(1000), 3 * few);
  EXPECT_LT(few, 500 * 100);  // reading a map takes thousands
}

TEST(SiteConfig, OneMeterTooManyIsFoundInALargePortfolio) {
  std::string text = portfolio(600);
  text.replace(text.find("unit = 7\n", text.find("[bus.b1]")), 9, "unit = 6\n");
  const auto site = parse_site(text, "site.toml");
  ASSERT_FALSE(site.has_value());
  EXPECT_THAT(site.error(),
              ElementsAre(::testing::HasSubstr(
                  "meters 'm205' and 'm206' are the same registers of unit 6 on bus 'b1'")));
}

TEST(SiteConfig, ASiteFileThatIsNoFileIsRefusedAtOnce) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "site.toml";
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  EXPECT_THAT(load_site(file).error(),
              ElementsAre("site file '" + file.string() +
                          "' is a pipe, not a file; save its content to a file first"));
}

}  // namespace
}  // namespace recald::daemon::site_config_test
