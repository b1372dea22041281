#include "daemon/site/calibrate/site_on_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "adapters/csv/weather_csv.hpp"
#include "adapters/doe/days_file.hpp"
#include "core/assessment/common_errors.hpp"
#include "core/assessment/model_errors.hpp"
#include "core/display/id_words.hpp"
#include "core/display/warning.hpp"
#include "core/model/metamodel/builders.hpp"
#include "core/model/model_adaptors.hpp"
#include "core/model/parameter_library.hpp"
#include "core/random/streams.hpp"
#include "daemon/site/calibrate/design_extension.hpp"
#include "daemon/site/calibrate/design_outliers.hpp"
#include "daemon/site/calibrate/site_runs.hpp"

namespace recald::daemon {
namespace {

constexpr std::uint64_t kSeed = 1;  // screening: the same answer at each calibration

/// The runs, or in words what to do to get them.
Result<doe::DesignFolder> read_runs(const SiteConfig& site) {
  const std::filesystem::path& folder = site.model->energyplus->design;
  std::error_code ignored;
  if (!std::filesystem::exists(folder / "doe_outputs.csv", ignored)) {
    return failure(ErrorCode::not_found,
                   fmt::format("there are no runs of the EnergyPlus model in '{}'; run `recald doe "
                               "{}` where EnergyPlus is installed",
                               folder.string(), site.file.filename().string()));
  }
  auto design = doe::read_design_folder(folder);
  if (!design) return design;
  for (std::string& note : set_aside_outliers(*design)) design->notes.push_back(std::move(note));
  return design;
}

/// The site file may have been edited since the runs were made.
Result<void> require_same_parameters(const SiteConfig& site, const doe::DesignFolder& design) {
  const auto other = [&](const std::string& what) {
    return failure(ErrorCode::invalid_value,
                   fmt::format("the runs in '{}' {}, but the site file asks for something else; "
                               "give the model another 'design' folder, or delete this one",
                               design.folder.string(), what));
  };
  std::vector<std::string> run;
  for (const Parameter& parameter : design.parameters) run.push_back(parameter.name);
  const auto& asked = site.model->parameters;
  if (!std::ranges::equal(run, asked, {}, {}, &ParameterConfig::name)) {
    return other(fmt::format("vary {}", fmt::join(run, ", ")));
  }
  for (std::size_t j = 0; j < asked.size(); ++j) {
    const Prior& prior = design.parameters[j].prior;
    if (!asked[j].prior || *asked[j].prior == prior) continue;
    return other(fmt::format("vary {} from {} to {}", run[j], prior.min(), prior.max()));
  }
  return {};
}

/// The weather that the runs had, where the folder has it.
Result<weather::WeatherSeries> weather_of_runs(const doe::DesignFolder& design) {
  auto read = TRY(
      csv::read_weather(design.folder / kRunsWeather, {.values = weather::RecordedValues::mean}));
  return std::move(read.series);
}

/// Both, hour by hour: the first where it has a value.
weather::WeatherSeries joined(const weather::WeatherSeries& first,
                              const weather::WeatherSeries& second) {
  weather::WeatherSeries all{std::min(first.begin, second.begin), {}};
  const auto end = std::max(first.end(), second.end());
  for (auto hour = all.begin; hour < end; hour += std::chrono::hours{1}) {
    const weather::WeatherHour* own = first.find(hour);
    const bool is_known = own != nullptr && std::isfinite(own->dry_bulb_C);
    const weather::WeatherHour* other = is_known ? own : second.find(hour);
    all.hours.push_back(other == nullptr ? weather::WeatherHour{} : *other);
  }
  return all;
}

/// Months of the site that were not simulated, and how far their figures may be off.
struct NewMonths {
  std::vector<std::string> names;
  Eigen::MatrixXd sd;  ///< (outputs of the design x names) in the outputs' units.
};

/// Continues the design into the site's other months, from the days of its runs.
/// @param days_of  Asked if there are such months.
Result<NewMonths> add_new_months(const SiteConfig& site, const metering::LocalCalendar& calendar,
                                 const SiteWeather& weather, const SiteCalibration& so_far,
                                 const DaysOfDesign& days_of, doe::DesignFolder& design) {
  std::vector<metering::Month> wanted;
  for (const metering::Month month : so_far.months) {
    const auto name = metering::to_string(month);
    if (std::ranges::find(design.months, name, &doe::DesignMonth::text) == design.months.end()) {
      wanted.push_back(month);
    }
  }
  if (wanted.empty()) return NewMonths{};
  const auto cannot = [&](const std::string& why) {
    return failure(
        ErrorCode::not_enough_data,
        fmt::format(
            "the runs in '{}' do not cover {}{}, and {}; run `recald doe` for a "
            "new design folder",
            design.folder.string(), metering::to_string(wanted.front()),
            wanted.size() == 1 ? "" : fmt::format(" and {} other months", wanted.size() - 1), why));
  };
  const auto days = days_of(design);
  if (!days) return cannot(days.error().message);
  const auto of_runs = weather_of_runs(design);
  if (!of_runs) return cannot(of_runs.error().message);
  auto extended =
      TRY(extend_design(std::move(design), *days, joined(*of_runs, weather.filled.series), calendar,
                        site.holidays, wanted));
  design = std::move(extended.design);
  for (std::string& note : extended.notes) design.notes.push_back(std::move(note));
  NewMonths added{{}, std::move(extended.month_error_sd)};
  for (const metering::Month month : extended.added) {
    added.names.push_back(metering::to_string(month));
  }
  return added;
}

/// What is not known of months that were not simulated: common to all runs of a month.
void add_prediction_errors(const NewMonths& added, const doe::DesignFolder& design,
                           SiteCalibration& result) {
  for (assessment::OutputCalibration& output : result.outputs) {
    const auto k =
        std::ranges::find(design.output_names, output.name) - design.output_names.begin();
    if (k == std::ssize(design.output_names)) continue;  // said where the design is read
    if (output.extra_variances.empty()) output.extra_variances.assign(result.months.size(), 0.0);
    for (std::size_t i = 0; i < added.names.size(); ++i) {
      const auto place = std::ranges::find(result.month_names, added.names[i]);
      if (place == result.month_names.end()) continue;
      const double sd = added.sd(k, static_cast<Eigen::Index>(i));
      output.extra_variances[static_cast<std::size_t>(place - result.month_names.begin())] +=
          sd * sd;
    }
  }
}

/// The design in the site's outputs and months, as fits read it.
Result<regression::DesignData> data_of(const doe::DesignFolder& design,
                                       const SiteCalibration& so_far) {
  regression::DesignData all = design_data(design);
  std::vector<Eigen::Index> columns;
  std::string missing;
  std::vector<Eigen::Index> places;
  for (const std::string& month : so_far.month_names) {
    const auto place = std::ranges::find(all.months, month) - all.months.begin();
    if (place == std::ssize(all.months)) missing += (missing.empty() ? "" : ", ") + month;
    places.push_back(place);
  }
  if (!missing.empty()) {
    return failure(
        ErrorCode::not_enough_data,
        fmt::format("the runs in '{}' do not cover {}; run `recald doe` for a new design "
                    "folder",
                    design.folder.string(), missing));
  }
  for (const assessment::OutputCalibration& output : so_far.outputs) {
    const auto k = std::ranges::find(all.outputs, output.name) - all.outputs.begin();
    if (k == std::ssize(all.outputs)) {
      return failure(ErrorCode::invalid_value,
                     fmt::format("the runs in '{}' have no {}; give the model another 'design' "
                                 "folder, or delete this one",
                                 design.folder.string(), output.name));
    }
    for (const Eigen::Index place : places) columns.push_back(k * all.month_count() + place);
  }
  all.values = all.values(Eigen::all, columns).eval();
  all.outputs.clear();
  for (const auto& output : so_far.outputs) all.outputs.push_back(output.name);
  all.months = so_far.month_names;
  all.inputs.clear();
  all.month_inputs.resize(0, 0);
  return all;
}

std::vector<int> influential(const screening::Screening& screening) {
  std::vector<int> kept;
  for (std::size_t j = 0; j < screening.parameters.size(); ++j) {
    if (screening.parameters[j].verdict == screening::Verdict::influential) {
      kept.push_back(static_cast<int>(j));
    }
  }
  return kept;
}

/// "Outdoor airflow rate" as the library calls it, else the name in words.
std::string label_of(const std::string& name) {
  const auto library = model::parameter_library();
  const auto known = std::ranges::find(library, name, &model::ParameterDefinition::name);
  return known == library.end() ? display::meter_label(name) : std::string{known->label};
}

void take_parameters(const SiteConfig& site, const doe::DesignFolder& design,
                     const std::vector<int>& free, SiteCalibration& result) {
  for (std::size_t j = 0; j < design.parameters.size(); ++j) {
    const Parameter& parameter = design.parameters[j];
    if (!std::ranges::binary_search(free, static_cast<int>(j))) {
      result.fixed_parameters.push_back(parameter);
      continue;
    }
    Parameter& taken = result.parameters.emplace_back(parameter);
    taken.label = label_of(parameter.name);
    taken.source = site.model->parameters[j].source;
  }
}

/// The meta-model's own error.
void add_metamodel_errors(const FittedMetamodel& fitted, PreparedSite& prepared) {
  SiteCalibration& result = prepared.so_far;
  const Eigen::VectorXd sd = fitted.error_sd();
  const auto months = std::ssize(result.month_names);
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    const Eigen::VectorXd of_output = sd.segment(static_cast<Eigen::Index>(k) * months, months);
    const Eigen::VectorXd variances = of_output.cwiseAbs2();
    result.outputs[k].model_variances.assign(variances.begin(), variances.end());
  }
  prepared.problem.model_error_sd =
      assessment::leading_months(sd, months, std::ssize(prepared.problem.month_names));
}

std::unique_ptr<MonthlyModel> model_of(const FittedMetamodel& fitted,
                                       std::span<const std::string> months,
                                       const std::vector<double>& means,
                                       const std::vector<int>& free) {
  const auto all = model::metamodel::model_of(*fitted.monthly_form, months).value();
  return std::make_unique<FixedParametersModel>(all.clone(), means, free);
}

}  // namespace

Result<regression::DesignData> data_in_site_months(const ModelledSite& modelled,
                                                   const SiteCalibration& so_far,
                                                   doe::DesignFolder design,
                                                   const DaysOfDesign& days_of) {
  TRY(add_new_months(modelled.site.config, modelled.site.calendar, modelled.weather, so_far,
                     days_of, design));
  return data_of(design, so_far);
}

Result<PreparedSite> prepare_on_runs(const SiteConfig& site,
                                     const metering::LocalCalendar& calendar,
                                     const Recording& recording, const SiteWeather& weather) {
  auto begun = TRY(begin_site(site, recording, weather));
  PreparedSite prepared{.so_far = std::move(begun.so_far)};
  SiteCalibration& result = prepared.so_far;
  auto design = TRY(read_runs(site));
  TRY(require_runs_of(*site.model));
  TRY(require_same_parameters(site, design));
  const auto added_months =
      TRY(add_new_months(site, calendar, weather, result, doe::read_design_days, design));
  add_prediction_errors(added_months, design, result);
  const auto data = TRY(data_of(design, result));
  display::add_notes(design.notes, result.warnings);

  Rng rng{kSeed, streams::kScreening.first};
  auto screening = TRY(screening::screen(data, {}, rng));
  const std::vector<int> free = influential(screening);
  if (free.empty()) {
    return failure(ErrorCode::not_enough_data,
                   "no parameter of the EnergyPlus model moves a meter; widen the priors, or vary "
                   "something else");
  }
  take_parameters(site, design, free, result);
  auto fitted = TRY(fit_metamodel(data, {.form = MetamodelForm::monthly}));
  result.metamodel = assessment::MetamodelFacts{.form = std::string{to_string(fitted.form)},
                                                .why = fitted.why,
                                                .r2_left_out = fitted.quality().all.r2_left_out,
                                                .sigma_r = fitted.sigma_r(fitted.form)};

  const std::size_t calibration_months = begun.months.calibration.size();
  const std::vector<double> means = prior_means(design.parameters);
  const std::span<const std::string> names{result.month_names};
  prepared.model = model_of(fitted, names.first(calibration_months), means, free);
  prepared.whole_model = model_of(fitted, names, means, free);
  prepared.problem = assessment::problem_of(result, calibration_months);
  add_inputs(calendar, weather, begun.months, prepared);
  add_metamodel_errors(fitted, prepared);
  auto all_parameters = model::metamodel::model_of(*fitted.monthly_form, names).value();
  add_common_errors(assessment::held_parameter_errors(all_parameters, design.parameters, free), {},
                    prepared);
  result.design = std::make_shared<const SiteDesign>(
      SiteDesign{std::move(design), std::move(screening), std::move(fitted)});
  return prepared;
}

}  // namespace recald::daemon
