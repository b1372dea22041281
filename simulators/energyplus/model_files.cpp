#include "simulators/energyplus/model_files.hpp"

#include <fmt/format.h>

#include "simulators/building/drawings.hpp"
#include "simulators/energyplus/hidden_truth.hpp"
#include "simulators/energyplus/run_readings.hpp"
#include "simulators/energyplus/weather_files.hpp"
#include "simulators/feed/write_file.hpp"

namespace recald::simulators::energyplus {
namespace {

/// A kind of building, with what its seed hides.
struct Building {
  Use use;
  Json model;
  Json truth;
  Json description;
  std::vector<PeopleSchedule> schedules;
};

Result<Building> building_of(const std::string& kind, std::uint64_t seed) {
  if (kind == "laboratory") {
    auto truth = laboratory_truth(seed);
    return Building{Use::laboratory, laboratory_model({}), laboratory_model(truth.parameters),
                    std::move(truth.description), laboratory_schedules()};
  }
  if (kind == "small_office") {
    auto truth = small_office_truth(seed);
    return Building{Use::office, small_office_model({}), small_office_model(truth.parameters),
                    std::move(truth.description), small_office_schedules()};
  }
  return failure(
      ErrorCode::invalid_value,
      fmt::format("there is no kind of building '{}'; choose laboratory or small_office", kind));
}

/// For one calendar year, and telling what the building's meters are made of.
Json reporting(Json model, int year) {
  for (auto& [name, period] : model["RunPeriod"].items()) {
    period["begin_year"] = year;
    period["end_year"] = year;
  }
  Json meters = Json::object();
  for (const RunMeter& meter : district_meters()) {
    meters[meter.id] = {{"key_name", meter.reported}, {"reporting_frequency", "Timestep"}};
  }
  model["Output:Meter"] = std::move(meters);
  model["Output:SQLite"] = {{"Results", {{"option_type", "Simple"}}}};
  return model;
}

/// Writes until a file fails.
class Folder {
 public:
  explicit Folder(const std::filesystem::path& folder)
      : folder_(folder), so_far_(make_folder(folder)) {}
  void write(const std::string& name, const std::string& text) {
    if (so_far_) so_far_ = write_file(folder_ / name, text);
  }
  [[nodiscard]] Result<void> so_far() const { return so_far_; }

 private:
  std::filesystem::path folder_;
  Result<void> so_far_;
};

}  // namespace

Result<void> write_model_files(const ModelFileOptions& options) {
  const auto building = TRY(building_of(options.kind, options.seed));
  const auto local = TRY(metering::LocalCalendar::open(kTimeZone));
  Folder out(options.out);
  out.write("model.epJSON", building.model.dump(1));
  if (options.with_truth) {
    out.write("truth.epJSON", building.truth.dump(1));
    out.write("truth.json", building.description.dump(1));
  }
  if (options.years == 0) return out.so_far();

  const Calendar calendar(building.use);
  const Place place = Drawings{}.place;
  const auto hours = simulate_hours(hot_humid_climate(place), options.first_year, options.years,
                                    options.seed, local);
  out.write("weather.csv", weather_csv(hours));
  for (int year = options.first_year; year < options.first_year + options.years; ++year) {
    out.write(fmt::format("{}.epw", year),
              epw_text(hours, year, place, local, calendar.holidays_of(std::chrono::year{year})));
    if (!options.with_truth) continue;
    const std::string csv = fmt::format("habits-{}.csv", year);
    const Habits habits =
        with_habits(building.truth, building.schedules, year, calendar, options.seed, csv);
    out.write(csv, habits.csv);
    out.write(fmt::format("truth-{}.epJSON", year), reporting(habits.model, year).dump(1));
  }
  return out.so_far();
}

}  // namespace recald::simulators::energyplus
