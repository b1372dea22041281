/// Which populations there are, in either world.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "simulators/building/drawings.hpp"

namespace recald::blind {

/// Buildings to learn from and buildings to judge with share no use, and in the world of EnergyPlus
/// no floor plan and no air system. A test holds that they have nothing in common.
enum class Family { learning, judging };

[[nodiscard]] std::string_view to_string(Family family);
[[nodiscard]] std::span<const simulators::Use> uses_of(Family family);

/// Shares of the meter that is moved most.
struct ShareBin {
  double least;
  double most;

  [[nodiscard]] bool holds(double share) const { return share >= least && share < most; }
};

/// So many single effects of this size.
struct Singles {
  ShareBin share;
  int count;
};

struct PopulationKind {
  std::string name;
  Family family;
  int no_effect;
  std::vector<Singles> singles;
  int out_of_catalogue;
  int pairs;
  int years;
};

/// "smoke", "development" and "learning" of the learning family, "sealed" of the judging one.
/// @param world  "own" or "energyplus", where a year costs more. @return not_found with the names.
[[nodiscard]] Result<PopulationKind> population_kind(std::string_view world, std::string_view name);

inline constexpr ShareBin kBelow3{0.005, 0.03};
inline constexpr ShareBin kFrom3To10{0.03, 0.1};
inline constexpr ShareBin kAbove10{0.1, 0.5};
/// Of pairs and of what no catalogue contains.
inline constexpr ShareBin kAbove3{0.03, 0.5};

/// A seed that no population of another name shares.
[[nodiscard]] std::uint64_t own_seed(std::string_view population, std::uint64_t seed);

}  // namespace recald::blind
