#include "core/metering/registers/rest.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "core/metering/reading.hpp"

namespace recald::metering {
namespace {

using std::chrono::seconds;

constexpr std::size_t kStepsMin = 48;
constexpr std::size_t kGapsMin = 3;
constexpr double kRepeatedMax = 0.01;  // of the steps of a register that is logged on change
constexpr double kRestingMin = 0.9;    // of its gaps
constexpr double kLoadAtRest = 0.5;    // of the load outside of the gaps, at most
constexpr double kLargeStep = 0.95;    // quantile of the rises in one step
constexpr double kLargerStep = 1.5;    // … and by how much the largest may be larger

struct RegisterStep {
  seconds length;
  double rise_kWh;
};

template <class T>
T quantile_of(std::vector<T> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

std::vector<RegisterStep> steps_of(const std::vector<RegisterSample>& samples) {
  std::vector<RegisterStep> steps;
  const RegisterSample* last = nullptr;
  for (const RegisterSample& sample : samples) {
    if (!std::isfinite(sample.value_kWh)) continue;
    if (last != nullptr) {
      steps.push_back({sample.time - last->time, sample.value_kWh - last->value_kWh});
    }
    last = &sample;
  }
  return steps;
}

/// How a register that rests is logged.
struct Rests {
  seconds step;         ///< The usual one.
  double rise_max_kWh;  ///< Of one step.

  [[nodiscard]] bool is_gap(const RegisterStep& one) const { return 2 * one.length > 5 * step; }
  [[nodiscard]] bool is_rest(const RegisterStep& one) const {
    return is_gap(one) && one.rise_kWh <= rise_max_kWh;
  }
};

double load_kW(double energy_kWh, seconds span) {
  return span > seconds{0} ? energy_kWh / in_hours(span) : 0.0;
}

std::optional<Rests> find_rests(const std::vector<RegisterStep>& steps) {
  if (steps.size() < kStepsMin) return {};
  std::vector<seconds> lengths;
  for (const RegisterStep& one : steps) lengths.push_back(one.length);
  Rests rests{.step = quantile_of(std::move(lengths), 0.5), .rise_max_kWh = 0.0};

  std::vector<double> rises_kWh;
  std::size_t repeated = 0;
  seconds running{0};
  double running_kWh = 0.0;
  for (const RegisterStep& one : steps) {
    if (rests.is_gap(one)) continue;
    rises_kWh.push_back(one.rise_kWh);
    repeated += one.rise_kWh == 0.0 ? 1 : 0;
    running += one.length;
    running_kWh += one.rise_kWh;
  }
  const auto share = [](std::size_t part, std::size_t whole) {
    return static_cast<double>(part) / static_cast<double>(whole);
  };
  if (rises_kWh.empty() || share(repeated, rises_kWh.size()) > kRepeatedMax) return {};
  rests.rise_max_kWh = kLargerStep * quantile_of(std::move(rises_kWh), kLargeStep);

  std::size_t gaps = 0;
  std::size_t resting = 0;
  seconds gap{0};
  double gap_kWh = 0.0;
  for (const RegisterStep& one : steps) {
    if (!rests.is_gap(one)) continue;
    ++gaps;
    resting += rests.is_rest(one) ? 1 : 0;
    gap += one.length;
    gap_kWh += one.rise_kWh;
  }
  if (gaps < kGapsMin || share(resting, gaps) < kRestingMin) return {};
  if (load_kW(gap_kWh, gap) > kLoadAtRest * load_kW(running_kWh, running)) return {};
  return rests;
}

}  // namespace

std::vector<RegisterSample> with_rests(std::vector<RegisterSample> samples) {
  const auto rests = find_rests(steps_of(samples));
  if (!rests) return samples;
  std::vector<RegisterSample> whole;
  std::optional<RegisterSample> last;
  for (const RegisterSample& sample : samples) {
    if (std::isfinite(sample.value_kWh)) {
      // A row without a value in between says that nothing could be read.
      const bool rested =
          last && whole.back() == *last &&
          rests->is_rest({sample.time - last->time, sample.value_kWh - last->value_kWh});
      if (rested) whole.push_back({sample.time - rests->step, last->value_kWh});
      last = sample;
    }
    whole.push_back(sample);
  }
  return whole;
}

}  // namespace recald::metering
