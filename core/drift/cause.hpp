/// What has changed: a parameter of the building, a meter, or something that the model lacks?
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/calibration/posterior/posterior.hpp"
#include "core/drift/alarm_kinds.hpp"
#include "core/drift/prequential.hpp"
#include "core/drift/sequential.hpp"

namespace recald::drift {

/// A way in which all points may move together that no parameter stands for.
struct Direction {
  std::string name;  ///< "electricity use"
  /// (outputs * months) in units, output-major, for an amplitude of 1 (a change by 100 %).
  std::vector<double> change;
};

struct Cause {
  CauseKind kind = CauseKind::nothing;
  int index = 0;  ///< Of the parameter, direction or output; -1: an unknown effect on all outputs.
  double probability = 0.0;
  double log_evidence = 0.0;  ///< Of the months since the change.
  /// The value since, or the factor, of all months since; 90 % interval. NaN where there is none.
  double mean;
  double q05;
  double q95;
  std::string effect = {};  ///< Id in the catalogue; of a meter, what is likeliest wrong with it.
  std::string title = {};   ///< Its title.
};

struct CauseOptions {
  int particles = 96;         ///< Of the posterior before the change.
  int values = 32;            ///< Tried of what changed, a particle.
  double factor_sd = 0.3;     ///< Of a meter's factor or a direction's amplitude, on the log scale.
  double uneven_share = 0.3;  ///< sd of a month's amplitude over all months', where it is uneven.
  /// Of an unknown effect: each output moves by this share of itself.
  double unknown_sd = 0.15;
  double monthly_sd = 0.10;  ///< By which an unknown effect on one output differs between months.
  /// Prior odds of the kinds, each shared among its members.
  double nothing = 0.10, building = 0.45, meters = 0.25, unknown = 0.20;
};

/// What a change is sought in.
struct ChangeCase {
  const MonthlyModel& model;  ///< Of all months.
  const std::vector<Parameter>& parameters;
  const calibration::PosteriorData& data;  ///< Of all months.
  const calibration::HyperPrior& prior;
  std::vector<LevelOutput> levels;
  const std::vector<Direction>& directions;
  int learning_months;  ///< That levels have learnt nothing from.
  int first;            ///< Month that is still believed: the building was another one before.
  int since;            ///< First month of the change …
  int until;            ///< … and the last one known.
};

/// Points of the posterior of the months before the change, evenly by weight.
/// @return or an error of the model or of sampling; not_enough_data before there is a posterior.
[[nodiscard]] Result<std::vector<Eigen::VectorXd>> known_before(
    const ChangeCase& change, const CauseOptions& options, std::uint64_t seed,
    const std::function<bool()>& proceed = {});

/// Competing refits of the months since the change, given those before it:
///
///     p(y_since | y_before, h) = E[ N(y_since; f(theta', s) + shift(theta, phi), Sigma(theta,
///     phi)) ]
///
/// over the posterior of the months before and the prior of what h says has changed. Everything
/// else stays as it was, hence a building that changed in one thing earns more than one that may
/// have changed in all.
///
/// @param before  Of `known_before`; the same for every later `until`.
/// @return all causes, the likeliest first, probabilities adding up to 1; or an error of the model.
[[nodiscard]] Result<std::vector<Cause>> weigh_causes(const ChangeCase& change,
                                                      const std::vector<Eigen::VectorXd>& before,
                                                      const CauseOptions& options,
                                                      std::uint64_t seed);

}  // namespace recald::drift
