#include "core/calibration/checks/leave_out.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/calibration/checks/psis.hpp"
#include "core/calibration/posterior/points_at_draw.hpp"
#include "core/calibration/posterior/summary.hpp"

namespace recald::calibration {
namespace {

constexpr double kParetoKMax = 0.7;  // Vehtari et al. (2024): above this the estimate is unreliable

}  // namespace

PointBlocks blocks_of_months(const std::vector<PointIndex>& points, int months) {
  assert(months >= 1);
  std::vector<int> in_use;
  for (const PointIndex& point : points) in_use.push_back(point.month);
  std::sort(in_use.begin(), in_use.end());
  in_use.erase(std::unique(in_use.begin(), in_use.end()), in_use.end());
  PointBlocks blocks((in_use.size() + static_cast<std::size_t>(months) - 1) /
                     static_cast<std::size_t>(months));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto at = std::lower_bound(in_use.begin(), in_use.end(), points[i].month);
    const auto block =
        static_cast<std::size_t>(at - in_use.begin()) / static_cast<std::size_t>(months);
    blocks[block].push_back(static_cast<Eigen::Index>(i));
  }
  return blocks;
}

Result<Eigen::MatrixXd> block_log_scores(Posterior& posterior,
                                         const std::vector<ChainDraws>& chains, int count,
                                         const PointBlocks& blocks,
                                         const std::function<bool()>& proceed) {
  if (blocks.empty()) {
    return failure(ErrorCode::not_enough_data, "there is no measured month to leave out");
  }
  const ThinnedDraws thinned = thin(chains, count);
  PointsAtDraw points(posterior.data(), posterior.prior());
  Eigen::MatrixXd scores(thinned.theta.rows(), static_cast<Eigen::Index>(blocks.size()));
  for (Eigen::Index d = 0; d < scores.rows(); ++d) {
    if (proceed && !proceed()) return failure(ErrorCode::cancelled, "cancelled while leaving out");
    const auto draw = static_cast<std::size_t>(d);
    const ChainDraws& chain = chains[static_cast<std::size_t>(thinned.chain[draw])];
    const Eigen::VectorXd theta = thinned.theta.row(d);
    const Eigen::VectorXd& residual =
        posterior.residual_at({theta.data(), static_cast<std::size_t>(theta.size())});
    TRY(points.go_to(chain, thinned.iteration[draw], residual));
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      scores(d, static_cast<Eigen::Index>(b)) = points.log_score(blocks[b]);
    }
  }
  return scores;
}

Result<LeaveOutScore> leave_out_score(Posterior& posterior, const std::vector<ChainDraws>& chains,
                                      int months, int count, const std::function<bool()>& proceed) {
  const PointBlocks blocks = blocks_of_months(posterior.data().points, months);
  const auto scores = TRY(block_log_scores(posterior, chains, count, blocks, proceed));
  const auto loo = TRY(psis_loo(scores));
  LeaveOutScore result{months,
                       static_cast<int>(blocks.size()),
                       loo.elpd,
                       loo.standard_error,
                       loo.pareto_k.maxCoeff(),
                       0};
  result.unreliable = static_cast<int>((loo.pareto_k.array() > kParetoKMax).count());
  return result;
}

}  // namespace recald::calibration
