#include "core/drift/watch/detectors.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace recald::drift {
namespace {

constexpr double kMinusInfinity = -std::numeric_limits<double>::infinity();

/// log(1 + exp(x)) without overflow.
double log_one_plus_exp(double x) {
  return x > 0.0 ? x + std::log1p(std::exp(-x)) : std::log1p(std::exp(x));
}

double normal_density(double x, double variance) {
  return std::exp(-0.5 * x * x / variance) / std::sqrt(2.0 * std::numbers::pi * variance);
}

}  // namespace

EDetector::EDetector(double alpha, double largest_shift)
    : largest_shift_(largest_shift),
      log_threshold_(-std::log(alpha)),
      log_evidence_(kMinusInfinity) {
  assert(alpha > 0.0 && alpha < 1.0 && largest_shift >= 0.25);
  log_processes_.fill(kMinusInfinity);
}

bool EDetector::observe(double standardised) {
  double largest = kMinusInfinity;
  double count = 0.0;
  for (std::size_t i = 0; i < kShifts.size(); ++i) {
    const double shift = kShifts[i];
    if (std::abs(shift) > largest_shift_) continue;
    count += 1.0;
    log_processes_[i] =
        log_one_plus_exp(log_processes_[i]) + shift * standardised - 0.5 * shift * shift;
    if (log_processes_[i] <= largest) continue;
    largest = log_processes_[i];
    likeliest_shift_ = shift;
  }
  double sum = 0.0;
  for (const double log_process : log_processes_) sum += std::exp(log_process - largest);
  log_evidence_ = largest + std::log(sum / count);
  if (log_evidence_ < log_threshold_) return false;
  log_processes_.fill(kMinusInfinity);
  return true;
}

bool Cusum::observe(double standardised) {
  upper_ = std::max(0.0, upper_ + standardised - allowance_);
  lower_ = std::max(0.0, lower_ - standardised - allowance_);
  if (std::max(upper_, lower_) < threshold_) return false;
  upper_ = 0.0;
  lower_ = 0.0;
  return true;
}

ChangePoint::ChangePoint(const Options& options)
    : options_(options), probabilities_{1.0}, sums_{0.0} {
  assert(options.mean_run > 1.0 && options.prior_sd > 0.0 && options.runs_max > 1);
}

void ChangePoint::observe(double standardised) {
  const double hazard = 1.0 / options_.mean_run;
  const double precision = 1.0 / (options_.prior_sd * options_.prior_sd);
  std::vector<double> grown(probabilities_.size() + 1);
  double changed = 0.0;
  for (std::size_t run = 0; run < probabilities_.size(); ++run) {
    // The level after `run` observations is N(mean, variance); the next one has sd 1 beside it.
    const double variance = 1.0 / (precision + static_cast<double>(run));
    const double mean = sums_[run] * variance;
    const double likelihood = normal_density(standardised - mean, 1.0 + variance);
    grown[run + 1] = probabilities_[run] * likelihood * (1.0 - hazard);
    changed += probabilities_[run] * likelihood * hazard;
  }
  grown[0] = changed;
  sums_.insert(sums_.begin(), 0.0);
  for (std::size_t run = 1; run < sums_.size(); ++run) sums_[run] += standardised;
  if (grown.size() > options_.runs_max) {
    const double last = grown.back();
    grown.pop_back();
    grown.back() += last;
    sums_.pop_back();
  }
  const double total = std::accumulate(grown.begin(), grown.end(), 0.0);
  for (double& probability : grown) probability /= total;
  probabilities_ = std::move(grown);
}

double ChangePoint::change_within(std::size_t steps) const {
  // The longest run began with, or before, the first observation: that is no change.
  const auto end = probabilities_.begin() +
                   static_cast<std::ptrdiff_t>(std::min(steps + 1, probabilities_.size() - 1));
  return std::accumulate(probabilities_.begin(), end, 0.0);
}

ChangePoint::StepsSince ChangePoint::since(double coverage) const {
  const auto likeliest = std::ranges::max_element(probabilities_) - probabilities_.begin();
  const double tail = 0.5 * (1.0 - coverage);
  StepsSince since{static_cast<std::size_t>(likeliest), 0, probabilities_.size() - 1};
  double sum = 0.0;
  bool has_shortest = false;
  for (std::size_t run = 0; run < probabilities_.size(); ++run) {
    sum += probabilities_[run];
    if (!has_shortest && sum >= tail) {
      since.shortest = run;
      has_shortest = true;
    }
    if (sum >= 1.0 - tail) {
      since.longest = run;
      break;
    }
  }
  return since;
}

}  // namespace recald::drift
