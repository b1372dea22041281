/// The EPC as a model to calibrate: parameters in, metered daily averages out.
#pragma once

#include <memory>
#include <vector>

#include "core/model/epc/epc.hpp"
#include "core/model/monthly_model.hpp"
#include "core/model/parameter_library.hpp"

namespace recald::model::epc {

/// Outputs are daily-average consumption in kWh/day, one per meter map.
class EpcModel final : public MonthlyModel {
 public:
  /// @param parameters  Each `is_modelled`; sets the order of theta.
  EpcModel(Building nominal, std::vector<const ParameterDefinition*> parameters,
           std::vector<MeterMap> outputs, std::shared_ptr<const ClimateClasses> climate);

  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override;
  [[nodiscard]] int parameter_count() const override {
    return static_cast<int>(parameters_.size());
  }
  [[nodiscard]] int output_count() const override { return static_cast<int>(outputs_.size()); }
  [[nodiscard]] int month_count() const override { return static_cast<int>(energy_.size()); }

  void evaluate(std::span<const double> theta, std::span<double> outputs) override;

  /// Energy by end use of each month at theta; valid until the next call.
  std::span<const EndUseEnergy> end_uses(std::span<const double> theta);

 private:
  Building nominal_;
  Building building_;  ///< Scratch: the nominal building with theta in it.
  std::vector<const ParameterDefinition*> parameters_;
  std::vector<MeterMap> outputs_;
  std::shared_ptr<const ClimateClasses> climate_;
  Epc epc_;
  std::vector<EndUseEnergy> energy_;
};

}  // namespace recald::model::epc
