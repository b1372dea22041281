/// The interface of every building model for calibration.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace recald {

namespace model {
struct Building;
}

/// f(x, θ) of eq. (3) of the seed for all months of the model's period at once.
///
/// The known inputs x (weather, schedules, months) are fixed at construction. An instance owns its
/// scratch memory, so `evaluate` does not allocate and an instance must not be shared between
/// threads: each chain uses a `clone`.
class MonthlyModel {
 public:
  virtual ~MonthlyModel() = default;

  [[nodiscard]] virtual std::unique_ptr<MonthlyModel> clone() const = 0;

  [[nodiscard]] virtual int parameter_count() const = 0;
  [[nodiscard]] virtual int output_count() const = 0;
  [[nodiscard]] virtual int month_count() const = 0;

  /// @param theta    (parameter_count) values in the parameters' own units.
  /// @param outputs  (output_count * month_count), output-major: outputs[k * month_count + i] is
  ///                 output k in month i, e.g. daily-average consumption in kWh/day. All finite for
  ///                 every theta inside the priors.
  virtual void evaluate(std::span<const double> theta, std::span<double> outputs) = 0;

  /// Whether `evaluate_with_jacobian` may be called.
  [[nodiscard]] virtual bool has_jacobian() const { return false; }

  /// The same outputs and their derivatives with respect to theta.
  /// @param jacobian  (output_count * month_count * parameter_count), column-major: the
  ///                  derivatives of all outputs with respect to theta_0 first.
  virtual void evaluate_with_jacobian(std::span<const double> theta, std::span<double> outputs,
                                      std::span<double> jacobian);
};

/// Makes a site's model of some months for a building that differs from the site's only in values.
using ModelFactory = std::function<std::unique_ptr<MonthlyModel>(const model::Building&)>;

/// One run of the model, outside inner loops. @return (output_count * month_count)
[[nodiscard]] std::vector<double> evaluate(MonthlyModel& model, std::span<const double> theta);

}  // namespace recald
