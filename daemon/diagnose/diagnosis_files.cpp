#include "daemon/diagnose/diagnosis_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace recald::daemon {
namespace {

using diagnosis::Addition;
using diagnosis::Candidate;
using diagnosis::Diagnosis;
using diagnosis::SiteProblem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kFindingsShown = 40;
constexpr std::size_t kFindingsInWords = 5;
constexpr std::size_t kCandidatesInWords = 5;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string meter_name(const SiteProblem& site, int meter) {
  return meter < 0 ? std::string{} : site.meters[static_cast<std::size_t>(meter)].id;
}

Json located_json(const SiteProblem& site, const std::vector<diagnosis::Finding>& findings) {
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(findings.size(), kFindingsShown); ++i) {
    const diagnosis::Finding& f = findings[i];
    list.push_back({{"meter", site.meters[f.meter].id},
                    {"by", f.family},
                    {"where", f.words},
                    {"share", number(f.share)},
                    {"share_se", number(f.share_se)},
                    {"kWh_month", number(f.kWh_month)},
                    {"t", number(f.statistic)},
                    {"adjusted_p", number(f.adjusted_p)}});
  }
  return list;
}

/// Day parameters count from the first day of the record; people read dates.
std::string date_of(const SiteProblem& site, double day) {
  const std::chrono::sys_days first{site.drivers->hours.front().date};
  return metering::to_string(
      metering::Day{first + std::chrono::days{static_cast<int>(std::lround(day))}});
}

Json parameters_json(const SiteProblem& site, const Candidate& candidate,
                     const std::vector<double>& values) {
  Json list = Json::array();
  for (std::size_t j = 0; j < candidate.parameters.size(); ++j) {
    const diagnosis::EffectParameter& p = candidate.parameters[j];
    Json entry = {{"name", p.name}, {"unit", p.unit}, {"mode", number(values[j])}};
    if (p.unit == "day") entry["date"] = date_of(site, values[j]);
    list.push_back(std::move(entry));
  }
  return list;
}

Json candidates_json(const SiteProblem& site, const Diagnosis& d) {
  // Of the last pass, whose rivals all had the same model to start from.
  const diagnosis::Naming& naming = d.passes.front().naming;
  Json list = Json::array();
  for (const diagnosis::NameProbability& p : naming.probabilities) {
    Json entry = {{"effect", p.effect}, {"probability", p.probability}};
    if (p.meter >= 0) entry["meter"] = meter_name(site, p.meter);
    if (p.explanation) {
      const diagnosis::Explanation& e = naming.explanations[*p.explanation];
      const diagnosis::Effect* effect = diagnosis::find_effect(p.effect);
      entry["title"] = effect->title;
      entry["evidence_gain"] = number(e.evidence_gain);
      entry["first_look"] = number(e.first_look);
      entry["selected_gain"] = number(e.selected_gain);
      entry["selected_se"] = number(e.selected_se);
      Json confusable = Json::array();
      Json separated = Json::array();
      for (const diagnosis::Confusable& c : effect->confusable) {
        confusable.push_back(c.effect);
        separated.push_back(c.separated_by);
      }
      entry["confusable_with"] = confusable;
      entry["separated_by"] = separated;
    }
    list.push_back(std::move(entry));
  }
  return list;
}

Json gaps_json(const SiteProblem& site, const std::vector<diagnosis::MeterGap>& gaps) {
  Json json = Json::object();
  for (std::size_t g = 0; g < gaps.size(); ++g) {
    json[site.meters[g].id] = {{"nmbe_sim_minus_meas", number(gaps[g].nmbe_sim_minus_meas)},
                               {"cvrmse", number(gaps[g].cvrmse_monthly)},
                               {"cvrmse_daily", number(gaps[g].cvrmse_daily)},
                               {"discrepancy_share", number(gaps[g].discrepancy_share)},
                               {"log_score", number(gaps[g].log_score)}};
  }
  return json;
}

Json gap_json(const SiteProblem& site, const diagnosis::GapChange& gap) {
  Json change = Json::object();
  for (std::size_t g = 0; g < gap.log_score_change.size(); ++g) {
    change[site.meters[g].id] = {{"sum", number(gap.log_score_change[g].sum)},
                                 {"se", number(gap.log_score_change[g].se)}};
  }
  return {{"hourly",
           {{"before", gaps_json(site, gap.before)},
            {"after", gaps_json(site, gap.after)},
            {"log_score_change", change},
            {"confirmed", gap.confirmed}}}};
}

Json added_json(const SiteProblem& site, const Diagnosis& d) {
  Json list = Json::array();
  for (const Addition& addition : d.added) list.push_back(addition.candidate.key(site));
  return list;
}

Json additions_json(const SiteProblem& site, const Diagnosis& d) {
  Json list = Json::array();
  for (const Addition& addition : d.added) {
    Json impact = Json::object();
    for (std::size_t g = 0; g < addition.monthly_kWh.size(); ++g) {
      impact[site.meters[g].id] = number(addition.monthly_kWh[g]);
    }
    Json parameters = parameters_json(site, addition.candidate, addition.eta);
    for (std::size_t j = 0; j < addition.eta_sd.size(); ++j) {
      parameters[j]["sd"] = number(addition.eta_sd[j]);
    }
    list.push_back({{"effect", addition.candidate.effect->id},
                    {"title", addition.candidate.effect->title},
                    {"meaning", addition.candidate.effect->meaning},
                    {"meter", meter_name(site, addition.candidate.meter)},
                    {"probability", addition.probability},
                    {"evidence_gain", number(addition.evidence_gain)},
                    {"parameters", parameters},
                    {"monthly_kWh", impact}});
  }
  return list;
}

std::string gap_words(const SiteProblem& site, const diagnosis::GapChange& gap) {
  std::string text = "On months that were kept back (daily CV(RMSE), before and after):\n";
  for (std::size_t g = 0; g < gap.before.size(); ++g) {
    text += fmt::format("  {:<16} {:5.1f} %  {:5.1f} %\n", site.meters[g].id,
                        100.0 * gap.before[g].cvrmse_daily, 100.0 * gap.after[g].cvrmse_daily);
  }
  return text;
}

diagnosis::EffectParameterRecord record_of(const Addition& addition, std::size_t j) {
  const diagnosis::EffectParameter& p = addition.candidate.parameters[j];
  std::vector<double> draws;
  for (const auto& draw : addition.draws) draws.push_back(draw[j]);
  std::vector<double> sorted = draws;
  std::ranges::sort(sorted);
  const auto at = [&](double share) {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  };
  double mean = 0.0;
  for (const double draw : draws) mean += draw / static_cast<double>(draws.size());
  return {p.name, p.unit, p.prior, mean, addition.eta_sd[j], at(0.05), at(0.5), at(0.95), draws};
}

}  // namespace

std::string diagnosis_json(const Diagnosis& d, const SiteProblem& site, const RunFacts& facts,
                           const std::string& applied) {
  Json not_identifiable = Json::array();
  for (const diagnosis::NotIdentifiable& n : d.not_identifiable) {
    not_identifiable.push_back({{"effect", n.effect}, {"why", n.why}});
  }
  const diagnosis::Pass& first = d.passes.front();
  for (std::size_t i = 0; i < first.look.candidates.size(); ++i) {
    const diagnosis::CandidateLook& look = first.look.candidates[i];
    if (look.visible) continue;
    not_identifiable.push_back(
        {{"effect", d.candidates[i].key(site)},
         {"why", fmt::format("too faint at these meters: detectability {:.1f}, needed {:.0f}",
                             look.most_detectable, diagnosis::kLeastDetectability)}});
  }
  Json json = {{"outcome", to_string(d.outcome)},
               {"why", first.naming.why},
               {"located", located_json(site, first.located)},
               {"candidates", candidates_json(site, d)},
               {"confusable", first.naming.confusable},
               {"added", d.not_confirmed ? Json::array() : added_json(site, d)},
               {"additions", additions_json(site, d)},
               {"null_threshold", number(first.naming.null_threshold)},
               {"unknown_gain", number(first.naming.unknown_gain)},
               {"base_fit", gaps_json(site, d.base_fit)},
               {"gap", d.gap ? gap_json(site, *d.gap) : Json(nullptr)},
               {"not_identifiable_here", not_identifiable},
               {"warnings", d.warnings},
               {"model_runs", d.model_runs},
               {"seed", facts.seed},
               {"data_revision", facts.data_revision},
               {"model_version", applied.empty() ? facts.model_version : applied},
               {"wall_s", facts.wall_s}};
  return json.dump(2) + "\n";
}

std::string diagnosis_words(const Diagnosis& d, const SiteProblem& site) {
  std::string text;
  const diagnosis::Pass& first = d.passes.front();
  if (first.located.empty()) {
    text += "Simulation and meters agree within what chance explains.\n";
  } else {
    text += "Where simulation and meters disagree most:\n";
    for (std::size_t i = 0; i < std::min(first.located.size(), kFindingsInWords); ++i) {
      const diagnosis::Finding& f = first.located[i];
      text += fmt::format("  {}, {}: {:+.0f} % +- {:.0f}, {:+.0f} kWh a month\n",
                          site.meters[f.meter].id, f.words, 100.0 * f.share, 100.0 * f.share_se,
                          f.kWh_month);
    }
  }
  text += "Explanations:\n";
  for (std::size_t i = 0; i < std::min(first.naming.probabilities.size(), kCandidatesInWords);
       ++i) {
    const diagnosis::NameProbability& p = first.naming.probabilities[i];
    const std::string at = p.meter < 0 ? "" : " (" + meter_name(site, p.meter) + ")";
    text += fmt::format("  {:5.1f} %  {}{}\n", 100.0 * p.probability, p.effect, at);
  }
  text += fmt::format("Outcome: {}: {}.\n", to_string(d.outcome), first.naming.why);
  for (const Addition& addition : d.added) {
    text += fmt::format("{} (probability {:.0f} %): {}\n", addition.candidate.effect->title,
                        100.0 * addition.probability, addition.candidate.effect->meaning);
  }
  if (d.gap) text += gap_words(site, *d.gap);
  for (const std::string& warning : d.warnings) text += "! " + warning + "\n";
  return text;
}

diagnosis::ModelVersion next_version(const Diagnosis& d, const SiteProblem& site,
                                     const diagnosis::ModelVersion& parent, const RunFacts& facts,
                                     const std::string& at) {
  diagnosis::ModelVersion next = parent;
  next.parent = parent.version;
  next.version.clear();
  next.created_at = at;
  next.author = diagnosis::VersionAuthor::human;
  next.status = diagnosis::VersionStatus::proposed;
  next.data_revision = facts.data_revision;
  next.catalogue_version = facts.recald_version;
  for (const Addition& addition : d.added) {
    diagnosis::AddedEffect added{.effect = std::string{addition.candidate.effect->id},
                                 .title = std::string{addition.candidate.effect->title},
                                 .meter = meter_name(site, addition.candidate.meter),
                                 .from = {},
                                 .to = {},
                                 .physics = std::string{addition.candidate.effect->physics},
                                 .parameters = {},
                                 .log_evidence_gain = addition.evidence_gain,
                                 .probability = addition.probability};
    for (std::size_t j = 0; j < addition.candidate.parameters.size(); ++j) {
      added.parameters.push_back(record_of(addition, j));
    }
    const std::chrono::sys_days first{site.drivers->hours.front().date};
    const std::size_t n = addition.eta.size();
    const auto day = [&](double days) {
      return metering::Day{first + std::chrono::days{static_cast<int>(std::lround(days))}};
    };
    if (addition.candidate.begins)
      added.from = day(addition.eta[n - (addition.candidate.ends ? 2 : 1)]);
    if (addition.candidate.ends) added.to = day(addition.eta[n - 1]);
    for (const diagnosis::NameProbability& p : d.passes.front().naming.probabilities) {
      if (p.effect != added.effect) added.rivals.push_back({p.effect, p.probability});
    }
    for (std::size_t g = 0; g < addition.monthly_kWh.size(); ++g) {
      added.impacts.push_back({site.meters[g].id, addition.monthly_kWh[g]});
    }
    for (std::size_t m = 0; m < site.drivers->months.size(); ++m) {
      if (site.month_roles[m] != diagnosis::Role::show) {
        added.months_used.push_back(site.drivers->months[m]);
      }
    }
    next.effects.push_back(std::move(added));
  }
  return next;
}

}  // namespace recald::daemon
