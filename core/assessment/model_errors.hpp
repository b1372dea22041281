/// How far a model's parameters and levels are from the building's, in all months together.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/metering/reading.hpp"
#include "core/model/model_kind.hpp"
#include "core/model/monthly_model.hpp"
#include "core/model/parameter.hpp"

namespace recald::assessment {

/// What kind of energy a meter counts, as far as a model's errors differ by it.
enum class Service { electricity, cooling, heating };
[[nodiscard]] Service service_of(metering::Utility utility);

/// Sizes of a model's own errors: learnt on buildings with nothing hidden, or assumed where there
/// are none to learn on.
struct ModelErrorSizes {
  /// c: a parameter that fits the model best is not quite the building's, since one number stands
  /// for many thermostats, fans and habits; by so many of its prior's standard deviations.
  double parameter_share = 0.0;
  double cooling_level = 0.0;  ///< sd of a factor on what the model has of a meter, relative.
  double heating_level = 0.0;
  double electricity_level = 0.0;  ///< Of lights and plugs that were read off a meter.
};

[[nodiscard]] const ModelErrorSizes& model_error_sizes(ModelKind kind);

/// Errors of one standard deviation common to all months, each (outputs * months) in units:
/// df/dtheta_j times its spread for every parameter that has one, then a factor on each thermal
/// output.
///
/// Without them the discrepancy, which is small, leaves a wrong level to the parameters, and they
/// run off, sure of themselves (Brynjarsdóttir, O'Hagan 2014, Inverse Problems 30).
///
/// @param model     Of all months.
/// @param spreads   (q) sd of what each parameter means in the model, in its unit; 0: none.
/// @param services  (outputs) what each counts.
[[nodiscard]] std::vector<Eigen::VectorXd> model_errors(MonthlyModel& model,
                                                        std::span<const Parameter> parameters,
                                                        std::span<const double> spreads,
                                                        std::span<const Service> services,
                                                        const ModelErrorSizes& sizes);

/// What an error common to all months is of.
struct CommonError {
  enum class Kind : unsigned char {
    other,
    parameter,  ///< What parameter `of` means in the model; `sd` in its unit.
    level,      ///< A factor on output `of`; `sd` relative.
  };
  Kind kind = Kind::other;
  std::size_t of = 0;
  double sd = 0.0;
};

/// What `model_errors` of the same arguments are of, in its order.
[[nodiscard]] std::vector<CommonError> kinds_of_model_errors(std::span<const double> spreads,
                                                             std::span<const Service> services,
                                                             const ModelErrorSizes& sizes);

/// `sizes.parameter_share` of every prior's standard deviation.
[[nodiscard]] std::vector<double> spreads_of(std::span<const Parameter> parameters,
                                             const ModelErrorSizes& sizes);

/// The part of an error that falls to the first months. @param error  (outputs * months)
[[nodiscard]] Eigen::VectorXd leading_months(const Eigen::VectorXd& error, Eigen::Index months,
                                             Eigen::Index leading);

}  // namespace recald::assessment
