/// Which of a building's parameters matter to its meters, and how sure that is.
#pragma once

#include <string>
#include <vector>

#include "core/random/rng.hpp"
#include "core/regression/design_data.hpp"
#include "core/result.hpp"
#include "core/screening/cross_validation.hpp"
#include "core/screening/lasso.hpp"
#include "core/screening/stability.hpp"

namespace recald::screening {

struct ScreenOptions {
  int folds = 10;
  double frequency_min = 0.6;  ///< Share of half-samples that must agree.
  /// Least share of an output's variance over the runs. A simulation has no noise, so with enough
  /// runs every parameter is found. At 0.005 one standard deviation of the parameter moves the
  /// output by 7 % of the output's own spread; less is real and yet not worth calibrating.
  double share_min = 0.005;
  LassoOptions lasso = {};
  StabilityOptions stability = {};
};

/// What a parameter does to one output.
struct ParameterEffect {
  bool selected;     ///< By the lasso at the penalty of the one-standard-error rule.
  double frequency;  ///< Share of half-samples that select it at that penalty.
  double share;      ///< Of the output's variance over the runs, months pooled.
  /// Change of the output for one standard deviation of the parameter over the design, in the
  /// output's unit: mean over the months, and the months with the least and the most.
  double change_mean;
  double change_least;
  double change_most;
};

enum class Verdict {
  influential,   ///< Selected, in enough half-samples, and worth calibrating for some output.
  minor,         ///< Found, but too small or not surely: keep it at its default.
  not_detected,  ///< No output selects it.
};

struct ScreenedParameter {
  std::string name;
  Verdict verdict;
  double frequency;                      ///< Largest over the outputs that count for the verdict.
  double share;                          ///< Largest over the outputs.
  int strongest_output;                  ///< Where `share` is.
  std::vector<ParameterEffect> effects;  ///< (outputs)
};

struct ScreenedOutput {
  std::string name;
  double penalty;       ///< Chosen, on the output's normalised scale; 0 if no parameter moves it.
  double penalty_best;  ///< With the smallest left-out error.
  int selected;         ///< Parameters selected at the chosen penalty.
  double r2_left_out;   ///< Of the chosen fit, about each month's mean.
};

struct Screening {
  std::vector<ScreenedOutput> outputs;
  std::vector<ScreenedParameter> parameters;  ///< In the design's order.

  /// Names of the influential ones, largest share first.
  [[nodiscard]] std::vector<std::string> influential() const;
};

/// Lasso screening of a design, one lasso an output, the union over outputs.
///
/// Rows are runs, the columns every parameter and its square (freed of its straight part), all of
/// unit variance; the responses are the months of the output on its [0, 1] scale, about their means
/// over the runs. A column is selected for all months of an output or for none (`fit_lasso`).
/// Pooled over months as the long form of the seed pools them, a parameter that adds in summer what
/// it saves in winter would vanish; a lasso a month would select by chance in one of twelve.
///
/// The penalty is chosen by cross-validation over runs with the one-standard-error rule, and the
/// selection repeated on half-samples of the runs at that penalty.
///
/// Effects are least squares on the selected columns, for the others the slope of what these leave.
///
/// @param rng  Deals runs into folds and halves.
/// @return the screening, or what `check_design` or the lasso finds.
[[nodiscard]] Result<Screening> screen(const regression::DesignData& design,
                                       const ScreenOptions& options, Rng& rng);

}  // namespace recald::screening
