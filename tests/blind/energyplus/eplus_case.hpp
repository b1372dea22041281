/// Cases of EnergyPlus buildings: something hidden that moves a meter by a wanted share, or
/// nothing.
#pragma once

#include "tests/blind/energyplus/simulated_building.hpp"
#include "tests/blind/population/make_case.hpp"

namespace recald::blind {

struct EplusCasePlan {
  EplusPlan building;
  Family family;
  Block block;
  simulators::MeterCare care;
  ShareBin wanted;  ///< Where something is hidden.
  /// The first that can move a meter so much is hidden.
  std::vector<std::string> candidates;
  bool begins_in_forecast_year = false;
};

/// The same name and seed give the same plans.
[[nodiscard]] std::vector<EplusCasePlan> plan_eplus(const PopulationKind& population,
                                                    std::uint64_t seed);

/// Simulates the building, finds the strength, writes case and answer.
/// @param scratch  For EnergyPlus's files; empty afterwards.
/// @return how many years EnergyPlus simulated, or what it refused, or io_failed.
[[nodiscard]] Result<int> make_eplus_case(const EplusCasePlan& plan, const Engine& engine,
                                          const std::filesystem::path& scratch,
                                          const CaseFolders& folders);

}  // namespace recald::blind
