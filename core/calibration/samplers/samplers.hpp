/// The samplers by name.
#pragma once

#include <span>
#include <string_view>

#include "core/calibration/samplers/sampler.hpp"

namespace recald::calibration {

struct Sampler {
  std::string_view name;
  bool uses_gradient;       ///< Needs `Target::has_gradient`.
  bool is_population;       ///< Draws are particles; `iterations` counts them, no burn-in.
  SamplerOptions defaults;  ///< For one chain of four.
  SampleFunction run;
};

/// nuts, dram, smc, seed_rwm.
[[nodiscard]] std::span<const Sampler> samplers();

/// @return the sampler, or not_found with the available names and the nearest one.
[[nodiscard]] Result<const Sampler*> find_sampler(std::string_view name);

}  // namespace recald::calibration
