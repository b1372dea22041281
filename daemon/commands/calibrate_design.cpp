#include <fmt/format.h>

#include <chrono>

#include "adapters/system/parallel_for.hpp"
#include "daemon/commands/calibration_options.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/design_input.hpp"
#include "daemon/commands/interrupt.hpp"
#include "daemon/site/calibrate/design_calibration.hpp"
#include "daemon/site/calibrate/design_site.hpp"
#include "daemon/site/results/calibration_files.hpp"
#include "daemon/site/results/design_files.hpp"
#include "daemon/site/results/result_folder.hpp"
#include "daemon/site/results/result_table.hpp"

namespace recald::daemon {
namespace {

std::filesystem::path measurements_file(const CalibrateArguments& arguments) {
  if (!arguments.measurements.empty()) return arguments.measurements;
  return arguments.design.folder / "measurements.csv";
}

Result<RunFacts> design_facts(const CalibrateArguments& arguments,
                              const doe::DesignFolder& design) {
  std::vector<std::filesystem::path> files = design.files;
  files.push_back(measurements_file(arguments));
  if (!arguments.metamodel.empty()) files.push_back(arguments.metamodel);
  return facts_of_files(files, name_of(ModelKind::metamodel));
}

DesignCalibrationOptions design_options(const CalibrateArguments& arguments,
                                        calibration::CalibrationOptions calibration) {
  DesignCalibrationOptions options;
  options.metamodel = metamodel_options(arguments.design, arguments.seed);
  options.given_metamodel = arguments.metamodel;
  if (!arguments.parameters.empty()) options.parameters = arguments.parameters;
  options.calibration = std::move(calibration);
  options.prior_sensitivity = arguments.prior_sensitivity;
  return options;
}

Result<void> write_all(const DesignCalibration& result, const doe::DesignFolder& design,
                       const RunFacts& facts, const std::string& json,
                       const std::filesystem::path& folder) {
  clear_results(folder);
  for (std::size_t chain = 0; chain < result.calibration.chains.size(); ++chain) {
    const std::string name = fmt::format("draws_{}.csv", chain + 1);
    auto written = write_result(folder, name.c_str(), draws_csv(result, chain, facts));
    if (!written) return written;
  }
  if (result.screening) {
    auto written =
        write_result(folder, "screen.json",
                     screen_json(*result.screening, design.parameters, design.notes, facts));
    if (!written) return written;
  }
  if (result.fitted) {
    auto written = write_result(folder, "metamodel.json",
                                metamodel_json(*result.fitted, result.fitted->notes, facts));
    if (!written) return written;
  }
  // Last: who finds calibration.json finds everything it speaks of.
  return write_result(folder, "calibration.json", json);
}

}  // namespace

int run_calibrate_design(const CalibrateArguments& arguments, const Console& console) {
  const auto begin = std::chrono::steady_clock::now();
  auto calibration = calibration_options(arguments, console);
  if (!calibration) return calibration.error();
  const auto design = open_design_folder(arguments.design, console);
  if (!design) return design.error();
  const auto measured = doe::read_measurements(measurements_file(arguments), *design);
  if (!measured) return console.fail(measured.error());
  const auto design_site = check_design_site(*design);
  if (!design_site) return console.fail(design_site.error());
  auto facts = design_facts(arguments, *design);
  if (!facts) return console.fail(facts.error());
  DesignCalibrationOptions options = design_options(arguments, std::move(*calibration));
  options.held = design_site->held;

  const InterruptGuard guard;
  auto calibrated = [&] {
    ProgressLine line{console};
    const calibration::RunContext context{.seed = arguments.seed,
                                          .executor = system::parallel_for(arguments.threads),
                                          .observer = [&](const calibration::Progress& progress) {
                                            line.show(progress);
                                            return !guard.interrupted();
                                          }};
    return calibrate_design(*design, *measured, options, context);
  }();
  if (!calibrated) return console.fail(calibrated.error());
  calibrated->warnings.insert(calibrated->warnings.end(), design_site->notes.begin(),
                              design_site->notes.end());
  RunFacts complete = with_sampling(std::move(*facts), arguments.seed, calibrated->calibration);
  complete.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  const std::string json = calibration_json(*calibrated, complete);
  const auto folder = folder_for(calibrated->calibration.converged, arguments);
  if (!arguments.out.empty()) {
    auto written = write_all(*calibrated, *design, complete, json, folder);
    if (!written) return console.fail(written.error());
  }
  console.out << (arguments.json ? json : result_table(*calibrated));
  return gate_verdict(calibrated->calibration.converged, arguments, folder, console);
}

}  // namespace recald::daemon
