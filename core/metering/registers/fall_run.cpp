#include "core/metering/registers/fall_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace recald::metering {
namespace {

constexpr int kFallsMin = 10;
constexpr int kReadsPerFall = 8;
constexpr double kStandardErrors = 5.0;
constexpr std::chrono::hours kRunMin{1};
constexpr std::chrono::hours kRunMax{7 * 24};  // falls further apart have nothing in common

bool is_frequent(const FallRun& run) { return run.samples <= kReadsPerFall * run.falls; }

/// It has passed where it was by more than jitter, and no single read period explains that.
bool gets_on(const FallRun& run, const FallLimits& limits) {
  if (run.last.value_kWh <= run.before.value_kWh + limits.jitter_kWh) return false;
  const bool may_vary = run.is_no_total || run.deep > 0;
  return !may_vary || run.last.value_kWh > limits.rise_max_kWh;
}

bool is_no_total(const FallRun& run, const FallLimits& limits) {
  if (run.falls < kFallsMin || run.last.time - run.before.time < kRunMin) return false;
  const double highest_kWh = std::max(run.before.value_kWh, run.last.value_kWh);
  // A new total without a load flickers where it stands.
  const bool falls_deep = run.deep > 0 || highest_kWh <= limits.jitter_kWh;
  if (falls_deep && is_frequent(run) && highest_kWh <= limits.rise_max_kWh) return true;
  return run.deep == 0 && -run.cubes_kWh3 > kStandardErrors * std::sqrt(run.sixths_kWh6);
}

}  // namespace

void watch_falls(std::optional<FallRun>& run, const RegisterSample& previous,
                 const RegisterSample& sample, const FallLimits& limits) {
  const RegisterSample before = run ? run->last : previous;
  const double step_kWh = sample.value_kWh - before.value_kWh;
  const bool is_deep = step_kWh < -limits.jitter_kWh;
  if (run && !run->is_no_total && sample.time - run->before.time > kRunMax) run.reset();
  if (is_deep && before.value_kWh > limits.rise_max_kWh) {
    run.reset();
    return;
  }
  if (step_kWh < 0.0) {
    const bool is_rare = run && is_deep && !run->is_no_total && !is_frequent(*run);
    if (!run || is_rare) run = FallRun{.before = before, .last = before};
    ++run->falls;
    run->deep += is_deep ? 1 : 0;
  }
  if (!run) return;
  ++run->samples;
  run->last = sample;
  run->cubes_kWh3 += std::pow(step_kWh, 3);
  run->sixths_kWh6 += std::pow(step_kWh, 6);
  if (gets_on(*run, limits)) {
    run.reset();
  } else {
    run->is_no_total = run->is_no_total || is_no_total(*run, limits);
  }
}

}  // namespace recald::metering
