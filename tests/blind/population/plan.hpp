/// What stands in each case of our own world, before any strength is known.
#pragma once

#include <string>
#include <vector>

#include "simulators/scenario/scenario.hpp"
#include "tests/blind/population/block.hpp"
#include "tests/blind/population/population_kind.hpp"

namespace recald::blind {

/// One effect that a case wants: the first of `candidates` that can move so much is taken, the
/// others stand by.
struct Wanted {
  std::vector<simulators::HiddenChoice> candidates;  ///< Strengths are limits: the sign is drawn.
  ShareBin share;                                    ///< That it shall move, alone.
};

struct CasePlan {
  std::string id;  ///< "sealed-017"
  Block block;
  std::uint64_t seed;                ///< Decides truth, weather, people and noise.
  simulators::Scenario scenario;     ///< Nothing hidden yet.
  simulators::Drawings as_believed;  ///< What the site file says: the drawings, in part mistaken.
  std::vector<Wanted> wanted;
};

/// The same kind and seed give the same plans; case i does not depend on how many follow.
[[nodiscard]] std::vector<CasePlan> plan_population(const PopulationKind& kind, std::uint64_t seed);

/// The uses of these names, in the simulator's order, each once.
/// @return not_found with the names there are; not_enough_data where none is given.
[[nodiscard]] Result<std::vector<simulators::Use>> uses_named(
    const std::vector<std::string>& names);

/// Buildings that hide nothing, of the uses in turn, three years each under meters with usual care:
/// models are compared, and the sizes of their own errors learnt, on these. What one set of uses
/// draws, another never does, whatever the seeds; case i does not depend on how many follow.
/// @pre uses as `uses_named` gives them
[[nodiscard]] std::vector<CasePlan> plan_plain(const std::vector<simulators::Use>& uses,
                                               std::size_t count, std::uint64_t seed);

}  // namespace recald::blind
