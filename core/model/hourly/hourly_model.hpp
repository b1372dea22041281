/// The hourly model as a model to calibrate: parameters in, monthly daily averages and peaks out.
#pragma once

#include <memory>
#include <vector>

#include "core/model/hourly/hourly.hpp"
#include "core/model/monthly_model.hpp"
#include "core/model/parameter_library.hpp"

namespace recald::model::hourly {

enum class OutputKind { daily_kWh, peak_kW };

struct OutputDefinition {
  int meter;  ///< Index into the meter maps.
  OutputKind kind;
};

/// Outputs are daily-average consumption, kWh/day, and monthly peak demand, kW, of meters.
class HourlyModel final : public MonthlyModel {
 public:
  /// @param parameters   Each `is_modelled`; sets the order of theta.
  /// @param alterations  Fixed effects of the model version; shared with clones.
  HourlyModel(Building nominal, std::vector<const ParameterDefinition*> parameters,
              std::vector<MeterMap> meters, std::vector<OutputDefinition> outputs,
              std::shared_ptr<const Drivers> drivers, const HourlyOptions& options = {},
              std::vector<std::shared_ptr<const Alteration>> alterations = {});

  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override;
  [[nodiscard]] int parameter_count() const override {
    return static_cast<int>(parameters_.size());
  }
  [[nodiscard]] int output_count() const override { return static_cast<int>(outputs_.size()); }
  [[nodiscard]] int month_count() const override;

  void evaluate(std::span<const double> theta, std::span<double> outputs) override;

 private:
  Building nominal_;
  Building building_;  ///< Scratch: the nominal building with theta in it.
  std::vector<const ParameterDefinition*> parameters_;
  std::vector<MeterMap> meters_;
  std::vector<OutputDefinition> outputs_;
  std::vector<std::shared_ptr<const Alteration>> alterations_;
  std::vector<const Alteration*> in_order_;  ///< As above, in the form a run takes.
  HourlyOptions options_;
  Hourly hourly_;
  Eigen::ArrayXXd power_kW_;
  std::vector<Eigen::Index> steps_;  ///< By month.
};

}  // namespace recald::model::hourly
