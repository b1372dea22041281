#include "simulators/footprint/week_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "simulators/footprint/means.hpp"
#include "simulators/footprint/meter_key.hpp"
#include "simulators/footprint/plot.hpp"
#include "simulators/footprint/showcase.hpp"

namespace recald::simulators {
namespace {

constexpr int kDays = 7;
constexpr double kWeekWidth = 900.0;
constexpr double kWeekMargin = 22.0;

/// Mondays of weeks without holidays in which all uses operate, including schools.
constexpr metering::Day kWinterMonday{std::chrono::year{kShowYear}, std::chrono::January,
                                      std::chrono::day{24}};
constexpr metering::Day kSummerMonday{std::chrono::year{kShowYear}, std::chrono::August,
                                      std::chrono::day{22}};

/// The columns of one week: temperature above, loads below.
struct Week {
  std::string caption;
  std::vector<double> outdoor_C;
  std::vector<std::vector<double>> loads_W_m2;  ///< In the order of the meters.
};

struct MeterYear {
  MeterPlate plate;
  std::vector<double> load_W_m2;

  [[nodiscard]] double annual_kWh_m2() const {
    constexpr double interval_kh = 0.25 / 1000.0;
    return interval_kh * std::accumulate(load_W_m2.begin(), load_W_m2.end(), 0.0);
  }
};

std::vector<MeterYear> meter_years(const Simulated& simulated,
                                   const metering::LocalCalendar& calendar) {
  const Drawings& drawings = simulated.building.truth().drawings;
  std::vector<MeterYear> meters;
  for (const MeterPlate& plate : plates_of(drawings)) {
    std::vector<double> load =
        metered_kW(simulated.recording, plate.utility, simulated.building.effects(), calendar);
    for (double& value : load) value *= 1000.0 / drawings.floor_area_m2();
    meters.push_back({plate, std::move(load)});
  }
  return meters;
}

Week week_from(metering::Day monday, const Recording& recording,
               const std::vector<MeterYear>& meters, const metering::LocalCalendar& calendar) {
  std::vector<double> outdoor_C;
  outdoor_C.reserve(recording.weather.size());
  for (const WeatherMean& weather : recording.weather) outdoor_C.push_back(weather.dry_bulb_C);
  Week week{"Week of " + metering::to_string(monday),
            hourly_means({recording.begin, outdoor_C}, monday, kDays, calendar),
            {}};
  for (const MeterYear& meter : meters) {
    week.loads_W_m2.push_back(
        hourly_means({recording.begin, meter.load_W_m2}, monday, kDays, calendar));
  }
  return week;
}

void draw_week(Svg& svg, double left, double top, const Week& week,
               const std::vector<MeterYear>& meters, const Scale& scale) {
  constexpr double width = 390.0;
  constexpr std::array<std::string_view, kDays> names{"Mon", "Tue", "Wed", "Thu",
                                                      "Fri", "Sat", "Sun"};
  const auto [coldest_C, warmest_C] = std::ranges::minmax(week.outdoor_C);
  const double low_C = coldest_C - 1.0;
  const double high_C = warmest_C + 1.0;
  Plot temperature(svg, {left, top, width, 62.0}, kDays,
                   {low_C, high_C, nice_ticks(low_C, high_C, 4)});
  temperature.caption(week.caption + ": outdoors, degC");
  temperature.x_rules(kDays);
  temperature.curve(week.outdoor_C, {.colour = "#009e73", .width = 1.5});

  Plot loads(svg, {left, top + 96.0, width, 190.0}, kDays, scale);
  loads.caption("Meters, W/m² of floor");
  loads.x_rules(kDays);
  std::vector<Mark> marks;
  for (const auto name : names) {
    marks.push_back({static_cast<double>(marks.size()) + 0.5, std::string(name)});
  }
  loads.x_marks(marks);
  for (std::size_t i = 0; i < meters.size(); ++i) {
    loads.curve(week.loads_W_m2[i], {.colour = colour_of(meters[i].plate.utility), .width = 1.5});
  }
  loads.zero_line();
}

void draw_years(Svg& svg, double y, const std::vector<MeterYear>& meters) {
  std::vector<KeyEntry> key;
  for (const MeterYear& meter : meters) {
    key.push_back(
        {meter.plate.utility, fmt::format("{} {:.0f} kWh/m² a year", in_words(meter.plate.kind),
                                          meter.annual_kWh_m2())});
  }
  draw_key(svg, {kWeekMargin, y}, key);
}

}  // namespace

std::string week_figure(const Scenario& scenario, const Simulated& simulated,
                        const metering::LocalCalendar& calendar) {
  const auto meters = meter_years(simulated, calendar);
  const std::array weeks{week_from(kWinterMonday, simulated.recording, meters, calendar),
                         week_from(kSummerMonday, simulated.recording, meters, calendar)};
  ValueRange range;
  for (const Week& week : weeks) {
    for (const auto& load_W_m2 : week.loads_W_m2) range.include(load_W_m2);
  }
  const Scale scale = range.scale(6);
  const std::string building = describe_scenario(scenario);
  Svg svg(kWeekWidth, 430.0, building);
  svg.text({kWeekMargin, 32.0}, building, {.size = 15.0, .bold = true});
  draw_years(svg, 60.0, meters);
  draw_week(svg, 56.0, 102.0, weeks[0], meters, scale);
  draw_week(svg, 494.0, 102.0, weeks[1], meters, scale);
  return svg.finished();
}

}  // namespace recald::simulators
