/// A building that differs from its drawings in what a calibration looks for, and a little in what
/// it does not.
#pragma once

#include "simulators/energyplus/laboratory.hpp"
#include "simulators/energyplus/small_office.hpp"

namespace recald::simulators::energyplus {

template <class Parameters>
struct HiddenTruth {
  Parameters parameters;
  /// For scoring: of each quantity its value by the drawings, the true one, and what turns the one
  /// into the other in the model's file.
  Json description;
};

/// Drawn from the seed.
[[nodiscard]] HiddenTruth<LaboratoryParameters> laboratory_truth(std::uint64_t seed);
[[nodiscard]] HiddenTruth<SmallOfficeParameters> small_office_truth(std::uint64_t seed);

}  // namespace recald::simulators::energyplus
