#include "core/calibration/sampler.hpp"

#include <string>

namespace recald::calibration {

Result<void> check_options(const SamplerOptions& options) {
  if (0 < options.burn_in && options.burn_in < options.iterations) return {};
  return failure(ErrorCode::invalid_value,
                 "a sampler needs 0 < burn-in < iterations, but burn-in is " +
                     std::to_string(options.burn_in) + " of " + std::to_string(options.iterations) +
                     " iterations");
}

}  // namespace recald::calibration
