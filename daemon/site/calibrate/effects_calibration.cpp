#include "daemon/site/calibrate/effects_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "core/assessment/cut_calibration.hpp"
#include "daemon/site/model/active_effects.hpp"

namespace recald::daemon {
namespace {

std::string effects_text(const diagnosis::ModelEffects& effects) {
  std::vector<std::string> titles;
  for (const diagnosis::AddedEffect& effect : effects.added) {
    titles.push_back(effect.meter.empty() ? fmt::format("'{}'", effect.title)
                                          : fmt::format("'{}' ({})", effect.title, effect.meter));
  }
  return fmt::format("The model has the effect{} {}, which a diagnosis added.",
                     titles.size() == 1 ? "" : "s", fmt::join(titles, " and "));
}

/// (calibration months) whether each may teach all effects.
std::vector<bool> teaching_months(const SiteCalibration& site, std::size_t months) {
  std::vector<bool> teaches(months);
  for (std::size_t i = 0; i < months; ++i) {
    teaches[i] = std::ranges::all_of(site.effects->added, [&](const auto& effect) {
      return may_learn_from(effect, site.months[i]);
    });
  }
  return teaches;
}

}  // namespace

Result<void> calibrate_with_effects(PreparedSite& prepared, const CalibrateOptions& options,
                                    calibration::DesignRuns design,
                                    const calibration::RunContext& context,
                                    SiteCalibration& result) {
  const std::vector<bool> teaches = teaching_months(result, prepared.problem.month_names.size());
  const std::string has = effects_text(*result.effects);
  if (std::ranges::all_of(teaches, std::identity{})) {
    result.warnings.push_back(
        {has,
         "All months here are later than those that it was learnt from, so what was learnt is the "
         "prior of its parameters, and these months teach them further."});
    return calibrate_all(prepared, options, std::move(design), context, result);
  }
  Eigen::MatrixXd eta = assessment::spread_eta(result.effects->draws);
  std::string how = "It was learnt from the months here";
  if (std::ranges::any_of(teaches, std::identity{})) {
    auto taught = assessment::taught_by_months(*prepared.model, prepared.problem, eta.cols(),
                                               teaches, options.calibration, context);
    if (taught) {
      eta = std::move(*taught);
      how =
          "It was learnt from some of the months here; the later ones alone were let teach it "
          "further";
    } else if (taught.error().code == ErrorCode::cancelled) {
      return tl::unexpected(taught.error());
    } else {
      how =
          "It was learnt from some of the months here, and the later ones cannot teach it further "
          "(" +
          taught.error().message + ")";
    }
  }
  result.warnings.push_back(
      {has, fmt::format("{}, so its parameters are not calibrated on them again: the others are "
                        "drawn given each of {} draws of them.",
                        how, eta.rows())});
  return assessment::calibrate_given_eta(*prepared.model, prepared.problem, design, eta,
                                         options.calibration, options.prior_sensitivity, context,
                                         result);
}

}  // namespace recald::daemon
