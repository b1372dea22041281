#include "core/change_point/curve_search.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace recald::change_point {
namespace {

constexpr int kCoarse = TemperatureSums::kEdgesPerKelvin;
constexpr int kLeastDeadBand = kCoarse;  // 1 K between two balance temperatures, or they are one
constexpr int kRefinements = 2;
constexpr double kRelativeZero = 1e-9;

}  // namespace

void CurveSearch::begin(const TemperatureSums& sums, const DayGroup& group) {
  sums_ = &sums;
  group_ = group;
  std::array<double, model::kDayTypes> weight{};
  energy_ = {};
  double squares = 0.0;
  for (std::size_t type = 0; type < model::kDayTypes; ++type) {
    if (group[type] == kNotInGroup) continue;
    const DaySums& all = sums.all(static_cast<model::DayType>(type));
    weight[static_cast<std::size_t>(group[type])] += all.weight;
    energy_[static_cast<std::size_t>(group[type])] += all.energy;
    squares += all.temperature_square;
  }
  least_square_ = kRelativeZero * squares;
  for (std::size_t base = 0; base < model::kDayTypes; ++base) {
    inverse_norm_[base] = weight[base] > 0.0 ? 1.0 / std::sqrt(weight[base]) : 0.0;
    energy_[base] *= inverse_norm_[base];
  }
}

CurveSearch::Hinge CurveSearch::heating_hinge(int edge) const {
  const double a = sums_->edge_C(edge) - sums_->reference_C();
  Hinge hinge;
  for (std::size_t type = 0; type < model::kDayTypes; ++type) {
    if (group_[type] == kNotInGroup) continue;
    const DaySums& cold = sums_->below(static_cast<model::DayType>(type), edge);
    const double sum = a * cold.weight - cold.temperature;  // of w (a - T)
    hinge.with_base[static_cast<std::size_t>(group_[type])] += sum;
    hinge.square += a * (sum - cold.temperature) + cold.temperature_square;
    hinge.product += a * cold.energy - cold.product;
  }
  eliminate_bases(hinge);
  return hinge;
}

CurveSearch::Hinge CurveSearch::cooling_hinge(int edge) const {
  const double a = sums_->edge_C(edge) - sums_->reference_C();
  Hinge hinge;
  for (std::size_t type = 0; type < model::kDayTypes; ++type) {
    if (group_[type] == kNotInGroup) continue;
    const auto kind = static_cast<model::DayType>(type);
    const DaySums warm = sums_->all(kind) - sums_->below(kind, edge);
    const double sum = warm.temperature - a * warm.weight;  // of w (T - a)
    hinge.with_base[static_cast<std::size_t>(group_[type])] += sum;
    hinge.square += warm.temperature_square - a * (warm.temperature + sum);
    hinge.product += warm.product - a * warm.energy;
  }
  eliminate_bases(hinge);
  return hinge;
}

void CurveSearch::eliminate_bases(Hinge& hinge) const {
  for (std::size_t base = 0; base < model::kDayTypes; ++base) {
    const double with_unit = hinge.with_base[base] * inverse_norm_[base];
    hinge.with_base[base] = with_unit;
    hinge.square -= with_unit * with_unit;
    hinge.product -= with_unit * energy_[base];
  }
}

CurveSearch::Slopes CurveSearch::one_slope(const Hinge& hinge, bool heats) const {
  if (hinge.square <= least_square_ || hinge.product <= 0.0) return {.gain = -1.0};
  const double slope = hinge.product / hinge.square;
  return {.heating = heats ? slope : 0.0,
          .cooling = heats ? 0.0 : slope,
          .gain = slope * hinge.product};
}

CurveSearch::Slopes CurveSearch::two_slopes(const Hinge& cold, const Hinge& warm) const {
  // The two hinges are never both positive, so only the eliminated bases relate them.
  double cross = 0.0;
  for (std::size_t b = 0; b < model::kDayTypes; ++b) cross -= cold.with_base[b] * warm.with_base[b];
  const double determinant = cold.square * warm.square - cross * cross;
  if (cold.square <= least_square_ || warm.square <= least_square_ ||
      determinant <= kRelativeZero * cold.square * warm.square) {
    return {.gain = -1.0};
  }
  const double h = (warm.square * cold.product - cross * warm.product) / determinant;
  const double c = (cold.square * warm.product - cross * cold.product) / determinant;
  return {.heating = h, .cooling = c, .gain = h * cold.product + c * warm.product};
}

CurveSearch::Found CurveSearch::search_one(EdgeLimits limits, bool heats) const {
  const int first = heats ? limits.heating_first : 0;
  const int last = heats ? sums_->last_edge() : limits.cooling_last;
  Found best{.slopes = {.gain = -1.0}};
  const auto look_at = [&](int edge) {
    const Slopes slopes = one_slope(heats ? heating_hinge(edge) : cooling_hinge(edge), heats);
    if (slopes.gain > best.slopes.gain) best = {edge, edge, slopes};
  };
  for (int edge = first; edge <= last; edge += kCoarse) look_at(edge);
  if (best.slopes.gain < 0.0) return best;
  const int centre = best.heating_edge;
  const int end = std::min(last, centre + kCoarse);
  for (int edge = std::max(first, centre - kCoarse); edge <= end; ++edge) look_at(edge);
  return best;
}

CurveSearch::Found CurveSearch::search_4p(EdgeLimits limits) const {
  Found best{.slopes = {.gain = -1.0}};
  const auto look_at = [&](int edge) {
    const Slopes slopes = two_slopes(heating_hinge(edge), cooling_hinge(edge));
    const bool is_roof = slopes.heating < 0.0 && slopes.cooling < 0.0;
    if (!is_roof && slopes.gain > best.slopes.gain) best = {edge, edge, slopes};
  };
  for (int edge = limits.heating_first; edge <= limits.cooling_last; edge += kCoarse) look_at(edge);
  if (best.slopes.gain < 0.0) return best;
  const int centre = best.heating_edge;
  const int end = std::min(limits.cooling_last, centre + kCoarse);
  for (int edge = std::max(limits.heating_first, centre - kCoarse); edge <= end; ++edge) {
    look_at(edge);
  }
  return best;
}

CurveSearch::Found CurveSearch::search_5p(EdgeLimits limits) {
  cold_.clear();
  warm_.clear();
  for (int edge = limits.heating_first; edge <= limits.cooling_last; edge += kCoarse) {
    cold_.push_back(heating_hinge(edge));
    warm_.push_back(cooling_hinge(edge));
  }
  Found best{.slopes = {.gain = -1.0}};
  for (std::size_t i = 0; i < cold_.size(); ++i) {
    for (std::size_t j = i + 1; j < warm_.size(); ++j) {
      const Slopes slopes = two_slopes(cold_[i], warm_[j]);
      if (slopes.heating < 0.0 || slopes.cooling < 0.0) continue;
      if (slopes.gain > best.slopes.gain) {
        best = {limits.heating_first + static_cast<int>(i) * kCoarse,
                limits.heating_first + static_cast<int>(j) * kCoarse, slopes};
      }
    }
  }
  if (best.slopes.gain >= 0.0) refine_5p(limits, best);
  return best;
}

void CurveSearch::refine_5p(EdgeLimits limits, Found& best) const {
  const auto consider = [&](int heating_edge, int cooling_edge, const Hinge& cold,
                            const Hinge& warm) {
    const Slopes slopes = two_slopes(cold, warm);
    if (slopes.heating >= 0.0 && slopes.cooling >= 0.0 && slopes.gain > best.slopes.gain) {
      best = {heating_edge, cooling_edge, slopes};
    }
  };
  for (int round = 0; round < kRefinements; ++round) {
    const int cooling_edge = best.cooling_edge;
    const Hinge warm = cooling_hinge(cooling_edge);
    const int heating_centre = best.heating_edge;
    const int heating_last = std::min(cooling_edge - kLeastDeadBand, heating_centre + kCoarse);
    for (int edge = std::max(limits.heating_first, heating_centre - kCoarse); edge <= heating_last;
         ++edge) {
      consider(edge, cooling_edge, heating_hinge(edge), warm);
    }
    const int heating_edge = best.heating_edge;
    const Hinge cold = heating_hinge(heating_edge);
    const int cooling_centre = best.cooling_edge;
    const int cooling_last = std::min(limits.cooling_last, cooling_centre + kCoarse);
    for (int edge = std::max(heating_edge + kLeastDeadBand, cooling_centre - kCoarse);
         edge <= cooling_last; ++edge) {
      consider(heating_edge, edge, cold, cooling_hinge(edge));
    }
  }
}

GroupFit CurveSearch::assemble(Form form, const Found& found) const {
  const bool heats = form != Form::no_temperature && form != Form::cooling_3p;
  const bool cools = form != Form::no_temperature && form != Form::heating_3p;
  GroupFit fit{.curve = {.form = form}, .base_kWh = {}};
  Hinge cold;
  Hinge warm;
  if (heats) {
    fit.curve.heating_balance_C = sums_->edge_C(found.heating_edge);
    fit.curve.heating_slope_kWh_K = found.slopes.heating;
    cold = heating_hinge(found.heating_edge);
  }
  if (cools) {
    fit.curve.cooling_balance_C = sums_->edge_C(found.cooling_edge);
    fit.curve.cooling_slope_kWh_K = found.slopes.cooling;
    warm = cooling_hinge(found.cooling_edge);
  }
  for (std::size_t base = 0; base < model::kDayTypes; ++base) {
    const double by_curve = fit.curve.heating_slope_kWh_K * cold.with_base[base] +
                            fit.curve.cooling_slope_kWh_K * warm.with_base[base];
    fit.base_kWh[base] = (energy_[base] - by_curve) * inverse_norm_[base];
  }
  return fit;
}

std::array<GroupFit, kForms> CurveSearch::fit(const TemperatureSums& sums, const DayGroup& group,
                                              EdgeLimits limits) {
  begin(sums, group);
  const Found none{};
  const Found heating = search_one(limits, true);
  const Found cooling = search_one(limits, false);
  const GroupFit flat = assemble(Form::no_temperature, none);
  const GroupFit heats = heating.slopes.gain < 0.0 ? flat : assemble(Form::heating_3p, heating);
  const GroupFit cools = cooling.slopes.gain < 0.0 ? flat : assemble(Form::cooling_3p, cooling);
  const GroupFit& simpler = heating.slopes.gain >= cooling.slopes.gain ? heats : cools;
  const Found four = search_4p(limits);
  const Found five = search_5p(limits);
  return {flat, heats, cools,
          four.slopes.gain < 0.0 ? simpler : assemble(Form::two_slopes_4p, four),
          five.slopes.gain < 0.0 ? simpler : assemble(Form::two_slopes_5p, five)};
}

}  // namespace recald::change_point
