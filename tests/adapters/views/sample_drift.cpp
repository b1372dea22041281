#include "tests/adapters/views/sample_drift.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace recald::views {
namespace {

using std::chrono::July;
using std::chrono::months;
using std::chrono::October;
using std::chrono::year;

constexpr metering::Month kFirst = year{2020} / std::chrono::January;
constexpr int kMonths = 36;
constexpr int kLearnt = 12;
constexpr int kChange = 30;

ForecastSeries series_of(const std::string& label, double rise) {
  ForecastSeries series{.label = label,
                        .unit = "kWh/day",
                        .trust = "22 of 24 months within 90 %.",
                        .months = {},
                        .alarms = {}};
  for (int i = 0; i < kMonths; ++i) {
    const double expected = 1000.0 - 400.0 * std::cos(2.0 * std::numbers::pi * i / 12.0);
    ForecastMonth month{.month = kFirst + months{i},
                        .q05 = {},
                        .q50 = {},
                        .q95 = {},
                        .measured = expected * (i < kChange ? 1.0 : 1.0 + rise)};
    if (i >= kLearnt) {
      month.q05 = 0.9 * expected;
      month.q50 = expected;
      month.q95 = 1.1 * expected;
    }
    series.months.push_back(month);
  }
  return series;
}

}  // namespace

DriftData sample_drift() {
  DriftData data{.title = "What has changed at Sample",
                 .site = {"sample", "Sample", "America/New_York"},
                 .generated_at = "2023-01-02 03:04",
                 .headline = "24 months forecast, 1 alarm.",
                 .alarms = {},
                 .meter_changes = {"gas reads about 1/28.2 what it read before."},
                 .notices = {{Severity::info, "2021-02 is left out."}},
                 .outputs = {series_of("Chilled water, daily average", 0.3),
                             series_of("Electricity, daily average", 0.0)},
                 .parameters = {},
                 .windows = {{"expanding", 12.5, 3}, {"12 months", 11.0, 2}},
                 .history = {{kFirst, "Model epc-1"}, {kFirst + months{kChange}, "Begun anew."}},
                 .provenance = {.recald_version = "0.1.0", .seed = 1}};
  data.outputs[0].alarms = {{year{2022} / July, year{2022} / October}};
  data.alarms.push_back({.title = "Chilled water is more than forecast since Jul 2022",
                         .sentence = "By +30 %; evidence 500 to 1.",
                         .causes = {{"outdoor_airflow is 6.2 m3/s since", 0.91},
                                    {"chance: nothing has changed", 0.0002}},
                         .consequence = "The model has been learnt anew.",
                         .advice = "Look at what was changed."});
  BelievedParameter airflow{
      .label = "Outdoor airflow", .unit = "m3/s", .months = {}, .last_year_mean = {}};
  for (int i = kLearnt - 1; i < kMonths; ++i) {
    const double mean = i < kChange ? 5.0 : 6.2;
    airflow.months.push_back({kFirst + months{i}, mean, mean - 0.5, mean + 0.5});
    airflow.last_year_mean.push_back(i < 14 ? std::numeric_limits<double>::quiet_NaN() : mean);
  }
  data.parameters.push_back(airflow);
  return data;
}

DriftData quiet_drift() {
  DriftData data = sample_drift();
  data.headline = "24 months forecast, none of them surprising enough for an alarm.";
  data.alarms.clear();
  data.meter_changes.clear();
  data.outputs.resize(1);
  data.outputs[0] = series_of("</script><b>Steam</b>", 0.0);
  data.outputs[0].months[20].measured.reset();
  data.parameters.clear();
  return data;
}

}  // namespace recald::views
