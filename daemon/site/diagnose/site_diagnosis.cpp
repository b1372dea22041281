#include "daemon/site/diagnose/site_diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "core/display/id_words.hpp"
#include "core/display/warning.hpp"
#include "daemon/site/model/active_effects.hpp"

namespace recald::daemon {
namespace {

/// A diagnosis starts from the drawings.
Result<void> require_drawings(const SiteConfig& site) {
  const auto present = TRY(active_version(site));
  if (present.effects.empty()) return {};
  std::vector<std::string> titles;
  for (const auto& effect : present.effects) titles.push_back("'" + effect.title + "'");
  return failure(ErrorCode::unsupported,
                 fmt::format("the model already has {} (version {}), but a diagnosis starts from "
                             "the drawings; first run `recald model revert {} {}`",
                             fmt::join(titles, ", "), diagnosis::short_version(present.version),
                             site.file.string(), diagnosis::kBaseVersion));
}

/// The same effects in the monthly model, which has a vote.
void ask_monthly_model(const ModelledSite& modelled, const diagnosis::SiteProblem& problem,
                       SiteDiagnosis& done) {
  if (!done.diagnosis.gap) return;
  auto monthly = epc_gap(modelled.site.config, modelled.site.calendar, modelled.recording,
                         modelled.weather, problem, done.diagnosis.added);
  if (!monthly) {
    done.diagnosis.warnings.push_back(
        display::warning_of("The monthly model was not used: " + monthly.error().message + "."));
    return;
  }
  take_vote(std::move(*monthly), "the monthly model", done);
}

}  // namespace

Result<diagnosis::SiteProblem> prepare_diagnosis(const ModelledSite& modelled) {
  const SiteConfig& config = modelled.site.config;
  TRY(require_drawings(config));
  TRY(require_months(config, modelled.recording, modelled.weather));
  return make_site_problem(config, modelled.site.calendar, modelled.recording, modelled.weather);
}

Result<SiteDiagnosis> diagnose_site(const ModelledSite& modelled,
                                    const diagnosis::SiteProblem& problem,
                                    const diagnosis::DiagnoseOptions& options,
                                    const diagnosis::Observer& observer) {
  auto diagnosis = TRY(diagnosis::diagnose(problem, options, observer));
  const auto data = data_warnings(modelled.site.config, modelled.recording, modelled.weather);
  diagnosis.warnings.insert(diagnosis.warnings.begin(), data.begin(), data.end());
  SiteDiagnosis done{std::move(diagnosis), {}};
  ask_monthly_model(modelled, problem, done);
  return done;
}

void take_vote(diagnosis::MonthlyVote vote, const std::string& whose, SiteDiagnosis& done) {
  diagnosis::Diagnosis& diagnosis = done.diagnosis;
  if (!vote.has_vote()) {
    diagnosis.warnings.push_back({display::capitalised(whose) + " could not check the result.",
                                  "No meter has a usable monthly figure in the held-out months."});
  } else if (!diagnosis.not_confirmed && !vote.agrees()) {
    diagnosis.not_confirmed = true;
    diagnosis.outcome = diagnosis::Outcome::unknown;
    diagnosis.why =
        "with what was named " + whose + " predicts the held-out months worse, so it was withdrawn";
  }
  done.others.push_back(std::move(vote.gap));
}

}  // namespace recald::daemon
