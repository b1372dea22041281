#include "core/assessment/common_errors.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace recald::assessment {
namespace {

// One standard deviation of the share of lights and plugs that heats the zone, relative.
constexpr double kHeatShareSd = 0.15;
// The same of a meter's peaks: schedules are means over many days, and a month's highest quarter
// hour is not on a mean day. Their own scatter lifts measured peaks by about 8 %.
constexpr double kPeakSd = 0.08;
// Of lights and plugs, for how everything else follows them.
constexpr double kMoreUse = 0.1;

/// How all months move together when more or less of the lights and plugs heats the zone: the
/// profile fixes their power, not where it ends up.
Eigen::VectorXd heat_share_error(const model::Building& building, const ModelFactory& make,
                                 std::span<const double> theta) {
  model::Building less_heat = building;
  less_heat.use.zone_heat_share *= 1.0 - kHeatShareSd;
  const std::vector<double> base = evaluate(*make(building), theta);
  const std::vector<double> moved = evaluate(*make(less_heat), theta);
  return Eigen::Map<const Eigen::VectorXd>(base.data(), static_cast<Eigen::Index>(base.size())) -
         Eigen::Map<const Eigen::VectorXd>(moved.data(), static_cast<Eigen::Index>(moved.size()));
}

}  // namespace

std::vector<Eigen::VectorXd> common_errors(const model::Building& building,
                                           const ModelFactory& make,
                                           const std::vector<OutputCalibration>& outputs,
                                           MonthlyModel& model, std::span<const double> theta) {
  std::vector<Eigen::VectorXd> errors{heat_share_error(building, make, theta)};
  const std::vector<double> base = evaluate(model, theta);
  const auto months = static_cast<Eigen::Index>(model.month_count());
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    if (outputs[k].unit != "kW") continue;
    // All peaks of one meter move together.
    Eigen::VectorXd error = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(base.size()));
    const auto first = static_cast<Eigen::Index>(k) * months;
    error.segment(first, months) =
        kPeakSd * Eigen::Map<const Eigen::VectorXd>(base.data() + first, months);
    errors.push_back(std::move(error));
  }
  return errors;
}

std::vector<CommonError> kinds_of_common_errors(const std::vector<OutputCalibration>& outputs) {
  std::vector<CommonError> kinds(1);
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    if (outputs[k].unit == "kW") kinds.push_back({CommonError::Kind::level, k, kPeakSd});
  }
  return kinds;
}

model::ElectricLoads more_use(model::ElectricLoads loads) {
  for (double& factor : loads.month_factor) factor *= 1.0 + kMoreUse;
  return loads;
}

std::vector<double> gain_by_use(MonthlyModel& model, MonthlyModel& with_more,
                                std::span<const double> theta) {
  const std::vector<double> base = evaluate(model, theta);
  std::vector<double> gain = evaluate(with_more, theta);
  for (std::size_t i = 0; i < gain.size(); ++i) gain[i] = (gain[i] - base[i]) / kMoreUse;
  return gain;
}

std::vector<Eigen::VectorXd> held_parameter_errors(MonthlyModel& model,
                                                   const std::vector<Parameter>& parameters,
                                                   const std::vector<int>& free) {
  const std::vector<double> means = prior_means(parameters);
  const auto run = [&](std::span<const double> theta) {
    const std::vector<double> outputs = evaluate(model, theta);
    return Eigen::VectorXd{Eigen::Map<const Eigen::VectorXd>(
        outputs.data(), static_cast<Eigen::Index>(outputs.size()))};
  };
  const Eigen::VectorXd base = run(means);
  std::vector<Eigen::VectorXd> moves;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    if (std::ranges::binary_search(free, static_cast<int>(j))) continue;
    std::vector<double> moved = means;
    moved[j] += std::sqrt(parameters[j].prior.variance());
    moves.push_back(run(moved) - base);
  }
  return moves;
}

}  // namespace recald::assessment
