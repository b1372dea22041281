#include "core/diagnosis/evidence/monthly_effect.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <utility>

namespace recald::diagnosis {
namespace {

using model::hourly::Alteration;

/// Number of values per parameter, by the number of parameters: at most 243 runs.
constexpr std::array<int, 6> kNodes = {1, 9, 9, 5, 3, 3};

/// Probability below one standard deviation under the mean of a normal.
constexpr double kBelow = 0.1587;

/// If a meter's mean month is below this share, no ratio is computed.
constexpr double kLeastShareOfMean = 1e-6;

std::vector<double> nodes_of(const ParameterRange& range, int count) {
  assert(std::isfinite(range.low) && std::isfinite(range.high) && range.low <= range.high);
  if (range.low == range.high) return {range.low};
  std::vector<double> nodes;
  nodes.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    nodes.push_back(range.low + (range.high - range.low) * i / (count - 1));
  }
  nodes.back() = range.high;  // rounding must not leave the prior's support
  return nodes;
}

/// Daily averages of each meter and month in kWh/day, (meters * months), of hourly power.
Eigen::ArrayXd daily_averages(const SiteProblem& site, const Eigen::ArrayXXd& hours_kW) {
  const model::Drivers& drivers = *site.drivers;
  const auto months = static_cast<Eigen::Index>(drivers.months.size());
  Eigen::ArrayXd sums = Eigen::ArrayXd::Zero(hours_kW.cols() * months);
  for (Eigen::Index g = 0; g < hours_kW.cols(); ++g) {
    for (Eigen::Index i = 0; i < hours_kW.rows(); ++i) {
      sums[g * months + drivers.hours[static_cast<std::size_t>(i)].month] += hours_kW(i, g);
    }
  }
  for (Eigen::Index row = 0; row < sums.size(); ++row) {
    sums[row] /= metering::days_in(drivers.months[static_cast<std::size_t>(row % months)]);
  }
  return sums;
}

/// Recorded divided by unrecorded; 1 if there was no consumption.
Eigen::ArrayXd ratios(const Eigen::ArrayXd& recorded, const Eigen::ArrayXd& unrecorded) {
  const double least = kLeastShareOfMean * unrecorded.mean();
  return (unrecorded > least).select(recorded / unrecorded, 1.0);
}

/// Position of a value between two nodes: the lower one and the weight of the upper.
struct NodePlace {
  Eigen::Index lower;
  double upper_share;
};

NodePlace place_of(const std::vector<double>& nodes, double value) {
  if (nodes.size() == 1) return {0, 0.0};
  const auto above = std::ranges::upper_bound(nodes, value);
  const auto cell = std::clamp<std::ptrdiff_t>(above - nodes.begin() - 1, 0, std::ssize(nodes) - 2);
  const double low = nodes[static_cast<std::size_t>(cell)];
  const double high = nodes[static_cast<std::size_t>(cell) + 1];
  return {cell, std::clamp((value - low) / (high - low), 0.0, 1.0)};
}

using Nodes = std::vector<std::vector<double>>;

/// Parameter values at a point of the grid, first parameter fastest.
void values_at_point(const Nodes& nodes, Eigen::Index point, std::vector<double>& values) {
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const auto size = static_cast<Eigen::Index>(nodes[j].size());
    values[j] = nodes[j][static_cast<std::size_t>(point % size)];
    point /= size;
  }
}

/// The table of a `MonthlyEffect` at one θ.
Eigen::ArrayXXd changes_over(Predictor& predictor, const SiteProblem& site,
                             const Candidate& candidate, const Nodes& nodes,
                             const std::vector<double>& theta) {
  Eigen::Index grid_points = 1;
  for (const auto& values : nodes) grid_points *= static_cast<Eigen::Index>(values.size());
  const SiteFacts facts = site.facts();
  predictor.parts_kW(theta);
  const Eigen::ArrayXXd without_kW = predictor.hours_kW();
  // The monthly model's profile has what the effect does at the same hours all year.
  const ProfileReading profile{site};
  const auto averages = [&](const Alteration& effect) -> Eigen::ArrayXd {
    predictor.parts_kW(theta, &effect);
    Eigen::ArrayXXd change_kW = predictor.hours_kW() - without_kW;
    profile.take_usual_day_from(change_kW);
    return daily_averages(site, without_kW + change_kW);
  };
  const auto months = static_cast<Eigen::Index>(site.drivers->months.size());
  const bool of_record = candidate.meter >= 0;
  const Eigen::ArrayXd without = daily_averages(site, without_kW);
  Eigen::ArrayXXd table(of_record ? months : without.size(), grid_points);
  std::vector<double> values(nodes.size());
  for (Eigen::Index point = 0; point < grid_points; ++point) {
    values_at_point(nodes, point, values);
    const Eigen::ArrayXd with = averages(*alteration_of(candidate, facts, values));
    if (of_record) {
      const Eigen::Index first = candidate.meter * months;
      table.col(point) = ratios(with.segment(first, months), without.segment(first, months));
    } else {
      table.col(point) = with - without;
    }
  }
  return table;
}

}  // namespace

MonthlyEffect::MonthlyEffect(std::vector<std::vector<double>> nodes, int meter,
                             Eigen::ArrayXXd table, int months, std::vector<double> middle,
                             std::vector<Eigen::ArrayXXd> slopes)
    : nodes_(std::move(nodes)),
      meter_(meter),
      table_(std::move(table)),
      months_(months),
      middle_(std::move(middle)),
      slopes_(std::move(slopes)) {
  [[maybe_unused]] Eigen::Index grid_points = 1;
  for (const auto& values : nodes_) grid_points *= static_cast<Eigen::Index>(values.size());
  assert(nodes_.size() < kNodes.size());
  assert(table_.cols() == grid_points && table_.rows() % months == 0);
  assert(meter_ < 0 || table_.rows() == months);
  assert(middle_.size() == slopes_.size());
}

void MonthlyEffect::apply(std::span<const double> theta, std::span<const double> eta,
                          std::span<double> daily_kWh) const {
  assert(eta.size() == nodes_.size() && theta.size() >= middle_.size());
  std::array<NodePlace, kNodes.size()> places{};
  for (std::size_t j = 0; j < eta.size(); ++j) places[j] = place_of(nodes_[j], eta[j]);
  const std::size_t first = is_of_record() ? static_cast<std::size_t>(meter_ * months_) : 0;
  assert(daily_kWh.size() >= first + static_cast<std::size_t>(table_.rows()));

  std::array<std::pair<Eigen::Index, double>, std::size_t{1} << kNodes.size()> corners{};
  std::size_t count = 0;
  for (unsigned corner = 0; corner < (1U << eta.size()); ++corner) {
    double weight = 1.0;
    Eigen::Index column = 0;
    Eigen::Index stride = 1;
    for (std::size_t j = 0; j < eta.size(); ++j) {
      const bool upper = ((corner >> j) & 1U) != 0;
      weight *= upper ? places[j].upper_share : 1.0 - places[j].upper_share;
      column += stride * (places[j].lower + (upper ? 1 : 0));
      stride *= static_cast<Eigen::Index>(nodes_[j].size());
    }
    if (weight > 0.0) corners[count++] = {column, weight};
  }
  for (Eigen::Index row = 0; row < table_.rows(); ++row) {
    double value = 0.0;
    for (std::size_t c = 0; c < count; ++c) {
      const auto [column, weight] = corners[c];
      value += weight * table_(row, column);
      for (std::size_t j = 0; j < slopes_.size(); ++j) {
        value += weight * slopes_[j](row, column) * (theta[j] - middle_[j]);
      }
    }
    double& meter_kWh = daily_kWh[first + static_cast<std::size_t>(row)];
    meter_kWh = is_of_record() ? meter_kWh * value : std::max(meter_kWh + value, 0.0);
  }
}

MonthlyEffect MonthlyEffect::in_months(std::span<const int> months) const {
  const Eigen::Index blocks = table_.rows() / months_;
  std::vector<Eigen::Index> rows;
  for (Eigen::Index block = 0; block < blocks; ++block) {
    for (const int month : months) rows.push_back(block * months_ + month);
  }
  const auto chosen = [&](const Eigen::ArrayXXd& table) -> Eigen::ArrayXXd {
    return table(rows, Eigen::all);
  };
  std::vector<Eigen::ArrayXXd> slopes;
  for (const Eigen::ArrayXXd& slope : slopes_) slopes.push_back(chosen(slope));
  return {nodes_,  meter_,           chosen(table_), static_cast<int>(months.size()),
          middle_, std::move(slopes)};
}

MonthlyEffect tabulate_effect(const SiteProblem& site,
                              const std::vector<std::shared_ptr<const Alteration>>& before,
                              const Candidate& candidate, std::span<const ParameterRange> ranges,
                              std::span<const ParameterSpread> theta) {
  assert(ranges.size() == candidate.parameters.size() && ranges.size() < kNodes.size());
  Nodes nodes;
  for (const ParameterRange& range : ranges) {
    nodes.push_back(nodes_of(range, kNodes[ranges.size()]));
  }
  Predictor predictor{site, before};
  std::vector<double> at;
  for (const ParameterSpread& parameter : theta) at.push_back(parameter.middle);
  const std::vector<double> middle = at;
  Eigen::ArrayXXd table = changes_over(predictor, site, candidate, nodes, at);
  std::vector<Eigen::ArrayXXd> slopes;
  for (std::size_t j = 0; j < theta.size() && candidate.meter < 0; ++j) {
    at[j] = theta[j].high;
    const Eigen::ArrayXXd above = changes_over(predictor, site, candidate, nodes, at);
    at[j] = theta[j].low;
    slopes.push_back((above - changes_over(predictor, site, candidate, nodes, at)) /
                     (theta[j].high - theta[j].low));
    at[j] = middle[j];
  }
  const auto months = static_cast<int>(site.drivers->months.size());
  // The ratio of a record does not depend on the consumption.
  if (candidate.meter >= 0) return {std::move(nodes), candidate.meter, std::move(table), months};
  return {std::move(nodes), -1, std::move(table), months, middle, std::move(slopes)};
}

std::vector<ParameterSpread> spreads_of(std::span<const Parameter> parameters) {
  std::vector<ParameterSpread> spreads;
  for (const Parameter& parameter : parameters) {
    const Prior& prior = parameter.prior;
    spreads.push_back({prior.quantile(kBelow), prior.mode(), prior.quantile(1.0 - kBelow)});
  }
  return spreads;
}

AlteredMonthlyModel::AlteredMonthlyModel(std::unique_ptr<MonthlyModel> model,
                                         std::vector<MonthlyEffect> effects)
    : model_(std::move(model)), effects_(std::move(effects)) {}

std::unique_ptr<MonthlyModel> AlteredMonthlyModel::clone() const {
  return std::make_unique<AlteredMonthlyModel>(model_->clone(), effects_);
}

int AlteredMonthlyModel::parameter_count() const {
  int count = model_->parameter_count();
  for (const MonthlyEffect& effect : effects_) count += effect.parameter_count();
  return count;
}

void AlteredMonthlyModel::apply(bool records, std::span<const double> theta_and_eta,
                                std::span<double> outputs) const {
  auto first = static_cast<std::size_t>(model_->parameter_count());
  const std::span<const double> theta = theta_and_eta.first(first);
  for (const MonthlyEffect& effect : effects_) {
    const auto count = static_cast<std::size_t>(effect.parameter_count());
    if (effect.is_of_record() == records) {
      effect.apply(theta, theta_and_eta.subspan(first, count), outputs);
    }
    first += count;
  }
}

void AlteredMonthlyModel::evaluate(std::span<const double> theta_and_eta,
                                   std::span<double> outputs) {
  assert(theta_and_eta.size() == static_cast<std::size_t>(parameter_count()));
  model_->evaluate(theta_and_eta.first(static_cast<std::size_t>(model_->parameter_count())),
                   outputs);
  apply(false, theta_and_eta, outputs);
  apply(true, theta_and_eta, outputs);
}

}  // namespace recald::diagnosis
