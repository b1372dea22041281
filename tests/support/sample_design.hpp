/// A small design of experiments with a simulation of its own: a few lines of arithmetic on weather
/// and parameters, enough to be bent, and nothing that recald's models contain.
#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/random/rng.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::testing {

/// Set-point, air and people move the outputs, the paint hardly does.
inline constexpr std::array<const char*, 4> kSampleParameters = {"set_point", "air", "people",
                                                                 "paint"};
inline constexpr const char* kSamplePriors =
    "parameter,unit,min,mode,max\n"
    "set_point,degC,20,23,26\n"
    "air,m3/s,0.5,2,3\n"
    "people,person/m2,0,0.05,0.1\n"
    "paint,-,0.9,1,1.1\n";

using SampleTheta = std::array<double, 4>;
inline constexpr SampleTheta kSampleTruth = {24.0, 1.4, 0.06, 1.0};

struct SampleMonth {
  std::string name;  ///< "2020-01"
  double dry_bulb_C;
  double wind_deg;
};

/// `count` months from January 2020.
inline std::vector<SampleMonth> sample_months(int count) {
  std::vector<SampleMonth> months;
  for (int i = 0; i < count; ++i) {
    const std::string month = std::to_string(i % 12 + 1);
    months.push_back({std::to_string(2020 + i / 12) + (month.size() == 1 ? "-0" : "-") + month,
                      14.0 - 11.0 * std::cos(i * 0.5236) + 1.5 * std::sin(i * 2.1),
                      std::fmod(300.0 + 47.0 * i, 360.0)});
  }
  return months;
}

/// Chilled water of a month: kWh a day, and kW at the peak.
inline std::array<double, 2> sample_outputs(const SampleTheta& theta, const SampleMonth& month) {
  const auto& [set_point, air, people, paint] = theta;
  const double warmth = std::log1p(std::exp(0.3 * (month.dry_bulb_C + 4.0 - set_point))) / 0.3;
  const double daily = 400.0 + 55.0 * air * warmth + 9000.0 * people * (1.0 + 0.02 * warmth) +
                       20.0 * (paint - 1.0) * warmth;
  return {daily, 30.0 + daily / 14.0 + 8.0 * air + 200.0 * people};
}

/// Writes the five files: the design over the first `design_months` of `months`, measurements over
/// all of them, at the truth with 2 % of noise.
inline void write_sample_design(const std::filesystem::path& folder, int runs = 60,
                                int design_months = 12, int months = 15) {
  std::filesystem::create_directories(folder);
  Rng rng{7};
  const auto all = sample_months(months);
  write_text(folder / "priors.csv", kSamplePriors);
  std::string inputs = "run,set_point,air,people,paint\n";
  std::string outputs = "run,month,chw_daily_kwh,chw_peak_kw\n";
  for (int run = 1; run <= runs; ++run) {
    const SampleTheta theta = {rng.uniform(20.0, 26.0), rng.uniform(0.5, 3.0),
                               rng.uniform(0.0, 0.1), rng.uniform(0.9, 1.1)};
    inputs += std::to_string(run);
    for (const double value : theta) inputs += "," + std::to_string(value);
    inputs += '\n';
    for (int i = 0; i < design_months; ++i) {
      const auto [daily, peak] = sample_outputs(theta, all[static_cast<std::size_t>(i)]);
      outputs += std::to_string(run) + "," + all[static_cast<std::size_t>(i)].name + "," +
                 std::to_string(daily) + "," + std::to_string(peak) + "\n";
    }
  }
  write_text(folder / "doe_inputs.csv", inputs);
  write_text(folder / "doe_outputs.csv", outputs);
  std::string weather = "month,drybulb,winddir\n";
  std::string measured = "month,chw_daily_kwh,chw_peak_kw,note\n";
  for (const SampleMonth& month : all) {
    const auto [daily, peak] = sample_outputs(kSampleTruth, month);
    weather += month.name + "," + std::to_string(month.dry_bulb_C) + "," +
               std::to_string(month.wind_deg) + "\n";
    measured += month.name + "," + std::to_string(daily * (1.0 + 0.02 * rng.normal())) + "," +
                std::to_string(peak * (1.0 + 0.02 * rng.normal())) + ",fine\n";
  }
  write_text(folder / "inputs.csv", weather);
  write_text(folder / "measurements.csv", measured);
}

}  // namespace recald::testing
