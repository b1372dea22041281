/// d* of what an effect adds, measured at its twin by the project's own model.
///
/// A thermostat that once switched some minutes later switches on at other minutes for days: the
/// difference of two runs holds such jitter even where the effect is a millionth of itself. Energy
/// merely changes places, yet against four-hour noise it may have a d* of 10, and no model can tell
/// it from any other jitter. Two footprints s_1, s_2 of one effect, at the building and at one that
/// nearly is that building, share what the effect does and not the jitter, so s_1' M s_2 estimates
/// d*^2 without it.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "core/diagnosis/detectability.hpp"
#include "simulators/scenario/twin.hpp"

namespace recald::blind {

class TwinGauge {
 public:
  /// Opens the twin as a user's site would be opened, and calibrates the base model to it.
  /// @param site_file  With the twin's readings and weather beside it.
  /// @return what the site's files or the calibration refuse.
  [[nodiscard]] static Result<TwinGauge> open(const std::filesystem::path& site_file);

  /// @param footprint_kW  By plate, then interval of `recording`.
  [[nodiscard]] Result<diagnosis::Detectability> measure(
      const std::vector<std::vector<double>>& footprint_kW,
      const std::vector<simulators::MeterPlate>& plates,
      const simulators::Recording& recording) const;

  /// d* of what two footprints of one effect have in common; 0 where they contradict each other.
  [[nodiscard]] Result<double> repeatable(const std::vector<std::vector<double>>& one_kW,
                                          const std::vector<std::vector<double>>& other_kW,
                                          const std::vector<simulators::MeterPlate>& plates,
                                          const simulators::Recording& recording) const;

 private:
  /// (hours x m) kW
  [[nodiscard]] Eigen::ArrayXXd hours_kW(const std::vector<std::vector<double>>& footprint_kW,
                                         const std::vector<simulators::MeterPlate>& plates,
                                         const simulators::Recording& recording) const;

  TwinGauge(std::unique_ptr<diagnosis::SiteProblem> twin, diagnosis::FootprintGauge gauge)
      : twin_(std::move(twin)), gauge_(std::move(gauge)) {}

  std::unique_ptr<diagnosis::SiteProblem> twin_;  ///< Stays where the gauge saw it.
  diagnosis::FootprintGauge gauge_;
};

}  // namespace recald::blind
