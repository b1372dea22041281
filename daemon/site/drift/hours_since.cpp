#include "daemon/site/drift/hours_since.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/diagnosis/model_effects.hpp"
#include "core/diagnosis/naming/learnt_names.hpp"
#include "core/diagnosis/naming/signature_evidence.hpp"
#include "core/diagnosis/naming/signature_names.hpp"
#include "core/diagnosis/naming/signatures.hpp"
#include "daemon/site/model/diagnosis_input.hpp"

namespace recald::daemon {
namespace {

using diagnosis::Candidate;
using diagnosis::SiteProblem;
using metering::Month;

/// What came before is known well enough from so many months.
constexpr std::chrono::months kMonthsBefore{24};

/// The record up to a month, all of it to be read: nothing is kept back for a final check.
Result<SiteProblem> problem_until(const ModelledSite& modelled, Month first, Month since,
                                  Month until) {
  SiteConfig site = modelled.site.config;
  site.period = PeriodConfig{{first, until}, {}};
  auto problem = make_site_problem(site, modelled.site.calendar, modelled.recording,
                                   modelled.weather, since - std::chrono::months{1});
  if (!problem) return problem;
  std::ranges::fill(problem->month_roles, diagnosis::Role::fit);
  std::ranges::fill(problem->roles, diagnosis::Role::fit);
  return problem;
}

/// As `DriverHour::day_index`.
int day_of(const SiteProblem& problem, const drift::Alarm& alarm, Month since) {
  const std::chrono::sys_days day{alarm.days ? alarm.days->since : since / 1};
  return static_cast<int>(
      (day - std::chrono::sys_days{problem.drivers->hours.front().date}).count());
}

std::vector<Candidate> that_begin(const SiteProblem& problem) {
  std::vector<Candidate> candidates = diagnosis::list_candidates(problem).candidates;
  std::erase_if(candidates, [](const Candidate& candidate) { return !candidate.begins; });
  return candidates;
}

/// Whether the meter that has raised an alarm has signatures.
bool can_tell(const SiteProblem& problem, const std::string& meter) {
  const auto found = std::ranges::find(problem.meters, meter, &diagnosis::MeterData::id);
  return found != problem.meters.end() && diagnosis::SignatureReader{problem}.reads(
                                              static_cast<int>(found - problem.meters.begin()));
}

/// Each effect in its likeliest shape. @param meters  As of `ask_hours_of`.
std::optional<drift::NamedChange> named(const diagnosis::SignatureNames& names,
                                        const SiteProblem& problem,
                                        const std::vector<std::string>& meters) {
  const double something = 1.0 - names.none;
  if (something <= 0.0) return std::nullopt;
  drift::NamedChange change;
  change.unknown = names.unknown / something;
  for (std::size_t i = 0; i < names.evidence.effects.size(); ++i) {
    const Candidate& candidate = *names.evidence.effects[i].shape.candidate;
    int output = -1;
    if (candidate.meter >= 0) {
      const std::string& id = problem.meters[static_cast<std::size_t>(candidate.meter)].id;
      const auto place = std::ranges::find(meters, id);
      if (place == meters.end()) continue;
      output = static_cast<int>(place - meters.begin());
    }
    change.effects.push_back({std::string{candidate.effect->id},
                              std::string{candidate.effect->title}, output,
                              names.probabilities[static_cast<Eigen::Index>(i)] / something});
  }
  return change;
}

}  // namespace

drift::AskHours ask_hours_of(const ModelledSite& modelled, std::vector<std::string> months,
                             std::vector<std::string> meters,
                             std::vector<diagnosis::AddedEffect> added) {
  if (!modelled.site.config.building) return {};
  return
      [&modelled, months = std::move(months), meters = std::move(meters), added = std::move(added)](
          const drift::Alarm& alarm, int begun, int until,
          const std::function<bool()>& proceed) -> std::optional<drift::NamedChange> {
        const auto month_at = [&](int i) {
          return *metering::parse_month(months[static_cast<std::size_t>(i)]);
        };
        const Month since = month_at(alarm.since);
        const Month first = std::max(month_at(begun), since - kMonthsBefore);
        auto made = problem_until(modelled, first, since, month_at(until));
        if (!made) return std::nullopt;
        if (!can_tell(*made, meters[static_cast<std::size_t>(alarm.output)])) return std::nullopt;
        const auto problem = std::make_shared<const SiteProblem>(std::move(*made));
        std::vector<std::shared_ptr<const model::hourly::Alteration>> accepted;
        if (!added.empty()) {
          const auto effects = diagnosis::make_model_effects(added, problem);
          if (!effects) return std::nullopt;
          accepted = effects->alterations(effects->mean());
        }
        diagnosis::Predictor predictor{*problem, accepted, proceed};
        const std::vector<Candidate> candidates = that_begin(*problem);
        auto evidence = evidence_of(*problem, candidates, diagnosis::learnt_null(), predictor,
                                    day_of(*problem, alarm, since));
        if (predictor.is_stopped() || evidence.effects.empty()) return std::nullopt;
        return named(names_by(std::move(evidence), diagnosis::learnt_weights()), *problem, meters);
      };
}

}  // namespace recald::daemon
