#include "daemon/commands/calibration_options.hpp"

#include "core/calibration/samplers.hpp"
#include "daemon/site/config/hyper_prior_file.hpp"
#include "daemon/site/results/result_folder.hpp"

namespace recald::daemon {

tl::expected<calibration::CalibrationOptions, int> calibration_options(
    const SamplingArguments& arguments, const Console& console) {
  auto hyper_prior = choose_hyper_prior(arguments.hyper_prior);
  if (!hyper_prior) {
    console.fail(hyper_prior.error());
    return tl::unexpected(arguments.hyper_prior.ends_with(".toml") ? kFailure : kUsage);
  }
  calibration::CalibrationOptions options;
  options.hyper_prior = std::move(*hyper_prior);
  if (arguments.sampler != "auto") {
    const auto sampler = calibration::find_sampler(arguments.sampler);
    if (!sampler) return tl::unexpected(console.misused(sampler.error().message));
    options.sampling.sampler = *sampler;
  }
  options.sampling.iterations = arguments.iterations;
  options.sampling.burn_in = arguments.burn_in;
  options.sampling.chains = arguments.chains;
  const auto usable = calibration::check_sampling(options.sampling);
  if (!usable) return tl::unexpected(console.misused(usable.error().message));
  return options;
}

std::filesystem::path folder_for(bool converged, const CalibrateArguments& arguments) {
  if (arguments.out.empty()) return {};
  return result_folder(arguments.out, converged, arguments.iterations.has_value());
}

int gate_verdict(bool converged, const CalibrateArguments& arguments,
                 const std::filesystem::path& folder, const Console& console) {
  if (converged) return kSuccess;
  if (folder != arguments.out) return console.fail(kept_sentence(folder));
  if (arguments.iterations) return kSuccess;
  return console.fail("the chains have not converged; do not rely on these figures");
}

}  // namespace recald::daemon
