// Hours of weather are finite or absent and within what can be measured on the ground; whatever is
// kept out has its reason.
#include <cmath>

#include "adapters/csv/weather_csv.hpp"
#include "tests/fuzz/require.hpp"

namespace recald::fuzz {
namespace {

void require_measurable(const weather::WeatherSeries& series) {
  require(series.begin.time_since_epoch() % std::chrono::hours{1} == std::chrono::seconds{0},
          "the series begins on the hour");
  for (const weather::WeatherHour& hour : series.hours) {
    for (const weather::WeatherVariable& variable : weather::kWeatherVariables) {
      require(!std::isinf(hour.*variable.member), "a value is finite or absent");
    }
    require(!(hour.rel_humidity_pct < 0.0 || hour.rel_humidity_pct > 100.0 + 1e-9),
            "humidity between 0 and 100 %");
    require(!(hour.dry_bulb_C < -90.0 - 1e-9 || hour.dry_bulb_C > 60.0 + 1e-9),
            "a temperature on Earth");
    require(!(hour.wind_dir_deg < -1e-9 || hour.wind_dir_deg > 360.0 + 1e-9),
            "a direction within the circle");
  }
}

}  // namespace
}  // namespace recald::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald::fuzz;
  Input input{data, size};
  recald::csv::WeatherCsvOptions options;
  if (input.below(2) == 1) options.stamps = recald::csv::Stamps::end;
  const auto weather =
      recald::csv::read_weather_text(text_of(input.rest(), input.left()), "weather.csv", options);
  if (!weather) {
    require_sentence(weather.error().message);
    return 0;
  }
  require_measurable(weather->series);
  for (const auto& issue : weather->issues.listed) require_sentence(issue.reason);
  for (const std::string& column : weather->ignored_columns) {
    if (!column.empty()) require_sentence(column);
  }
  return 0;
}
