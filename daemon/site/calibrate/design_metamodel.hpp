/// The meta-model that stands in for a design's simulation: fitted in both forms, one chosen.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/doe/design_folder.hpp"
#include "core/model/metamodel/builders.hpp"
#include "core/model/monthly_model.hpp"
#include "core/regression/design_data.hpp"
#include "core/regression/monthly_form.hpp"
#include "core/regression/seed_form.hpp"
#include "core/result.hpp"

namespace recald::daemon {

enum class MetamodelForm {
  seed,     ///< One regression a meter over all months: also speaks of months outside the design.
  monthly,  ///< Gaussian processes: more exact, and only for the design's months.
};

[[nodiscard]] std::string_view to_string(MetamodelForm form);

struct MetamodelOptions {
  std::optional<MetamodelForm> form;  ///< Absent: what predicts left-out runs better.
  bool wind_in_degrees = false;       ///< The seed's plain number instead of sine and cosine.
  std::uint64_t seed = 1;             ///< Deals the runs into the folds of the seed's form.
};

struct FittedMetamodel {
  std::optional<regression::SeedForm> seed_form;  ///< Absent where it could not be fitted.
  std::optional<regression::MonthlyForm> monthly_form;
  MetamodelForm form;  ///< Chosen; that one is there.
  std::string why;     ///< In words, with both figures.
  std::vector<std::string> notes;

  [[nodiscard]] const regression::DesignQuality& quality(MetamodelForm of) const;
  [[nodiscard]] const regression::DesignQuality& quality() const { return quality(form); }
  /// (outputs) error of a form in output units.
  [[nodiscard]] std::vector<double> sigma_r(MetamodelForm of) const;
  /// (outputs * months) error of the chosen form in output units, output-major. The seed's is the
  /// same in all months, as in its eq. (1).
  [[nodiscard]] Eigen::VectorXd error_sd() const;
};

/// The design as fits read it.
[[nodiscard]] regression::DesignData design_data(const doe::DesignFolder& design);

/// Some months' model inputs. @pre each month has a row in `inputs`
[[nodiscard]] model::metamodel::MonthInputs month_inputs(const doe::MonthlyTable& inputs,
                                                         std::span<const doe::DesignMonth> months);

/// Fits both forms. @return what `fit_seed_form` or `fit_monthly_form` finds, for the form that was
/// asked for, or when neither can be fitted.
[[nodiscard]] Result<FittedMetamodel> fit_metamodel(const regression::DesignData& design,
                                                    const MetamodelOptions& options);

/// The chosen form's model of some months. @return or not_found, not_finite: see builders.hpp
[[nodiscard]] Result<std::unique_ptr<MonthlyModel>> model_over(
    const FittedMetamodel& fitted, const model::metamodel::MonthInputs& months);

/// How the meta-model predicts another design of the same model, such as corners of the prior.
/// @return (outputs) or invalid_value: other parameters, outputs or months.
[[nodiscard]] Result<std::vector<regression::CheckedOutput>> check_metamodel(
    const FittedMetamodel& fitted, const regression::DesignData& design,
    const regression::DesignData& check);

}  // namespace recald::daemon
