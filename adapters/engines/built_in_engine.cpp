#include "adapters/engines/built_in_engine.hpp"

#include <utility>

#include "core/design/model_runs.hpp"

namespace recald::engines {

BuiltInEngine::BuiltInEngine(std::unique_ptr<MonthlyModel> model, std::vector<Parameter> parameters)
    : model_{std::move(model)}, parameters_{std::move(parameters)} {}

Result<Eigen::MatrixXd> BuiltInEngine::run(const Eigen::MatrixXd& theta,
                                           const ForEachIndex& executor, const Observer& observer) {
  return design::run_model(*model_, parameters_, theta, executor, observer);
}

}  // namespace recald::engines
