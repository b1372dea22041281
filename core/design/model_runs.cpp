#include "core/design/model_runs.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace recald::design {
namespace {

// Enough blocks to keep a workstation's cores busy, few enough that clones cost nothing.
constexpr Eigen::Index kBlocks = 16;

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// One design being run: blocks of rows write to disjoint rows of `outputs`.
class Runs {
 public:
  Runs(const MonthlyModel& prototype, std::span<const Parameter> parameters,
       const Eigen::MatrixXd& theta, const RunObserver& observer)
      : prototype_(prototype),
        parameters_(parameters),
        observer_(observer),
        theta_(theta),
        outputs_(theta.rows(), prototype.output_count() * prototype.month_count()),
        errors_(kBlocks) {}

  void run_block(std::size_t block) {
    const auto b = static_cast<Eigen::Index>(block);
    const Eigen::Index begin = theta_.rows() * b / kBlocks;
    const Eigen::Index end = theta_.rows() * (b + 1) / kBlocks;
    const auto model = prototype_.clone();
    for (Eigen::Index i = begin; i < end && !stop_; ++i) {
      if (auto ran = run_row(*model, i); !ran) {
        errors_[block] = std::move(ran.error());
        stop_ = true;
      }
    }
  }

  Result<Eigen::MatrixXd> result() && {
    // A bad row stops the others wherever they are, so which of several is reported may depend on
    // the executor; that there is one does not. A row's own error says more than a cancellation.
    const Error* first = nullptr;
    for (const auto& error : errors_) {
      if (!error) continue;
      if (first == nullptr || first->code == ErrorCode::cancelled) first = &*error;
    }
    if (first != nullptr) return tl::unexpected(*first);
    return Eigen::MatrixXd(outputs_);
  }

 private:
  Result<void> run_row(MonthlyModel& model, Eigen::Index i) {
    const std::span<const double> theta(theta_.row(i).data(),
                                        static_cast<std::size_t>(theta_.cols()));
    const std::span<double> outputs(outputs_.row(i).data(),
                                    static_cast<std::size_t>(outputs_.cols()));
    model.evaluate(theta, outputs);
    if (auto finite = check_finite(parameters_, theta, outputs, model.month_count()); !finite) {
      return finite;
    }
    if (observer_ && !observer_(++done_, static_cast<int>(theta_.rows()))) {
      return failure(ErrorCode::cancelled, "cancelled while running the model");
    }
    return {};
  }

  const MonthlyModel& prototype_;
  std::span<const Parameter> parameters_;
  const RunObserver& observer_;
  RowMajorMatrix theta_;
  RowMajorMatrix outputs_;
  std::vector<std::optional<Error>> errors_;
  std::atomic<int> done_ = 0;
  std::atomic<bool> stop_ = false;
};

}  // namespace

Result<void> check_finite(std::span<const Parameter> parameters, std::span<const double> theta,
                          std::span<const double> outputs, int month_count) {
  const auto bad = std::find_if_not(outputs.begin(), outputs.end(),
                                    [](double value) { return std::isfinite(value); });
  if (bad == outputs.end()) return {};
  const auto index = static_cast<int>(bad - outputs.begin());
  return failure(ErrorCode::not_finite, "the model gives a value that is not finite (output " +
                                            std::to_string(index / month_count + 1) + ", month " +
                                            std::to_string(index % month_count + 1) + ") at " +
                                            describe(parameters, theta) +
                                            "; check the priors and the fixed inputs");
}

Result<Eigen::MatrixXd> run_model(const MonthlyModel& prototype,
                                  std::span<const Parameter> parameters,
                                  const Eigen::MatrixXd& theta, const ForEachIndex& executor,
                                  const RunObserver& observer) {
  assert(theta.cols() == prototype.parameter_count());
  assert(parameters.size() == static_cast<std::size_t>(theta.cols()));
  Runs runs(prototype, parameters, theta, observer);
  executor(kBlocks, [&runs](std::size_t block) { runs.run_block(block); });
  return std::move(runs).result();
}

}  // namespace recald::design
