#include "core/diagnosis/evidence/block_noise.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

namespace recald::diagnosis {
namespace {

constexpr double log_two_pi = 1.8378770664093454836;

constexpr int columns_of_strip = 8;

using SparseColumn = Eigen::SparseMatrix<double>::InnerIterator;

/// Calls `work(strip, first, count)` for all columns: strip (8 x n) has `count` of them, starting
/// at `first`, as rows, and zeros below. A point's values are then adjacent, and loops over the
/// points keep eight columns in registers. A single last column has its own strip (1 x n).
template <class Work>
void by_strips(const Eigen::MatrixXd& columns, const Work& work) {
  Eigen::Index first = 0;
  Eigen::Array<double, columns_of_strip, Eigen::Dynamic> strip;
  for (; columns.cols() - first > 1; first += columns_of_strip) {
    const auto count = std::min<Eigen::Index>(columns_of_strip, columns.cols() - first);
    strip.setZero(columns_of_strip, columns.rows());
    strip.topRows(count) = columns.middleCols(first, count).transpose();
    work(strip, first, count);
  }
  if (columns.cols() - first == 1) {
    Eigen::Array<double, 1, Eigen::Dynamic> single = columns.col(first).transpose();
    work(single, first, Eigen::Index{1});
  }
}

constexpr double structure_prior_share = 0.1;  // sd of the half-normal prior of s, likewise
constexpr double correlation_min_h = 12.0;
constexpr double correlation_max_h = 480.0;
constexpr double white_share_min = 1e-4;
constexpr double white_share_max = 1.0;
constexpr double structure_share_min = 1e-4;  // below it u is negligible; its log needs a bound
constexpr double structure_share_max = 1.0;

/// log s, log T, log sigma
using LogLevel = Eigen::Vector3d;

struct Peak {
  LogLevel at;
  double value;
};

/// Nelder and Mead's simplex search for a maximum, with their coefficients 1, 2, 1/2, 1/2.
/// @see Nelder, Mead (1965), Comput. J. 7(4).
template <class Function>
Peak climb(const Function& function, const LogLevel& start, double step) {
  constexpr int rounds_max = 200;
  constexpr double tolerance = 0.2;  // nats between best and worst corner: negligible
  std::array<Peak, 4> corners;
  for (int i = 0; i < 4; ++i) {
    LogLevel at = start;
    if (i > 0) at[i - 1] += step;
    corners[static_cast<std::size_t>(i)] = {at, function(at)};
  }
  const auto higher = [](const Peak& a, const Peak& b) { return a.value > b.value; };
  for (int round = 0; round < rounds_max; ++round) {
    std::sort(corners.begin(), corners.end(), higher);
    Peak& worst = corners.back();
    if (corners.front().value - worst.value < tolerance) break;
    const LogLevel centre = (corners[0].at + corners[1].at + corners[2].at) / 3.0;
    const auto probe = [&](double reach) {
      const LogLevel at = centre + reach * (worst.at - centre);
      return Peak{at, function(at)};
    };
    const Peak reflected = probe(-1.0);
    if (higher(reflected, corners.front())) {
      const Peak expanded = probe(-2.0);
      worst = higher(expanded, reflected) ? expanded : reflected;
    } else if (higher(reflected, corners[2])) {
      worst = reflected;
    } else {
      const Peak contracted = probe(higher(reflected, worst) ? -0.5 : 0.5);
      if (higher(contracted, worst) && !higher(reflected, contracted)) {
        worst = contracted;
        continue;
      }
      for (std::size_t i = 1; i < 4; ++i) {
        corners[i].at = 0.5 * (corners[i].at + corners[0].at);
        corners[i].value = function(corners[i].at);
      }
    }
  }
  return *std::min_element(corners.begin(), corners.end(), higher);
}

/// The nearest point of the prior's support.
LogLevel inside_support(const LogLevel& at, double mean) {
  const LogLevel low =
      LogLevel(structure_share_min * mean, correlation_min_h, white_share_min * mean).array().log();
  const LogLevel high =
      LogLevel(structure_share_max * mean, correlation_max_h, white_share_max * mean).array().log();
  return at.cwiseMax(low).cwiseMin(high);
}

NoiseLevel level_at(const LogLevel& at, double pattern_sd) {
  return {.structure_sd = std::exp(at[0]),
          .correlation_h = std::exp(at[1]),
          .white_sd = std::exp(at[2]),
          .pattern_sd = pattern_sd};
}

/// Points that stand out from the filter's prediction, with patterns removed.
std::vector<bool> standing_out(const GateInput& input, double limit_sd) {
  const BlockDesign ungated{input.design.times_h, input.design.patterns, {}};
  const BlockNoise noise(ungated, input.level);
  const Eigen::VectorXd rest =
      input.residual - ungated.patterns * noise.pattern_mean(input.residual);
  const double stationary = std::pow(input.level.structure_sd, 2);
  const double white = std::pow(input.level.white_sd, 2);

  std::vector<bool> out(static_cast<std::size_t>(rest.size()), false);
  double mean = 0.0;
  double variance = stationary;
  for (Eigen::Index i = 0; i < rest.size(); ++i) {
    const double error = rest[i] - mean;
    const bool stands_out = std::abs(error) > limit_sd * std::sqrt(variance + white);
    out[static_cast<std::size_t>(i)] = stands_out;
    const double gain = variance / (variance + white * (stands_out ? gated_variance_factor : 1.0));
    if (i + 1 == rest.size()) break;
    const double step_h = ungated.times_h[i + 1] - ungated.times_h[i];
    const double correlation = std::exp(-step_h / input.level.correlation_h);
    mean = correlation * (mean + gain * error);
    variance = correlation * correlation * (1.0 - gain) * variance +
               stationary * (1.0 - correlation * correlation);
  }
  return out;
}

/// Whether a point of `out`, other than the one at `self`, lies within `reach_h` of `time_h`.
bool any_near(const Eigen::VectorXd& times_h, const std::vector<bool>& out, double time_h,
              double reach_h, Eigen::Index self) {
  const double* begin = times_h.data();
  const double* end = begin + times_h.size();
  for (const double* t = std::lower_bound(begin, end, time_h - reach_h);
       t != end && *t <= time_h + reach_h; ++t) {
    const auto i = t - begin;
    if (i != self && out[static_cast<std::size_t>(i)]) return true;
  }
  return false;
}

}  // namespace

SparsePatterns sparse_patterns(const BlockDesign& design) {
  return std::make_shared<const Eigen::SparseMatrix<double>>(design.patterns.sparseView());
}

BlockNoise::BlockNoise(const BlockDesign& design, const NoiseLevel& level, SparsePatterns patterns)
    : level_(level), patterns_(std::move(patterns)) {
  const Eigen::Index n = design.times_h.size();
  assert(n >= 1 && design.patterns.rows() == n);
  assert(design.gated.empty() || static_cast<Eigen::Index>(design.gated.size()) == n);
  assert(level.structure_sd >= 0.0 && level.correlation_h > 0.0);
  assert(level.white_sd > 0.0 && level.pattern_sd >= 0.0);

  white_variance_ = Eigen::VectorXd::Constant(n, level.white_sd * level.white_sd);
  for (std::size_t i = 0; i < design.gated.size(); ++i) {
    if (design.gated[i]) white_variance_[static_cast<Eigen::Index>(i)] *= gated_variance_factor;
  }
  factor_filter(design);
  factor_patterns();
}

void BlockNoise::factor_filter(const BlockDesign& design) {
  const Eigen::Index n = design.times_h.size();
  correlation_ = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    const double step_h = design.times_h[i + 1] - design.times_h[i];
    assert(step_h > 0.0);
    correlation_[i] = std::exp(-step_h / level_.correlation_h);
  }
  weight_.resize(n);
  keep_.resize(n);
  take_.resize(n);
  const double stationary = level_.structure_sd * level_.structure_sd;
  double variance = stationary;  // of u_i given the readings before i
  for (Eigen::Index i = 0; i < n; ++i) {
    const double error_variance = variance + white_variance_[i];
    const double gain = variance / error_variance;
    const double rho = correlation_[i];
    weight_[i] = 1.0 / std::sqrt(error_variance);
    keep_[i] = rho * (1.0 - gain);
    take_[i] = rho * gain;
    log_determinant_ += std::log(error_variance);
    variance = rho * rho * (1.0 - gain) * variance + stationary * (1.0 - rho * rho);
  }
}

struct BlockNoise::Whitened {
  Eigen::MatrixXd columns;      ///< W X (n x k)
  Eigen::MatrixXd in_patterns;  ///< tau Z' W' W X (p x k)
};

void BlockNoise::factor_patterns() {
  const Eigen::Index p = patterns_->cols();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(p, p);
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(p, columns_of_strip);
  Eigen::Array<double, columns_of_strip, Eigen::Dynamic> strip;
  for (Eigen::Index j = 0; j < p; j += columns_of_strip) {
    const Eigen::Index count = std::min<Eigen::Index>(columns_of_strip, p - j);
    strip.setZero(columns_of_strip, points());
    for (Eigen::Index c = 0; c < count; ++c) {
      for (SparseColumn entry(*patterns_, j + c); entry; ++entry) {
        strip(c, entry.index()) = entry.value();
      }
    }
    whiten_strip(strip);
    whiten_strip_transposed(strip);
    gather(strip, products, j);  // The factor reads what is below the diagonal.
    matrix.middleCols(j, count).bottomRows(p - j) +=
        level_.pattern_sd * products.topLeftCorner(p, count).bottomRows(p - j);
  }
  // I plus a positive semi-definite matrix can always be factorised.
  pattern_factor_.compute(matrix);
  log_determinant_ += 2.0 * pattern_factor_.matrixLLT().diagonal().array().log().sum();
}

template <class Strip>
void BlockNoise::whiten_strip(Strip& strip) const {
  constexpr int width = Strip::RowsAtCompileTime;
  Eigen::Array<double, width, 1> prediction = Eigen::Array<double, width, 1>::Zero();
  for (Eigen::Index i = 0; i < strip.cols(); ++i) {
    const Eigen::Array<double, width, 1> read = strip.col(i);
    strip.col(i) = (read - prediction) * weight_[i];
    prediction = keep_[i] * prediction + take_[i] * read;
  }
}

// `whiten_strip` in reverse: `pull` is the derivative with respect to the next prediction.
template <class Strip>
void BlockNoise::whiten_strip_transposed(Strip& strip) const {
  constexpr int width = Strip::RowsAtCompileTime;
  Eigen::Array<double, width, 1> pull = Eigen::Array<double, width, 1>::Zero();
  for (Eigen::Index i = strip.cols() - 1; i >= 0; --i) {
    const Eigen::Array<double, width, 1> direct = strip.col(i) * weight_[i];
    strip.col(i) = direct + take_[i] * pull;
    pull = keep_[i] * pull - direct;
  }
}

/// tau Z' X (p x k) of a strip that may have more than k columns; rows before `from` are left.
template <class Strip>
void BlockNoise::gather(const Strip& strip, Eigen::Ref<Eigen::MatrixXd> products,
                        Eigen::Index from) const {
  constexpr int width = Strip::RowsAtCompileTime;
  for (Eigen::Index j = from; j < patterns_->cols(); ++j) {
    Eigen::Array<double, width, 1> sum = Eigen::Array<double, width, 1>::Zero();
    for (SparseColumn entry(*patterns_, j); entry; ++entry) {
      sum += entry.value() * strip.col(entry.index());
    }
    products.row(j) = level_.pattern_sd * sum.head(products.cols()).matrix().transpose();
  }
}

BlockNoise::Whitened BlockNoise::whiten_and_gather(const Eigen::MatrixXd& columns) const {
  assert(columns.rows() == points());
  Whitened result{Eigen::MatrixXd(points(), columns.cols()),
                  Eigen::MatrixXd(patterns_->cols(), columns.cols())};
  by_strips(columns, [&](auto& strip, Eigen::Index first, Eigen::Index count) {
    whiten_strip(strip);
    result.columns.middleCols(first, count) = strip.topRows(count).matrix().transpose();
    whiten_strip_transposed(strip);
    gather(strip, result.in_patterns.middleCols(first, count), 0);
  });
  return result;
}

Eigen::MatrixXd BlockNoise::weigh(const Eigen::MatrixXd& columns) const {
  assert(columns.rows() == points());
  Eigen::MatrixXd weighed(columns.rows(), columns.cols());
  by_strips(columns, [&](auto& strip, Eigen::Index first, Eigen::Index count) {
    whiten_strip(strip);
    whiten_strip_transposed(strip);
    weighed.middleCols(first, count) = strip.topRows(count).matrix().transpose();
  });
  return weighed;
}

Eigen::MatrixXd BlockNoise::whiten(const Eigen::MatrixXd& columns) const {
  assert(columns.rows() == points());
  Eigen::MatrixXd whitened(columns.rows(), columns.cols());
  by_strips(columns, [&](auto& strip, Eigen::Index first, Eigen::Index count) {
    whiten_strip(strip);
    whitened.middleCols(first, count) = strip.topRows(count).matrix().transpose();
  });
  return whitened;
}

Eigen::MatrixXd BlockNoise::gram(const Eigen::MatrixXd& columns) const {
  const Whitened whitened = whiten_and_gather(columns);
  const Eigen::MatrixXd explained = pattern_factor_.matrixL().solve(whitened.in_patterns);
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(columns.cols(), columns.cols());
  products.selfadjointView<Eigen::Lower>().rankUpdate(whitened.columns.transpose());
  products.selfadjointView<Eigen::Lower>().rankUpdate(explained.transpose(), -1.0);
  return products.selfadjointView<Eigen::Lower>();
}

Eigen::VectorXd BlockNoise::squared_norms(const Eigen::MatrixXd& columns) const {
  const Whitened whitened = whiten_and_gather(columns);
  const Eigen::MatrixXd explained = pattern_factor_.matrixL().solve(whitened.in_patterns);
  return (whitened.columns.colwise().squaredNorm() - explained.colwise().squaredNorm()).transpose();
}

Eigen::MatrixXd BlockNoise::solve(const Eigen::MatrixXd& columns) const {
  const Eigen::MatrixXd weighed = weigh(columns);
  const Eigen::MatrixXd pattern =
      pattern_factor_.solve(level_.pattern_sd * (patterns_->transpose() * weighed));
  return weighed - weigh(level_.pattern_sd * (*patterns_ * pattern));
}

Eigen::VectorXd BlockNoise::pattern_mean(const Eigen::VectorXd& residual) const {
  return level_.pattern_sd * pattern_factor_.solve(whiten_and_gather(residual).in_patterns);
}

double BlockNoise::marginal_log_density(const Eigen::VectorXd& residual) const {
  return -0.5 *
         (static_cast<double>(points()) * log_two_pi + log_determinant_ + gram(residual)(0, 0));
}

double BlockNoise::student_log_density(const Eigen::VectorXd& residual, double freedom) const {
  const auto n = static_cast<double>(points());
  const double half = 0.5 * (freedom + n);
  return std::lgamma(half) - std::lgamma(0.5 * freedom) -
         0.5 * (n * (log_two_pi + std::log(0.5 * freedom)) + log_determinant_) -
         half * std::log1p(gram(residual)(0, 0) / freedom);
}

Eigen::VectorXd BlockNoise::draw(Rng& rng) const {
  const auto standard_normals = [&rng](Eigen::Index size) {
    return Eigen::VectorXd::NullaryExpr(size, [&rng](Eigen::Index) { return rng.normal(); });
  };
  const Eigen::VectorXd pattern = standard_normals(patterns_->cols());
  Eigen::VectorXd values = level_.pattern_sd * (*patterns_ * pattern);
  double structure = level_.structure_sd * rng.normal();
  for (Eigen::Index i = 0; i < points(); ++i) {
    values[i] += structure + std::sqrt(white_variance_[i]) * rng.normal();
    const double rho = correlation_[i];
    structure = rho * structure + level_.structure_sd * std::sqrt(1.0 - rho * rho) * rng.normal();
  }
  return values;
}

Eigen::VectorXd BlockNoise::inverse_diagonal() const {
  // Squared norms of the columns of W, last one first: the effect of a reading on the
  // errors after it.
  Eigen::VectorXd diagonal(points());
  double later = 0.0;
  for (Eigen::Index i = points() - 1; i >= 0; --i) {
    const double own = weight_[i] * weight_[i];
    diagonal[i] = own + take_[i] * take_[i] * later;
    later = own + keep_[i] * keep_[i] * later;
  }
  const Eigen::MatrixXd weighted = level_.pattern_sd * weigh(Eigen::MatrixXd(*patterns_));
  const Eigen::MatrixXd explained =
      pattern_factor_.matrixL().solve(Eigen::MatrixXd(weighted.transpose()));
  return diagonal - explained.colwise().squaredNorm().transpose();
}

// e | r, parameters has mean E Sigma^-1 r and covariance E - E Sigma^-1 E; so does the
// structure r - e, except for its mean. The parameters then move both: e by E Sigma^-1 J, and
// the rest by J minus that.
ResidualShares BlockNoise::residual_shares(const Eigen::VectorXd& residual,
                                           const Eigen::MatrixXd& jacobian,
                                           const Eigen::MatrixXd& covariance) const {
  assert(jacobian.rows() == points() && jacobian.cols() == covariance.rows());
  const auto white = white_variance_.asDiagonal();
  const Eigen::VectorXd white_mean = white * solve(residual);
  const Eigen::MatrixXd white_moves = white * solve(jacobian);
  const Eigen::MatrixXd structure_moves = jacobian - white_moves;
  const double variance =
      (white_variance_.array() - white_variance_.array().square() * inverse_diagonal().array())
          .sum();
  // trace(X V X') for the rows of X
  const auto spread = [&covariance](const Eigen::MatrixXd& moves) {
    return ((moves * covariance).array() * moves.array()).sum();
  };
  return {.structural = (residual - white_mean).squaredNorm() + variance + spread(structure_moves),
          .white = white_mean.squaredNorm() + variance + spread(white_moves)};
}

Result<LevelFit> fit_levels(const Eigen::VectorXd& residual, const BlockDesign& design, double mean,
                            double pattern_share, const std::optional<NoiseLevel>& start) {
  constexpr Eigen::Index points_min = 10;
  assert(mean > 0.0 && residual.size() == design.times_h.size());
  if (residual.size() < points_min) {
    return failure(ErrorCode::not_enough_data,
                   "the noise of a meter needs at least 10 blocks with readings; it has " +
                       std::to_string(residual.size()));
  }
  if (!residual.allFinite()) {
    return failure(ErrorCode::not_finite, "a residual of a meter is not a finite number");
  }
  int evaluations = 0;
  const SparsePatterns patterns = sparse_patterns(design);
  const auto log_density = [&](const LogLevel& at) {
    const LogLevel inside = inside_support(at, mean);
    const NoiseLevel level = level_at(inside, pattern_share * mean);
    ++evaluations;
    const double standardised = level.structure_sd / (structure_prior_share * mean);
    // Outside the support a slope leads back; a wall would flatten the simplex.
    return BlockNoise(design, level, patterns).marginal_log_density(residual) -
           0.5 * standardised * standardised - (at - inside).squaredNorm();
  };
  const double root_mean_square = residual.norm() / std::sqrt(static_cast<double>(residual.size()));
  const double sd = std::max(root_mean_square, 1e-3 * mean);
  // Mostly slow structure, or mostly noise: this density has these two kinds of maximum.
  const LogLevel slow = LogLevel(0.8 * sd, 120.0, 0.4 * sd).array().log();
  const LogLevel noisy = LogLevel(0.4 * sd, 24.0, 0.8 * sd).array().log();
  constexpr double step = 0.7;
  constexpr double small_step = 0.3;
  Peak best;
  if (start) {
    const LogLevel near =
        LogLevel(start->structure_sd, start->correlation_h, start->white_sd).array().log();
    best = climb(log_density, near, small_step);
  } else {
    const Peak first = climb(log_density, slow, step);
    const Peak second = climb(log_density, noisy, step);
    best = first.value >= second.value ? first : second;
  }
  const LogLevel inside = inside_support(best.at, mean);
  return LevelFit{level_at(inside, pattern_share * mean), log_density(inside), evaluations};
}

std::vector<std::vector<bool>> choose_gates(std::span<const GateInput> meters,
                                            const GateOptions& options) {
  constexpr double same_time_h = 1e-6;
  std::vector<std::vector<bool>> out;
  for (const GateInput& meter : meters) out.push_back(standing_out(meter, options.limit_sd));
  const auto has_company = [&](std::size_t meter, Eigen::Index i) {
    const double time_h = meters[meter].design.times_h[i];
    for (std::size_t other = 0; other < meters.size(); ++other) {
      const bool own = other == meter;
      if (any_near(meters[other].design.times_h, out[other], time_h,
                   own ? options.neighbourhood_h : same_time_h, own ? i : -1)) {
        return true;
      }
    }
    return false;
  };
  std::vector<std::vector<bool>> gated;
  for (std::size_t meter = 0; meter < meters.size(); ++meter) {
    const auto points = static_cast<Eigen::Index>(out[meter].size());
    std::vector<Eigen::Index> alone;
    for (Eigen::Index i = 0; i < points; ++i) {
      if (out[meter][static_cast<std::size_t>(i)] && !has_company(meter, i)) alone.push_back(i);
    }
    const Eigen::VectorXd& residual = meters[meter].residual;
    std::sort(alone.begin(), alone.end(), [&residual](Eigen::Index a, Eigen::Index b) {
      return std::abs(residual[a]) > std::abs(residual[b]);
    });
    const auto most = static_cast<std::size_t>(options.share_max * static_cast<double>(points));
    alone.resize(std::min(alone.size(), most));
    std::vector<bool>& flags = gated.emplace_back(out[meter].size(), false);
    for (const Eigen::Index i : alone) flags[static_cast<std::size_t>(i)] = true;
  }
  return gated;
}

}  // namespace recald::diagnosis
