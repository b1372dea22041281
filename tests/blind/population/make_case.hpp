/// Turns a plan into a case: finds the strengths, runs building and twin, writes files.
#pragma once

#include <filesystem>

#include "simulators/scenario/twin.hpp"
#include "tests/blind/population/plan.hpp"

namespace recald::blind {

/// One effect as it came out.
struct HiddenAtStrength {
  simulators::HiddenChoice choice;
  std::vector<double> share_of_meter;  ///< Signed, in the order of `plates_of`.
  std::vector<double> moved_share;     ///< By months and parts of the day; likewise.
};

struct SettledCase {
  simulators::Scenario scenario;  ///< With the effects at their strengths.
  std::vector<HiddenAtStrength> effects;
  std::vector<std::string>
      refused;  ///< Effects drawn before that have no strength as asked; see `settle`.
  int simulations = 0;
};

/// Finds for each wanted effect a strength at which it moves as much as asked; or a stand-in that
/// does.
/// @return not_found if the system has no zone files; not_enough_data where no stand-in does.
[[nodiscard]] Result<SettledCase> settle(const CasePlan& plan);

struct CaseFolders {
  std::filesystem::path cases;    ///< Gets `<id>/` with readings.csv, weather.csv, site.toml.
  std::filesystem::path answers;  ///< Gets `<id>.json`, last: a case with an answer is whole.
  /// Gets `<id>/` with the twin's files and footprint.csv, where not empty.
  std::filesystem::path twins;
};

/// Writes what a user would have, and the answer apart. @return io_failed, not_found.
[[nodiscard]] Result<void> write_case(const CasePlan& plan, const SettledCase& settled,
                                      const CaseFolders& folders);

}  // namespace recald::blind
