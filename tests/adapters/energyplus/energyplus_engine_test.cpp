/// A small building of our own in EnergyPlus itself. Skipped where there is no EnergyPlus.
#include "adapters/energyplus/energyplus_engine.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "adapters/energyplus/effect_patch.hpp"
#include "adapters/energyplus/model/component_sizes.hpp"
#include "adapters/energyplus/read_model.hpp"
#include "adapters/energyplus/trial.hpp"
#include "adapters/epw/epw_writer.hpp"
#include "adapters/system/parallel_for.hpp"
#include "tests/support/installed_energyplus.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::energyplus::energyplus_engine_test {
namespace {

using metering::LocalCalendar;
using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using ::testing::HasSubstr;

/// A box of 10 by 10 m without heating or cooling.
constexpr std::string_view kBox = R"({
  "Version": {"Version 1": {"version_identifier": "VERSION"}},
  "SimulationControl": {"s": {"do_zone_sizing_calculation": "No"}},
  "Timestep": {"t": {"number_of_timesteps_per_hour": 4}},
  "Building": {"Box": {"terrain": "City", "solar_distribution": "FullExterior"}},
  "GlobalGeometryRules": {"g": {"coordinate_system": "World",
    "starting_vertex_position": "UpperLeftCorner", "vertex_entry_direction": "Counterclockwise"}},
  "RunPeriod": {"r": {"begin_month": 1, "begin_day_of_month": 1, "end_month": 12,
    "end_day_of_month": 31, "use_weather_file_daylight_saving_period": "Yes",
    "use_weather_file_holidays_and_special_days": "Yes"}},
  "Material": {"Wall": {"roughness": "Rough", "thickness": 0.2, "conductivity": 0.1,
    "density": 800, "specific_heat": 900}},
  "Construction": {"Wall construction": {"outside_layer": "Wall"}},
  "Zone": {"Room": {}},
  "BuildingSurface:Detailed": {SURFACES},
  "ScheduleTypeLimits": {"Any": {}},
  "Schedule:Constant": {"Always": {"schedule_type_limits_name": "Any", "hourly_value": 1.0}},
  "Lights": {"Room lights": {"zone_or_zonelist_or_space_or_spacelist_name": "Room",
    "schedule_name": "Always", "design_level_calculation_method": "Watts/Area",
    "watts_per_floor_area": 10.0}}
})";

std::string vertices(std::initializer_list<std::array<double, 3>> points) {
  std::string text;
  for (const auto& [x, y, z] : points) {
    text += fmt::format(
        R"({}{{"vertex_x_coordinate":{},"vertex_y_coordinate":{},"vertex_z_coordinate":{}}})",
        text.empty() ? "" : ",", x, y, z);
  }
  return text;
}

std::string surface(std::string_view name, std::string_view type, std::string_view outside,
                    const std::string& points) {
  return fmt::format(
      R"("{}":{{"surface_type":"{}","construction_name":"Wall construction","zone_name":"Room",
      "outside_boundary_condition":"{}","sun_exposure":"{}","wind_exposure":"{}",
      "number_of_vertices":4,"vertices":[{}]}})",
      name, type, outside, outside == "Outdoors" ? "SunExposed" : "NoSun",
      outside == "Outdoors" ? "WindExposed" : "NoWind", points);
}

ModelDocument box(const std::string& version) {
  std::string text{kBox};
  const auto put = [&text](const std::string& what, const std::string& with) {
    text.replace(text.find(what), what.size(), with);
  };
  put("VERSION", version);
  put("SURFACES", surface("South", "Wall", "Outdoors",
                          vertices({{0, 0, 3}, {0, 0, 0}, {10, 0, 0}, {10, 0, 3}})) +
                      "," +
                      surface("North", "Wall", "Outdoors",
                              vertices({{10, 10, 3}, {10, 10, 0}, {0, 10, 0}, {0, 10, 3}})) +
                      "," +
                      surface("East", "Wall", "Outdoors",
                              vertices({{10, 0, 3}, {10, 0, 0}, {10, 10, 0}, {10, 10, 3}})) +
                      "," +
                      surface("West", "Wall", "Outdoors",
                              vertices({{0, 10, 3}, {0, 10, 0}, {0, 0, 0}, {0, 0, 3}})) +
                      "," +
                      surface("Roof", "Roof", "Outdoors",
                              vertices({{0, 10, 3}, {0, 0, 3}, {10, 0, 3}, {10, 10, 3}})) +
                      "," +
                      surface("Floor", "Floor", "Ground",
                              vertices({{0, 0, 0}, {0, 10, 0}, {10, 10, 0}, {10, 0, 0}})));
  return parse_epjson(text, "box.epJSON").value();
}

weather::WeatherSeries winter(int year) {
  using namespace std::chrono;
  weather::WeatherSeries series{.begin = sys_days{std::chrono::year{year} / 1 / 1} - hours{25},
                                .hours = {}};
  for (int hour = 0; hour < 24 * 368; ++hour) {
    const double day = 2.0 * std::numbers::pi * hour / 24.0;
    series.hours.push_back({.dry_bulb_C = 5.0 + 4.0 * std::sin(day),
                            .rel_humidity_pct = 70.0,
                            .wind_speed_m_s = 3.0,
                            .ghi_W_m2 = std::max(200.0 * std::sin(day), 0.0)});
  }
  return series;
}

class RealEnergyPlus : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path installed =
        recald::testing::installed_energyplus(RECALD_ENERGYPLUS_ENVIRONMENT);
    auto found = find_program(installed);
    if (!found) GTEST_SKIP() << found.error().message;
    program_ = *found;
    const auto text = epw::epw_text(
        winter(2021), 2021, {.latitude_deg = 52.5, .longitude_deg = 13.4}, calendar_, {}, "Box");
    ASSERT_TRUE(text.has_value()) << text.error().message;
    write_text(folder_ / "2021.epw", *text);
  }

  EngineSetup setup() {
    EngineSetup setup{.model = box(program_.version),
                      .parameters = {},
                      .outputs = {{"electricity", {{"Electricity:Facility", 1.0}}, false},
                                  {"electricity", {{"Electricity:Facility", 1.0}}, true}},
                      .months = {std::chrono::year{2021} / 1, std::chrono::year{2021} / 2},
                      .weather = {{2021, folder_ / "2021.epw"}},
                      .program = program_,
                      .folder = folder_ / "runs"};
    setup.parameters.push_back({{"lighting", "-", Prior{0.5, 1.0, 1.5}},
                                {find_target(setup.model, "Lights/*/watts_per_floor_area").value()},
                                ChangeKind::scale});
    return setup;
  }

  std::unique_ptr<EnergyPlusEngine> engine(EngineSetup setup) {
    auto made = EnergyPlusEngine::make(std::move(setup), calendar_);
    EXPECT_TRUE(made.has_value()) << made.error().message;
    return std::move(*made);
  }

  LocalCalendar calendar_ = LocalCalendar::open("Europe/Berlin").value();
  TemporaryFolder folder_;
  Program program_;
};

// 10 W/m2 on 100 m2 all day: 24 kWh a day, a peak of 1 kW.
TEST_F(RealEnergyPlus, AParameterChangesTheMonths) {
  const auto run = engine(setup());
  const auto outputs =
      run->run((Eigen::MatrixXd(2, 1) << 1.0, 0.5).finished(), system::parallel_for(2), {});
  ASSERT_TRUE(outputs.has_value()) << outputs.error().message;
  ASSERT_TRUE(run->failed_runs().empty()) << run->failed_runs().front().because;
  const Eigen::RowVector4d whole{24.0, 24.0, 1.0, 1.0};
  EXPECT_LT((outputs->row(0) - whole).cwiseAbs().maxCoeff(), 1e-6) << *outputs;
  EXPECT_LT((outputs->row(1) - 0.5 * whole).cwiseAbs().maxCoeff(), 1e-6);
  ASSERT_EQ(run->days().size(), 59u);
  ASSERT_EQ(run->daily().cols(), 2 * 59);
  EXPECT_TRUE(run->daily().row(0).head(59).isConstant(24.0, 1e-6)) << "kWh";
  EXPECT_TRUE(run->daily().row(1).tail(59).isConstant(0.5, 1e-6)) << "kW";
}

// Lamps outside from 10 February: every day before is as without them.
TEST_F(RealEnergyPlus, AnEffectBeginsOnItsDay) {
  EngineSetup lit = setup();
  const auto patch = find_effect_patch(lit.model, "exterior_lighting",
                                       std::vector<std::string>{"power", "share_in_plugs"});
  ASSERT_TRUE(patch.has_value()) << patch.error().message;
  const auto effect = std::make_shared<const ModelEffect>(
      ModelEffect{*patch, 2, std::chrono::year{2021} / 2 / 10, {}});
  lit.parameters.push_back(
      {.parameter = {"power", "kW", Prior{0.0, 1.0, 5.0}}, .targets = {}, .effect = effect});
  lit.parameters.push_back(
      {.parameter = {"share", "-", Prior{0.0, 0.5, 1.0}}, .targets = {}, .effect = effect});
  const auto run = engine(lit);
  const auto outputs =
      run->run((Eigen::MatrixXd(1, 3) << 1.0, 2.0, 0.0).finished(), for_each_index_serially, {});
  ASSERT_TRUE(outputs.has_value()) << outputs.error().message;
  ASSERT_TRUE(run->failed_runs().empty()) << run->failed_runs().front().because;
  const Eigen::VectorXd days = run->daily().row(0).head(59);
  EXPECT_TRUE(days.head(40).isConstant(24.0, 1e-6)) << days.transpose();
  // Some 14 hours of darkness.
  EXPECT_GT(days.tail(19).minCoeff(), 24.0 + 2.0 * 12.0);
  EXPECT_LT(days.tail(19).maxCoeff(), 24.0 + 2.0 * 16.0);
  EXPECT_NE(run->fingerprint(), engine(setup())->fingerprint());
  EXPECT_TRUE(run->last_model((Eigen::VectorXd(3) << 1.0, 2.0, 0.0).finished())
                  .contains("Exterior:Lights"));
}

TEST_F(RealEnergyPlus, WhatWasRunIsNotRunAgain) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Constant(1, 1, 1.25);
  const auto made = engine(setup());
  const auto first = made->run(one, for_each_index_serially, {});
  ASSERT_TRUE(first.has_value()) << first.error().message;
  EngineSetup without_program = setup();
  without_program.program.executable = "/no/such/energyplus";
  const auto kept = engine(without_program);
  const auto again = kept->run(one, for_each_index_serially, {});
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(*again, *first);
  EXPECT_TRUE(kept->daily().isApprox(made->daily(), 1e-5));
}

TEST_F(RealEnergyPlus, ARunThatFailsIsToldAndTheOthersGoOn) {
  EngineSetup broken = setup();
  broken.parameters.front().targets = {
      find_target(broken.model, "Material/Wall/thickness").value()};
  const auto run = engine(broken);
  const auto outputs =
      run->run((Eigen::MatrixXd(2, 1) << -1.0, 1.0).finished(), system::parallel_for(2), {});
  ASSERT_TRUE(outputs.has_value());
  ASSERT_EQ(run->failed_runs().size(), 1u);
  EXPECT_EQ(run->failed_runs().front().row, 0);
  EXPECT_THAT(run->failed_runs().front().because, HasSubstr("EnergyPlus says"));
  EXPECT_TRUE(outputs->row(0).array().isNaN().all());
  EXPECT_TRUE(run->daily().row(0).array().isNaN().all());
  EXPECT_TRUE(outputs->row(1).allFinite());
}

TEST_F(RealEnergyPlus, AMeterThatTheModelDoesNotReportIsNamed) {
  EngineSetup wrong = setup();
  wrong.outputs = {{"electricity", {{"Electricity:Facilty", 1.0}}, false}};
  const auto run = engine(wrong);
  ASSERT_TRUE(run->run(Eigen::MatrixXd::Ones(1, 1), for_each_index_serially, {}).has_value());
  ASSERT_EQ(run->failed_runs().size(), 1u);
  EXPECT_THAT(run->failed_runs().front().because, HasSubstr("does not report a meter"));
}

TEST_F(RealEnergyPlus, AnUndividedPeakWindowHasItsShareOfTheSteps) {
  EngineSetup ten_minutes = setup();
  ten_minutes.model.objects["Timestep"]["t"]["number_of_timesteps_per_hour"] = 6;
  const auto outputs =
      engine(ten_minutes)->run(Eigen::MatrixXd::Ones(1, 1), for_each_index_serially, {});
  ASSERT_TRUE(outputs.has_value());
  EXPECT_NEAR((*outputs)(0, 2), 1.0, 1e-6);
}

TEST_F(RealEnergyPlus, ATrialFindsTheMetersAndIsKept) {
  const EngineSetup all = setup();
  const auto tried = [&](const std::vector<std::string>& meters, const Program& program) {
    return try_model(all.model, meters, std::chrono::year{2021} / 1 / 1, all.weather.at(2021),
                     all.folder, program, {}, {});
  };
  const auto first = tried({"Electricity:Facility"}, program_);
  ASSERT_TRUE(first.has_value()) << first.error().message;
  EXPECT_EQ(first->model.objects, all.model.objects);
  EXPECT_EQ(first->sizes.frozen, 0);
  const Program nowhere{"/no/such/energyplus", program_.version};
  EXPECT_TRUE(tried({"Electricity:Facility"}, nowhere).has_value());
  EXPECT_THAT(tried({"Electricity:Facilty"}, program_).error().message,
              HasSubstr("does not report a meter"));
}

TEST_F(RealEnergyPlus, AnIdfIsConvertedAndStaysAsItWas) {
  const std::string text =
      "Version," + program_.version +
      ";\nBuilding,House,0,City,0.04,0.4,FullExterior,25,6;\n"
      "GlobalGeometryRules,UpperLeftCorner,Counterclockwise,World;\nSchedule:Constant,On,,1;\n";
  write_text(folder_ / "house.idf", text);
  const auto model = read_model(folder_ / "house.idf", program_);
  ASSERT_TRUE(model.has_value()) << model.error().message;
  EXPECT_EQ(model->version, program_.version);
  EXPECT_TRUE(model->objects["Building"].contains("House"));
  EXPECT_EQ(recald::testing::read_text(folder_ / "house.idf"), text);
}

TEST_F(RealEnergyPlus, AModelOfAnotherYearsReleaseIsRefused) {
  write_text(folder_ / "old.epJSON",
             R"({"Version": {"v": {"version_identifier": "9.5"}}, "Building": {"House": {}}})");
  EXPECT_THAT(read_model(folder_ / "old.epJSON", program_).error().message,
              HasSubstr("is a model of EnergyPlus 9.5 and the program is " + program_.version));
}

TEST_F(RealEnergyPlus, StopsWhenAskedTo) {
  const auto stopped = engine(setup())->run(Eigen::MatrixXd::Ones(2, 1), for_each_index_serially,
                                            [](int, int) { return false; });
  EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
}

TEST_F(RealEnergyPlus, AYearWithoutWeatherIsSaid) {
  EngineSetup without = setup();
  without.months.push_back(std::chrono::year{2022} / 1);
  EXPECT_THAT(EnergyPlusEngine::make(without, calendar_).error().message,
              HasSubstr("no weather for 2022"));
}

}  // namespace
}  // namespace recald::energyplus::energyplus_engine_test
