#include "core/model/epc/epc_model.hpp"

#include <cassert>
#include <utility>

namespace recald::model::epc {

EpcModel::EpcModel(Building nominal, std::vector<const ParameterDefinition*> parameters,
                   std::vector<MeterMap> outputs, std::shared_ptr<const ClimateClasses> climate)
    : nominal_(std::move(nominal)),
      building_(nominal_),
      parameters_(std::move(parameters)),
      outputs_(std::move(outputs)),
      climate_(std::move(climate)),
      epc_(climate_),
      energy_(climate_->months.size()) {}

std::unique_ptr<MonthlyModel> EpcModel::clone() const {
  return std::make_unique<EpcModel>(nominal_, parameters_, outputs_, climate_);
}

std::span<const EndUseEnergy> EpcModel::end_uses(std::span<const double> theta) {
  assert(theta.size() == parameters_.size());
  building_ = nominal_;  // Same sizes, so nothing is allocated.
  for (std::size_t j = 0; j < theta.size(); ++j) parameters_[j]->set(building_, theta[j]);
  settle(building_);
  epc_.evaluate(building_, energy_);
  return energy_;
}

void EpcModel::evaluate(std::span<const double> theta, std::span<double> outputs) {
  assert(outputs.size() == outputs_.size() * energy_.size());
  end_uses(theta);
  for (std::size_t k = 0; k < outputs_.size(); ++k) {
    for (std::size_t i = 0; i < energy_.size(); ++i) {
      outputs[k * energy_.size() + i] = outputs_[k].sum_kWh(energy_[i]) / climate_->months[i].days;
    }
  }
}

}  // namespace recald::model::epc
