#include "daemon/site/setup/meter_sums.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace recald::daemon {
namespace {

constexpr std::size_t kKeptMax = 2000;
constexpr std::size_t kPartsMax = 40;
constexpr Eigen::Index kCommonMin = 48;

/// Whether one of so many stamps is kept; what is kept at 2n is kept at n.
bool is_kept(metering::Instant start, std::uint64_t every) {
  // Knuth's multiplicative hash spreads quarters of an hour evenly.
  const auto minutes = static_cast<std::uint64_t>(start.time_since_epoch().count() / 60);
  return ((minutes * 2'654'435'761u) >> 7) % every == 0;
}

double mean_of(const SampledReadings& meter) {
  double sum = 0.0;
  for (const auto& [start, value] : meter.kept()) sum += value;
  return meter.kept().empty() ? 0.0 : sum / static_cast<double>(meter.kept().size());
}

/// Values at the stamps that all have: the parts in columns, the sum in the last one.
Eigen::MatrixXd common_values(std::span<const SampledReadings* const> meters) {
  std::vector<std::vector<double>> rows;
  for (const auto& [start, value] : meters.back()->kept()) {
    std::vector<double> row;
    for (const SampledReadings* meter : meters) {
      const auto found = meter->kept().find(start);
      if (found == meter->kept().end()) break;
      row.push_back(found->second);
    }
    if (row.size() == meters.size()) rows.push_back(std::move(row));
  }
  Eigen::MatrixXd values(static_cast<Eigen::Index>(rows.size()),
                         static_cast<Eigen::Index>(meters.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < meters.size(); ++j) {
      values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = rows[i][j];
    }
  }
  return values;
}

/// Positions of the columns that add up to the last one; empty where they do not.
std::vector<std::size_t> parts_of(const Eigen::MatrixXd& values) {
  const Eigen::Index parts = values.cols() - 1;
  if (values.rows() < std::max(kCommonMin, 2 * parts)) return {};
  const Eigen::VectorXd sum = values.col(parts);
  const Eigen::VectorXd shares = values.leftCols(parts).colPivHouseholderQr().solve(sum);
  std::vector<std::size_t> chosen;
  Eigen::VectorXd rest = sum;
  for (Eigen::Index j = 0; j < parts; ++j) {
    const bool is_part = std::abs(shares[j] - 1.0) < 0.05;
    if (!is_part && std::abs(shares[j]) > 0.05) return {};
    if (!is_part) continue;
    rest -= values.col(j);
    chosen.push_back(static_cast<std::size_t>(j));
  }
  const double scale = sum.cwiseAbs().mean();
  const bool is_exact = scale > 0.0 && rest.cwiseAbs().mean() < 1e-3 * scale &&
                        rest.cwiseAbs().maxCoeff() < 2e-2 * scale;
  return is_exact && chosen.size() >= 2 ? chosen : std::vector<std::size_t>{};
}

}  // namespace

void SampledReadings::take(metering::Instant start, double mean_kW) {
  if (!std::isfinite(mean_kW) || !is_kept(start, every_)) return;
  kept_[start] = mean_kW;
  if (kept_.size() <= kKeptMax) return;
  every_ *= 2;
  std::erase_if(kept_, [&](const auto& one) { return !is_kept(one.first, every_); });
}

std::vector<FoundSum> find_sums(std::span<const SampledReadings* const> meters) {
  std::vector<std::size_t> order(meters.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return mean_of(*meters[a]) < mean_of(*meters[b]);
  });
  std::vector<FoundSum> sums;
  std::vector<std::size_t> smaller;  // no sums, and not idle
  for (const std::size_t candidate : order) {
    if (mean_of(*meters[candidate]) <= 0.0) continue;
    std::vector<const SampledReadings*> together;
    for (const std::size_t part : smaller) together.push_back(meters[part]);
    together.push_back(meters[candidate]);
    const auto parts =
        smaller.size() < 2 ? std::vector<std::size_t>{} : parts_of(common_values(together));
    if (parts.empty()) {
      if (smaller.size() < kPartsMax) smaller.push_back(candidate);
      continue;
    }
    FoundSum found{.sum = candidate, .parts = {}};
    for (const std::size_t part : parts) found.parts.push_back(smaller[part]);
    std::sort(found.parts.begin(), found.parts.end());
    sums.push_back(std::move(found));
  }
  return sums;
}

}  // namespace recald::daemon
