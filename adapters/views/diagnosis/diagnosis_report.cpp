#include "adapters/views/diagnosis/diagnosis_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "adapters/views/diagnosis/diagnosis_words.hpp"
#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/provenance.hpp"
#include "core/absent.hpp"
#include "core/diagnosis/effect_posterior.hpp"
#include "core/display/id_words.hpp"
#include "core/display/unit.hpp"
#include "core/display/warning.hpp"

namespace recald::views {
namespace {

using diagnosis::Addition;
using diagnosis::Diagnosis;
using diagnosis::ModelGap;
using diagnosis::ParameterPosterior;
using diagnosis::Role;
using diagnosis::SiteProblem;

Provenance diagnosis_provenance(const RunFacts& facts) {
  Provenance from = provenance_of(facts);
  from.catalogue =
      fmt::format("{} effects, of recald {}", diagnosis::catalogue().size(), facts.recald_version);
  from.seed = facts.seed;
  return from;
}

std::vector<EffectParameterRow> rows_of(const SiteProblem& site,
                                        const std::vector<ParameterPosterior>& posterior) {
  std::vector<EffectParameterRow> rows;
  for (const ParameterPosterior& p : posterior) {
    const auto text = [&](double value) {
      if (p.is_day()) return day_words(day_after(site, value));
      const display::Unit unit = display::unit_of(site.units, p.unit);
      return number_text(unit.shown(value)) + (unit.name.empty() ? "" : " " + unit.name);
    };
    std::string name = p.name;
    std::ranges::replace(name, '_', ' ');
    rows.push_back({std::move(name), text(p.mode), text(p.q05), text(p.q95)});
  }
  return rows;
}

AddedEffectCard card_of(const SiteProblem& site, const Addition& addition) {
  const diagnosis::Effect& effect = *addition.candidate.effect;
  AddedEffectCard card{.title = effect_label(site, effect.id, addition.candidate.meter),
                       .meaning = std::string{effect.meaning},
                       .physics = std::string{effect.physics},
                       .when = when_words(site, addition),
                       .probability = addition.probability,
                       .impacts = {},
                       .parameters = rows_of(site, posterior_of(addition))};
  for (std::size_t g = 0; g < addition.monthly_kWh.size(); ++g) {
    card.impacts.push_back(
        {display::meter_label(site.meters[g].id),
         signed_amount_text(addition.monthly_kWh[g],
                            display::unit_of(site.units, "kWh", site.meters[g].utility))});
  }
  return card;
}

/// @param which  Index among the probabilities.
CandidateBar bar_of(const SiteProblem& site, const Diagnosis& d, std::size_t which) {
  const diagnosis::Naming& naming = d.passes.front().naming;
  const diagnosis::NameProbability& p = naming.probabilities[which];
  CandidateBar bar{.label = effect_label(site, p.effect, p.meter),
                   .meaning = {},
                   .kind = CandidateKind::effect,
                   .probability = p.probability,
                   .if_half_lack_nothing = probabilities_at(naming, 0.5)[which],
                   .if_nine_in_ten_lack_nothing = probabilities_at(naming, 0.9)[which],
                   .evidence_gain = kAbsent,
                   .parameters = {}};
  if (p.effect == "none") {
    bar.kind = CandidateKind::none;
    bar.meaning = "Nothing that these meters can show is missing from the model.";
  } else if (p.effect == "unknown") {
    bar.kind = CandidateKind::unknown;
    bar.meaning = "The gap has a pattern that no effect of the catalogue causes.";
  } else if (const diagnosis::Effect* effect = diagnosis::find_effect(p.effect)) {
    bar.meaning = effect->meaning;
  }
  if (p.explanation) {
    const diagnosis::Explanation& e = naming.explanations[*p.explanation];
    bar.evidence_gain = e.evidence_gain;
    bar.parameters = rows_of(site, posterior_of(d.candidates[e.candidate], e.fit));
  }
  return bar;
}

std::vector<SignRow> signs_of(const SiteProblem& site, const Diagnosis& d) {
  std::vector<SignRow> rows;
  for (const diagnosis::NameProbability& p : d.passes.front().naming.probabilities) {
    if (!p.explanation) continue;
    for (const diagnosis::EffectSign& sign : p.signs) {
      rows.push_back({.effect = effect_label(site, p.effect, p.meter),
                      .meter = display::capitalised(std::string{diagnosis::to_string(sign.meter)}),
                      .where = display::capitalised(diagnosis::signature_names()[sign.signature]),
                      .without = sign.without,
                      .with = sign.with});
    }
  }
  return rows;
}

/// A meter without readings in the held-out months has no gap, rather than a gap of zero.
std::vector<diagnosis::MeterGap> where_measured(const SiteProblem& site,
                                                std::vector<diagnosis::MeterGap> gaps) {
  for (std::size_t g = 0; g < gaps.size(); ++g) {
    bool measured = false;
    for (Eigen::Index i = 0; i < site.day_parts.count(); ++i) {
      measured =
          measured || (site.roles[static_cast<std::size_t>(i)] == Role::show &&
                       std::isfinite(site.measured_parts_kW(i, static_cast<Eigen::Index>(g))));
    }
    if (!measured) gaps[g] = {kAbsent, kAbsent, kAbsent, kAbsent, gaps[g].discrepancy_share};
  }
  return gaps;
}

/// The model as drawn, then one step per addition; empty if no month was held out.
std::vector<GapStep> steps_of(const SiteProblem& site, const Diagnosis& d) {
  if (std::ranges::count(site.roles, Role::show) == 0) return {};
  std::vector<GapStep> steps{{"as drawn", where_measured(site, d.passes.front().gaps)}};
  for (std::size_t i = 0; i < d.added.size(); ++i) {
    const diagnosis::Candidate& candidate = d.added[i].candidate;
    const auto& gaps = i + 1 < d.passes.size() ? d.passes[i + 1].gaps : d.gaps;
    steps.push_back({"+ " + effect_label(site, candidate.effect->id, candidate.meter),
                     where_measured(site, gaps)});
  }
  return steps;
}

std::vector<MeterMaps> maps_of(const SiteProblem& site, const Diagnosis& d,
                               const std::vector<double>& limits_C) {
  const Eigen::ArrayXXd before = residual_shares(site, d.passes.front().modelled_kW);
  const Eigen::ArrayXXd after = residual_shares(site, d.modelled_kW);
  const std::size_t months = site.drivers->months.size();
  std::vector<MeterMaps> maps;
  for (std::size_t g = 0; g < site.meters.size(); ++g) {
    const auto column = static_cast<Eigen::Index>(g);
    maps.push_back(
        {.meter = display::meter_label(site.meters[g].id),
         .mean_load = amount_text(measured_mean_kW(site, column),
                                  display::unit_of(site.units, "kW", site.meters[g].utility)),
         .before = residual_map(site.day_parts, before.col(column), months, limits_C),
         .after = {}});
    if (!d.added.empty()) {
      maps.back().after = residual_map(site.day_parts, after.col(column), months, limits_C);
    }
  }
  return maps;
}

std::vector<EffectSignature> signatures_of(const SiteProblem& site, const Diagnosis& d,
                                           const std::vector<double>& limits_C) {
  std::vector<EffectSignature> signatures;
  for (std::size_t i = 0; i < std::min(d.added.size(), d.passes.size()); ++i) {
    const Addition& addition = d.added[i];
    const Eigen::ArrayXXd& old_kW = d.passes[i].modelled_kW;
    const Eigen::ArrayXXd& new_kW =
        i + 1 < d.passes.size() ? d.passes[i + 1].modelled_kW : d.modelled_kW;
    const Eigen::ArrayXXd residual = residual_shares(site, old_kW);
    const Eigen::ArrayXXd change = change_shares(site, new_kW - old_kW);
    const Eigen::ArrayXXd alone = change_shares(site, addition.effect_kW);
    for (std::size_t g = 0; g < site.meters.size(); ++g) {
      const auto column = static_cast<Eigen::Index>(g);
      const auto signature = [&](const Eigen::ArrayXXd& shares) {
        return signature_of(site.day_parts, shares.col(column), limits_C);
      };
      signatures.push_back(
          {.effect = effect_label(site, addition.candidate.effect->id, addition.candidate.meter),
           .meter = display::meter_label(site.meters[g].id),
           .residual = signature(residual),
           .change = signature(change),
           .effect_alone = signature(alone)});
    }
  }
  return signatures;
}

}  // namespace

DiagnosisData diagnosis_report_of(SiteLine line, const Diagnosis& d, const SiteProblem& site,
                                  const RunFacts& facts, std::string generated_at,
                                  const std::vector<ModelGap>& others) {
  OutcomeWords words = outcome_words(d, site, others);
  DiagnosisData data{.title = "Diagnosis of " + line.name,
                     .generated_at = std::move(generated_at),
                     .site = std::move(line),
                     .provenance = diagnosis_provenance(facts),
                     .outcome = d.outcome,
                     .not_confirmed = d.not_confirmed,
                     .headline = std::move(words.headline),
                     .explanations = std::move(words.sentences)};
  for (const display::Warning& warning : d.warnings) {
    data.notices.push_back(notice_of(Severity::warning, warning));
  }
  for (const Addition& addition : d.added) data.added.push_back(card_of(site, addition));
  for (const diagnosis::MeterData& meter : site.meters) {
    data.meters.push_back(display::meter_label(meter.id));
    data.units.push_back(display::meter_units(site.units, meter.utility));
  }
  data.months = site.drivers->months;
  data.uses = site.month_roles;
  const std::vector<double> limits_C = diagnosis::temperature_limits_C(site.day_parts);
  const display::Unit outdoor = display::unit_of(site.units, "degC");
  data.temperature_unit = outdoor.name;
  for (const double limit_C : limits_C) data.temperature_limits.push_back(outdoor.shown(limit_C));
  data.maps = maps_of(site, d, limits_C);
  data.located = d.passes.front().located;
  if (!d.added.empty() && d.passes.size() > 1) {
    data.located_after = d.passes.back().located;
  }
  for (std::size_t i = 0; i < d.passes.front().naming.probabilities.size(); ++i) {
    data.candidates.push_back(bar_of(site, d, i));
  }
  data.signs = signs_of(site, d);
  data.separations = separations_of(d, site);
  data.steps = steps_of(site, d);
  data.other_gaps = others;
  for (ModelGap& gap : data.other_gaps) {
    for (std::string& output : gap.outputs) {
      output = display::capitalised(display::output_words(output));
    }
  }
  data.signatures = signatures_of(site, d, limits_C);
  data.base_fit = d.base_fit;
  for (const diagnosis::NotIdentifiable& n : not_seen_here(d)) {
    data.not_identifiable.push_back({effect_label(site, n.effect, -1), n.why});
  }
  return data;
}

}  // namespace recald::views
