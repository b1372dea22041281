#include "core/calibration/samplers/sampler.hpp"

#include <cassert>
#include <string>

namespace recald::calibration {

Result<double> Target::log_density_and_gradient(const Eigen::VectorXd& /*point*/,
                                                Eigen::VectorXd& /*gradient*/) {
  assert(!has_gradient() && "a target that claims to have a gradient must compute it");
  return failure(
      ErrorCode::unsupported,
      "this density has no gradient; choose a sampler that does not need one (dram, smc)");
}

Result<void> check_options(const SamplerOptions& options) {
  if (0 < options.burn_in && options.burn_in < options.iterations) return {};
  const bool continues = options.begin_at.has_value();
  if (options.burn_in == 0 && options.iterations > 0 && continues) return {};
  return failure(ErrorCode::invalid_value,
                 "a sampler needs 0 < burn-in < iterations, but burn-in is " +
                     std::to_string(options.burn_in) + " of " + std::to_string(options.iterations) +
                     " iterations" + (continues ? "" : " and there is no chain to continue"));
}

}  // namespace recald::calibration
