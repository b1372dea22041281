/// The monthly form of an effect, for models without hours.
///
/// The site's hourly model is run with and without the effect over a grid of the effect's
/// parameters, and the change of each meter in each month is stored. A monthly model adds that
/// change to its own meters, so it has the same effect at the same values. Meters are sums of end
/// uses, so a table by meter suffices. For an effect on a single meter's record we store the ratio
/// of recorded to unrecorded.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "core/diagnosis/evidence/site_problem.hpp"
#include "core/model/monthly_model.hpp"

namespace recald::diagnosis {

/// The range of a parameter of an effect. low == high: it is fixed.
struct ParameterRange {
  double low;
  double high;
};

/// The expected value of a model parameter, and about one sd below and above.
struct ParameterSpread {
  double low;
  double middle;
  double high;
};

/// The effect on the meters of each month as a function of its own parameters η and, to first
/// order, of the model's parameters θ: with more outdoor air, for example, a stuck-open
/// damper costs more.
class MonthlyEffect {
 public:
  /// @param nodes   (r) ascending values of each parameter at which the effect is known.
  /// @param meter   For an effect on one meter's record; -1: on the building.
  /// @param table   (meters * months x grid points), meter-major, first parameter fastest: change
  ///                of the daily average in kWh/day; or, for a record, the ratio (months x grid
  ///                points).
  /// @param months  Of the table.
  /// @param middle  (q) θ of the table; may be empty.
  /// @param slopes  (q) tables of the change by θ.
  MonthlyEffect(std::vector<std::vector<double>> nodes, int meter, Eigen::ArrayXXd table,
                int months, std::vector<double> middle = {},
                std::vector<Eigen::ArrayXXd> slopes = {});

  [[nodiscard]] int parameter_count() const { return static_cast<int>(nodes_.size()); }
  [[nodiscard]] bool is_of_record() const { return meter_ >= 0; }

  /// Applies the effect to a month's meters: linear between the grid's values, constant beyond
  /// them; no meter falls below zero. Does not allocate.
  /// @param theta      The first q are used; fewer are not allowed.
  /// @param eta        (r)
  /// @param daily_kWh  (meters * months), meter-major, in place.
  void apply(std::span<const double> theta, std::span<const double> eta,
             std::span<double> daily_kWh) const;

  /// The same effect in some of the months, in this order.
  [[nodiscard]] MonthlyEffect in_months(std::span<const int> months) const;

 private:
  std::vector<std::vector<double>> nodes_;
  int meter_;
  Eigen::ArrayXXd table_;
  int months_;
  std::vector<double> middle_;
  std::vector<Eigen::ArrayXXd> slopes_;
};

/// Runs the hourly model over the grid: 9 values for each of one or two parameters, 5 for
/// three, 3 for more; and once more for the low and the high end of every θ. Takes 2 ms per
/// run of two years.
///
/// @param before  Effects that the model already has, in order.
/// @param ranges  (r) in order of the candidate's parameters, within their priors' supports.
/// @param theta   (q) the first parameters of the site, those of the monthly model; empty: the
///                change is computed for the drawings, whatever θ.
/// @return the effect in the months of the site's drivers. @pre low <= high, for θ
///         low < high; finite
[[nodiscard]] MonthlyEffect tabulate_effect(
    const SiteProblem& site,
    const std::vector<std::shared_ptr<const model::hourly::Alteration>>& before,
    const Candidate& candidate, std::span<const ParameterRange> ranges,
    std::span<const ParameterSpread> theta = {});

/// Prior modes, 16 % and 84 % quantiles, for `tabulate_effect`.
[[nodiscard]] std::vector<ParameterSpread> spreads_of(std::span<const Parameter> parameters);

/// A model of daily averages with effects added: its own parameters θ, then η of each effect.
class AlteredMonthlyModel final : public MonthlyModel {
 public:
  /// @param model    Its outputs are the meters of the effects' tables, in kWh/day.
  /// @param effects  In the order of addition. Effects on records are applied last.
  AlteredMonthlyModel(std::unique_ptr<MonthlyModel> model, std::vector<MonthlyEffect> effects);

  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override;
  [[nodiscard]] int parameter_count() const override;
  [[nodiscard]] int output_count() const override { return model_->output_count(); }
  [[nodiscard]] int month_count() const override { return model_->month_count(); }

  void evaluate(std::span<const double> theta_and_eta, std::span<double> outputs) override;

 private:
  void apply(bool records, std::span<const double> theta_and_eta, std::span<double> outputs) const;

  std::unique_ptr<MonthlyModel> model_;
  std::vector<MonthlyEffect> effects_;
};

}  // namespace recald::diagnosis
