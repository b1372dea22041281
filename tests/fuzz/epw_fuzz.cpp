// A weather file that is accepted is a whole year. The rows of a year are too long to be found by
// chance, so the input is the file's head and one row, which is repeated for each hour.
#include <cmath>

#include "adapters/epw/epw.hpp"
#include "tests/fuzz/require.hpp"

namespace recald::fuzz {
namespace {

/// `row` is what follows "year,month,day,hour" in each of the year's rows.
std::string whole_year(std::string_view head, std::string_view row) {
  std::string text{head};
  for (int month = 1; month <= 12; ++month) {
    const auto last = metering::days_in(std::chrono::year{2001} / month);
    for (int day = 1; day <= last; ++day) {
      for (int hour = 1; hour <= 24; ++hour) {
        text += "2001," + std::to_string(month) + "," + std::to_string(day) + "," +
                std::to_string(hour);
        text += row;
        text += '\n';
      }
    }
  }
  return text;
}

void require_sound(const Result<epw::EpwWeather>& weather) {
  if (!weather) return require_sentence(weather.error().message);
  require(weather->series.hours.size() >= 8760 && weather->series.hours.size() <= 8785,
          "a whole year");
  require(std::abs(weather->location.latitude_deg) <= 90.0, "a place on Earth");
  for (const std::string& note : weather->notes) require_sentence(note);
  for (const weather::WeatherHour& hour : weather->series.hours) {
    for (const weather::WeatherVariable& variable : weather::kWeatherVariables) {
      require(!std::isinf(hour.*variable.member), "a value is finite or absent");
    }
  }
}

}  // namespace
}  // namespace recald::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald::fuzz;
  const std::string_view text = text_of(data, size);
  require_sound(recald::epw::read_epw_text(text, "weather.epw"));
  // Head and row are parted by a line that is a percent sign.
  const std::size_t parting = text.find("\n%\n");
  if (parting == std::string_view::npos || size > 4096) return 0;
  const std::string_view row = text.substr(parting + 3);
  if (row.find('\n') != std::string_view::npos) return 0;
  require_sound(recald::epw::read_epw_text(whole_year(text.substr(0, parting + 1), row),
                                           "weather.epw", 2001));
  return 0;
}
