#include <fmt/format.h>

#include <chrono>
#include <cstdlib>

#include "adapters/report/report.hpp"
#include "adapters/system/parallel_for.hpp"
#include "adapters/system/write_file.hpp"
#include "daemon/calibrate/active_effects.hpp"
#include "daemon/calibrate/site_calibration.hpp"
#include "daemon/commands/calibration_options.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/interrupt.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/results/calibration_files.hpp"
#include "daemon/results/report_of.hpp"
#include "daemon/results/result_folder.hpp"
#include "daemon/results/result_table.hpp"
#include "daemon/results/run_facts.hpp"

namespace recald::daemon {
namespace {

/// Everything that one calibration leaves behind.
struct Finished {
  OpenSite site;
  Recording recording;
  SiteCalibration calibration;
  RunFacts facts;
};

/// From the site file to the calibration; failures are printed and come back as an exit code.
tl::expected<Finished, int> finish_calibration(const CalibrateArguments& arguments,
                                               const Console& console) {
  const auto begin = std::chrono::steady_clock::now();
  auto calibration = calibration_options(arguments, console);
  if (!calibration) return tl::unexpected(calibration.error());
  calibration->design_runs = arguments.design_runs;
  const CalibrateOptions options{std::move(*calibration), arguments.prior_sensitivity};
  auto modelled = open_modelled_site(arguments.site, console, arguments.model);
  if (!modelled) return tl::unexpected(modelled.error());
  auto& [site, recording, weather, facts] = *modelled;
  auto version = active_version(site.config);
  if (!version) return tl::unexpected(console.fail(version.error()));
  facts.model_version = version_name(*version, facts.model_version);

  const InterruptGuard guard;
  ProgressLine line{console};
  const calibration::RunContext context{.seed = arguments.seed,
                                        .executor = system::parallel_for(arguments.threads),
                                        .observer = [&](const calibration::Progress& progress) {
                                          line.show(progress);
                                          return !guard.interrupted();
                                        }};
  auto calibrated = calibrate_site(site.config, site.calendar, recording, weather, options, context,
                                   std::move(version->effects));
  if (!calibrated) return tl::unexpected(console.fail(calibrated.error()));
  RunFacts complete = with_sampling(std::move(facts), arguments, calibrated->calibration);
  complete.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return Finished{std::move(site), std::move(recording), std::move(*calibrated),
                  std::move(complete)};
}

/// The wall clock is read here and nowhere deeper. SOURCE_DATE_EPOCH makes the page repeatable.
std::string generated_at() {
  if (const char* fixed = std::getenv("SOURCE_DATE_EPOCH")) {
    return metering::to_string(metering::Instant{std::chrono::seconds{std::atoll(fixed)}});
  }
  return metering::to_string(
      std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now()));
}

std::string render(const Finished& done) {
  return report::render_report(report_of(done.site.config, done.site.calendar, done.recording,
                                         done.calibration, done.facts, generated_at()));
}

Result<void> write_all(const Finished& done, const std::string& json,
                       const std::filesystem::path& folder) {
  if (auto made = system::make_folder(folder); !made) return made;
  clear_results(folder);
  for (std::size_t chain = 0; chain < done.calibration.calibration.chains.size(); ++chain) {
    const auto file = folder / fmt::format("draws_{}.csv", chain + 1);
    auto written = system::write_file(file, draws_csv(done.calibration, chain, done.facts));
    if (!written) return written;
  }
  const auto write = [&](const char* name, const std::string& text) {
    return system::write_file(folder / name, text);
  };
  if (auto w = write("months.csv", months_csv(done.recording, done.facts.time_zone_data)); !w)
    return w;
  if (auto w = write("profile.json", profile_json(done.calibration.profile)); !w) return w;
  if (auto w = write("report.html", render(done)); !w) return w;
  // Last: who finds calibration.json finds everything it speaks of.
  return write("calibration.json", json);
}

}  // namespace

int run_calibrate(const CalibrateArguments& arguments, const Console& console) {
  if (!arguments.design.folder.empty()) return run_calibrate_design(arguments, console);
  const auto done = finish_calibration(arguments, console);
  if (!done) return done.error();
  const std::string json = calibration_json(done->calibration, done->facts);
  const auto folder = folder_for(done->calibration.calibration.converged, arguments);
  if (!arguments.out.empty()) {
    if (auto written = write_all(*done, json, folder); !written) {
      return console.fail(written.error());
    }
  }
  console.out << (arguments.json ? json : result_table(done->calibration));
  return gate_verdict(done->calibration.calibration.converged, arguments, folder, console);
}

int run_report(const CalibrateArguments& arguments, const Console& console) {
  const auto done = finish_calibration(arguments, console);
  if (!done) return done.error();
  if (auto written = system::write_file(arguments.out, render(*done)); !written) {
    return console.fail(written.error());
  }
  if (arguments.json) {
    console.out << calibration_json(done->calibration, done->facts);
  } else {
    console.out << arguments.out.string() << "\n";
  }
  return kSuccess;
}

}  // namespace recald::daemon
