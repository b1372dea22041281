/// The effects of the version in force, ready to be applied to a monthly or an hourly model.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/diagnosis/evidence/monthly_effect.hpp"
#include "core/diagnosis/evidence/site_problem.hpp"
#include "core/diagnosis/model_version.hpp"
#include "core/model/parameter_library.hpp"
#include "core/result.hpp"

namespace recald::diagnosis {

/// An effect parameter in a calibration, together with the text it refers to.
struct EffectParameterLabel {
  std::string name;
  std::string unit;
  std::string label;
  model::ParameterDefinition definition;  ///< Built from the three above; not a building parameter.
};

/// All effects of one version, in the order of addition. η is (r): the parameters of the first
/// effect, then those of the second …
struct ModelEffects {
  std::shared_ptr<const SiteProblem> site;  ///< As a diagnosis of it would build it.
  std::vector<AddedEffect> added;
  std::vector<Candidate> candidates;  ///< Of `added`.
  std::vector<Parameter> parameters;  ///< (r) priors are fitted to what is known of η.
  Eigen::MatrixXd draws;  ///< (draws x r) of the posteriors; days from the site's origin.
  std::vector<std::shared_ptr<const EffectParameterLabel>> labels;  ///< (r)

  [[nodiscard]] std::vector<double> mean() const;  ///< (r) of the draws.

  /// The alterations of an hourly run, in order. @param eta  (r) in the supports of the priors
  [[nodiscard]] std::vector<std::shared_ptr<const model::hourly::Alteration>> alterations(
      std::span<const double> eta) const;

  /// The additions to a monthly model, over the range of the draws and of the priors of
  /// `parameters`: for all months of `site`, each effect on top of the earlier ones at their means.
  /// @param theta  Of the monthly model; the first parameters of `site`.
  [[nodiscard]] std::vector<MonthlyEffect> monthly(std::span<const Parameter> theta) const;
};

/// @param added  Not empty.
/// @return the effects; or
///         unsupported      the catalogue has no such effect, or not with these parameters; the
///                          site does not model its meter; it counts days from months outside
///                          the site's period;
///         not_enough_data  no draws.
[[nodiscard]] Result<ModelEffects> make_model_effects(std::vector<AddedEffect> added,
                                                      std::shared_ptr<const SiteProblem> site);

/// The hourly model with η among its parameters: θ of the site, then η. A change of η binds the
/// effects again, which allocates but costs little compared with a run.
class AlteredHourlyModel final : public MonthlyModel {
 public:
  /// Makes a model of some months with these alterations.
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
  std::vector<std::shared_ptr<Slot>> slots_;  ///< The model reads its effects from these.
  std::vector<double> eta_;                   ///< The values that the slots are bound to.
  std::unique_ptr<MonthlyModel> model_;
};

}  // namespace recald::diagnosis
