#include "tests/adapters/views/sample_report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random/rng.hpp"

namespace recald::views {
namespace {

using assessment::BoxPlot;
using assessment::FitMetrics;
using assessment::MonthRole;
using metering::MonthlyFigure;
using std::chrono::day;
using std::chrono::month;
using std::chrono::year;

constexpr int kFirstYear = 2019;
constexpr int kYears = 3;
constexpr int kDraws = 270;

/// −1 in January, +1 in July.
double season(unsigned month_number) {
  return -std::cos(2.0 * std::numbers::pi * (month_number - 1.0) / 12.0);
}

struct MeterShape {
  const char* name;
  double mean_kWh;
  double swing;  ///< Relative; positive peaks in summer.
};

constexpr MeterShape kMeters[] = {
    {"Chilled water", 14'500.0, 0.55}, {"Steam", 9'200.0, -0.45}, {"Electricity", 11'800.0, 0.04}};

MonthRole role_of(int index) { return index < 24 ? MonthRole::calibration : MonthRole::validation; }

BoxPlot box_around(double centre, double sd) {
  return {centre - 2.7 * sd,  centre - 0.67 * sd, centre,
          centre + 0.67 * sd, centre + 2.7 * sd,  centre + 0.02 * sd};
}

OutputMonth output_month(const MeterShape& meter, int index, Rng& rng) {
  const unsigned number = static_cast<unsigned>(index % 12) + 1;
  const double truth = meter.mean_kWh * (1.0 + meter.swing * season(number));
  OutputMonth result;
  MonthlyFigure& figure = result.figure;
  figure.month = metering::Month{year{kFirstYear + index / 12}, month{number}};
  result.role = role_of(index);
  figure.daily_average_kWh = truth * (1.0 + 0.06 * rng.normal());
  figure.peak_window = std::chrono::minutes{15};
  figure.usable = true;
  figure.filled_share = rng.uniform() < 0.4 ? rng.uniform(0.001, 0.06) : 0.0;
  figure.coverage = 1.0 - figure.filled_share;
  result.box = box_around(truth * (1.0 + 0.03 * rng.normal()), 0.035 * meter.mean_kWh);
  const double sd = 0.05 * meter.mean_kWh;
  result.forecast = assessment::MonthForecast{truth, truth - 1.64 * sd, truth - 0.67 * sd,
                                              truth, truth + 0.67 * sd, truth + 1.64 * sd};
  return result;
}

/// The steam meter has a month too thin to use, a month without anything and two odd ones.
void spoil_steam(OutputResult& steam) {
  MonthlyFigure& thin = steam.months[14].figure;
  thin.coverage = 0.41;
  thin.filled_share = 0.59;
  thin.usable = false;
  thin.unusable_because = "41.0 % of the month is measured, 60 % are needed";
  MonthlyFigure& empty = steam.months[15].figure;
  empty.coverage = 0.0;
  empty.filled_share = 0.0;
  empty.daily_average_kWh = NAN;
  empty.usable = false;
  empty.unusable_because = "nothing was measured";
  for (const std::size_t odd : {std::size_t{34}, std::size_t{35}}) {
    steam.months[odd].figure.daily_average_kWh *= 0.6;
    steam.months[odd].flagged_different = true;
  }
}

std::vector<double> scatter_draws(double centre, double spread, Rng& rng) {
  std::vector<double> draws;
  for (int i = 0; i < kDraws; ++i) {
    draws.push_back(centre + spread * std::abs(rng.normal()) + 0.2 * spread * rng.normal());
  }
  return draws;
}

OutputResult output_result(const MeterShape& meter, Rng& rng) {
  OutputResult result;
  result.label = meter.name;
  for (int index = 0; index < 12 * kYears; ++index) {
    result.months.push_back(output_month(meter, index, rng));
  }
  const double scale = meter.swing < 0.0 ? 1.5 : 1.0;
  const auto metrics = [scale](double nmbe, double cvrmse) {
    return FitMetrics{scale * nmbe, -scale * nmbe, scale * cvrmse, 12};
  };
  assessment::OutputAssessment& fit = result.assessment.emplace();
  fit.before = {metrics(0.182, 0.243), metrics(0.203, 0.262)};
  fit.prior_mean = {metrics(-0.034, 0.147), metrics(-0.021, 0.151)};
  fit.after = {metrics(0.012, 0.098), metrics(-0.028, 0.118)};
  fit.draw_cvrmse_calibration = scatter_draws(0.095 * scale, 0.018, rng);
  fit.draw_cvrmse_validation = scatter_draws(0.112 * scale, 0.024, rng);
  fit.forecast.calibration = {
      metrics(0.003, 0.041),
      assessment::ForecastScores{24, 13, 22, 0.02 * meter.mean_kWh, 0.15 * meter.mean_kWh}};
  fit.forecast.validation = {
      metrics(0.007, 0.052),
      assessment::ForecastScores{12, 5, 10, 0.03 * meter.mean_kWh, 0.19 * meter.mean_kWh}};
  fit.yardstick.emplace().validation = {
      metrics(0.009, 0.083),
      assessment::ForecastScores{12, 6, 11, 0.05 * meter.mean_kWh, 0.31 * meter.mean_kWh}};
  return result;
}

/// Draws around `mean`, kept inside the prior, and the summary that belongs to them.
ParameterResult parameter_result(std::string name, std::string label, std::string unit, Prior prior,
                                 double mean, double sd, Rng& rng) {
  ParameterResult result{.label = std::move(label),
                         .prior = prior,
                         .summary = {.name = std::move(name),
                                     .unit = std::move(unit),
                                     .rhat = 1.003,
                                     .ess_bulk = 1240.0,
                                     .ess_tail = 980.0},
                         .draws = {}};
  calibration::Summary& summary = result.summary;
  while (result.draws.size() < 2700) {
    const double draw = mean + sd * rng.normal();
    if (draw > prior.min() && draw < prior.max()) result.draws.push_back(draw);
  }
  std::vector<double> sorted = result.draws;
  std::sort(sorted.begin(), sorted.end());
  double sum = 0.0;
  double squares = 0.0;
  for (const double draw : sorted) sum += draw;
  summary.mean = sum / 2700.0;
  for (const double draw : sorted) squares += (draw - summary.mean) * (draw - summary.mean);
  summary.sd = std::sqrt(squares / 2699.0);
  summary.q05 = sorted[135];
  summary.q50 = sorted[1350];
  summary.q95 = sorted[2564];
  summary.contraction = 1.0 - summary.sd * summary.sd / prior.variance();
  return result;
}

PeakSeries peak_series(const OutputResult& output, const metering::LocalCalendar& calendar,
                       Rng& rng) {
  PeakSeries result{.meter = output.label, .months = {}};
  for (const OutputMonth& from : output.months) {
    MonthlyFigure& figure = result.months.emplace_back(from.figure);
    if (std::isnan(figure.daily_average_kWh)) continue;
    figure.peak = {.kW = figure.daily_average_kWh / 24.0 * rng.uniform(1.5, 1.9),
                   .start = calendar.first_instant(figure.month / 14, 15 * 60 + 45),
                   .could_be_exceeded = figure.coverage < 0.98};
  }
  return result;
}

double office_hours(std::size_t hour) { return hour >= 7 && hour < 19 ? 1.0 : 0.0; }

DayTypeProfile day_type_profile(std::string label, double activity, Rng& rng) {
  DayTypeProfile result{.label = std::move(label), .parts = {}, .measured_mean_kW = {}};
  ProfilePart base{"Base", {}};
  ProfilePart lights{"Lights", {}};
  ProfilePart plugs{"Plug loads", {}};
  ProfilePart fans{"Fans and pumps", {}};
  for (std::size_t hour = 0; hour < 24; ++hour) {
    base.mean_kW[hour] = 210.0;
    lights.mean_kW[hour] = 25.0 + 140.0 * activity * office_hours(hour);
    plugs.mean_kW[hour] = 45.0 + 110.0 * activity * office_hours(hour);
    fans.mean_kW[hour] = 70.0 + 60.0 * activity * office_hours(hour);
    result.measured_mean_kW[hour] =
        (350.0 + 310.0 * activity * office_hours(hour)) * (1.0 + 0.02 * rng.normal());
  }
  result.parts = {base, lights, plugs, fans};
  return result;
}

/// Marks hours [from, to) of a grid; hours without a value to show become NaN.
void mark_hours(LoadGrid& load, std::size_t from, std::size_t to, HourStatus status) {
  for (std::size_t i = from; i < std::min(to, load.status.size()); ++i) {
    load.status[i] = status;
    if (status == HourStatus::missing) load.mean_kW[i] = NAN;
  }
}

LoadGrid load_grid(const MeterShape& meter, Rng& rng) {
  LoadGrid load;
  load.meter = meter.name;
  load.first_day = metering::Day{year{kFirstYear}, month{1}, day{1}};
  const std::chrono::sys_days first{load.first_day};
  const std::chrono::sys_days end{metering::Day{year{kFirstYear + kYears}, month{1}, day{1}}};
  for (std::chrono::sys_days today = first; today < end; today += std::chrono::days{1}) {
    const metering::Day date{today};
    const bool weekend = std::chrono::weekday{today}.iso_encoding() >= 6;
    const double weather = 1.0 + meter.swing * season(unsigned{date.month()}) + 0.08 * rng.normal();
    for (std::size_t hour = 0; hour < 24; ++hour) {
      const double activity = 0.75 + (weekend ? 0.1 : 0.5) * office_hours(hour);
      load.mean_kW.push_back(static_cast<float>(meter.mean_kWh / 24.0 * weather * activity *
                                                (1.0 + 0.04 * rng.normal())));
    }
  }
  load.status.assign(load.mean_kW.size(), HourStatus::ok);
  mark_hours(load, 24 * 150 + 9, 24 * 150 + 15, HourStatus::partly_filled);
  mark_hours(load, 24 * 300, 24 * 312, HourStatus::partly_filled);
  mark_hours(load, 24 * 200 + 6, 24 * 203 + 20, HourStatus::missing);
  mark_hours(load, 24 * 700 + 6, 24 * 720, HourStatus::suspect);
  return load;
}

metering::DataFinding finding(std::string meter, std::string sentence, metering::Instant from,
                              metering::Instant to, int slots) {
  return {.meter = std::move(meter),
          .sentence = std::move(sentence),
          .span = {from, to},
          .slots = slots};
}

void add_words(ReportData& data) {
  data.first = {
      .sentence =
          "The model uses 22\u00a0% too little chilled water; calibration did not mend that: "
          "something is missing in it.",
      .more = "",
      .numbers = {{"−22.1\u00a0%", "Chilled water, model against meter in months not fitted"},
                  {"+3.0\u00a0%", "Steam, model against meter in months not fitted"},
                  {"−0.4\u00a0%", "Electricity, model against meter in months not fitted"}}};
  data.asks_for_diagnosis = true;
  data.headlines = {
      "Chilled water: forecast of months it has not seen: CV(RMSE) 5.2\u00a0% and NMBE "
      "+0.7\u00a0%.",
      "The data narrowed two of the three uncertain parameters: the building takes in less outdoor "
      "air and is kept warmer than its design says. About the number of people they say nothing."};
  data.verdicts = {
      {"Chilled water",
       {true,
        "Bias +1.2 % and scatter 9.8 % on the calibration months; −2.8 % and 11.8 % on "
        "validation."}},
      {"Steam",
       {false,
        "Scatter of 17.7 % on the validation months exceeds 15 %; two months there are flagged as "
        "different."}},
      {"Electricity",
       {true,
        "Bias +1.2 % and scatter 9.8 % on the calibration months; −2.8 % and 11.8 % on "
        "validation."}}};
  data.notices = {
      {Severity::info, "These numbers are invented: a sample that shows what a report looks like."},
      {Severity::warning,
       "Steam in November and December 2021 is 40 % below what the model expects; ask what "
       "changed."},
      {Severity::warning,
       "The variance of the model discrepancy left the range its prior thought likely."},
      {Severity::failure,
       "Steam has no usable figure for March and April 2020; both months were left out."}};
  const auto at = [&data](int in_year, unsigned in_month, unsigned on, int hour, int minute) {
    return data.calendar->first_instant(metering::Day{year{in_year}, month{in_month}, day{on}},
                                        60 * hour + minute);
  };
  data.findings = {
      finding("Steam", "A run of zeros that means no data, not no steam: kept out.",
              at(2020, 3, 12, 6, 0), at(2020, 4, 30, 23, 45), 4776),
      finding("Electricity", "The same reading 31 times in a row.", at(2019, 8, 3, 2, 15),
              at(2019, 8, 3, 9, 45), 31),
      finding("Chilled water",
              "Single readings more than eight times the usual spread above their hour.",
              at(2021, 6, 1, 13, 0), at(2021, 6, 19, 15, 30), 7)};
  data.not_known = {
      "Whether the calibrated values are the building's true values: they are the ones with which "
      "this "
      "model repeats these meters best.",
      "Peak demand: the model works on monthly sums.",
      "Steam in March and April 2020, because the meter recorded next to nothing.",
      "Anything that was the same in all three years, such as a meter that reads 5 % high "
      "throughout."};
}

}  // namespace

ReportData sample_report() {
  Rng rng{20'261'121};
  ReportData data;
  data.title = "Calibration report (sample, invented numbers)";
  data.generated_at = "2022-01-05 09:30 (UTC−05:00)";
  data.site = {"sample-laboratory", "Sample Laboratory Building", "America/New_York"};
  data.calendar = metering::LocalCalendar::open(data.site.time_zone).value();
  data.provenance = {.recald_version = "0.1.0",
                     .data_revision = "9f2c51d07e6b4a83",
                     .model_version = "epc 1, three parameters",
                     .time_zone_data = "2025b",
                     .sampler = "seed_rwm",
                     .hyper_prior_profile = "scaled",
                     .seed = 20150601,
                     .iterations = 30'000,
                     .burn_in = 3'000,
                     .chains = 4,
                     .wall_s = 21.4};
  add_words(data);
  for (const MeterShape& meter : kMeters) {
    data.outputs.push_back(output_result(meter, rng));
    data.loads.push_back(load_grid(meter, rng));
  }
  spoil_steam(data.outputs[1]);
  for (const OutputResult& output : data.outputs) {
    data.peaks.push_back(peak_series(output, *data.calendar, rng));
  }
  data.parameters = {parameter_result("cooling_setpoint", "Cooling set-point", "°C",
                                      {20.0, 23.9, 27.8}, 25.1, 0.72, rng),
                     parameter_result("occupancy_density", "Occupancy density", "person/m²",
                                      {0.0, 0.05, 0.1}, 0.0493, 0.024, rng),
                     parameter_result("outdoor_air", "Outdoor airflow rate", "m³/s",
                                      {4.2, 14.0, 16.8}, 8.4, 1.3, rng)};
  data.parameters[1].summary.rhat = 1.034;
  data.parameters[1].summary.ess_bulk = 212.0;
  data.profile = {
      {day_type_profile("Working day", 1.0, rng), day_type_profile("Saturday", 0.35, rng),
       day_type_profile("Sunday and holiday", 0.05, rng)},
      "Month by month the profile repeats the meter with a CV(RMSE) of 2.9 % and no trend; "
      "up to 5 % counts as constant."};
  return data;
}

ReportData readings_only_report() {
  ReportData data = sample_report();
  data.title = "Readings report (sample, invented numbers)";
  data.first = {};
  data.asks_for_diagnosis = false;
  data.headlines = {"Two meters were read for five months; there is no model yet."};
  data.verdicts.clear();
  data.notices.resize(1);
  data.findings.clear();
  data.not_known.clear();
  data.parameters.clear();
  data.profile = {};
  data.outputs.resize(2);
  data.peaks.resize(2);
  data.loads.resize(2);
  for (OutputResult& output : data.outputs) {
    output.months = {output.months.begin() + 10, output.months.begin() + 15};
    for (OutputMonth& month : output.months) {
      month.role = MonthRole::unused;
      month.box.reset();
    }
    output.assessment.reset();
  }
  for (OutputMonth& month : data.outputs[1].months) {
    month.figure.daily_average_kWh = NAN;
    month.figure.usable = false;
    month.figure.coverage = 0.0;
    month.figure.unusable_because = "nothing was measured";
  }
  for (PeakSeries& series : data.peaks) {
    series.months = {series.months.begin() + 10, series.months.begin() + 15};
  }
  for (MonthlyFigure& figure : data.peaks[1].months) figure.peak.reset();
  for (LoadGrid& load : data.loads) {
    load.first_day = metering::Day{year{kFirstYear}, month{11}, day{1}};
    load.mean_kW.resize(24 * 152);
    load.status.resize(24 * 152);
  }
  mark_hours(data.loads[1], 0, 24 * 152, HourStatus::missing);
  return data;
}

ReportData design_report() {
  ReportData data = sample_report();
  data.title = "Calibration on a design (sample, invented numbers)";
  data.site = {.id = {}, .name = "sample design", .time_zone = {}};
  data.calendar.reset();
  data.asks_for_diagnosis = false;
  data.findings.clear();
  data.profile = {};
  data.peaks.clear();
  data.loads.clear();
  data.outputs[1].label += " peak";
  data.outputs[1].is_peak = true;
  data.outputs[2].units.daily.name.clear();
  for (OutputResult& output : data.outputs) {
    int number = 0;
    for (OutputMonth& month : output.months) {
      const double measured = month.figure.daily_average_kWh;
      month.number = std::to_string(++number);
      month.flagged_different = false;
      month.figure = {.daily_average_kWh = output.is_peak ? NAN : measured,
                      .coverage = NAN,
                      .filled_share = NAN,
                      .usable = std::isfinite(measured)};
      if (output.is_peak) month.figure.peak = metering::PeakDemand{.kW = measured};
    }
  }
  return data;
}

}  // namespace recald::views
