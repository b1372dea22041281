/// Detectors of a change in a stream of standardised surprises, one a month or a day.
///
/// Each is a value: all that must survive a restart, fed one surprise after the other. Their claims
/// hold for surprises that are standard normal while nothing changes; `calibration_check.hpp` tests
/// whether they are.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace recald::drift {

/// e-detector: a mixture of Shiryaev-Roberts processes, one for each shift worth noticing.
///
///     M_t(l) = (M_(t-1)(l) + 1) exp(l u_t - l^2 / 2),   alarm when the mean of M_t(l) >= 1 / alpha
///
/// The mean time between false alarms is at least 1 / alpha for any dependence, as long as each u_t
/// given its past is standard normal, or lighter in its tails. What is averaged is the processes:
/// averaging their increments first would be valid too and nearly blind.
/// @see Shin, Ramdas, Rinaldo (2024), Sequential Analysis 43(2), "E-detectors", definition 2.1.
class EDetector {
 public:
  /// Shifts in standard deviations, to either side.
  static constexpr std::array<double, 8> kShifts{-2.0, -1.0, -0.5, -0.25, 0.25, 0.5, 1.0, 2.0};

  /// @param largest_shift  Those beyond it are left out: they answer to a few odd values.
  /// @pre 0 < alpha < 1, largest_shift >= 0.25
  explicit EDetector(double alpha, double largest_shift = kShifts.back());

  /// One more surprise. @return whether it raises the alarm; then the detector begins anew.
  bool observe(double standardised);

  /// log of the evidence for a change, before a new beginning; alarm at -log(alpha).
  [[nodiscard]] double log_evidence() const { return log_evidence_; }
  [[nodiscard]] double log_threshold() const { return log_threshold_; }
  /// The shift whose process is largest: its sign tells the direction.
  [[nodiscard]] double likeliest_shift() const { return likeliest_shift_; }

  [[nodiscard]] const std::array<double, 8>& log_processes() const { return log_processes_; }
  /// Goes on from what `log_processes` gave.
  void restore(const std::array<double, 8>& log_processes) { log_processes_ = log_processes; }

 private:
  double largest_shift_;
  double log_threshold_;
  double log_evidence_;
  double likeliest_shift_ = 0.0;
  std::array<double, 8> log_processes_;  ///< log M_t(l); -infinity before the first.
};

/// Two-sided cumulative sum, S+- = max(0, S+- +- u_t - k).
/// @see Page (1954), Biometrika 41.
class Cusum {
 public:
  /// k = 1/2 is best for a shift of one standard deviation. h = 4.34 gives one false alarm in 240.
  explicit Cusum(double threshold, double allowance = 0.5)
      : threshold_(threshold), allowance_(allowance) {}

  /// @return whether it raises the alarm; then the sums begin anew.
  bool observe(double standardised);
  [[nodiscard]] double upper() const { return upper_; }
  [[nodiscard]] double lower() const { return lower_; }
  void restore(double upper, double lower) {
    upper_ = upper;
    lower_ = lower;
  }

 private:
  double threshold_;
  double allowance_;
  double upper_ = 0.0;
  double lower_ = 0.0;
};

/// Bayesian online change points: how long ago the stream's level last changed.
///
/// Between changes u is normal with an unknown mean ~ N(0, prior_sd^2) and sd 1; a change comes
/// with probability 1 / mean_run each time. Run lengths beyond `runs_max` are put together.
/// @see Adams, MacKay (2007), arXiv:0710.3742, algorithm 1. The sd is known here: a standardised
///      surprise has sd 1 by construction, and with an unknown one two outliers are a change.
class ChangePoint {
 public:
  struct Options {
    double mean_run = 60.0;  ///< Steps between changes, 1 / hazard.
    double prior_sd = 2.0;   ///< Of the level after a change.
    std::size_t runs_max = 600;
  };

  ChangePoint() : ChangePoint(Options{}) {}
  explicit ChangePoint(const Options& options);

  void observe(double standardised);

  /// (t + 1) P(run length = r | u_1 … u_t), r = 0 meaning that the change is yet to come.
  [[nodiscard]] const std::vector<double>& run_lengths() const { return probabilities_; }

  /// P(a change within the last `steps` observations).
  [[nodiscard]] double change_within(std::size_t steps) const;

  /// The steps since a change, as the shortest and longest of a central interval.
  struct StepsSince {
    std::size_t likeliest;
    std::size_t shortest;
    std::size_t longest;
  };
  [[nodiscard]] StepsSince since(double coverage = 0.9) const;

 private:
  Options options_;
  std::vector<double> probabilities_;
  std::vector<double> sums_;  ///< Of the u since the change, by run length.
};

}  // namespace recald::drift
