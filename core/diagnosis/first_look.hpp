/// A first look at every candidate: how visible it is here, and how strongly the residuals support
/// it.
///
/// Linear: one run of the model per shape, with the base parameters only integrated out, not
/// refitted. Decides which candidates are worth a fit where signatures do not, and which cannot be
/// distinguished or seen.
#pragma once

#include <vector>

#include "core/diagnosis/joint_fit.hpp"
#include "core/random/rng.hpp"

namespace recald::diagnosis {

/// A candidate with one choice of shapes and days.
struct Look {
  std::size_t candidate;       ///< Index into the list.
  std::vector<double> values;  ///< Of all its parameters; amounts are typical.
  double detectability = 0.0;  ///< d of the typical amount.
  double score = 0.0;          ///< z
  AmountPrior prior;           ///< Of the factor on the typical amount.
  double log_bayes_factor = 0.0;
};

struct CandidateLook {
  Look best;                ///< The shape that fits the residuals best.
  double log_bayes_factor;  ///< Averaged over the shapes tried.
  double most_detectable;   ///< Largest d over the shapes.
  bool visible;             ///< d reaches at least 3: its residuals show it at this site.
};

struct FirstLook {
  std::vector<CandidateLook> candidates;  ///< In order of the list.
  Eigen::MatrixXd confusability;          ///< kappa of the best shapes.
  double null_threshold;                  ///< c_99 of the largest log Bayes factor without effect.
};

inline constexpr double kLeastDetectability = 3.0;

/// @param none  The base model at its mode.
[[nodiscard]] Result<FirstLook> look_at(Predictor& predictor, const FitContext& context,
                                        const JointFit& none,
                                        const std::vector<Candidate>& candidates, Rng& rng);

}  // namespace recald::diagnosis
