/// Which kinds of day share what, and which form each curve has, chosen by days that were left out.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/change_point/curve.hpp"
#include "core/change_point/curve_search.hpp"
#include "core/change_point/temperature_sums.hpp"
#include "core/model/schedule.hpp"

namespace recald::change_point {

/// A usable day. Temperature and energy are finite; without temperatures all are 0.
struct TrainingDay {
  int day_number;  ///< Since 1970, ascending.
  model::DayType type;
  double dry_bulb_C;
  double energy_kWh;
  int block;            ///< Days of one month, or of a shorter stretch, are left out together …
  int fold;             ///< … with a few other blocks of other seasons.
  double weight = 1.0;  ///< 0…1, less for outliers; > 0.
};

/// A curve for each group; together the groups hold each kind of day once.
struct Choice {
  std::vector<DayGroup> groups;
  std::vector<Form> forms;  ///< (groups)
};

struct Selection {
  Choice choice;
  /// (days) Measured minus expected by the chosen form, fitted without the day's fold. kWh
  std::vector<double> left_out_residual_kWh;
};

/// Chooses among the five forms, for days that share one base load, that have one by kind of day,
/// or of which open and closed days have curves of their own. A candidate's loss is the weighted
/// sum of squares of days that were left out by folds. Chosen is the simplest candidate that is not
/// worse than the best by more than the standard error of the difference over blocks: first a form
/// for each group, then the grouping.
/// @see Breiman, Friedman, Olshen, Stone (1984), Classification and Regression Trees, 3.4.3, for
/// the
///      rule of one standard error, here of paired differences.
class Selector {
 public:
  /// @param days  At least two folds; types, dates and temperatures stay what they are, weights may
  ///              change between calls.
  /// @param with_temperature  False: only the form without.
  Selector(std::span<const TrainingDay> days, bool with_temperature);

  [[nodiscard]] Selection select(std::span<const TrainingDay> days);
  /// (groups of the choice)
  [[nodiscard]] std::vector<GroupFit> fit(std::span<const TrainingDay> days, const Choice& choice);

 private:
  struct Candidate {
    DayGroup group;
    EdgeLimits limits;
  };

  std::size_t add_group(std::span<const TrainingDay> days, const DayGroup& group,
                        bool with_temperature);
  void leave_folds_out(std::span<const TrainingDay> days);
  [[nodiscard]] std::vector<double> losses(std::span<const TrainingDay> days, std::size_t group,
                                           std::size_t form) const;
  [[nodiscard]] std::size_t choose_form(std::span<const TrainingDay> days, std::size_t group) const;
  [[nodiscard]] double& residual(std::size_t day, std::size_t group, std::size_t form) {
    return residuals_[(group * kForms + form) * days_ + day];
  }
  [[nodiscard]] double residual(std::size_t day, std::size_t group, std::size_t form) const {
    return residuals_[(group * kForms + form) * days_ + day];
  }

  std::size_t days_;
  int blocks_;
  int folds_;
  TemperatureSums sums_;
  CurveSearch search_;
  std::vector<Candidate> candidates_;
  std::vector<std::vector<std::size_t>> groupings_;  ///< Indices of candidates, simplest first.
  std::vector<double> residuals_;  ///< (days, forms, candidates) of days left out, kWh.
};

}  // namespace recald::change_point
