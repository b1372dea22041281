#include "daemon/site/diagnose/site_diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "core/display/warning.hpp"
#include "daemon/site/model/active_effects.hpp"

namespace recald::daemon {
namespace {

/// A diagnosis starts from the drawings.
Result<void> require_drawings(const SiteConfig& site) {
  const auto present = active_version(site);
  if (!present) return tl::unexpected(present.error());
  if (present->effects.empty()) return {};
  std::vector<std::string> titles;
  for (const auto& effect : present->effects) titles.push_back("'" + effect.title + "'");
  return failure(ErrorCode::unsupported,
                 fmt::format("the model already has {} (version {}), but a diagnosis starts from "
                             "the drawings; first run `recald model revert {} {}`",
                             fmt::join(titles, ", "), diagnosis::short_version(present->version),
                             site.file.string(), diagnosis::kBaseVersion));
}

/// The same effects in the monthly model, which has a vote: if it predicts the held-out months
/// worse with them, they are not confirmed. Empty if there was nothing to judge.
std::vector<diagnosis::ModelGap> ask_monthly_model(const ModelledSite& modelled,
                                                   const diagnosis::SiteProblem& problem,
                                                   diagnosis::Diagnosis& diagnosis) {
  if (!diagnosis.gap) return {};
  auto monthly = epc_gap(modelled.site.config, modelled.site.calendar, modelled.recording,
                         modelled.weather, problem, diagnosis.added);
  if (!monthly) {
    diagnosis.warnings.push_back(
        display::warning_of("The monthly model was not used: " + monthly.error().message + "."));
    return {};
  }
  if (!monthly->has_vote()) {
    diagnosis.warnings.push_back({"The monthly model could not check the result.",
                                  "No meter has a usable monthly figure in the held-out months."});
  } else if (!diagnosis.not_confirmed && !monthly->agrees()) {
    diagnosis.not_confirmed = true;
    diagnosis.outcome = diagnosis::Outcome::unknown;
    diagnosis.why =
        "with what was named the monthly model predicts the held-out months worse, so it was "
        "withdrawn";
  }
  return {std::move(monthly->gap)};
}

}  // namespace

Result<diagnosis::SiteProblem> prepare_diagnosis(const ModelledSite& modelled) {
  const SiteConfig& config = modelled.site.config;
  if (auto plain = require_drawings(config); !plain) return tl::unexpected(plain.error());
  if (auto enough = require_months(config, modelled.recording, modelled.weather); !enough) {
    return tl::unexpected(enough.error());
  }
  return make_site_problem(config, modelled.site.calendar, modelled.recording, modelled.weather);
}

Result<SiteDiagnosis> diagnose_site(const ModelledSite& modelled,
                                    const diagnosis::SiteProblem& problem,
                                    const diagnosis::DiagnoseOptions& options,
                                    const diagnosis::Observer& observer) {
  auto diagnosis = diagnosis::diagnose(problem, options, observer);
  if (!diagnosis) return tl::unexpected(diagnosis.error());
  const auto data = data_warnings(modelled.site.config, modelled.recording, modelled.weather);
  diagnosis->warnings.insert(diagnosis->warnings.begin(), data.begin(), data.end());
  auto others = ask_monthly_model(modelled, problem, *diagnosis);
  return SiteDiagnosis{std::move(*diagnosis), std::move(others)};
}

}  // namespace recald::daemon
