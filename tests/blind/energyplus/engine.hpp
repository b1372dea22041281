/// EnergyPlus as the judge runs it. It shares nothing with the product's own adapter: what both
/// misread alike would be seen by nobody.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/result.hpp"
#include "simulators/energyplus/parts/building_parts.hpp"
#include "simulators/energyplus/parts/schedule_year.hpp"

namespace recald::blind {

using simulators::energyplus::Json;

/// A table of EnergyPlus's own reports: row -> column -> what stands there.
using Table = std::map<std::string, std::map<std::string, std::string>>;

/// What EnergyPlus said of a model after sizing it.
struct SizedModel {
  Json model;  ///< With the sizes that were found.
  std::map<std::string, Table> tables;
  std::filesystem::path schedules;  ///< `eplusout.eio`, with every schedule.
};

/// Names of what a meter is made of; a minus subtracts.
struct MeterSum {
  std::string id;
  std::vector<std::string> reported;
};

class Engine {
 public:
  /// RECALD_ENERGYPLUS names the program. @return not_found
  [[nodiscard]] static Result<Engine> find();

  /// A model of templates as a model of objects. @return invalid_value: EnergyPlus refused it.
  [[nodiscard]] Result<Json> expand(const Json& templated,
                                    const std::filesystem::path& folder) const;
  /// @param model  With design days. @return invalid_value: EnergyPlus refused it.
  [[nodiscard]] Result<SizedModel> size(Json model, const std::filesystem::path& weather,
                                        const std::filesystem::path& folder) const;
  /// One calendar year: kW by quarter hour of standard time for each meter.
  /// @param model  Written into the folder, beside the files that it names.
  /// @return invalid_value: EnergyPlus refused it; malformed: an interval is missing.
  [[nodiscard]] Result<std::vector<std::vector<double>>> run(
      Json model, int year, const std::filesystem::path& weather,
      const std::vector<MeterSum>& meters, const std::filesystem::path& folder) const;

 private:
  explicit Engine(std::filesystem::path payload) : payload_(std::move(payload)) {}
  [[nodiscard]] Result<void> simulate(const Json& model, const std::filesystem::path& weather,
                                      const std::vector<std::string>& options,
                                      const std::filesystem::path& folder) const;

  std::filesystem::path payload_;  ///< The folder of the program and what lies beside it.
};

/// The sizes of `ComponentSizes` in the place of "Autosize", by the words that field and
/// description have in common. Cooling towers keep theirs open.
[[nodiscard]] Result<Json> with_sizes(Json model, const std::filesystem::path& sql);

}  // namespace recald::blind
