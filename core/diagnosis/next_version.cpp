#include "core/diagnosis/next_version.hpp"

#include <set>
#include <utility>

#include "core/diagnosis/effect_posterior.hpp"

namespace recald::diagnosis {
namespace {

std::string meter_name(const SiteProblem& site, int meter) {
  return meter < 0 ? std::string{} : site.meters[static_cast<std::size_t>(meter)].id;
}

/// Months whose readings were used to fit or to choose.
std::vector<metering::Month> months_that_taught(const SiteProblem& site) {
  std::set<metering::Month> months;
  for (Eigen::Index i = 0; i < site.day_parts.count(); ++i) {
    const auto month =
        static_cast<std::size_t>(site.day_parts.parts[static_cast<std::size_t>(i)].month);
    if (site.month_roles[month] == Role::show) continue;
    if (site.measured_parts_kW.row(i).isFinite().any()) months.insert(site.drivers->months[month]);
  }
  return {months.begin(), months.end()};
}

std::vector<EffectParameterRecord> records_of(const Addition& addition) {
  const std::vector<ParameterPosterior> posterior = posterior_of(addition);
  std::vector<EffectParameterRecord> records;
  for (std::size_t j = 0; j < posterior.size(); ++j) {
    std::vector<double> draws;
    double mean = 0.0;
    for (const auto& draw : addition.draws) {
      draws.push_back(draw[j]);
      mean += draw[j] / static_cast<double>(addition.draws.size());
    }
    const ParameterPosterior& p = posterior[j];
    records.push_back({p.name, p.unit, addition.candidate.parameters[j].prior, mean, p.sd, p.q05,
                       p.q50, p.q95, std::move(draws)});
  }
  return records;
}

}  // namespace

ModelVersion next_version(const Diagnosis& d, const SiteProblem& site, const ModelVersion& parent,
                          const VersionOrigin& origin) {
  ModelVersion next = parent;
  next.parent = parent.version;
  next.version.clear();
  next.created_at = origin.created_at;
  next.author = origin.author;
  next.status = VersionStatus::proposed;
  next.data_revision = origin.data_revision;
  next.catalogue_version = origin.catalogue_version;
  for (std::size_t i = 0; i < d.added.size(); ++i) {
    const Addition& addition = d.added[i];
    AddedEffect added{.effect = std::string{addition.candidate.effect->id},
                      .title = std::string{addition.candidate.effect->title},
                      .meter = meter_name(site, addition.candidate.meter),
                      .from = {},
                      .to = {},
                      .physics = std::string{addition.candidate.effect->physics},
                      .parameters = {},
                      .log_evidence_gain = addition.evidence_gain,
                      .probability = addition.probability};
    added.parameters = records_of(addition);
    const std::size_t n = addition.eta.size();
    if (addition.candidate.begins) {
      added.from = day_after(site, addition.eta[n - (addition.candidate.ends ? 2 : 1)]);
    }
    if (addition.candidate.ends) added.to = day_after(site, addition.eta[n - 1]);
    for (const NameProbability& p : d.passes[i].naming.probabilities) {
      if (p.effect != added.effect) added.rivals.push_back({p.effect, p.probability});
    }
    for (std::size_t g = 0; g < addition.monthly_kWh.size(); ++g) {
      added.impacts.push_back({site.meters[g].id, addition.monthly_kWh[g]});
    }
    added.months_used = months_that_taught(site);
    next.effects.push_back(std::move(added));
  }
  return next;
}

}  // namespace recald::diagnosis
