#include <fmt/format.h>

#include <chrono>

#include "adapters/system/write_file.hpp"
#include "daemon/commands/calibration_options.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/generated_at.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/calibrate/finished_calibration.hpp"
#include "daemon/site/results/calibration_files.hpp"
#include "daemon/site/results/calibration_folder.hpp"
#include "daemon/site/results/meters_report.hpp"

namespace recald::daemon {
namespace {

/// A site without a model still has forecasts, where it has a temperature.
tl::expected<ModelledSite, int> open_for_calibration(const CalibrateArguments& arguments,
                                                     const Console& console) {
  auto site = open_site(arguments.site);
  if (!site || site->config.model || !site->config.weather) {
    return open_modelled_site(arguments.site, console, arguments.model);
  }
  if (arguments.model || arguments.prior_sensitivity || arguments.predictive ||
      arguments.discrepancy != "sound") {
    return tl::unexpected(console.fail(fmt::format(
        "{} has no [[model]], so --model, --discrepancy, --predictive and --prior-sensitivity have "
        "nothing to act on; leave them out",
        arguments.site.filename().string())));
  }
  return load_aloud(std::move(*site), console);
}

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
  auto modelled = open_for_calibration(arguments, console);
  if (!modelled) return tl::unexpected(modelled.error());

  const InterruptGuard guard;
  ProgressLine line{console};
  auto done =
      finish_calibration(std::move(*modelled), options, run_context(arguments, guard, line));
  if (!done) return tl::unexpected(console.fail(done.error()));
  done->modelled.facts.wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return std::move(*done);
}

/// A site without a model and without weather: what its meters tell by themselves.
int report_meters(const OpenSite& site, const CalibrateArguments& arguments,
                  const Console& console) {
  VirtualClock clock{metering::Instant{}};
  const auto recording = record_site(site, {}, clock, {});
  if (!recording) return console.fail(recording.error());
  print_data_words(*recording, console);
  const auto page = render_meters_of(site, *recording, generated_at());
  if (!page) return console.fail(page.error());
  if (auto written = system::write_file(arguments.out, *page); !written) {
    return console.fail(written.error());
  }
  if (!arguments.json) console.out << arguments.out.string() << "\n";
  return kSuccess;
}

}  // namespace

int run_calibrate(const CalibrateArguments& arguments, const Console& console) {
  if (!arguments.design.folder.empty()) return run_calibrate_design(arguments, console);
  const auto done = calibrate_aloud(arguments, console);
  if (!done) return done.error();
  const InterruptGuard until_written;
  const std::string json = calibration_json(done->calibration, done->modelled.facts);
  return deliver(done->calibration, json, arguments, console,
                 [&](const std::filesystem::path& folder) {
                   return write_calibration(*done, json, generated_at(), folder);
                 });
}

int run_report(const CalibrateArguments& arguments, const Console& console) {
  if (auto site = open_site(arguments.site); site && !site->config.model && !site->config.weather) {
    return report_meters(*site, arguments, console);
  }
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
