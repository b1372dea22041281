#include "core/change_point/day_noise.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace recald::change_point {
namespace {

constexpr std::size_t kDaysOfALevel = 40;
constexpr double kProposalCut = 2.0;  // sd
// E min(z^2, 4) of a standard normal z: what proposal 2 divides by.
constexpr double kProposalMean = 0.920537;
constexpr int kProposalSteps = 20;
constexpr double kFullWeight = 3.0;  // sd
constexpr double kNoWeight = 6.0;
constexpr double kLeastWeight = 1e-6;  // no kind of day may vanish
constexpr double kLargestCorrelation = 0.9;

double proposal_2(std::span<const double> residuals) {
  double variance = 0.0;
  for (const double one : residuals) variance += one * one / static_cast<double>(residuals.size());
  for (int step = 0; step < kProposalSteps; ++step) {
    const double largest = kProposalCut * kProposalCut * variance;
    double squares = 0.0;
    for (const double one : residuals) squares += std::min(one * one, largest);
    variance = squares / (kProposalMean * static_cast<double>(residuals.size()));
  }
  return std::sqrt(variance);
}

}  // namespace

ScatterByLevel::ScatterByLevel(std::span<const double> levels_kWh,
                               std::span<const double> residuals_kWh, double least_sd_kWh) {
  assert(!levels_kWh.empty() && levels_kWh.size() == residuals_kWh.size());
  nodes_.clear();
  const std::size_t n = levels_kWh.size();
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return levels_kWh[i]; });
  std::vector<double> sorted(n);
  std::ranges::transform(order, sorted.begin(), [&](std::size_t i) { return residuals_kWh[i]; });
  for (std::size_t begin = 0; begin < n;) {
    std::size_t end = std::min(n, begin + kDaysOfALevel);
    // Equal levels stay together, and so do too few at the end.
    while (end < n && levels_kWh[order[end]] == levels_kWh[order[end - 1]]) ++end;
    if (n - end < kDaysOfALevel) end = n;
    double level = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      level += levels_kWh[order[i]] / static_cast<double>(end - begin);
    }
    const double sd = proposal_2(std::span{sorted}.subspan(begin, end - begin));
    nodes_.push_back({level, std::max(least_sd_kWh, sd)});
    begin = end;
  }
}

double ScatterByLevel::at(double level_kWh) const {
  const auto above = std::ranges::upper_bound(nodes_, level_kWh, {}, &Node::level);
  if (above == nodes_.begin()) return nodes_.front().sd;
  if (above == nodes_.end()) return nodes_.back().sd;
  const Node& low = *(above - 1);
  const double share = (level_kWh - low.level) / (above->level - low.level);
  return low.sd + share * (above->sd - low.sd);
}

double outlier_weight(double standardised) {
  const double beyond = (std::abs(standardised) - kFullWeight) / (kNoWeight - kFullWeight);
  if (!(beyond > 0.0)) return 1.0;
  if (beyond >= 1.0) return kLeastWeight;
  return std::max(kLeastWeight, (1.0 - beyond * beyond) * (1.0 - beyond * beyond));
}

double lag_one_correlation(std::span<const double> standardised, std::span<const int> day_numbers,
                           std::span<const int> blocks) {
  double products = 0.0;
  double pairs = 0.0;
  double squares = 0.0;
  double days = 0.0;
  double counted_blocks = 0.0;
  const auto cut = [&](std::size_t i) {
    return std::clamp(standardised[i], -kFullWeight, kFullWeight);
  };
  for (std::size_t begin = 0; begin < standardised.size();) {
    std::size_t end = begin;
    double mean = 0.0;
    while (end < standardised.size() && blocks[end] == blocks[begin]) mean += cut(end++);
    mean /= static_cast<double>(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      squares += (cut(i) - mean) * (cut(i) - mean);
      if (i == begin || day_numbers[i] != day_numbers[i - 1] + 1) continue;
      products += (cut(i) - mean) * (cut(i - 1) - mean);
      pairs += 1.0;
    }
    days += static_cast<double>(end - begin);
    counted_blocks += 1.0;
    begin = end;
  }
  if (!(squares > 0.0) || pairs < 2.0) return 0.0;
  const double plain = (products / pairs) / (squares / days);
  // A mean of n days has the variance v = (1 + rho) / ((1 - rho) n) and takes it from products and
  // squares alike, so plain = (rho - v) / (1 - v), to first order rho - (1 + rho) / n.
  const double n = std::max(2.0, days / counted_blocks);
  return std::clamp((plain + 1.0 / n) / (1.0 - 1.0 / n), 0.0, kLargestCorrelation);
}

Eigen::MatrixXd autoregressive_products(const Eigen::Ref<const Eigen::MatrixXd>& parts,
                                        std::span<const int> day_numbers, double rho) {
  const Eigen::Index sums = parts.rows();
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(sums, sums);
  Eigen::VectorXd past = Eigen::VectorXd::Zero(sums);  // sum over j < i of rho^(t_i - t_j) r_j
  for (Eigen::Index i = 0; i < parts.cols(); ++i) {
    if (i > 0) {
      const int elapsed =
          day_numbers[static_cast<std::size_t>(i)] - day_numbers[static_cast<std::size_t>(i) - 1];
      past = std::pow(rho, elapsed) * (past + parts.col(i - 1));
    }
    products.noalias() += parts.col(i) * parts.col(i).transpose();
    products.noalias() += 2.0 * past * parts.col(i).transpose();
  }
  return 0.5 * (products + products.transpose());
}

}  // namespace recald::change_point
