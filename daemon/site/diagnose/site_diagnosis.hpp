/// One diagnosis of a site from its readings to its files, as the command and the daemon do it.
#pragma once

#include <string>
#include <vector>

#include "core/diagnosis/diagnose.hpp"
#include "daemon/site/diagnose/epc_gap.hpp"
#include "daemon/site/model/diagnosis_input.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// All that can be checked before the long part, so that nobody waits for a refusal.
/// @return unsupported when the model has effects already: a diagnosis starts from the drawings;
///         not_enough_data as `require_months`; or the errors of `make_site_problem`.
/// @pre the site's model is hourly
[[nodiscard]] Result<diagnosis::SiteProblem> prepare_diagnosis(const ModelledSite& modelled);

struct SiteDiagnosis {
  diagnosis::Diagnosis diagnosis;  ///< Its warnings begin with what the data show.
  /// Of the monthly model and the EnergyPlus model, of those that were asked.
  std::vector<diagnosis::ModelGap> others;
};

/// Locates, names and shows; then the monthly model has its vote.
/// @return or the errors of `diagnosis::diagnose`.
[[nodiscard]] Result<SiteDiagnosis> diagnose_site(const ModelledSite& modelled,
                                                  const diagnosis::SiteProblem& problem,
                                                  const diagnosis::DiagnoseOptions& options,
                                                  const diagnosis::Observer& observer);

/// If another model predicts the held-out months worse with what was named, it is not confirmed.
/// @param whose  "the monthly model"
void take_vote(diagnosis::MonthlyVote vote, const std::string& whose, SiteDiagnosis& done);

}  // namespace recald::daemon
