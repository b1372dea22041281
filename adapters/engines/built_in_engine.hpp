/// recald's own models as an engine.
#pragma once

#include <memory>
#include <vector>

#include "adapters/ports/engine.hpp"
#include "core/model/monthly_model.hpp"
#include "core/model/parameter.hpp"

namespace recald::engines {

class BuiltInEngine final : public Engine {
 public:
  /// @param parameters  Of the model; used to name the values in an error.
  BuiltInEngine(std::unique_ptr<MonthlyModel> model, std::vector<Parameter> parameters);

  /// @return the outputs, or the errors of `design::run_model`.
  Result<Eigen::MatrixXd> run(const Eigen::MatrixXd& theta, const ForEachIndex& executor,
                              const Observer& observer) override;

 private:
  std::unique_ptr<MonthlyModel> model_;
  std::vector<Parameter> parameters_;
};

}  // namespace recald::engines
