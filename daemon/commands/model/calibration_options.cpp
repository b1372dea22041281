#include "daemon/commands/model/calibration_options.hpp"

#include "adapters/system/parallel_for.hpp"
#include "core/calibration/samplers/samplers.hpp"
#include "daemon/site/config/hyper_prior_file.hpp"
#include "daemon/site/results/result_folder.hpp"
#include "daemon/site/results/result_table.hpp"

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
  options.predictive = arguments.predictive;
  const auto usable = calibration::check_sampling(options.sampling);
  if (!usable) return tl::unexpected(console.misused(usable.error().message));
  return options;
}

calibration::RunContext run_context(const SamplingArguments& arguments, const InterruptGuard& guard,
                                    ProgressLine& line) {
  return {.seed = arguments.seed,
          .executor = system::parallel_for(arguments.threads),
          .observer = [&guard, &line](const calibration::Progress& progress) {
            line.show(progress);
            return !guard.interrupted();
          }};
}

int deliver(const assessment::AssessedCalibration& result, const std::string& json,
            const CalibrateArguments& arguments, const Console& console,
            const std::function<Result<void>(const std::filesystem::path&)>& write) {
  const bool sound = is_sound(result);
  const std::filesystem::path folder =
      arguments.out.empty() ? arguments.out
                            : result_folder(arguments.out, sound, arguments.iterations.has_value());
  if (!folder.empty()) {
    if (auto written = write(folder); !written) return console.fail(written.error());
  }
  console.out << (arguments.json ? json : result_table(result));
  if (sound) return kSuccess;
  if (folder != arguments.out) return console.fail(kept_sentence(folder));
  if (arguments.iterations) return kSuccess;
  return console.fail("the chains have not converged; do not rely on these figures");
}

}  // namespace recald::daemon
