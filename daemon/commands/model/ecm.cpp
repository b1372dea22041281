#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "adapters/views/savings/savings_words.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/generated_at.hpp"
#include "daemon/commands/model/calibration_options.hpp"
#include "daemon/commands/model/engine_runs.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/savings/measure_columns.hpp"
#include "daemon/site/savings/measure_file.hpp"
#include "daemon/site/savings/measure_runs.hpp"
#include "daemon/site/savings/savings_files.hpp"
#include "daemon/site/savings/savings_report.hpp"

namespace recald::daemon {
namespace {

using Begin = std::chrono::steady_clock::time_point;

/// Calibrates as `recald calibrate` does; failures are printed and come back as an exit code.
tl::expected<FinishedCalibration, int> finish_aloud(ModelledSite modelled,
                                                    const EcmArguments& arguments,
                                                    const calibration::RunContext& context,
                                                    Begin begin, const Console& console) {
  auto done = finish_calibration(std::move(modelled), {}, context);
  if (!done) return tl::unexpected(console.fail(done.error()));
  if (!is_sound(done->calibration)) {
    return tl::unexpected(console.fail(
        fmt::format("the chains have not converged, so nothing is said of savings; see `recald "
                    "calibrate {}`",
                    arguments.site.filename().string())));
  }
  done->modelled.facts.seed = arguments.seed;
  done->modelled.facts.wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return std::move(*done);
}

template <class Savings>
int deliver_savings(const FinishedCalibration& finished, const Savings& savings,
                    const EcmArguments& arguments, const Console& console) {
  const std::string json = savings_json(finished, savings);
  if (!arguments.out.empty()) {
    const auto written = write_savings(finished, savings, generated_at(), json, arguments.out);
    if (!written) return console.fail(written.error());
  }
  console.out << (arguments.json ? json
                                 : views::savings_words(savings_report_of(finished, savings, "")));
  return kSuccess;
}

/// Reads the measures too, which are checked against the model.
tl::expected<ModelledSite, int> open_for_measures(const EcmArguments& arguments,
                                                  std::vector<savings::Measure>& measures,
                                                  const Console& console) {
  auto site = open_site(arguments.site);
  if (!site) return tl::unexpected(console.fail(site.error()));
  if (auto has = require_model(site->config); !has) {
    return tl::unexpected(console.fail(has.error()));
  }
  if (arguments.model) {
    if (auto chosen = choose_model(site->config, *arguments.model); !chosen) {
      return tl::unexpected(console.fail(chosen.error()));
    }
  }
  auto read = load_measures(arguments.measure, site->config);
  if (!read) return tl::unexpected(console.fail(read.error()));
  measures = std::move(*read);
  return load_aloud(std::move(*site), console);
}

/// Of an EnergyPlus model, the runs with each measure that are missing. @return an exit code
int make_missing_runs(const ModelledSite& modelled, const std::vector<savings::Measure>& measures,
                      const EcmArguments& arguments, const Console& console) {
  const ModelConfig& model = *modelled.site.config.model;
  if (!model.energyplus) return kSuccess;
  auto all = alone_and_together(measures);
  std::ranges::reverse(all);  // together first: what no model has is found before anything is run
  for (const std::span<const savings::Measure> some : all) {
    if (has_measure_runs(model, some)) continue;
    console.err << fmt::format("Runs with {}:\n",
                               some.size() == 1 ? "'" + some.front().name + "'" : "all measures");
    const auto made = make_runs_aloud(
        [&](const ForEachIndex& executor, const Engine::Observer& observer) {
          return make_measure_runs(modelled, some, executor, observer);
        },
        arguments.threads, console);
    if (!made) return made.error();
    if (made->failed > 0) {
      console.err << fmt::format("! {} of {} runs failed; {} says why.\n", made->failed,
                                 made->total,
                                 (measure_folder(model, some) / "failed.csv").string());
    }
  }
  return kSuccess;
}

int run_measures(const EcmArguments& arguments, const Console& console) {
  const Begin begin = std::chrono::steady_clock::now();
  std::vector<savings::Measure> measures;
  auto modelled =
      with_runs([&](const Console& to) { return open_for_measures(arguments, measures, to); },
                arguments.seed, arguments.threads, console);
  if (!modelled) return modelled.error();
  if (const int code = make_missing_runs(*modelled, measures, arguments, console);
      code != kSuccess) {
    return code;
  }
  const InterruptGuard guard;
  ProgressLine line{console};
  const calibration::RunContext context = run_context(arguments, guard, line);
  auto finished = finish_aloud(std::move(*modelled), arguments, context, begin, console);
  if (!finished) return finished.error();
  const auto savings = savings_of(*finished, measures, context);
  if (!savings) return console.fail(savings.error());
  return deliver_savings(*finished, *savings, arguments, console);
}

int run_since(const EcmArguments& arguments, const Console& console) {
  const Begin begin = std::chrono::steady_clock::now();
  const auto since = metering::parse_day(arguments.since);
  if (!since) return console.misused("--since: " + since.error().message);
  auto site = open_site(arguments.site);
  if (!site) return console.fail(site.error());
  if (!site->config.weather) {
    return console.fail(fmt::format(
        "{} has no [weather]: what the months after would have used depends on their temperature",
        arguments.site.filename().string()));
  }
  if (arguments.model && site->config.model) {
    if (auto chosen = choose_model(site->config, *arguments.model); !chosen) {
      return console.fail(chosen.error());
    }
  }
  auto modelled =
      load_aloud(std::move(*site), console,
                 [&](const OpenSite& open, const Recording& recording, metering::Instant now) {
                   return months_about(open, recording, now, *since);
                 });
  if (!modelled) return modelled.error();
  const InterruptGuard guard;
  ProgressLine line{console};
  const calibration::RunContext context = run_context(arguments, guard, line);
  const auto finished = finish_aloud(std::move(*modelled), arguments, context, begin, console);
  if (!finished) return finished.error();
  return deliver_savings(*finished, savings_since(*finished, *since), arguments, console);
}

}  // namespace

int run_ecm(const EcmArguments& arguments, const Console& console) {
  if (arguments.measure.empty() == arguments.since.empty()) {
    return console.misused(
        "ecm needs either --measure FILE, for what measures would save, or --since DATE, for what "
        "was saved");
  }
  return arguments.since.empty() ? run_measures(arguments, console) : run_since(arguments, console);
}

}  // namespace recald::daemon
