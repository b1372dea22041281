#include "core/calibration/predictive.hpp"

#include <cmath>
#include <numbers>

#include "core/calibration/posterior/points_at_draw.hpp"
#include "core/random/rng.hpp"
#include "core/random/streams.hpp"

namespace recald::calibration {
namespace {

/// `go_on(done)` is asked before each draw.
template <class GoOn>
Result<void> predict_chain(Posterior posterior, const ChainDraws& chain, Rng& rng,
                           ChainPredictions& predictions, GoOn go_on) {
  const PosteriorData& data = posterior.data();
  const Eigen::Index n = chain.theta.rows();
  const Eigen::Index m = data.values.size();
  predictions = {Eigen::MatrixXd(n, m), Eigen::MatrixXd(n, m)};
  PointsAtDraw points(data, posterior.prior());
  for (Eigen::Index d = 0; d < n; ++d) {
    if (!go_on(static_cast<int>(d))) {
      return failure(ErrorCode::cancelled, "the calibration was cancelled");
    }
    const Eigen::VectorXd theta = chain.theta.row(d);
    const Eigen::VectorXd& residual =
        posterior.residual_at({theta.data(), static_cast<std::size_t>(theta.size())});
    if (auto there = points.go_to(chain, d, residual); !there) return there;
    for (Eigen::Index p = 0; p < m; ++p) {
      const auto output = data.points[static_cast<std::size_t>(p)].output;
      const OutputScale& scale = data.scales[static_cast<std::size_t>(output)];
      const PointNormal given = points.given_others(p);
      const double z = (residual(p) - given.mean) / given.sd;
      predictions.log_likelihood(d, p) = -0.5 * z * z - std::log(given.sd * scale.range()) -
                                         0.5 * std::log(2.0 * std::numbers::pi);
      const double drawn = data.values(p) + given.sd * (rng.normal() - z);
      predictions.replicates(d, p) = scale.min + scale.range() * drawn;
    }
  }
  return {};
}

}  // namespace

Result<PointPredictions> predict_points(const Posterior& prototype,
                                        const std::vector<ChainDraws>& chains,
                                        const RunContext& context) {
  PointPredictions result{prototype.data().points, std::vector<ChainPredictions>(chains.size())};
  std::vector<Result<void>> done(chains.size());
  context.executor(chains.size(), [&](std::size_t k) {
    Rng rng{context.seed, streams::kPredictions[k]};
    const auto total = static_cast<int>(chains[k].theta.rows());
    done[k] = predict_chain(prototype, chains[k], rng, result.chains[k], [&](int draws) {
      return !context.observer ||
             context.observer({Progress::Stage::predicting, static_cast<int>(k), draws, total});
    });
  });
  for (const Result<void>& chain : done) {
    if (!chain) return tl::unexpected(chain.error());
  }
  return result;
}

}  // namespace recald::calibration
