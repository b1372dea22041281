#include "core/model/monthly_model.hpp"

#include <cassert>

namespace recald {

void MonthlyModel::evaluate_with_jacobian(std::span<const double> theta, std::span<double> outputs,
                                          std::span<double> /*jacobian*/) {
  assert(false && "this model has no Jacobian");
  evaluate(theta, outputs);
}

std::vector<double> evaluate(MonthlyModel& model, std::span<const double> theta) {
  std::vector<double> outputs(static_cast<std::size_t>(model.output_count() * model.month_count()));
  model.evaluate(theta, outputs);
  return outputs;
}

}  // namespace recald
