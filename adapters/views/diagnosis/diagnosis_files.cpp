#include "adapters/views/diagnosis/diagnosis_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "adapters/results/job_result_json.hpp"
#include "adapters/shapes/shape_json.hpp"
#include "adapters/views/diagnosis/diagnosis_words.hpp"
#include "core/diagnosis/effect_posterior.hpp"
#include "core/display/warning.hpp"

SHAPE(recald::diagnosis::ParameterPosterior, name, unit, mode, sd, q05, q50, q95);
SHAPE(recald::diagnosis::ScoreGain, sum, se);
SHAPE(recald::diagnosis::NotIdentifiable, effect, why);
SHAPE(recald::diagnosis::ModelGap::Figures, nmbe_sim_minus_meas, cvrmse, discrepancy_share,
      log_score);

namespace recald::views {
namespace {

using diagnosis::Addition;
using diagnosis::Candidate;
using diagnosis::ChangeInterval;
using diagnosis::Diagnosis;
using diagnosis::ModelGap;
using diagnosis::ParameterPosterior;
using diagnosis::SiteProblem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kFindingsShown = 40;

std::string meter_name(const SiteProblem& site, int meter) {
  return meter < 0 ? std::string{} : site.meters[static_cast<std::size_t>(meter)].id;
}

Json located_json(const SiteProblem& site, const std::vector<diagnosis::Misfit>& findings) {
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(findings.size(), kFindingsShown); ++i) {
    const diagnosis::Misfit& f = findings[i];
    list.push_back({{"meter", site.meters[f.meter].id},
                    {"by", f.family},
                    {"where", f.words},
                    {"share", results::number(f.share)},
                    {"share_se", results::number(f.share_se)},
                    {"kWh_month", results::number(f.kWh_month)},
                    {"t", results::number(f.statistic)},
                    {"adjusted_p", results::number(f.adjusted_p)}});
  }
  return list;
}

/// Days are written as the dates that people read, too.
Json parameters_json(const SiteProblem& site, const std::vector<ParameterPosterior>& posterior) {
  Json list = Json::array();
  for (const ParameterPosterior& p : posterior) {
    Json entry = shapes::json_of(p);
    if (p.is_day()) {
      const auto date = [&](double days) { return metering::to_string(day_after(site, days)); };
      entry["date"] = date(p.mode);
      entry["date_q05"] = date(p.q05);
      entry["date_q95"] = date(p.q95);
    }
    list.push_back(std::move(entry));
  }
  return list;
}

void add_explanation(const SiteProblem& site, const Diagnosis& d, const diagnosis::Explanation& e,
                     Json& entry) {
  const Candidate& candidate = d.candidates[e.candidate];
  entry["key"] = candidate.key(site);
  entry["title"] = candidate.effect->title;
  entry["parameters"] = parameters_json(site, posterior_of(candidate, e.fit));
  entry["evidence_gain"] = results::number(e.evidence_gain);
  entry["selected_gain"] = results::number(e.selected.sum);
  entry["selected_se"] = results::number(e.selected.se);
  if (!e.objection.empty()) entry["objection"] = e.objection;
  entry["at_truncation"] = e.at_truncation;
  Json confusable = Json::array();
  Json separated = Json::array();
  for (const diagnosis::Confusable& c : candidate.effect->confusable) {
    confusable.push_back(c.effect);
    separated.push_back(c.separated_by);
  }
  entry["confusable_with"] = confusable;
  entry["separated_by"] = separated;
}

Json signs_json(const std::vector<diagnosis::EffectSign>& signs) {
  Json list = Json::array();
  for (const diagnosis::EffectSign& sign : signs) {
    list.push_back({{"meter", to_string(sign.meter)},
                    {"signature", diagnosis::signature_names()[sign.signature]},
                    {"without", results::number(sign.without)},
                    {"with", results::number(sign.with)}});
  }
  return list;
}

/// Of the first search: there all rivals started from the model as drawn.
Json candidates_json(const SiteProblem& site, const Diagnosis& d) {
  const diagnosis::Naming& naming = d.passes.front().naming;
  const std::vector<double> even = probabilities_at(naming, 0.5);
  const std::vector<double> rare = probabilities_at(naming, 0.9);
  Json list = Json::array();
  for (std::size_t i = 0; i < naming.probabilities.size(); ++i) {
    const diagnosis::NameProbability& p = naming.probabilities[i];
    Json entry = {{"effect", p.effect},
                  {"probability", results::number(p.probability)},
                  {"probability_at_prior_none",
                   {{"0.5", results::number(even[i])}, {"0.9", results::number(rare[i])}}}};
    if (p.meter >= 0) entry["meter"] = meter_name(site, p.meter);
    if (!p.signs.empty()) entry["signs"] = signs_json(p.signs);
    if (p.explanation) add_explanation(site, d, naming.explanations[*p.explanation], entry);
    list.push_back(std::move(entry));
  }
  return list;
}

Json base_parameters_json(const SiteProblem& site,
                          const std::vector<diagnosis::ParameterBelief>& beliefs) {
  Json list = Json::array();
  for (std::size_t j = 0; j < beliefs.size(); ++j) {
    list.push_back({{"name", site.parameters[j].name},
                    {"unit", site.parameters[j].unit},
                    {"mode", results::number(beliefs[j].mode)},
                    {"q05", results::number(beliefs[j].q05)},
                    {"q95", results::number(beliefs[j].q95)}});
  }
  return list;
}

Json gaps_json(const SiteProblem& site, const std::vector<diagnosis::MeterGap>& gaps) {
  Json json = Json::object();
  for (std::size_t g = 0; g < gaps.size(); ++g) {
    json[site.meters[g].id] = {
        {"nmbe_sim_minus_meas", results::number(gaps[g].nmbe_sim_minus_meas)},
        {"cvrmse", results::number(gaps[g].cvrmse_monthly)},
        {"cvrmse_daily", results::number(gaps[g].cvrmse_daily)},
        {"discrepancy_share", results::number(gaps[g].discrepancy_share)},
        {"log_score", results::number(gaps[g].log_score)}};
  }
  return json;
}

/// By meter.
Json gains_json(const SiteProblem& site, const std::vector<diagnosis::ScoreGain>& gains) {
  Json json = Json::object();
  for (std::size_t g = 0; g < gains.size(); ++g)
    json[site.meters[g].id] = shapes::json_of(gains[g]);
  return json;
}

Json hourly_gap_json(const SiteProblem& site, const diagnosis::GapChange& gap) {
  return {{"before", gaps_json(site, gap.before)},
          {"after", gaps_json(site, gap.after)},
          {"log_score_change", gains_json(site, gap.log_score_change)},
          {"log_error_cut", gains_json(site, gap.error_cut)},
          {"confirmed", gap.confirmed}};
}

Json figures_json(const ModelGap& gap, const std::vector<ModelGap::Figures>& figures) {
  Json json = Json::object();
  for (std::size_t i = 0; i < figures.size(); ++i) {
    json[gap.outputs[i]] = shapes::json_of(figures[i]);
  }
  return json;
}

Json change_json(const ModelGap& gap) {
  const auto interval = [](const ChangeInterval& change) {
    return Json{{"q05", results::number(change.low)}, {"q95", results::number(change.high)}};
  };
  Json json = Json::object();
  for (std::size_t i = 0; i < gap.change.size(); ++i) {
    const ModelGap::Change& change = gap.change[i];
    json[gap.outputs[i]] = {{"log_score", shapes::json_of(change.log_score)},
                            {"nmbe_size", interval(change.nmbe_size)},
                            {"cvrmse", interval(change.cvrmse)}};
  }
  return json;
}

/// One entry per model; null if nothing was added or no month was held out.
Json gap_json(const SiteProblem& site, const Diagnosis& d, const std::vector<ModelGap>& others) {
  Json json = Json::object();
  if (d.gap) json["hourly"] = hourly_gap_json(site, *d.gap);
  for (const ModelGap& gap : others) {
    json[std::string{name_of(gap.model)}] = {{"before", figures_json(gap, gap.before)},
                                             {"after", figures_json(gap, gap.after)},
                                             {"change", change_json(gap)}};
  }
  return json.empty() ? Json(nullptr) : json;
}

/// Ids of what is in the model now, in the order of their addition.
Json added_json(const Diagnosis& d) {
  Json list = Json::array();
  if (d.not_confirmed) return list;
  for (const Addition& addition : d.added) list.push_back(addition.candidate.effect->id);
  return list;
}

Json additions_json(const SiteProblem& site, const Diagnosis& d) {
  Json list = Json::array();
  for (const Addition& addition : d.added) {
    Json impact = Json::object();
    for (std::size_t g = 0; g < addition.monthly_kWh.size(); ++g) {
      impact[site.meters[g].id] = results::number(addition.monthly_kWh[g]);
    }
    Json entry = {{"effect", addition.candidate.effect->id},
                  {"key", addition.candidate.key(site)},
                  {"title", addition.candidate.effect->title},
                  {"meaning", addition.candidate.effect->meaning},
                  {"meter", meter_name(site, addition.candidate.meter)},
                  {"status", d.not_confirmed ? "tried and withdrawn" : "added"},
                  {"when", when_words(site, addition)},
                  {"probability", results::number(addition.probability)},
                  {"evidence_gain", results::number(addition.evidence_gain)},
                  {"parameters", parameters_json(site, posterior_of(addition))},
                  {"monthly_kWh", impact}};
    list.push_back(std::move(entry));
  }
  return list;
}

Json not_identifiable_json(const Diagnosis& d) { return shapes::json_of(not_seen_here(d)); }

}  // namespace

std::string diagnosis_json(const Diagnosis& d, const SiteProblem& site, const RunFacts& facts,
                           const std::vector<ModelGap>& others) {
  const diagnosis::Pass& first = d.passes.front();
  Json json = {{"outcome", to_string(d.outcome)},
               {"why", d.why},
               {"most_likely", most_likely_words(d, site)},
               {"not_confirmed", d.not_confirmed},
               {"located", located_json(site, first.located)},
               {"prior_none", results::number(first.naming.prior_none)},
               {"candidates", candidates_json(site, d)},
               {"confusable", first.naming.confusable},
               {"added", added_json(d)},
               {"additions", additions_json(site, d)},
               {"parameters_before", base_parameters_json(site, d.parameters_before)},
               {"parameters_after", base_parameters_json(site, d.parameters_after)},
               {"base_fit", gaps_json(site, d.base_fit)},
               {"held_fit", gaps_json(site, d.passes.front().gaps)},
               {"gap", gap_json(site, d, others)},
               {"not_identifiable_here", not_identifiable_json(d)},
               {"warnings", display::texts_of(d.warnings)},
               {"model_runs", d.model_runs},
               {"seed", facts.seed},
               {"recald_version", facts.recald_version},
               {"data_revision", facts.data_revision},
               {"weather_values", facts.weather_values},
               {"weather", results::weather_json(facts.weather)},
               {"weather_assumed", facts.weather_assumed},
               {"model_version", facts.model_version},
               {"wall_s", facts.wall_s}};
  if (!d.added.empty()) json["located_after"] = located_json(site, d.passes.back().located);
  // Bytes of a name that are not UTF-8 become U+FFFD instead of an exception.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace recald::views
