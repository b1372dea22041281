#include "daemon/site/calibrate/design_metamodel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/model/parameter_library.hpp"
#include "core/random/rng.hpp"
#include "core/random/streams.hpp"

namespace recald::daemon {
namespace {

const char* description(MetamodelForm form) {
  return form == MetamodelForm::seed ? "one regression for all months (form seed)"
                                     : "Gaussian processes of the design's months (form monthly)";
}

/// Chooses among the forms that could be fitted, and says why.
void choose_form(FittedMetamodel& fitted, std::optional<MetamodelForm> asked) {
  if (!fitted.seed_form || !fitted.monthly_form) {
    fitted.form = fitted.seed_form ? MetamodelForm::seed : MetamodelForm::monthly;
    fitted.why = fmt::format("{} is all that can be fitted; it reaches a left-out R2 of {:.4f}.",
                             description(fitted.form), fitted.quality().all.r2_left_out);
    return;
  }
  const double seed = fitted.seed_form->quality.all.r2_left_out;
  const double monthly = fitted.monthly_form->quality.all.r2_left_out;
  const MetamodelForm better = monthly > seed ? MetamodelForm::monthly : MetamodelForm::seed;
  fitted.form = asked.value_or(better);
  const MetamodelForm other =
      fitted.form == MetamodelForm::seed ? MetamodelForm::monthly : MetamodelForm::seed;
  fitted.why = fmt::format("on left-out runs {} reaches R2 {:.4f} and {} {:.4f}; {}.",
                           description(fitted.form), fitted.quality().all.r2_left_out,
                           description(other), fitted.quality(other).all.r2_left_out,
                           asked ? "the first was asked for" : "the first predicts better");
}

}  // namespace

std::string_view to_string(MetamodelForm form) {
  return form == MetamodelForm::seed ? "seed" : "monthly";
}

const regression::DesignQuality& FittedMetamodel::quality(MetamodelForm of) const {
  assert(of == MetamodelForm::seed ? seed_form.has_value() : monthly_form.has_value());
  return of == MetamodelForm::seed ? seed_form->quality : monthly_form->quality;
}

std::vector<double> FittedMetamodel::sigma_r(MetamodelForm of) const {
  std::vector<double> sd;
  for (const regression::OutputQuality& output : quality(of).outputs) sd.push_back(output.sigma_r);
  return sd;
}

Eigen::VectorXd FittedMetamodel::error_sd() const {
  const auto& outputs = quality().outputs;
  const Eigen::Index months = outputs.front().sigma_by_month.size();
  Eigen::VectorXd sd(std::ssize(outputs) * months);
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    auto of_output = sd.segment(static_cast<Eigen::Index>(k) * months, months);
    if (form == MetamodelForm::seed) {
      of_output.setConstant(outputs[k].sigma_r);
    } else {
      of_output = outputs[k].sigma_by_month;
    }
  }
  return sd;
}

regression::DesignData design_data(const doe::DesignFolder& design) {
  regression::DesignData data;
  for (const Parameter& parameter : design.parameters) data.parameters.push_back(parameter.name);
  data.theta = design.theta;
  data.outputs = design.output_names;
  for (const doe::DesignMonth month : design.months) data.months.push_back(month.text());
  data.values = design.outputs;
  data.inputs = design.inputs.names;
  data.month_inputs = design.design_inputs();
  const auto place = [&](std::string_view name) {
    return static_cast<int>(std::ranges::find(data.parameters, name) - data.parameters.begin());
  };
  const int heating = place("heating_setpoint");
  const int cooling = place("cooling_setpoint");
  const int count = static_cast<int>(data.parameters.size());
  if (heating < count && cooling < count) {
    data.caps.push_back({heating, cooling, model::kLeastDeadBand_K});
  }
  return data;
}

model::metamodel::MonthInputs month_inputs(const doe::MonthlyTable& inputs,
                                           std::span<const doe::DesignMonth> months) {
  model::metamodel::MonthInputs picked{inputs.names, {}, {}};
  picked.values.resize(static_cast<Eigen::Index>(months.size()), inputs.values.cols());
  for (std::size_t i = 0; i < months.size(); ++i) {
    picked.months.push_back(months[i].text());
    picked.values.row(static_cast<Eigen::Index>(i)) = inputs.values.row(inputs.row_of(months[i]));
  }
  return picked;
}

Result<FittedMetamodel> fit_metamodel(const regression::DesignData& design,
                                      const MetamodelOptions& options) {
  Rng rng{options.seed, streams::kFolds.first};
  auto seed_form =
      regression::fit_seed_form(design, {.wind_in_degrees = options.wind_in_degrees}, rng);
  auto monthly_form = regression::fit_monthly_form(design);
  const bool seed_is_needed = options.form == MetamodelForm::seed || !monthly_form;
  if (!seed_form && seed_is_needed) return tl::unexpected(seed_form.error());
  if (!monthly_form && options.form == MetamodelForm::monthly) {
    return tl::unexpected(monthly_form.error());
  }
  FittedMetamodel fitted{};
  if (seed_form) {
    fitted.seed_form = std::move(*seed_form);
  } else {
    fitted.notes.push_back("The seed's form cannot be fitted: " + seed_form.error().message + ".");
  }
  if (monthly_form) {
    fitted.monthly_form = std::move(*monthly_form);
  } else {
    fitted.notes.push_back("The monthly form cannot be fitted: " + monthly_form.error().message +
                           ".");
  }
  choose_form(fitted, options.form);
  return fitted;
}

Result<std::unique_ptr<MonthlyModel>> model_over(const FittedMetamodel& fitted,
                                                 const model::metamodel::MonthInputs& months) {
  const auto on_heap = [](auto&& model) -> Result<std::unique_ptr<MonthlyModel>> {
    if (!model) return tl::unexpected(model.error());
    return model->clone();
  };
  return fitted.form == MetamodelForm::seed
             ? on_heap(model::metamodel::model_of(*fitted.seed_form, months))
             : on_heap(model::metamodel::model_of(*fitted.monthly_form, months.months));
}

Result<std::vector<regression::CheckedOutput>> check_metamodel(
    const FittedMetamodel& fitted, const regression::DesignData& design,
    const regression::DesignData& check) {
  if (check.parameters != design.parameters || check.outputs != design.outputs ||
      check.months != design.months) {
    return failure(ErrorCode::invalid_value,
                   "the runs to check with are of other parameters, outputs or months than the "
                   "design's; make both from one site file");
  }
  auto model = TRY(model_over(fitted, {design.inputs, design.months, design.month_inputs}));
  Eigen::MatrixXd predicted(check.values.rows(), check.values.cols());
  for (Eigen::Index i = 0; i < predicted.rows(); ++i) {
    const std::vector<double> theta{check.theta.row(i).begin(), check.theta.row(i).end()};
    const std::vector<double> outputs = evaluate(*model, theta);
    predicted.row(i) = Eigen::Map<const Eigen::RowVectorXd>(outputs.data(), predicted.cols());
  }
  return regression::check_predictions(check, predicted);
}

}  // namespace recald::daemon
