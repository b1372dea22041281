#include "daemon/site/diagnose/epc_gap.hpp"

#include <numeric>
#include <utility>

#include "core/diagnosis/evidence/monthly_effect.hpp"
#include "core/model/model_adaptors.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"
#include "daemon/site/diagnose/held_figures.hpp"
#include "daemon/site/model/site_model.hpp"
#include "daemon/site/model/site_parts.hpp"

namespace recald::daemon {
namespace {

using diagnosis::MonthlyFigures;
using metering::Month;

/// The effects at their modes, one on top of the other.
std::vector<diagnosis::MonthlyEffect> at_modes(const diagnosis::SiteProblem& problem,
                                               std::span<const diagnosis::Addition> added,
                                               std::span<const Parameter> theta) {
  std::vector<diagnosis::MonthlyEffect> effects;
  std::vector<std::shared_ptr<const model::hourly::Alteration>> before;
  for (const diagnosis::Addition& addition : added) {
    std::vector<diagnosis::ParameterRange> modes;
    for (const double eta : addition.eta) modes.push_back({eta, eta});
    effects.push_back(diagnosis::tabulate_effect(problem, before, addition.candidate, modes,
                                                 diagnosis::spreads_of(theta)));
    before.push_back(diagnosis::alteration_of(addition.candidate, problem.facts(), addition.eta));
  }
  return effects;
}

/// The model of all months with the effects where they were named; θ alone is left free.
FixedParametersModel with_effects(std::unique_ptr<MonthlyModel> epc,
                                  std::vector<diagnosis::MonthlyEffect> effects,
                                  std::span<const diagnosis::Addition> added) {
  std::vector<int> free(static_cast<std::size_t>(epc->parameter_count()));
  std::iota(free.begin(), free.end(), 0);
  std::vector<double> values(free.size());
  for (const diagnosis::Addition& addition : added) {
    values.insert(values.end(), addition.eta.begin(), addition.eta.end());
  }
  return {std::make_unique<diagnosis::AlteredMonthlyModel>(std::move(epc), std::move(effects)),
          std::move(values), std::move(free)};
}

}  // namespace

Result<diagnosis::MonthlyVote> epc_gap(const SiteConfig& as_configured,
                                       const metering::LocalCalendar& calendar,
                                       const Recording& recording, const SiteWeather& weather,
                                       const diagnosis::SiteProblem& problem,
                                       std::span<const diagnosis::Addition> added,
                                       std::uint64_t seed) {
  SiteConfig site = as_configured;
  site.model->kind = ModelKind::epc;
  const MonthlyFigures measured = held_figures(site, recording, problem);
  const auto parameters = TRY(site_parameters(site));
  TRY(diagnosis::require_enough(measured, parameters.size()));
  const auto maps = TRY(meter_maps(site));
  const std::vector<Month>& months = problem.drivers->months;
  std::vector<Month> fitted;
  for (const std::size_t i : measured.fitted) fitted.push_back(months[i]);
  const model::epc::Place place{calendar, site.holidays, *site.location, weather.filled.series};
  // Of the fitted months alone, or the months shown would tell their own electricity.
  auto profile = TRY(fit_site_profile(site, recording, place, fitted));
  profile.loads.month_factor.fill(1.0);
  const auto make =
      TRY(model_of(site, {definitions_of(parameters), maps, profile.loads, {}, {}}, months, place));

  const auto plain = make(*site.building);
  auto altered = with_effects(make(*site.building), at_modes(problem, added, parameters), added);
  auto vote = diagnosis::monthly_vote(*plain, altered, parameters, measured, seed);
  vote.gap.model = ModelKind::epc;
  return vote;
}

}  // namespace recald::daemon
