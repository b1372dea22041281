#include "adapters/doe/folder_engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace recald::doe {
namespace {

/// Runs between two writes: the most that an interruption loses.
constexpr std::ptrdiff_t kRunsPerWrite = 20;

}  // namespace

FolderEngine::FolderEngine(std::filesystem::path folder, DesignPlan plan, Engine* behind,
                           DesignRunsSoFar runs)
    : folder_{std::move(folder)}, plan_{std::move(plan)}, behind_{behind}, runs_{std::move(runs)} {}

Result<FolderEngine> FolderEngine::open(std::filesystem::path folder, DesignPlan plan,
                                        Engine* behind) {
  auto runs = TRY(open_design(folder, plan));
  return FolderEngine{std::move(folder), std::move(plan), behind, std::move(runs)};
}

Result<std::vector<Eigen::Index>> FolderEngine::rows_of(const Eigen::MatrixXd& theta) const {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < theta.rows(); ++i) {
    // A row is usually in the plan's own place; searching from the start each time would be
    // quadratic.
    const bool is_in_place = i < plan_.theta.rows() && plan_.theta.row(i) == theta.row(i);
    Eigen::Index row = is_in_place ? i : 0;
    while (row < plan_.theta.rows() && plan_.theta.row(row) != theta.row(i)) ++row;
    if (row == plan_.theta.rows()) {
      const std::vector<double> values{theta.row(i).begin(), theta.row(i).end()};
      return failure(ErrorCode::invalid_value,
                     fmt::format("the design in {} has no run at {}", folder_.string(),
                                 describe(plan_.parameters, values)));
    }
    rows.push_back(row);
  }
  return rows;
}

Result<void> FolderEngine::run_rows(const std::vector<Eigen::Index>& rows,
                                    const ForEachIndex& executor, const Observer& observer) {
  const auto outputs = TRY(behind_->run(plan_.theta(rows, Eigen::all), executor, observer));
  for (const FailedRun& failed : behind_->failed_runs()) {
    const Eigen::Index row = rows[static_cast<std::size_t>(failed.row)];
    runs_.failed[static_cast<int>(row) + 1] = failed.because;
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto outputs_of_run = outputs.row(static_cast<Eigen::Index>(i));
    if (!outputs_of_run.allFinite()) continue;
    runs_.outputs.row(rows[i]) = outputs_of_run;
    runs_.done[static_cast<std::size_t>(rows[i])] = true;
    runs_.failed.erase(static_cast<int>(rows[i]) + 1);
  }
  return write_outputs(folder_, plan_, runs_);
}

Result<Eigen::MatrixXd> FolderEngine::run(const Eigen::MatrixXd& theta,
                                          const ForEachIndex& executor, const Observer& observer) {
  const auto rows = TRY(rows_of(theta));
  std::vector<Eigen::Index> missing;
  std::ranges::copy_if(rows, std::back_inserter(missing), [&](Eigen::Index row) {
    return !runs_.done[static_cast<std::size_t>(row)];
  });
  if (!missing.empty() && behind_ == nullptr) {
    return failure(ErrorCode::not_found,
                   fmt::format("{} of {} runs are missing in {}", missing.size(), rows.size(),
                               folder_.string()));
  }
  const auto total = static_cast<int>(runs_.done.size());
  const std::ptrdiff_t batch = behind_ != nullptr && behind_->keeps_runs()
                                   ? std::max<std::ptrdiff_t>(std::ssize(missing), 1)
                                   : kRunsPerWrite;
  for (auto next = missing.begin(); next != missing.end();) {
    const auto end = next + std::min(batch, missing.end() - next);
    const int before = total - static_cast<int>(missing.end() - next);
    int reached = before;
    const auto goes_on = [&](int done, int) {
      reached = before + done;
      return !observer || observer(reached, total);
    };
    auto ran = goes_on(0, 0) ? run_rows({next, end}, executor, goes_on)
                             : Result<void>{failure(ErrorCode::cancelled, "stopped")};
    if (!ran && ran.error().code == ErrorCode::cancelled) {
      return failure(ErrorCode::cancelled,
                     fmt::format("stopped after {} of {} runs; the same command goes on with the "
                                 "others",
                                 reached, total));
    }
    if (!ran) return tl::unexpected(ran.error());
    next = end;
  }
  return Eigen::MatrixXd{runs_.outputs(rows, Eigen::all)};
}

}  // namespace recald::doe
