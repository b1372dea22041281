#include "core/model/hourly/hourly_model.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace recald::model::hourly {

HourlyModel::HourlyModel(Building nominal, std::vector<const ParameterDefinition*> parameters,
                         std::vector<MeterMap> meters, std::vector<OutputDefinition> outputs,
                         std::shared_ptr<const Drivers> drivers, const HourlyOptions& options,
                         std::vector<std::shared_ptr<const Alteration>> alterations)
    : nominal_(std::move(nominal)),
      building_(nominal_),
      parameters_(std::move(parameters)),
      meters_(std::move(meters)),
      outputs_(std::move(outputs)),
      alterations_(std::move(alterations)),
      options_(options),
      hourly_(std::move(drivers), options),
      power_kW_(hourly_.step_count(), static_cast<Eigen::Index>(meters_.size())) {
  for (const auto& alteration : alterations_) in_order_.push_back(alteration.get());
  const std::vector<DriverHour>& hours = hourly_.drivers().hours;
  steps_.assign(hourly_.drivers().months.size(), 0);
  for (const DriverHour& hour : hours) {
    steps_[static_cast<std::size_t>(hour.month)] += options_.steps_per_hour;
  }
}

std::unique_ptr<MonthlyModel> HourlyModel::clone() const {
  return std::make_unique<HourlyModel>(*this);
}

int HourlyModel::month_count() const { return static_cast<int>(steps_.size()); }

void HourlyModel::evaluate(std::span<const double> theta, std::span<double> outputs) {
  assert(theta.size() == parameters_.size());
  assert(outputs.size() == outputs_.size() * steps_.size());
  building_ = nominal_;  // Same sizes, so nothing is allocated.
  for (std::size_t j = 0; j < theta.size(); ++j) parameters_[j]->set(building_, theta[j]);
  settle(building_);
  hourly_.run(building_, in_order_, meters_, power_kW_);

  const std::vector<metering::Month>& months = hourly_.drivers().months;
  for (std::size_t k = 0; k < outputs_.size(); ++k) {
    Eigen::Index first = 0;
    for (std::size_t i = 0; i < months.size(); ++i) {
      const auto month_kW = power_kW_.col(outputs_[k].meter).segment(first, steps_[i]);
      first += steps_[i];
      outputs[k * months.size() + i] =
          outputs_[k].kind == OutputKind::peak_kW
              ? month_kW.maxCoeff()
              : month_kW.sum() / options_.steps_per_hour / metering::days_in(months[i]);
    }
  }
}

}  // namespace recald::model::hourly
