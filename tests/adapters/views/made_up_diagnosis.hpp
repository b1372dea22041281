/// A site of two meters and diagnoses of it that no model has computed: what files, words and the
/// page make of a diagnosis, not how it is found.
#pragma once

#include <memory>

#include "core/diagnosis/diagnose.hpp"
#include "tests/support/sample_building.hpp"

namespace recald::testing {

/// Eight months from January 2021; the last two are kept back, the fourth is to choose by.
inline diagnosis::SiteProblem made_up_site() {
  using diagnosis::Role;
  diagnosis::SiteProblem site;
  site.nominal = sample_building();
  site.parameters.push_back(
      *model::make_parameter(**model::find_parameter("cooling_setpoint"), site.nominal));
  site.drivers = std::make_shared<const model::Drivers>(sample_drivers(site.nominal, 8));
  for (const auto& [id, utility] : {std::pair{"chilled_water", metering::Utility::chilled_water},
                                    std::pair{"steam", metering::Utility::steam}}) {
    site.meters.push_back({id, utility, *model::default_meter_map(utility)});
  }
  site.day_parts = diagnosis::make_day_parts(*site.drivers);
  site.measured_parts_kW = Eigen::ArrayXXd::Constant(site.day_parts.count(), 2, 100.0);
  site.month_roles = {Role::fit, Role::fit, Role::fit,  Role::select,
                      Role::fit, Role::fit, Role::show, Role::show};
  for (const diagnosis::DayPart& part : site.day_parts.parts) {
    site.roles.push_back(site.month_roles[static_cast<std::size_t>(part.month)]);
  }
  return site;
}

/// The candidate of an effect of the whole building, with a first day if it is to begin.
inline diagnosis::Candidate candidate_of(const diagnosis::SiteProblem& site, const char* id,
                                         bool begins = false) {
  diagnosis::Candidate candidate;
  candidate.effect = diagnosis::find_effect(id);
  candidate.begins = begins;
  candidate.parameters = candidate.effect->parameters(site.facts());
  if (begins) {
    candidate.parameters.push_back({.name = "first_day",
                                    .unit = "day",
                                    .prior = UniformPrior{.min = 0.0, .max = 240.0},
                                    .neutral = std::nan("")});
  }
  return candidate;
}

/// Fitted at score 0.5 with a posterior sd of 0.2 in every score.
inline diagnosis::Explanation explanation_of(const std::vector<diagnosis::Candidate>& candidates,
                                             std::size_t index) {
  const diagnosis::Candidate& candidate = candidates[index];
  const auto n = 1 + static_cast<Eigen::Index>(candidate.parameters.size());
  diagnosis::Explanation e{};
  e.candidate = index;
  e.fit.scores = Eigen::VectorXd::Constant(n, 0.5);
  e.fit.posterior.covariance = 0.04 * Eigen::MatrixXd::Identity(n, n);
  for (const diagnosis::EffectParameter& p : candidate.parameters) {
    e.fit.eta.push_back(p.prior.at_score(0.5).value);
  }
  e.evidence_gain = 30.0;
  e.selected = {12.0, 3.0};
  return e;
}

inline diagnosis::Pass pass_of(const diagnosis::SiteProblem& site, double modelled_kW,
                               double cvrmse_daily) {
  diagnosis::Pass pass;
  pass.modelled_kW = Eigen::ArrayXXd::Constant(site.day_parts.count(), 2, modelled_kW);
  pass.gaps.assign(2, {0.01, cvrmse_daily, 0.05, -100.0, 0.4});
  return pass;
}

/// Two candidates were weighed, a steam leak since a day and a server room; nothing was named.
inline diagnosis::Diagnosis nothing_named(const diagnosis::SiteProblem& site) {
  diagnosis::Diagnosis d;
  d.candidates = {candidate_of(site, "steam_trap_leak", true), candidate_of(site, "server_room")};
  d.not_identifiable = {{"wind_infiltration", "the weather record has no wind"}};
  d.why = "no effect is supported strongly enough";
  diagnosis::Pass pass = pass_of(site, 90.0, 0.14);
  pass.located = {
      {1, "kind of day and hours", "working days 00-04 h", 0.14, 0.03, 2100.0, 6.0, 0.01}};
  pass.naming.why = d.why;
  pass.naming.explanations = {explanation_of(d.candidates, 0), explanation_of(d.candidates, 1)};
  pass.naming.probabilities = {{"none", -1, 0.5, {}},
                               {"steam_trap_leak", -1, 0.3, 0},
                               {"server_room", -1, 0.15, 1},
                               {"unknown", -1, 0.05, {}}};
  d.modelled_kW = pass.modelled_kW;
  d.gaps = pass.gaps;
  d.base_fit = pass.gaps;
  d.passes.push_back(std::move(pass));
  return d;
}

/// The steam leak was named and added, and the months kept back confirm it.
inline diagnosis::Diagnosis one_named(const diagnosis::SiteProblem& site) {
  diagnosis::Diagnosis d = nothing_named(site);
  d.outcome = diagnosis::Outcome::named;
  d.why = d.passes.front().naming.why =
      "one effect explains the gap better than all others together";
  diagnosis::Addition leak{.candidate = d.candidates[0],
                           .eta = {4.0, 59.0},
                           .eta_sd = {0.5, 3.0},
                           .draws = {},
                           .probability = 0.93,
                           .evidence_gain = 30.0,
                           .monthly_kWh = {0.4, 2920.0},
                           .effect_kW = Eigen::ArrayXXd::Zero(site.day_parts.count(), 2)};
  for (int i = 0; i <= 100; ++i) leak.draws.push_back({3.0 + 0.02 * i, 54.0 + 0.1 * i});
  leak.effect_kW.col(1) = 4.0;
  d.added.push_back(leak);
  d.passes.push_back(pass_of(site, 96.0, 0.08));
  d.modelled_kW = d.passes.back().modelled_kW;
  d.gaps = d.passes.back().gaps;
  d.gap = diagnosis::GapChange{.before = d.passes.front().gaps,
                               .after = d.gaps,
                               .log_score_change = {{1.0, 2.0}, {40.0, 5.0}},
                               .confirmed = true};
  return d;
}

/// The same, and the months kept back say no.
inline diagnosis::Diagnosis one_taken_back(const diagnosis::SiteProblem& site) {
  diagnosis::Diagnosis d = one_named(site);
  d.outcome = diagnosis::Outcome::unknown;
  d.why =
      "what was named does not improve the prediction of the held-out months, so it was withdrawn";
  d.not_confirmed = true;
  d.gap->confirmed = false;
  return d;
}

}  // namespace recald::testing
