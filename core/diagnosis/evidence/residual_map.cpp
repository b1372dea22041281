#include "core/diagnosis/evidence/residual_map.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/absent.hpp"

namespace recald::diagnosis {
namespace {

constexpr int kTemperatureBinsMax = 14;
constexpr std::array<double, 5> kBinWidths_K = {1.0, 2.0, 3.0, 5.0, 10.0};

/// Weighted means in a table of cells, NaN for empty cells.
class CellMeans {
 public:
  CellMeans(Eigen::Index rows, Eigen::Index columns)
      : sums_(Eigen::ArrayXXd::Zero(rows, columns)), weights_(sums_) {}

  void add(Eigen::Index row, Eigen::Index column, double value, double weight) {
    sums_(row, column) += weight * value;
    weights_(row, column) += weight;
  }
  [[nodiscard]] Eigen::ArrayXXd means() const {
    return (weights_ > 0.0).select(sums_ / weights_.max(1e-12), kAbsent);
  }

 private:
  Eigen::ArrayXXd sums_;
  Eigen::ArrayXXd weights_;
};

/// Bin of a temperature; the outermost bins include everything beyond them.
Eigen::Index bin_of(double temperature_C, const std::vector<double>& limits_C) {
  const auto above = std::ranges::upper_bound(limits_C, temperature_C) - limits_C.begin();
  return std::clamp<Eigen::Index>(above - 1, 0, std::ssize(limits_C) - 2);
}

Eigen::Index bins_of(const std::vector<double>& limits_C) {
  return std::max<Eigen::Index>(std::ssize(limits_C) - 1, 0);
}

}  // namespace

double measured_mean_kW(const SiteProblem& site, Eigen::Index meter) {
  double sum = 0.0;
  double hours = 0.0;
  for (Eigen::Index i = 0; i < site.day_parts.count(); ++i) {
    const double kW = site.measured_parts_kW(i, meter);
    if (!std::isfinite(kW)) continue;
    const double weight = site.day_parts.parts[static_cast<std::size_t>(i)].hours;
    sum += weight * kW;
    hours += weight;
  }
  return hours > 0.0 ? sum / hours : kAbsent;
}

Eigen::ArrayXXd residual_shares(const SiteProblem& site, const Eigen::ArrayXXd& modelled_kW) {
  assert(modelled_kW.rows() == site.day_parts.count() &&
         modelled_kW.cols() == site.measured_parts_kW.cols());
  return change_shares(site, site.measured_parts_kW - modelled_kW);
}

Eigen::ArrayXXd change_shares(const SiteProblem& site, const Eigen::ArrayXXd& change_kW) {
  Eigen::ArrayXXd shares = change_kW;
  for (Eigen::Index g = 0; g < shares.cols(); ++g) {
    const double mean_kW = measured_mean_kW(site, g);
    const auto measured = site.measured_parts_kW.col(g).isFinite();
    if (mean_kW > 0.0) {
      shares.col(g) = measured.select(change_kW.col(g) / mean_kW, kAbsent);
    } else {
      shares.col(g).setConstant(kAbsent);
    }
  }
  return shares;
}

std::vector<double> temperature_limits_C(const DayParts& day_parts) {
  if (day_parts.parts.empty()) return {};
  const auto [coldest, warmest] =
      std::ranges::minmax(day_parts.parts, {}, [](const DayPart& p) { return p.dry_bulb_C; });
  double width_K = kBinWidths_K.back();
  for (const double candidate_K : kBinWidths_K) {
    const double bins = std::floor(warmest.dry_bulb_C / candidate_K) -
                        std::floor(coldest.dry_bulb_C / candidate_K) + 1.0;
    if (bins > kTemperatureBinsMax) continue;
    width_K = candidate_K;
    break;
  }
  std::vector<double> limits_C{width_K * std::floor(coldest.dry_bulb_C / width_K)};
  while (limits_C.back() <= warmest.dry_bulb_C) limits_C.push_back(limits_C.back() + width_K);
  return limits_C;
}

ResidualMap residual_map(const DayParts& day_parts, const Eigen::Ref<const Eigen::ArrayXd>& shares,
                         std::size_t months, const std::vector<double>& limits_C) {
  assert(shares.size() == day_parts.count());
  CellMeans by_month{kPartsPerWeek, static_cast<Eigen::Index>(months)};
  CellMeans by_temperature{kPartsPerDay, bins_of(limits_C)};
  for (Eigen::Index i = 0; i < shares.size(); ++i) {
    if (!std::isfinite(shares[i])) continue;
    const DayPart& part = day_parts.parts[static_cast<std::size_t>(i)];
    by_month.add(part.part_of_week, part.month, shares[i], part.hours);
    by_temperature.add(part.part, bin_of(part.dry_bulb_C, limits_C), shares[i], part.hours);
  }
  return {by_month.means(), by_temperature.means()};
}

Signature signature_of(const DayParts& day_parts, const Eigen::Ref<const Eigen::ArrayXd>& shares,
                       const std::vector<double>& limits_C) {
  assert(shares.size() == day_parts.count());
  CellMeans by_part{kPartsPerWeek, 1};
  CellMeans by_temperature{bins_of(limits_C), 1};
  for (Eigen::Index i = 0; i < shares.size(); ++i) {
    if (!std::isfinite(shares[i])) continue;
    const DayPart& part = day_parts.parts[static_cast<std::size_t>(i)];
    by_part.add(part.part_of_week, 0, shares[i], part.hours);
    by_temperature.add(bin_of(part.dry_bulb_C, limits_C), 0, shares[i], part.hours);
  }
  return {by_part.means(), by_temperature.means()};
}

}  // namespace recald::diagnosis
