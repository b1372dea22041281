#include <chrono>

#include "adapters/system/parallel_for.hpp"
#include "adapters/system/write_file.hpp"
#include "daemon/commands/calibration_options.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/generated_at.hpp"
#include "daemon/commands/interrupt.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/calibrate/finished_calibration.hpp"
#include "daemon/site/calibrate/meter_forecast.hpp"
#include "daemon/site/results/calibration_files.hpp"
#include "daemon/site/results/calibration_folder.hpp"
#include "daemon/site/results/result_table.hpp"

namespace recald::daemon {
namespace {

/// From the site file to the calibration; failures are printed and come back as an exit code.
tl::expected<FinishedCalibration, int> calibrate_aloud(const CalibrateArguments& arguments,
                                                       const Console& console) {
  const auto begin = std::chrono::steady_clock::now();
  auto calibration = calibration_options(arguments, console);
  if (!calibration) return tl::unexpected(calibration.error());
  calibration->design_runs = arguments.design_runs;
  const CalibrateOptions options{
      std::move(*calibration), arguments.prior_sensitivity,
      arguments.discrepancy == "seed" ? DiscrepancyForm::seed : DiscrepancyForm::sound};
  auto modelled = open_modelled_site(arguments.site, console, arguments.model);
  if (!modelled) return tl::unexpected(modelled.error());

  const InterruptGuard guard;
  ProgressLine line{console};
  const calibration::RunContext context{.seed = arguments.seed,
                                        .executor = system::parallel_for(arguments.threads),
                                        .observer = [&](const calibration::Progress& progress) {
                                          line.show(progress);
                                          return !guard.interrupted();
                                        }};
  auto done = finish_calibration(std::move(*modelled), options, context);
  if (!done) return tl::unexpected(console.fail(done.error()));
  done->modelled.facts.wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return std::move(*done);
}

/// A site without a model: there is nothing to calibrate, and still something to forecast.
int forecast_alone(OpenSite site, const CalibrateArguments& arguments, const Console& console) {
  const auto begin = std::chrono::steady_clock::now();
  auto recorded = load_modelled_site(
      std::move(site), std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now()));
  if (!recorded) return console.fail(recorded.error());
  print_data_words(recorded->recording, console);
  const auto forecast = forecast_meters(*recorded);
  if (!forecast) return console.fail(forecast.error());
  RunFacts& facts = recorded->facts;
  facts.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const std::string json = meter_forecast_json(*forecast, facts);
  if (!arguments.out.empty()) {
    const std::string months = months_csv(recorded->recording, facts.time_zone_data);
    if (auto written = write_meter_forecast(json, months, arguments.out); !written) {
      return console.fail(written.error());
    }
  }
  console.out << (arguments.json ? json : meter_forecast_table(*forecast));
  return kSuccess;
}

}  // namespace

int run_calibrate(const CalibrateArguments& arguments, const Console& console) {
  if (!arguments.design.folder.empty()) return run_calibrate_design(arguments, console);
  if (auto site = open_site(arguments.site); site && !site->config.model && site->config.weather) {
    return forecast_alone(std::move(*site), arguments, console);
  }
  const auto done = calibrate_aloud(arguments, console);
  if (!done) return done.error();
  const InterruptGuard until_written;
  const std::string json = calibration_json(done->calibration, done->modelled.facts);
  const auto folder = folder_for(done->calibration.calibration.converged, arguments);
  if (!arguments.out.empty()) {
    if (auto written = write_calibration(*done, json, generated_at(), folder); !written) {
      return console.fail(written.error());
    }
  }
  console.out << (arguments.json ? json : result_table(done->calibration));
  return gate_verdict(done->calibration.calibration.converged, arguments, folder, console);
}

int run_report(const CalibrateArguments& arguments, const Console& console) {
  const auto done = calibrate_aloud(arguments, console);
  if (!done) return done.error();
  if (auto written = system::write_file(arguments.out, render(*done, generated_at())); !written) {
    return console.fail(written.error());
  }
  if (arguments.json) {
    console.out << calibration_json(done->calibration, done->modelled.facts);
  } else {
    console.out << arguments.out.string() << "\n";
  }
  return kSuccess;
}

}  // namespace recald::daemon
