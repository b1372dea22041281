#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>

#include "adapters/report/report.hpp"
#include "adapters/system/parallel_for.hpp"
#include "adapters/system/write_file.hpp"
#include "daemon/calibrate/site_calibration.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/results/calibration_files.hpp"
#include "daemon/results/report_of.hpp"
#include "daemon/results/result_table.hpp"
#include "daemon/results/run_facts.hpp"

namespace recald::daemon {
namespace {

/// Set by Ctrl-C; a calibration stops at its next report of progress.
std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch such");

class InterruptGuard {
 public:
  InterruptGuard() : previous_(std::signal(SIGINT, [](int) { interrupted = true; })) {
    interrupted = false;
  }
  ~InterruptGuard() { std::signal(SIGINT, previous_); }
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

 private:
  void (*previous_)(int);
};

/// Everything that one calibration leaves behind.
struct Finished {
  OpenSite site;
  Recording recording;
  SiteCalibration calibration;
  RunFacts facts;
};

Result<CalibrateOptions> options_of(const CalibrateArguments& arguments) {
  const auto profile = calibration::parse_hyper_prior_profile(arguments.hyper_prior);
  if (!profile) return tl::unexpected(profile.error());
  CalibrateOptions options;
  options.calibration.hyper_prior = *profile;
  options.calibration.design_runs = arguments.design_runs;
  options.calibration.chains = arguments.chains;
  options.calibration.sampling = {arguments.iterations, arguments.burn_in};
  options.prior_sensitivity = arguments.prior_sensitivity;
  return options;
}

RunFacts complete_facts(RunFacts facts, const CalibrateArguments& arguments) {
  facts.sampler = arguments.sampler;
  facts.hyper_prior_profile = arguments.hyper_prior;
  facts.seed = arguments.seed;
  facts.iterations = arguments.iterations;
  facts.burn_in = arguments.burn_in;
  facts.chains = arguments.chains;
  facts.design_runs = arguments.design_runs;
  return facts;
}

/// From the site file to the calibration; failures are printed and come back as an exit code.
tl::expected<Finished, int> finish_calibration(const CalibrateArguments& arguments,
                                               const Console& console) {
  const auto begin = std::chrono::steady_clock::now();
  auto site = open_site(arguments.site);
  if (!site) return tl::unexpected(console.fail(site.error()));
  const auto fail = [&](const Error& error) { return tl::unexpected(console.fail(error)); };
  if (auto modelled = require_model(site->config); !modelled) return fail(modelled.error());
  const auto options = options_of(arguments);
  if (!options) return fail(options.error());
  if (const auto checked = calibration::check_options(options->calibration.sampling); !checked) {
    console.fail(checked.error());
    return tl::unexpected(kUsage);
  }
  auto facts = facts_of(site->config);
  if (!facts) return fail(facts.error());

  VirtualClock clock{metering::Instant{}};
  auto recording = replay_meters(site->config, site->calendar, {}, clock, {});
  if (!recording) return fail(recording.error());
  print_data_words(*recording, console);
  const auto weather = load_weather(site->config, site->calendar, whole_period(site->config));
  if (!weather) return fail(weather.error());

  const InterruptGuard guard;
  ProgressLine line{console};
  const calibration::RunContext context{.seed = arguments.seed,
                                        .executor = system::parallel_for(arguments.threads),
                                        .observer = [&](const calibration::Progress& progress) {
                                          line.show(progress);
                                          return !interrupted;
                                        }};
  auto calibrated =
      calibrate_site(site->config, site->calendar, *recording, *weather, *options, context);
  if (!calibrated) return fail(calibrated.error());
  RunFacts complete = complete_facts(std::move(*facts), arguments);
  complete.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return Finished{std::move(*site), std::move(*recording), std::move(*calibrated),
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
  const auto done = finish_calibration(arguments, console);
  if (!done) return done.error();
  const std::string json = calibration_json(done->calibration, done->recording, done->facts);
  if (!arguments.out.empty()) {
    if (auto written = write_all(*done, json, arguments.out); !written) {
      return console.fail(written.error());
    }
  }
  console.out << (arguments.json ? json : result_table(done->calibration, done->recording));
  return kSuccess;
}

int run_report(const CalibrateArguments& arguments, const Console& console) {
  const auto done = finish_calibration(arguments, console);
  if (!done) return done.error();
  if (auto written = system::write_file(arguments.out, render(*done)); !written) {
    return console.fail(written.error());
  }
  if (arguments.json) {
    console.out << calibration_json(done->calibration, done->recording, done->facts);
  } else {
    console.out << arguments.out.string() << "\n";
  }
  return kSuccess;
}

}  // namespace recald::daemon
