/// blind_run: diagnoses the cases of a population, one results line each.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <iostream>

#include "tests/blind/running/run_cases.hpp"

namespace {

using recald::blind::RunRequest;
using recald::blind::RunSummary;

constexpr int kExitFailure = 1;
constexpr int kExitUsage = 2;
constexpr int kExitStopped = 130;

std::atomic<bool> stop = false;
static_assert(std::atomic<bool>::is_always_lock_free, "set by a signal handler");

void add_options(CLI::App& app, RunRequest& request) {
  app.add_option("--population", request.population, "folder that holds cases/")->required();
  app.add_option("--results", request.results, "results file; a run goes on where it ends")
      ->required();
  app.add_option(
         "--method", request.method,
         "its name in the results; oracle needs --answers; calibrate and drift run those commands")
      ->capture_default_str();
  app.add_option("--answers", request.answers, "folder with <case>.json, for method oracle");
  app.add_option("--jobs", request.jobs, "diagnoses at a time")
      ->capture_default_str()
      ->check(CLI::Range(1, 64));
  app.add_option("--cases", request.cases, "only these, such as 1-20");
  app.add_option("--limit-s", request.limit_s, "wall time of a diagnosis")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--keep", request.keep,
                 "folder that gets each case's diagnosis.json, calibration.json or drift.json");
  app.add_option("--recald", request.program, "the program")->capture_default_str();
}

void show_progress(std::size_t done, std::size_t of, std::size_t failed) {
  std::cerr << fmt::format("\r{} of {}, {} without a diagnosis   ", done, of, failed);
}

void report(const RunRequest& request, const RunSummary& summary) {
  if (summary.done > 0) std::cerr << '\n';
  for (const std::string& torn : summary.torn) std::cerr << "blind_run: " << torn << '\n';
  std::cout << fmt::format(
      "{}: {} of {} cases have a line in {}, {} of them new; {} of the new without a diagnosis, "
      "{} of these over {:g} s\n",
      request.method, summary.found + summary.done, summary.cases, request.results.string(),
      summary.done, summary.failed, summary.over_limit, request.limit_s);
  if (summary.stopped) std::cout << "stopped; the same command goes on\n";
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Diagnoses the cases of a blind population, one results line each.", "blind_run"};
  RunRequest request;
  request.program = RECALD_PROGRAM;
  add_options(app, request);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  for (const int signal : {SIGINT, SIGTERM}) {
    std::signal(signal, [](int) { stop = true; });
  }
  const auto summary = recald::blind::run_cases(request, stop, show_progress);
  if (!summary) {
    std::cerr << "blind_run: " << summary.error().message << '\n';
    return summary.error().code == recald::ErrorCode::invalid_value ? kExitUsage : kExitFailure;
  }
  report(request, *summary);
  return summary->stopped ? kExitStopped : 0;
}
