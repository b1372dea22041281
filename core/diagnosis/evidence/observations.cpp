#include "core/diagnosis/evidence/observations.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace recald::diagnosis {
namespace {

constexpr int kTemperatureSplines = 8;
constexpr int kTemperatureSplinesByPart = 5;
constexpr int kDriverSplines = 6;
constexpr int kSeasonSplines = 10;
constexpr double kDaysPerDateSpline = 45.0;
// A slow drift of the meters' patterns, in units of the other patterns.
constexpr double kDateFactor = 0.5;
// The electricity meter's hourly pattern was derived from the meter itself, so its level in each
// part of the week says nothing about the model.
constexpr double kElectricityPatternFactor = 15.0;

/// Linear B-splines (hats) on equally populated knots: local, sparse and never negative.
struct Hats {
  std::vector<double> knots;

  static Hats at_quantiles(std::vector<double> values, int count) {
    std::ranges::sort(values);
    Hats hats;
    for (int k = 0; k < count; ++k) {
      const auto index = static_cast<std::size_t>(std::lround(
          static_cast<double>(k) / (count - 1) * static_cast<double>(values.size() - 1)));
      if (hats.knots.empty() || values[index] > hats.knots.back() + 1e-9) {
        hats.knots.push_back(values[index]);
      }
    }
    return hats;
  }
  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(knots.size()); }

  void fill(double x, Eigen::Ref<Eigen::RowVectorXd> row) const {
    const auto upper = std::ranges::upper_bound(knots, x);
    if (upper == knots.begin()) {
      row[0] = 1.0;
      return;
    }
    if (upper == knots.end()) {
      row[count() - 1] = 1.0;
      return;
    }
    const auto i = static_cast<Eigen::Index>(upper - knots.begin()) - 1;
    const double share = (x - knots[static_cast<std::size_t>(i)]) / (*upper - *(upper - 1));
    row[i] = 1.0 - share;
    row[i + 1] = share;
  }
};

using PartValue = double (*)(const DayPart&);

/// Day of the year; the hats at the two ends are adjacent at New Year but unconnected.
double season_days(metering::Day date) {
  const std::chrono::sys_days new_year{date.year() / 1 / 1};
  return static_cast<double>((std::chrono::sys_days{date} - new_year).count());
}

struct SplineOver {
  PartValue value;
  Hats hats;
  double factor = 1.0;  ///< Of its size, relative to the other patterns.
};

/// Knots for the whole period, whatever months are observed, so that patterns learnt from one set
/// of months apply to another.
SplineOver spline_over(const SiteProblem& site, PartValue value, int count) {
  std::vector<double> values;
  values.reserve(site.day_parts.parts.size());
  for (const DayPart& part : site.day_parts.parts) values.push_back(value(part));
  return {value, Hats::at_quantiles(std::move(values), count)};
}

std::vector<SplineOver> splines_of(const SiteProblem& site) {
  std::vector<SplineOver> splines;
  splines.push_back(spline_over(
      site, [](const DayPart& p) { return p.dry_bulb_C; }, kTemperatureSplines));
  const auto add = [&](PartValue value, int count) {
    splines.push_back(spline_over(site, value, count));
  };
  add([](const DayPart& p) { return season_days(p.date); }, kSeasonSplines);
  add([](const DayPart& p) { return p.global_horizontal_W_m2; }, kDriverSplines);
  if (site.drivers->has_humidity) {
    add([](const DayPart& p) { return p.humidity_ratio; }, kDriverSplines);
  }
  if (site.drivers->has_wind) add([](const DayPart& p) { return p.wind_m_s; }, kDriverSplines);
  const auto& parts = site.day_parts.parts;
  const double days = parts.back().day_index - parts.front().day_index + 1.0;
  add([](const DayPart& p) { return static_cast<double>(p.day_index); },
      std::max(3, static_cast<int>(days / kDaysPerDateSpline)));
  splines.back().factor = kDateFactor;
  return splines;
}

BlockDesign design_of(const SiteProblem& site, const std::vector<Eigen::Index>& rows,
                      bool electricity) {
  const std::vector<SplineOver> splines = splines_of(site);
  // A spline in outdoor temperature for each part of the day, separately for workdays and other
  // days: the errors of a simple building model depend on hour and weather.
  const SplineOver by_part = spline_over(
      site, [](const DayPart& p) { return p.dry_bulb_C; }, kTemperatureSplinesByPart);
  const Eigen::Index per_part = by_part.hats.count();
  Eigen::Index columns = kPartsPerWeek + 2 * kPartsPerDay * per_part;
  for (const SplineOver& s : splines) columns += s.hats.count();
  const auto n = static_cast<Eigen::Index>(rows.size());
  BlockDesign design{Eigen::VectorXd(n), Eigen::MatrixXd::Zero(n, columns), {}};
  Eigen::RowVectorXd hats;
  for (Eigen::Index i = 0; i < n; ++i) {
    const DayPart& part =
        site.day_parts.parts[static_cast<std::size_t>(rows[static_cast<std::size_t>(i)])];
    design.times_h[i] = part.time_h;
    design.patterns(i, part.part_of_week) = electricity ? kElectricityPatternFactor : 1.0;
    const bool workday = part.day == model::DayType::workday;
    hats.setZero(per_part);
    by_part.hats.fill(by_part.value(part), hats);
    design.patterns.row(i).segment(
        kPartsPerWeek + (part.part + (workday ? 0 : kPartsPerDay)) * per_part, per_part) = hats;
    Eigen::Index first = kPartsPerWeek + 2 * kPartsPerDay * per_part;
    for (const SplineOver& s : splines) {
      hats.setZero(s.hats.count());
      s.hats.fill(s.value(part), hats);
      design.patterns.row(i).segment(first, s.hats.count()) = s.factor * hats;
      first += s.hats.count();
    }
  }
  design.drifts = splines.back().hats.count();  // the dates
  return design;
}

}  // namespace

double on_scale(double power_kW, double mean_kW, ResidualScale scale) {
  if (scale == ResidualScale::linear) return power_kW;
  return 2.0 * std::sqrt(1.1 * mean_kW * (std::max(power_kW, 0.0) + 0.1 * mean_kW));
}

Eigen::VectorXd Observations::stack(const Eigen::ArrayXXd& parts_kW) const {
  Eigen::VectorXd stacked(count());
  for (std::size_t g = 0; g < meters.size(); ++g) {
    const MeterRows& meter = meters[g];
    for (std::size_t i = 0; i < meter.rows.size(); ++i) {
      const double spread =
          meter.scale.spread.size() == 0 ? 1.0 : meter.scale.spread[meter.rows[i]];
      stacked[meter.offset + static_cast<Eigen::Index>(i)] =
          on_scale(parts_kW(meter.rows[i], static_cast<Eigen::Index>(g)), meter.mean_kW,
                   meter.scale.levels) /
          spread;
    }
  }
  return stacked;
}

Observations observe(const SiteProblem& site, const std::vector<bool>& part_flags,
                     std::span<const MeterScale> scales) {
  Observations result;
  const SiteFacts facts = site.facts();
  Eigen::Index offset = 0;
  for (std::size_t g = 0; g < site.meters.size(); ++g) {
    MeterRows meter;
    meter.offset = offset;
    meter.mean_kW = facts.mean_kW[g];
    meter.scale = scales[g];
    for (Eigen::Index i = 0; i < site.day_parts.count(); ++i) {
      if (part_flags[static_cast<std::size_t>(i)] &&
          std::isfinite(site.measured_parts_kW(i, static_cast<Eigen::Index>(g)))) {
        meter.rows.push_back(i);
      }
    }
    if (!meter.rows.empty()) {
      meter.design =
          design_of(site, meter.rows, site.meters[g].utility == metering::Utility::electricity);
    }
    offset += static_cast<Eigen::Index>(meter.rows.size());
    result.meters.push_back(std::move(meter));
  }
  result.measured.resize(offset);
  result.measured = result.stack(site.measured_parts_kW);
  return result;
}

Eigen::ArrayXd spread_of(const SiteProblem& site, const MeterRows& meter,
                         const Eigen::Ref<const Eigen::VectorXd>& residual) {
  constexpr int kTemperatures = 3;
  constexpr double kPriorParts = 50.0;  // the weight of the overall mean in each bin
  constexpr double kLeast = 0.25;       // of that mean: no part is known exactly
  const SplineOver thirds = spline_over(
      site, [](const DayPart& p) { return p.dry_bulb_C; }, kTemperatures + 1);
  const auto bin_of = [&](const DayPart& part) {
    const auto& knots = thirds.hats.knots;
    const auto above =
        std::ranges::count_if(knots, [&](double knot) { return part.dry_bulb_C >= knot; });
    const int third = std::clamp(static_cast<int>(above) - 1, 0, kTemperatures - 1);
    const int workday = part.day == model::DayType::workday ? 0 : 1;
    return static_cast<std::size_t>((part.part + kPartsPerDay * workday) * kTemperatures + third);
  };
  std::array<double, 2 * kPartsPerDay * kTemperatures> squares{};
  std::array<double, 2 * kPartsPerDay * kTemperatures> counts{};
  for (std::size_t i = 0; i < meter.rows.size(); ++i) {
    const std::size_t bin = bin_of(site.day_parts.parts[static_cast<std::size_t>(meter.rows[i])]);
    squares[bin] += residual[static_cast<Eigen::Index>(i)] * residual[static_cast<Eigen::Index>(i)];
    counts[bin] += 1.0;
  }
  const double mean = std::max(residual.squaredNorm() / static_cast<double>(residual.size()),
                               std::numeric_limits<double>::min());
  Eigen::ArrayXd spread(site.day_parts.count());
  for (Eigen::Index i = 0; i < spread.size(); ++i) {
    const std::size_t bin = bin_of(site.day_parts.parts[static_cast<std::size_t>(i)]);
    const double square = (squares[bin] + kPriorParts * mean) / (counts[bin] + kPriorParts);
    spread[i] = std::sqrt(std::max(square / mean, kLeast * kLeast));
  }
  double logs = 0.0;
  for (const Eigen::Index row : meter.rows) logs += std::log(spread[row]);
  return spread / std::exp(logs / static_cast<double>(meter.rows.size()));
}

std::vector<bool> parts_of(const SiteProblem& site, std::initializer_list<Role> roles) {
  std::vector<bool> flags;
  flags.reserve(site.roles.size());
  for (const Role role : site.roles) {
    flags.push_back(std::ranges::find(roles, role) != roles.end());
  }
  return flags;
}

GramSystem NoiseNode::gram(const Observations& observations,
                           const Eigen::Ref<const Eigen::MatrixXd>& columns) const {
  GramSystem system;
  std::size_t next = 0;
  for (const MeterRows& meter : observations.meters) {
    if (meter.rows.empty()) continue;
    system.add(meters[next++],
               columns.middleRows(meter.offset, static_cast<Eigen::Index>(meter.rows.size())));
  }
  return system;
}

Eigen::MatrixXd NoiseNode::solve(const Observations& observations,
                                 const Eigen::Ref<const Eigen::MatrixXd>& columns) const {
  Eigen::MatrixXd solved(columns.rows(), columns.cols());
  std::size_t next = 0;
  for (const MeterRows& meter : observations.meters) {
    if (meter.rows.empty()) continue;
    const auto n = static_cast<Eigen::Index>(meter.rows.size());
    solved.middleRows(meter.offset, n) = meters[next++].solve(columns.middleRows(meter.offset, n));
  }
  return solved;
}

Eigen::VectorXd NoiseNode::squared_norms(const Observations& observations,
                                         const Eigen::Ref<const Eigen::MatrixXd>& columns) const {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(columns.cols());
  std::size_t next = 0;
  for (const MeterRows& meter : observations.meters) {
    if (meter.rows.empty()) continue;
    squares += meters[next++].squared_norms(
        columns.middleRows(meter.offset, static_cast<Eigen::Index>(meter.rows.size())));
  }
  return squares;
}

std::vector<NoiseNode> noise_grid(const Observations& observations,
                                  std::span<const NoiseLevel> levels, bool whole,
                                  const ForEachIndex& executor) {
  constexpr std::array<double, 3> kStructure{0.6, 1.0, 1.7};
  constexpr std::array<double, 3> kCorrelation{0.4, 1.0, 2.5};
  constexpr std::array<double, 3> kWhite{0.8, 1.0, 1.25};
  constexpr std::array<double, 3> kMiddle{1.0, 1.0, 1.0};
  const std::size_t n = whole ? 3 : 1;
  const auto& structure = whole ? kStructure : kMiddle;
  const auto& correlation = whole ? kCorrelation : kMiddle;
  const auto& white = whole ? kWhite : kMiddle;
  const std::size_t nodes = n * n * n;
  std::vector<NoiseNode> grid(nodes, {{}, -std::log(static_cast<double>(nodes))});
  std::vector<SparsePatterns> patterns;
  for (const MeterRows& meter : observations.meters) {
    patterns.push_back(sparse_patterns(meter.design));
  }
  executor(nodes, [&](std::size_t i) {
    for (std::size_t g = 0; g < observations.meters.size(); ++g) {
      if (observations.meters[g].rows.empty()) continue;
      NoiseLevel level = levels[g];
      level.structure_sd *= structure[i / (n * n)];
      level.correlation_h *= correlation[i / n % n];
      level.white_sd *= white[i % n];
      grid[i].meters.emplace_back(observations.meters[g].design, level, patterns[g]);
    }
  });
  return grid;
}

}  // namespace recald::diagnosis
