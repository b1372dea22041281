/// One EnergyPlus building through its years, with and without something hidden.
#pragma once

#include <memory>
#include <optional>

#include "simulators/energyplus/changes/hidden_change.hpp"
#include "simulators/energyplus/true_building.hpp"
#include "tests/blind/energyplus/building_draw.hpp"
#include "tests/blind/energyplus/foreign_building.hpp"
#include "tests/blind/energyplus/site_text.hpp"

namespace recald::blind {

struct EplusPlan {
  std::string id;
  std::uint64_t seed;  ///< Of the truth, the weather, the people and the meters.
  simulators::energyplus::TemplatedBuilding building;
  /// Of others: this one is simulated, and of `building` only the place counts.
  std::optional<ForeignModel> foreign = {};
  int first_year;
  int years;
};

/// kW by meter, then quarter hour, over all years.
using Loads = std::vector<std::vector<double>>;

struct HiddenInBuilding {
  const simulators::energyplus::HiddenChange* change;
  double strength;
  std::optional<metering::Day> from;  ///< Absent: it has always been there.
  std::optional<metering::Day> to;    ///< Of one that goes away: the last day in full.
};

class SimulatedBuilding {
 public:
  /// Draws the weather, makes the model, has it sized, and runs it as it is.
  /// @param folder  For EnergyPlus's files; the caller removes it.
  /// @return what EnergyPlus refuses, or not_found if the system has no zone files.
  [[nodiscard]] static Result<SimulatedBuilding> make(const EplusPlan& plan, const Engine& engine,
                                                      const std::filesystem::path& folder);

  [[nodiscard]] const std::vector<CaseMeter>& meters() const { return meters_; }
  [[nodiscard]] const Loads& twin() const { return twin_; }
  [[nodiscard]] const simulators::energyplus::TrueParameters& truth() const { return truth_; }
  /// Of the building as it is, and by its drawings.
  [[nodiscard]] BaseParameters base_truth() const;
  [[nodiscard]] BaseParameters as_drawn() const { return blind::as_drawn(sized_, drawn_.front()); }
  [[nodiscard]] bool could_have(const simulators::energyplus::HiddenChange& change) const {
    return change.possible(years_.front());
  }
  /// The loads with it.
  [[nodiscard]] Result<Loads> with(const HiddenInBuilding& hidden) const;

  /// As the feed's meters take them.
  [[nodiscard]] simulators::Recording recording_of(const Loads& loads) const;
  [[nodiscard]] const metering::LocalCalendar& calendar() const { return *calendar_; }
  /// Of each quarter hour.
  [[nodiscard]] std::vector<double> outdoor_C() const;
  [[nodiscard]] std::string weather_text() const;
  [[nodiscard]] std::string site_text(const std::vector<simulators::MeterPlate>& plates) const;
  [[nodiscard]] std::vector<simulators::MeterPlate> plates() const;

 private:
  SimulatedBuilding() = default;
  [[nodiscard]] static Result<SizedModel> size(const EplusPlan& plan, const Engine& engine,
                                               const simulators::energyplus::DesignHours& hours,
                                               const std::filesystem::path& folder);
  [[nodiscard]] Result<Loads> run_year(const simulators::energyplus::BuildingYear& year,
                                       const std::string& name) const;

  EplusPlan plan_;
  const Engine* engine_ = nullptr;
  std::filesystem::path folder_;
  std::unique_ptr<metering::LocalCalendar> calendar_;
  metering::Instant begin_;  ///< Of the first year, in standard time.
  std::vector<simulators::energyplus::WeatherHour> hours_;
  SizedModel sized_;
  std::vector<CaseMeter> meters_;
  simulators::energyplus::TrueParameters truth_;
  /// Each year's surroundings, which `years_` refer to.
  std::vector<std::unique_ptr<simulators::energyplus::YearAround>> around_;
  std::vector<simulators::energyplus::BuildingYear> years_;  ///< As the building is.
  std::vector<simulators::energyplus::BuildingYear> drawn_;  ///< The first, by its drawings.
  Loads twin_;
};

}  // namespace recald::blind
