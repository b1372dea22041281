#include "core/change_point/month_errors.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <utility>

#include "core/change_point/day_noise.hpp"
#include "core/change_point/parameters.hpp"

namespace recald::change_point {
namespace {

constexpr double kLargestDay = 6.0;  // sd that a day may put a month off
constexpr double kBandProbability = 0.95;

/// A X' W X with the prior of the balance temperatures, and X' W V W X for the two parts of V.
struct Sandwich {
  Eigen::MatrixXd bread;
  Eigen::MatrixXd by_days;    ///< AR(1), and the prior.
  Eigen::MatrixXd by_months;  ///< For a month variance of one.

  /// g' A^-1 B A^-1 g of the two parts.
  [[nodiscard]] std::pair<double, double> variances(const Eigen::VectorXd& gradient) const {
    const Eigen::VectorXd solved = bread.ldlt().solve(gradient);
    return {solved.dot(by_days * solved), solved.dot(by_months * solved)};
  }
  [[nodiscard]] Eigen::MatrixXd covariance(double month_variance) const {
    const Eigen::LDLT<Eigen::MatrixXd> factor = bread.ldlt();
    const Eigen::MatrixXd filling = by_days + month_variance * by_months;
    const Eigen::MatrixXd half = factor.solve(filling);
    const Eigen::MatrixXd whole = factor.solve(half.transpose());
    return 0.5 * (whole + whole.transpose());
  }
};

struct Design {
  Eigen::MatrixXd gradient;  ///< (p x n) Of each day.
  Eigen::VectorXd balance;   ///< (p) 1 where a parameter is a balance temperature.
  double balance_variance;   ///< K²
};

/// @param fold_left_out  -1: none.
Sandwich sandwich_of(std::span<const TrainingDay> days, const FittedDays& fitted,
                     const Design& design, double correlation, int fold_left_out) {
  const Eigen::Index p = design.gradient.rows();
  Eigen::MatrixXd parts(p, design.gradient.cols());  // w sd g
  std::vector<int> numbers;
  Sandwich sandwich{Eigen::MatrixXd::Zero(p, p), {}, Eigen::MatrixXd::Zero(p, p)};
  Eigen::VectorXd of_block = Eigen::VectorXd::Zero(p);
  double variance = 0.0;
  int block = 0;
  const auto close_block = [&] {
    sandwich.by_months.noalias() += of_block * of_block.transpose();
    of_block.setZero();
  };
  for (std::size_t i = 0; i < days.size(); ++i) {
    if (days[i].fold == fold_left_out) continue;
    const auto at = static_cast<Eigen::Index>(i);
    const auto kept = static_cast<Eigen::Index>(numbers.size());
    if (days[i].block != block) close_block();
    block = days[i].block;
    sandwich.bread.noalias() +=
        days[i].weight * design.gradient.col(at) * design.gradient.col(at).transpose();
    parts.col(kept) = days[i].weight * fitted.sd_kWh(at) * design.gradient.col(at);
    of_block += parts.col(kept);
    variance += fitted.sd_kWh(at) * fitted.sd_kWh(at);
    numbers.push_back(days[i].day_number);
  }
  close_block();
  const auto kept = static_cast<Eigen::Index>(numbers.size());
  variance /= static_cast<double>(kept);
  sandwich.by_days = autoregressive_products(parts.leftCols(kept), numbers, correlation);
  // As if each balance temperature had been read once, with the prior's variance k: sigma²/k in the
  // bread and its square times k in the filling.
  sandwich.bread.diagonal() += variance / design.balance_variance * design.balance;
  sandwich.by_days.diagonal() += variance * variance / design.balance_variance * design.balance;
  return sandwich;
}

/// A block that was left out: its error in units of its days' mean sd, and what is expected of its
/// square for a month variance v: known + v (1 + per_variance).
struct LeftOutBlock {
  double square;
  double known;
  double per_variance;
};

std::vector<LeftOutBlock> left_out_blocks(std::span<const TrainingDay> days,
                                          const FittedDays& fitted, const Design& design,
                                          std::span<const double> left_out_residual_kWh,
                                          double correlation) {
  const int folds = 1 + std::ranges::max_element(days, {}, &TrainingDay::fold)->fold;
  std::vector<Sandwich> without;
  for (int fold = 0; fold < folds; ++fold) {
    without.push_back(sandwich_of(days, fitted, design, correlation, fold));
  }
  std::vector<LeftOutBlock> blocks;
  std::vector<int> numbers;
  for (std::size_t begin = 0; begin < days.size();) {
    std::size_t end = begin;
    double error = 0.0;
    numbers.clear();
    while (end < days.size() && days[end].block == days[begin].block) {
      const double largest = kLargestDay * fitted.sd_kWh(static_cast<Eigen::Index>(end));
      error += std::clamp(left_out_residual_kWh[end], -largest, largest);
      numbers.push_back(days[end].day_number);
      ++end;
    }
    const auto first = static_cast<Eigen::Index>(begin);
    const auto count = static_cast<Eigen::Index>(end - begin);
    const double sd = fitted.sd_kWh.segment(first, count).sum();
    const Eigen::MatrixXd shares = fitted.sd_kWh.segment(first, count).transpose() / sd;
    const double noise = autoregressive_products(shares, numbers, correlation)(0, 0);
    const auto [by_days, by_months] = without[static_cast<std::size_t>(days[begin].fold)].variances(
        design.gradient.middleCols(first, count).rowwise().sum() / sd);
    blocks.push_back({error * error / (sd * sd), noise + by_days, by_months});
    begin = end;
  }
  return blocks;
}

/// The variance at which the blocks' squares are on average what is expected of them; 0 if less is
/// seen even then.
double month_variance_of(const std::vector<LeftOutBlock>& blocks) {
  const auto excess = [&](double variance) {
    double sum = 0.0;
    for (const LeftOutBlock& block : blocks) {
      sum += block.square / (block.known + variance * (1.0 + block.per_variance)) - 1.0;
    }
    return sum;
  };
  if (excess(0.0) <= 0.0) return 0.0;
  double low = 0.0;
  double high = 1.0;
  while (excess(high) > 0.0) high *= 2.0;  // ends: the squares are finite
  for (int step = 0; step < 50; ++step) {
    const double middle = 0.5 * (low + high);
    (excess(middle) > 0.0 ? low : high) = middle;
  }
  return high;
}

}  // namespace

void learn_errors(std::span<const TrainingDay> days, std::span<const double> left_out_residual_kWh,
                  const FittedDays& fitted, Regression& regression) {
  const Eigen::VectorXd standardised = fitted.residual_kWh.cwiseQuotient(fitted.sd_kWh);
  std::vector<int> numbers(days.size());
  std::vector<int> blocks(days.size());
  std::ranges::transform(days, numbers.begin(), &TrainingDay::day_number);
  std::ranges::transform(days, blocks.begin(), &TrainingDay::block);
  regression.day_correlation =
      lag_one_correlation({standardised.data(), days.size()}, numbers, blocks);

  const double range = regression.warmest_C - regression.coldest_C;
  Design design{Eigen::MatrixXd::Zero(parameters_of(regression), fitted.sd_kWh.size()),
                balance_flags(regression), std::max(1.0, range * range / 12.0)};
  for (std::size_t i = 0; i < days.size(); ++i) {
    set_gradient(regression, days[i].type, days[i].dry_bulb_C,
                 design.gradient.col(static_cast<Eigen::Index>(i)));
  }
  const auto left_out =
      left_out_blocks(days, fitted, design, left_out_residual_kWh, regression.day_correlation);
  regression.month_variance = month_variance_of(left_out);
  regression.parameter_covariance =
      sandwich_of(days, fitted, design, regression.day_correlation, -1)
          .covariance(regression.month_variance);
  // The scale of all errors rests on so many squares, so a forecast is Student's t; the normal that
  // stands for it has its 90 % interval.
  const boost::math::students_t few{static_cast<double>(left_out.size()) - 1.0};
  const double wider = boost::math::quantile(few, kBandProbability) /
                       boost::math::quantile(boost::math::normal{}, kBandProbability);
  regression.widening = wider * wider;
}

}  // namespace recald::change_point
