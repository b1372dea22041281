/// Prior distributions of calibration parameters.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "core/result.hpp"

namespace recald {

/// Triangular distribution on [min, max]; the seed's choice for every parameter.
///
/// All three numbers are in the parameter's own unit. min < max and min <= mode <= max.
struct TriangularPrior {
  double min;
  double mode;
  double max;
  bool operator==(const TriangularPrior&) const = default;
};

struct UniformPrior {
  double min;
  double max;
  bool operator==(const UniformPrior&) const = default;
};

/// Normal(location, sd) truncated to [min, max]; either bound may be infinite.
struct TruncatedNormalPrior {
  double location;  ///< Mean and mode of the normal before truncation.
  double sd;        ///< Of the normal before truncation, > 0.
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool operator==(const TruncatedNormalPrior&) const = default;
};

/// exp of a normal, truncated to [min, max]; 0 <= min, and max may be infinite.
struct LogNormalPrior {
  double median;  ///< Before truncation, > 0.
  double log_sd;  ///< Standard deviation of the logarithm, > 0.
  double min = 0.0;
  double max = std::numeric_limits<double>::infinity();
  bool operator==(const LogNormalPrior&) const = default;
};

/// A prior as given in files. The meaning of each number depends on the distribution:
/// see `Prior::named`.
struct PriorNumbers {
  std::optional<double> min;
  std::optional<double> mode;
  std::optional<double> max;
  std::optional<double> sd;
};

/// A value and its derivative with respect to the normal score.
struct ScoredValue {
  double value;
  double derivative;
};

/// The belief about one parameter before any measurement, in the parameter's own unit.
class Prior {
 public:
  using Distribution =
      std::variant<TriangularPrior, UniformPrior, TruncatedNormalPrior, LogNormalPrior>;

  /// @return the prior, or invalid_value when the numbers are not finite, not in order, or truncate
  ///         all but 1e-12 of the probability, so that it cannot be sampled.
  static Result<Prior> make(Distribution distribution);

  /// triangular        min, mode, max;
  /// uniform           min, max; a mode is ignored;
  /// truncated_normal  mode: centre, sd: before truncation; min, max: bounds, absent: none;
  /// log_normal        mode: median, sd: of the logarithm; min, max: bounds, absent: 0, none.
  /// @return the prior, or invalid_value: unknown name, a missing number, or what `make` refuses.
  static Result<Prior> named(std::string_view distribution, const PriorNumbers& numbers);

  /// Triangular. @pre min <= mode <= max, min < max, all finite
  Prior(double min, double mode, double max);
  /// Any of the distributions. @pre `make` would accept it
  template <class D>
  requires std::is_constructible_v<Distribution, D> Prior(
      D distribution)  // NOLINT(google-explicit-constructor): each of them is a prior
      : Prior(Checked{}, Distribution(std::move(distribution))) {}

  [[nodiscard]] double density(double value) const;
  [[nodiscard]] double cumulative(double value) const;
  /// Inverse of `cumulative`. @pre 0 <= probability <= 1
  [[nodiscard]] double quantile(double probability) const;
  /// quantile(Phi(score)) with its derivative; accurate in both tails, so that a standard normal
  /// score gives exactly this prior.
  [[nodiscard]] ScoredValue at_score(double score) const;

  [[nodiscard]] double mean() const { return mean_; }
  [[nodiscard]] double variance() const { return variance_; }
  [[nodiscard]] double mode() const;  ///< The middle of a uniform prior.
  [[nodiscard]] double min() const;   ///< Lower end of the support; may be minus infinity.
  [[nodiscard]] double max() const;   ///< Upper end of the support; may be infinity.

  [[nodiscard]] const Distribution& distribution() const { return distribution_; }
  /// "triangular", "uniform", "truncated_normal", "log_normal".
  [[nodiscard]] std::string_view name() const;
  /// With the name what `named` makes the same prior of; infinite bounds are as they are.
  [[nodiscard]] PriorNumbers numbers() const;

  bool operator==(const Prior& other) const { return distribution_ == other.distribution_; }

 private:
  /// The position of a probability, with the density there. Both tails are given: 1 - p
  /// loses the small one.
  struct Located {
    double value;
    double density;
  };

  struct Checked {};
  Prior(Checked, Distribution distribution);

  [[nodiscard]] Located locate(double below, double above) const;

  Distribution distribution_;
  double mean_ = 0.0;
  double variance_ = 0.0;
};

}  // namespace recald
