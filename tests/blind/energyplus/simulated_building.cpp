#include "tests/blind/energyplus/simulated_building.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "adapters/system/files/write_file.hpp"
#include "simulators/climate/normals.hpp"
#include "simulators/energyplus/model_edits.hpp"
#include "tests/blind/energyplus/foreign_building.hpp"

namespace recald::blind {
namespace {

using namespace simulators::energyplus;
using simulators::Utility;
using std::chrono::sys_days;

constexpr double kDaysAYear = 365.25;
/// Streams of a case's seed that are no simulator's.
constexpr std::uint64_t kAlterations = 76;
constexpr std::uint64_t kMemory = 77;
constexpr std::uint64_t kMeterSizes = 78;

/// The next size of a series of ten a decade. @see ISO 3 (1973), R10.
double standard_size(double least_kW) {
  constexpr double kADecade = 10.0;
  const double step = std::ceil(kADecade * std::log10(least_kW) - 1e-9);
  return std::round(std::pow(10.0, step / kADecade));
}

double quantile_of(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// Stull's approximation would do; a design day needs no more than that: a third of the way from
/// the dew point to the dry bulb.
double wet_bulb_C(double dry_C, double dew_C) { return dew_C + (dry_C - dew_C) / 3.0; }

DesignHours design_hours(const std::vector<WeatherHour>& hours, const simulators::Place& place,
                         std::chrono::seconds standard_offset) {
  constexpr double kRare = 0.004;
  std::vector<double> dry_C;
  for (const WeatherHour& hour : hours) dry_C.push_back(hour.at_end.air.temperature_C);
  const double hot_C = quantile_of(dry_C, 1.0 - kRare);
  double dew_C = 0.0;
  double count = 0.0;
  for (const WeatherHour& hour : hours) {
    if (hour.at_end.air.temperature_C < hot_C) continue;
    dew_C += simulators::dew_point_C(
        simulators::vapour_pressure_Pa(hour.at_end.air.humidity_kg_kg, hour.at_end.pressure_Pa));
    count += 1.0;
  }
  return {.heating_C = quantile_of(dry_C, kRare),
          .cooling_C = hot_C,
          .cooling_wet_bulb_C = wet_bulb_C(hot_C, dew_C / count),
          .pressure_Pa = hours.front().at_end.pressure_Pa,
          .place = place,
          .zone_h = metering::in_hours(standard_offset)};
}

/// Wet or dry as a whole: partly wet coils took seven eighths of EnergyPlus's time in ten days of
/// July of a building with fan coils, and cooled 1.4 % more.
void use_fast_coils(Json& model) {
  for_each_object(model, "Coil:Cooling:Water", [](const std::string& /*name*/, Json& coil) {
    coil["type_of_analysis"] = "SimpleAnalysis";
  });
}

/// How much of an effect there is on a day, 0 to 1.
double share_on(const HiddenInBuilding& hidden, sys_days day, sys_days first, sys_days end) {
  if (hidden.from && day < sys_days{*hidden.from}) return 0.0;
  switch (hidden.change->course) {
    case Course::at_once:
      return 1.0;
    case Course::steadily: {
      const sys_days begin = hidden.from ? std::max(first, sys_days{*hidden.from}) : first;
      return static_cast<double>((day - begin).count()) /
             static_cast<double>((end - first).count());
    }
    case Course::sawtooth: {
      // Put right in April of every year.
      const std::chrono::year_month_day date{day};
      const sys_days april{date.year() / 4 / 1};
      const sys_days cleaned =
          day >= april ? april : sys_days{(date.year() - std::chrono::years{1}) / 4 / 1};
      return static_cast<double>((day - cleaned).count()) / kDaysAYear;
    }
    case Course::for_a_while: {
      if (!hidden.to || day <= sys_days{*hidden.to}) return 1.0;
      constexpr double kReturn_days = 60.0;  // Little by little.
      const auto gone = static_cast<double>((day - sys_days{*hidden.to}).count());
      return std::max(1.0 - gone / kReturn_days, 0.0);
    }
  }
  return 1.0;
}

}  // namespace

Result<SimulatedBuilding> SimulatedBuilding::make(const EplusPlan& plan, const Engine& engine,
                                                  const std::filesystem::path& given) {
  const std::filesystem::path folder = std::filesystem::absolute(given);
  SimulatedBuilding building;
  building.plan_ = plan;
  building.engine_ = &engine;
  building.folder_ = folder;
  const simulators::Drawings& drawings = plan.building.drawings;
  auto calendar = metering::LocalCalendar::open(drawings.time_zone);
  if (!calendar) return tl::unexpected(calendar.error());
  building.calendar_ = std::make_unique<metering::LocalCalendar>(std::move(*calendar));
  building.hours_ = simulate_hours(simulators::climate_of(drawings.climate, drawings.place),
                                   plan.first_year, plan.years, plan.seed, *building.calendar_);
  if (const auto made = system::make_folder(folder); !made) return tl::unexpected(made.error());

  const auto offset = building.calendar_->standard_offset(std::chrono::year{plan.first_year});
  building.begin_ = sys_days{std::chrono::year{plan.first_year} / 1 / 1} - offset;
  const simulators::Calendar holidays(plan.foreign ? plan.foreign->like : drawings.calendar);
  std::size_t hour = 0;
  for (int year = plan.first_year; year < plan.first_year + plan.years; ++year) {
    const std::vector<metering::Day> free = holidays.holidays_of(std::chrono::year{year});
    const std::size_t count = days_of(year).size() * 24;
    const auto first = building.hours_.begin() + static_cast<std::ptrdiff_t>(hour);
    auto around = std::make_unique<YearAround>();
    around->year = year;
    around->holidays = free;
    around->hours.assign(first, first + static_cast<std::ptrdiff_t>(count));
    hour += count;
    building.around_.push_back(std::move(around));
    const auto written = system::write_file(
        folder / fmt::format("{}.epw", year),
        epw_text(building.hours_, year, drawings.place, *building.calendar_, free));
    if (!written) return tl::unexpected(written.error());
  }
  auto sized = size(plan, engine, design_hours(building.hours_, drawings.place, offset), folder);
  if (!sized) return tl::unexpected(sized.error());
  building.sized_ = std::move(*sized);
  building.meters_ = meters_of(building.sized_.model);
  building.truth_ = draw_true_parameters(plan.seed);
  const auto& zones = building.sized_.tables["Zone Summary"];
  const double floor_m2 = std::strtod(zones.at("Conditioned Total").at("Area").c_str(), nullptr);

  building.twin_.resize(building.meters_.size());
  for (const auto& around : building.around_) {
    around->floor_m2 = floor_m2;
    auto schedules = read_schedules(building.sized_.schedules, around->year, around->holidays);
    if (!schedules) return tl::unexpected(schedules.error());
    BuildingYear year(building.sized_.model, std::move(*schedules), *around);
    if (building.drawn_.empty()) building.drawn_.push_back(year);
    make_true(year, building.truth_);
    follow_habits(year, building.truth_, plan.seed);
    const auto loads = building.run_year(year, fmt::format("twin-{}", around->year));
    if (!loads) return tl::unexpected(loads.error());
    for (std::size_t meter = 0; meter < loads->size(); ++meter) {
      building.twin_[meter].insert(building.twin_[meter].end(), (*loads)[meter].begin(),
                                   (*loads)[meter].end());
    }
    building.years_.push_back(std::move(year));
  }
  return building;
}

Result<SizedModel> SimulatedBuilding::size(const EplusPlan& plan, const Engine& engine,
                                           const DesignHours& hours,
                                           const std::filesystem::path& folder) {
  const std::filesystem::path weather = folder / fmt::format("{}.epw", plan.first_year);
  if (!plan.foreign) {
    Json templated = templated_model(plan.building);
    add_design_days(templated, hours);
    auto expanded = engine.expand(templated, folder / "expand");
    if (!expanded) return tl::unexpected(expanded.error());
    use_fast_coils(*expanded);
    return engine.size(std::move(*expanded), weather, folder / "size");
  }
  auto model = read_foreign_model(plan.foreign->file);
  if (!model) return tl::unexpected(model.error());
  for (const char* theirs :
       {"Site:Location", "SizingPeriod:DesignDay", "SizingPeriod:WeatherFileDays",
        "SizingPeriod:WeatherFileConditionType"}) {
    model->erase(theirs);
  }
  add_design_days(*model, hours);
  return engine.size(altered(std::move(*model), Rng{plan.seed, kAlterations}), weather,
                     folder / "size");
}

Result<Loads> SimulatedBuilding::run_year(const BuildingYear& year, const std::string& name) const {
  const std::filesystem::path folder = folder_ / name;
  if (const auto made = system::make_folder(folder); !made) return tl::unexpected(made.error());
  const std::string csv = "schedules.csv";
  const BuildingYear::Written written = year.write(csv);
  if (const auto done = system::write_file(folder / csv, written.csv); !done) {
    return tl::unexpected(done.error());
  }
  std::vector<MeterSum> sums;
  for (const CaseMeter& meter : meters_) sums.push_back(meter.sum);
  const int of = year.around().year;
  auto loads = engine_->run(written.model, of, folder_ / fmt::format("{}.epw", of), sums, folder);
  std::error_code whatever;  // A folder that stays costs room and nothing else.
  if (loads) std::filesystem::remove_all(folder, whatever);
  return loads;
}

Result<Loads> SimulatedBuilding::with(const HiddenInBuilding& hidden) const {
  Loads loads = twin_;
  const sys_days first{std::chrono::year{plan_.first_year} / 1 / 1};
  const sys_days end{std::chrono::year{plan_.first_year + plan_.years} / 1 / 1};
  const double whole =
      hidden.change->course == Course::steadily ? static_cast<double>(plan_.years) : 1.0;
  std::size_t slot = 0;
  for (const BuildingYear& as_is : years_) {
    const int of = as_is.around().year;
    const std::size_t slots = as_is.days().size() * kQuartersPerDay;
    const bool is_before =
        hidden.from && sys_days{*hidden.from} >= sys_days{std::chrono::year{of + 1} / 1 / 1};
    if (is_before) {
      slot += slots;
      continue;
    }
    BuildingYear year = as_is;
    hidden.change->apply(year, whole * hidden.strength,
                         simulators::stream_of(plan_.seed, simulators::Stream::effects,
                                               static_cast<std::uint64_t>(of)));
    const auto changed = run_year(year, fmt::format("{}-{}", hidden.change->id, of));
    if (!changed) return tl::unexpected(changed.error());
    for (std::size_t i = 0; i < slots; ++i) {
      const metering::Day day =
          calendar_->local_time(begin_ + (slot + i) * simulators::kInterval).date;
      const double share = share_on(hidden, sys_days{day}, first, end);
      for (std::size_t meter = 0; meter < loads.size(); ++meter) {
        double& load = loads[meter][slot + i];
        load += share * ((*changed)[meter][i] - load);
      }
    }
    slot += slots;
  }
  return loads;
}

simulators::Recording SimulatedBuilding::recording_of(const Loads& loads) const {
  simulators::Recording recording;
  recording.begin = begin_;
  recording.power.resize(loads.front().size());
  for (std::size_t meter = 0; meter < meters_.size(); ++meter) {
    for (std::size_t slot = 0; slot < loads[meter].size(); ++slot) {
      recording.power[slot][meters_[meter].utility] = loads[meter][slot];
    }
  }
  return recording;
}

std::vector<simulators::MeterPlate> SimulatedBuilding::plates() const {
  simulators::Drawings as_metered;
  as_metered.cooling = simulators::CoolingPlant::packaged;
  as_metered.heating = simulators::HeatingPlant::heat_pump;
  // Meters come in sizes, and nobody chooses them by the year's true peak: else the rating would
  // tell whether readings are what they would be without an effect.
  Rng rng{plan_.seed, kMeterSizes};
  for (std::size_t meter = 0; meter < meters_.size(); ++meter) {
    const double reserve = rng.uniform(1.25, 2.4);
    const double rated_kW =
        standard_size(reserve * std::max(*std::ranges::max_element(twin_[meter]), 1.0));
    switch (meters_[meter].utility) {
      case Utility::electricity:
        as_metered.electricity_rated_kW = rated_kW;
        break;
      case Utility::cooling:
        as_metered.cooling = simulators::CoolingPlant::district;
        as_metered.cooling_rated_kW = rated_kW;
        break;
      case Utility::heat:
        as_metered.heating = meters_[meter].sum.id == "gas"
                                 ? simulators::HeatingPlant::boiler
                                 : simulators::HeatingPlant::district_water;
        as_metered.heat_rated_kW = rated_kW;
        break;
    }
  }
  return simulators::plates_of(as_metered);
}

BaseParameters SimulatedBuilding::base_truth() const {
  const BaseParameters drawn = as_drawn();
  return {drawn.occupancy_person_m2 * truth_.at("occupancy"),
          drawn.outdoor_air_m3_s * truth_.at("outdoor_air"),
          drawn.cooling_setpoint_C + truth_.at("cooling_setpoint_K")};
}

std::vector<double> SimulatedBuilding::outdoor_C() const {
  std::vector<double> outdoor_C;
  for (const WeatherHour& hour : hours_) {
    outdoor_C.insert(outdoor_C.end(), kQuartersPerDay / 24, hour.at_end.air.temperature_C);
  }
  return outdoor_C;
}

std::string SimulatedBuilding::weather_text() const { return weather_csv(hours_); }

std::string SimulatedBuilding::site_text(const std::vector<simulators::MeterPlate>& plates) const {
  const simulators::Drawings& drawings = plan_.building.drawings;
  SiteFacts facts{.id = plan_.id,
                  .title = !plan_.foreign ? fmt::format("{}, {} plan, {}", to_string(drawings.use),
                                                        to_string(plan_.building.shape),
                                                        to_string(plan_.building.system))
                                          : std::string{"A building of others"},
                  .time_zone = drawings.time_zone,
                  .place = drawings.place,
                  .first_year = plan_.first_year,
                  .years = plan_.years,
                  .holidays = {},
                  .leakage_cm2_m2 = drawings.leakage_cm2_m2,
                  .heavy = drawings.heavy};
  for (const auto& around : around_) {
    facts.holidays.insert(facts.holidays.end(), around->holidays.begin(), around->holidays.end());
  }
  return blind::site_text(facts, sized_, drawn_.front(), plates, Rng{plan_.seed, kMemory});
}

}  // namespace recald::blind
