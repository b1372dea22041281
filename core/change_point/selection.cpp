#include "core/change_point/selection.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace recald::change_point {
namespace {

constexpr int kDaysOfABase = 8;    // or a kind of day shares the base load of the next kind
constexpr int kDaysOfACurve = 30;  // or open and closed days share one
constexpr int kDaysBesideBalance = 10;

constexpr double kRounding = 1e-9;  // two ways to the same fit differ by it

constexpr std::size_t kWorkday = 0;
constexpr std::size_t kSaturday = 1;
constexpr std::size_t kSunday = 2;

using Flags = std::array<bool, model::kDayTypes>;

struct Kinds {
  std::array<int, model::kDayTypes> days{};
  std::array<std::set<int>, model::kDayTypes> folds;
};

Kinds count_kinds(std::span<const TrainingDay> days) {
  Kinds kinds;
  for (const TrainingDay& day : days) {
    const auto type = static_cast<std::size_t>(day.type);
    ++kinds.days[type];
    kinds.folds[type].insert(day.fold);
  }
  return kinds;
}

/// Whether days of these kinds remain whichever fold is left out.
bool may_have_a_base(const Kinds& kinds, std::initializer_list<std::size_t> types) {
  int days = 0;
  std::set<int> folds;
  for (const std::size_t type : types) {
    days += kinds.days[type];
    folds.insert(kinds.folds[type].begin(), kinds.folds[type].end());
  }
  return days >= kDaysOfABase && folds.size() >= 2;
}

/// Numbers of the base loads that can be told apart.
DayGroup own_bases(const Kinds& kinds) {
  if (!may_have_a_base(kinds, {kWorkday}) || !may_have_a_base(kinds, {kSaturday, kSunday})) {
    return {0, 0, 0};
  }
  if (!may_have_a_base(kinds, {kSaturday}) || !may_have_a_base(kinds, {kSunday})) return {0, 1, 1};
  return {0, 1, 2};
}

/// The kinds of a group out of all; base loads numbered anew from 0.
DayGroup part_of(const DayGroup& all, const Flags& members) {
  DayGroup part{kNotInGroup, kNotInGroup, kNotInGroup};
  int next = 0;
  for (std::size_t type = 0; type < model::kDayTypes; ++type) {
    if (!members[type]) continue;
    for (std::size_t earlier = 0; earlier < type; ++earlier) {
      if (members[earlier] && all[earlier] == all[type]) part[type] = part[earlier];
    }
    if (part[type] == kNotInGroup) part[type] = next++;
  }
  return part;
}

EdgeLimits edge_limits(std::span<const TrainingDay> days, const DayGroup& group,
                       const TemperatureSums& sums) {
  std::vector<double> temperatures;
  for (const TrainingDay& day : days) {
    if (group[static_cast<std::size_t>(day.type)] != kNotInGroup) {
      temperatures.push_back(day.dry_bulb_C);
    }
  }
  EdgeLimits limits{.heating_first = sums.last_edge() + 1, .cooling_last = -1};
  if (std::ssize(temperatures) < 2 * kDaysBesideBalance) return limits;
  std::sort(temperatures.begin(), temperatures.end());
  const double cold = temperatures[kDaysBesideBalance - 1];
  const double warm = temperatures[temperatures.size() - kDaysBesideBalance];
  const auto edge_near = [&](double temperature_C) {
    return (temperature_C - sums.edge_C(0)) * TemperatureSums::kEdgesPerKelvin;
  };
  limits.heating_first = static_cast<int>(std::floor(edge_near(cold))) + 1;
  limits.cooling_last = static_cast<int>(std::ceil(edge_near(warm))) - 1;
  return limits;
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Index of the first candidate that is worse than the best by at most the standard error of the
/// difference. @param losses  By candidate, simplest first, and block.
std::size_t simplest_good_one(const std::vector<std::vector<double>>& losses) {
  const auto best = std::ranges::min_element(losses, {}, sum);
  const double blocks = static_cast<double>(best->size());
  for (std::size_t k = 0; k < losses.size(); ++k) {
    double total = 0.0;
    double squares = 0.0;
    for (std::size_t b = 0; b < best->size(); ++b) {
      const double difference = losses[k][b] - (*best)[b];
      total += difference;
      squares += difference * difference;
    }
    const double variance = (squares - total * total / blocks) / (blocks - 1.0);
    if (total <= std::sqrt(std::max(0.0, variance) * blocks) + kRounding * sum(*best)) return k;
  }
  return static_cast<std::size_t>(best - losses.begin());
}

std::pair<double, double> temperature_range(std::span<const TrainingDay> days) {
  const auto [coldest, warmest] = std::ranges::minmax_element(days, {}, &TrainingDay::dry_bulb_C);
  return {coldest->dry_bulb_C, warmest->dry_bulb_C};
}

}  // namespace

Selector::Selector(std::span<const TrainingDay> days, bool with_temperature)
    : days_(days.size()),
      blocks_(1 + std::ranges::max_element(days, {}, &TrainingDay::block)->block),
      folds_(1 + std::ranges::max_element(days, {}, &TrainingDay::fold)->fold),
      sums_(temperature_range(days).first, temperature_range(days).second) {
  assert(folds_ >= 2);
  const Kinds kinds = count_kinds(days);
  const DayGroup bases = own_bases(kinds);
  groupings_.push_back({add_group(days, {0, 0, 0}, with_temperature)});
  if (bases != DayGroup{0, 0, 0}) {
    groupings_.push_back({add_group(days, bases, with_temperature)});
    const auto split = [&](const Flags& open) {
      const Flags closed{!open[kWorkday], !open[kSaturday], !open[kSunday]};
      int open_days = 0;
      for (std::size_t type = 0; type < model::kDayTypes; ++type) {
        if (open[type]) open_days += kinds.days[type];
      }
      const int closed_days = static_cast<int>(days.size()) - open_days;
      if (std::min(open_days, closed_days) < kDaysOfACurve) return;
      groupings_.push_back({add_group(days, part_of(bases, open), with_temperature),
                            add_group(days, part_of(bases, closed), with_temperature)});
    };
    split({true, false, false});
    if (bases == DayGroup{0, 1, 2}) split({true, true, false});
  }
  residuals_.resize(days.size() * kForms * candidates_.size());
}

std::size_t Selector::add_group(std::span<const TrainingDay> days, const DayGroup& group,
                                bool with_temperature) {
  const EdgeLimits none{.heating_first = sums_.last_edge() + 1, .cooling_last = -1};
  candidates_.push_back({group, with_temperature ? edge_limits(days, group, sums_) : none});
  return candidates_.size() - 1;
}

void Selector::leave_folds_out(std::span<const TrainingDay> days) {
  for (int fold = 0; fold < folds_; ++fold) {
    sums_.clear();
    for (const TrainingDay& day : days) {
      if (day.fold != fold) sums_.add(day.type, day.dry_bulb_C, day.energy_kWh, day.weight);
    }
    sums_.cumulate();
    for (std::size_t group = 0; group < candidates_.size(); ++group) {
      const Candidate& candidate = candidates_[group];
      const auto fits = search_.fit(sums_, candidate.group, candidate.limits);
      for (std::size_t d = 0; d < days.size(); ++d) {
        const int base = candidate.group[static_cast<std::size_t>(days[d].type)];
        if (days[d].fold != fold || base == kNotInGroup) continue;
        for (std::size_t form = 0; form < kForms; ++form) {
          residual(d, group, form) = days[d].energy_kWh -
                                     fits[form].base_kWh[static_cast<std::size_t>(base)] -
                                     fits[form].curve.at(days[d].dry_bulb_C);
        }
      }
    }
  }
}

std::vector<double> Selector::losses(std::span<const TrainingDay> days, std::size_t group,
                                     std::size_t form) const {
  std::vector<double> by_block(static_cast<std::size_t>(blocks_), 0.0);
  for (std::size_t d = 0; d < days.size(); ++d) {
    const double off = residual(d, group, form);  // 0 for days of other groups
    by_block[static_cast<std::size_t>(days[d].block)] += days[d].weight * off * off;
  }
  return by_block;
}

std::size_t Selector::choose_form(std::span<const TrainingDay> days, std::size_t group) const {
  std::vector<std::vector<double>> by_form;
  for (std::size_t form = 0; form < kForms; ++form) by_form.push_back(losses(days, group, form));
  // Of the two forms with three parameters neither is simpler: the better one stands for both.
  constexpr auto heating = static_cast<std::size_t>(Form::heating_3p);
  constexpr auto cooling = static_cast<std::size_t>(Form::cooling_3p);
  const bool cools = sum(by_form[cooling]) < sum(by_form[heating]);
  by_form.erase(by_form.begin() + (cools ? heating : cooling));
  const std::size_t chosen = simplest_good_one(by_form);
  return chosen < heating ? chosen : chosen == heating ? (cools ? cooling : heating) : chosen + 1;
}

Selection Selector::select(std::span<const TrainingDay> days) {
  assert(days.size() == days_);
  leave_folds_out(days);
  std::vector<std::size_t> form_of;
  for (std::size_t group = 0; group < candidates_.size(); ++group) {
    form_of.push_back(choose_form(days, group));
  }
  std::vector<std::vector<double>> by_grouping;
  for (const std::vector<std::size_t>& grouping : groupings_) {
    std::vector<double> total(static_cast<std::size_t>(blocks_), 0.0);
    for (const std::size_t group : grouping) {
      std::ranges::transform(total, losses(days, group, form_of[group]), total.begin(),
                             std::plus<>{});
    }
    by_grouping.push_back(std::move(total));
  }
  if (by_grouping.size() == 4 && sum(by_grouping[3]) < sum(by_grouping[2])) {
    std::swap(by_grouping[2], by_grouping[3]);  // equally simple
    std::swap(groupings_[2], groupings_[3]);
  }
  Selection selection;
  selection.left_out_residual_kWh.assign(days.size(), 0.0);
  for (const std::size_t group : groupings_[simplest_good_one(by_grouping)]) {
    selection.choice.groups.push_back(candidates_[group].group);
    selection.choice.forms.push_back(static_cast<Form>(form_of[group]));
    for (std::size_t d = 0; d < days.size(); ++d) {
      selection.left_out_residual_kWh[d] += residual(d, group, form_of[group]);
    }
  }
  return selection;
}

std::vector<GroupFit> Selector::fit(std::span<const TrainingDay> days, const Choice& choice) {
  sums_.clear();
  for (const TrainingDay& day : days) {
    sums_.add(day.type, day.dry_bulb_C, day.energy_kWh, day.weight);
  }
  sums_.cumulate();
  std::vector<GroupFit> fits;
  for (std::size_t k = 0; k < choice.groups.size(); ++k) {
    const auto candidate = std::ranges::find(candidates_, choice.groups[k], &Candidate::group);
    assert(candidate != candidates_.end());
    const auto forms = search_.fit(sums_, candidate->group, candidate->limits);
    fits.push_back(forms[static_cast<std::size_t>(choice.forms[k])]);
  }
  return fits;
}

}  // namespace recald::change_point
