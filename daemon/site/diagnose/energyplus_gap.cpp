#include "daemon/site/diagnose/energyplus_gap.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/model/metamodel/builders.hpp"
#include "core/model/model_adaptors.hpp"
#include "daemon/site/calibrate/site_on_runs.hpp"
#include "daemon/site/diagnose/held_figures.hpp"

namespace recald::daemon {
namespace {

/// Values of the effects' parameters, in the order in which the model has them.
struct EffectValues {
  std::vector<double> neutral;  ///< A shape has none: where it was found.
  std::vector<double> found;
};

EffectValues values_of(std::span<const diagnosis::Addition> added) {
  EffectValues values;
  for (const diagnosis::Addition& addition : added) {
    for (std::size_t j = 0; j < addition.eta.size(); ++j) {
      const diagnosis::EffectParameter& parameter = addition.candidate.parameters[j];
      if (parameter.unit == "day") continue;
      values.found.push_back(addition.eta[j]);
      values.neutral.push_back(std::isfinite(parameter.neutral) ? parameter.neutral
                                                                : addition.eta[j]);
    }
  }
  return values;
}

}  // namespace

Result<diagnosis::MonthlyVote> energyplus_gap(const ModelledSite& on_runs,
                                              const diagnosis::SiteProblem& problem,
                                              std::span<const diagnosis::Addition> added,
                                              std::uint64_t seed) {
  const SiteConfig& site = on_runs.site.config;
  const auto prepared =
      TRY(prepare_on_runs(site, on_runs.site.calendar, on_runs.recording, on_runs.weather));
  const std::vector<Parameter>& all = prepared.so_far.design->folder.parameters;
  const EffectValues effects = values_of(added);
  const std::size_t own = all.size() - effects.found.size();
  std::vector<int> free;
  std::vector<Parameter> fitted;
  std::vector<double> neutral;
  std::vector<double> found;
  for (std::size_t j = 0; j < all.size(); ++j) {
    const bool is_effect = j >= own;
    neutral.push_back(is_effect ? effects.neutral[j - own] : all[j].prior.mean());
    found.push_back(is_effect ? effects.found[j - own] : all[j].prior.mean());
    const bool is_influential =
        std::ranges::find(prepared.so_far.parameters, all[j].name, &Parameter::name) !=
        prepared.so_far.parameters.end();
    if (is_effect || !is_influential) continue;
    free.push_back(static_cast<int>(j));
    fitted.push_back(all[j]);
  }
  const diagnosis::MonthlyFigures measured = held_figures(site, on_runs.recording, problem);
  TRY(diagnosis::require_enough(measured, fitted.size()));
  std::vector<std::string> months;
  for (const metering::Month month : problem.drivers->months) {
    months.push_back(metering::to_string(month));
  }
  const auto made = TRY(model::metamodel::model_of(*prepared.so_far.design->fitted.monthly_form,
                                                   std::span<const std::string>{months}));
  FixedParametersModel before{made.clone(), std::move(neutral), free};
  FixedParametersModel after{made.clone(), std::move(found), free};
  auto vote = diagnosis::monthly_vote(before, after, fitted, measured, seed);
  vote.gap.model = ModelKind::energyplus;
  return vote;
}

}  // namespace recald::daemon
