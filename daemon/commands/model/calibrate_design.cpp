#include <fmt/format.h>

#include <chrono>

#include "daemon/commands/commands.hpp"
#include "daemon/commands/generated_at.hpp"
#include "daemon/commands/model/calibration_options.hpp"
#include "daemon/commands/model/design_input.hpp"
#include "daemon/site/calibrate/finished_calibration.hpp"
#include "daemon/site/results/calibration_files.hpp"
#include "daemon/site/results/calibration_folder.hpp"

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

/// "campus_lab" of "designs/campus_lab/".
std::string folder_name(const std::filesystem::path& folder) {
  std::error_code ignored;
  return std::filesystem::weakly_canonical(folder, ignored).filename().string();
}

}  // namespace

int run_calibrate_design(const CalibrateArguments& arguments, const Console& console) {
  const auto begin = std::chrono::steady_clock::now();
  auto calibration = calibration_options(arguments, console);
  if (!calibration) return calibration.error();
  auto design = open_design_folder(arguments.design, console);
  if (!design) return design.error();
  const auto measured = doe::read_measurements(measurements_file(arguments), *design);
  if (!measured) return console.fail(measured.error());
  const auto origin = check_origin(*design);
  if (!origin) return console.fail(origin.error());
  auto facts = design_facts(arguments, *design);
  if (!facts) return console.fail(facts.error());
  FinishedDesign begun{.name = folder_name(arguments.design.folder),
                       .design = std::move(*design),
                       .calibration = {},
                       .facts = std::move(*facts)};

  const InterruptGuard guard;
  auto done = [&] {
    ProgressLine line{console};
    return finish_calibration(std::move(begun), *origin, *measured,
                              design_options(arguments, std::move(*calibration)),
                              run_context(arguments, guard, line));
  }();
  if (!done) return console.fail(done.error());
  done->facts.wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  const std::string json = calibration_json(done->calibration, done->facts);
  return deliver(done->calibration, json, arguments, console,
                 [&](const std::filesystem::path& folder) {
                   return write_calibration(*done, months_csv(done->calibration), json,
                                            generated_at(), folder);
                 });
}

}  // namespace recald::daemon
