/// The effects of the version in force, ready to be put into a monthly or an hourly model.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/diagnosis/model_version.hpp"
#include "core/diagnosis/monthly_effect.hpp"
#include "core/diagnosis/site_problem.hpp"
#include "core/model/parameter_library.hpp"
#include "core/result.hpp"

namespace recald::daemon {

/// An effect parameter among those of a calibration, with all that its words point to.
struct EffectParameterLabel {
  std::string name;
  std::string unit;
  std::string label;
  model::ParameterDefinition definition;  ///< Of the three above; no building has it.
};

/// All effects of one version, in the order of addition. η is (r): the parameters of the first
/// effect, then those of the second …
struct ModelEffects {
  std::shared_ptr<const diagnosis::SiteProblem> site;  ///< As a diagnosis of it sees it.
  std::vector<diagnosis::AddedEffect> added;
  std::vector<diagnosis::Candidate> candidates;  ///< Of `added`.
  std::vector<Parameter> parameters;             ///< (r) with what is known of η as priors.
  Eigen::MatrixXd draws;                         ///< (draws x r) of the posteriors; days as here.
  std::vector<std::shared_ptr<const EffectParameterLabel>> labels;  ///< (r)

  [[nodiscard]] std::vector<double> mean() const;  ///< (r) of the draws.

  /// What an hourly run applies, in order. @param eta  (r) in the supports of the priors
  [[nodiscard]] std::vector<std::shared_ptr<const model::hourly::Alteration>> alterations(
      std::span<const double> eta) const;

  /// What a monthly model adds, over the range of the draws and of `parameters`' priors: all months
  /// of `site`, each effect on top of those before it at their means.
  /// @param theta  Of the monthly model; the first parameters of `site`.
  [[nodiscard]] std::vector<diagnosis::MonthlyEffect> monthly(
      std::span<const Parameter> theta) const;
};

/// @param added  Not empty.
/// @return the effects; or
///         unsupported      the catalogue has no such effect, or not with these parameters; the
///                          site does not model its meter; it counts days from months that the
///                          site's period no longer has;
///         not_enough_data  no draws.
[[nodiscard]] Result<ModelEffects> make_model_effects(
    std::vector<diagnosis::AddedEffect> added, std::shared_ptr<const diagnosis::SiteProblem> site);

/// The hourly model with η among its parameters: θ of the site, then η. A change of η binds the
/// effects anew, which allocates and is small beside a run.
class AlteredHourlyModel final : public MonthlyModel {
 public:
  /// Makes the model of some months that applies these alterations.
  using Factory = std::function<std::unique_ptr<MonthlyModel>(
      std::vector<std::shared_ptr<const model::hourly::Alteration>>)>;

  AlteredHourlyModel(Factory make, std::shared_ptr<const ModelEffects> effects);
  ~AlteredHourlyModel() override;

  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override;
  [[nodiscard]] int parameter_count() const override;
  [[nodiscard]] int output_count() const override { return model_->output_count(); }
  [[nodiscard]] int month_count() const override { return model_->month_count(); }
  void evaluate(std::span<const double> theta_and_eta, std::span<double> outputs) override;

 private:
  class Slot;

  void bind(std::span<const double> eta);

  Factory make_;
  std::shared_ptr<const ModelEffects> effects_;
  std::vector<std::shared_ptr<Slot>> slots_;  ///< In which the model finds the effects.
  std::vector<double> eta_;                   ///< Those of the slots.
  std::unique_ptr<MonthlyModel> model_;
};

}  // namespace recald::daemon
