#include "core/metering/months/validation.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/absent.hpp"

namespace recald::metering {
namespace {

using std::chrono::seconds;

constexpr double kNormalMad = 1.4826;      // MAD of a normal distribution to its sd
constexpr double kSpikeScaleFloor = 0.01;  // of the month's median
constexpr std::size_t kSpikeDaysMin = 5;   // fewer days say nothing about a time of day
constexpr double kSameSize = 2.0;          // firings of one boiler differ by less
constexpr int kFiringsConfirming = 2;      // that a load draws so much now and then
constexpr double kFewSteps = 8.0;          // of a coarse register; a load rests below this
constexpr double kSlipOfDay = 0.9;         // of a day's readings: above the limit all are slips

void condemn(MonthSlots& month, std::size_t slot, Reason reason) {
  month.validity[slot] = Validity::suspect;
  month.reasons[slot] |= reason;
}

/// The meter's value, accepted or not; NaN if there was none or only a counter's sum.
double reported_kW(const MonthSlots& month, std::size_t slot) {
  const Validity v = month.validity[slot];
  return v == Validity::ok || v == Validity::suspect ? month.measured_kW[slot] : kAbsent;
}

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Of the readings that are not zero.
double median_magnitude(const MonthSlots& month) {
  std::vector<double> values;
  values.reserve(month.measured_kW.size());
  for (std::size_t i = 0; i < month.measured_kW.size(); ++i) {
    const double magnitude_kW = std::abs(month.measured_kW[i]);
    if (month.validity[i] == Validity::ok && magnitude_kW > 0.0) values.push_back(magnitude_kW);
  }
  return values.empty() ? 0.0 : median_of(values);
}

struct Extremes {
  double lowest_kW = 0.0;  // 0 when nothing is below
  double highest_kW = 0.0;

  [[nodiscard]] double magnitude_kW() const { return std::max(highest_kW, -lowest_kW); }
};

/// Extremes of the source's readings.
Extremes extremes_of(const MonthSlots& month) {
  Extremes extremes;
  for (std::size_t i = 0; i < month.measured_kW.size(); ++i) {
    const double value_kW = month.measured_kW[i];
    const bool inside = !(value_kW > extremes.highest_kW) && !(value_kW < extremes.lowest_kW);
    if (inside || month.validity[i] == Validity::scaled) continue;
    extremes.highest_kW = std::max(extremes.highest_kW, value_kW);
    extremes.lowest_kW = std::min(extremes.lowest_kW, value_kW);
  }
  return extremes;
}

/// The largest value accepted from this meter in this month.
double range_limit_kW(const MonthSlots& month, double largest_kW, const Meter& meter,
                      const ValidationContext& context, const ValidationOptions& options) {
  if (meter.rated_kW) return options.range_factor * *meter.rated_kW;
  const double by_history =
      options.unrated_history_factor * context.largest_believed_kW.value_or(0.0);
  if (largest_kW <= by_history) return by_history;  // the usual case, without a median
  return std::max(by_history, options.unrated_range_factor * median_magnitude(month));
}

void check_range(MonthSlots& month, double lower_kW, double limit_kW, Reason below) {
  for (std::size_t i = 0; i < month.measured_kW.size(); ++i) {
    if (month.validity[i] != Validity::ok) continue;
    if (month.measured_kW[i] > limit_kW) condemn(month, i, Reason::range);
    if (month.measured_kW[i] < lower_kW) condemn(month, i, below);
  }
}

/// Believes readings above a limit that nobody gave, if others show that the load draws so much.
class LargeLoads {
 public:
  /// @param sign  1; −1 of a meter both ways: what it feeds in.
  LargeLoads(const MonthSlots& month, const ValidationContext& context, double limit_kW,
             double sign)
      : month_{month}, limit_kW_{limit_kW}, sign_{sign} {
    for (const MonthSlots* one : {context.before, &month, context.after}) {
      if (one != nullptr) gather(*one);
    }
  }

  /// @pre the slot's reading lies above the limit
  [[nodiscard]] bool believes(std::size_t slot) const {
    const Large own = large_of(month_, slot);
    if (is_slip(own)) return false;
    return std::any_of(large_.begin(), large_.end(), [&](const Large& other) {
      const bool is_another_day = other.month != own.month || other.day != own.day;
      const bool is_like = other.kW >= own.kW / kSameSize && other.kW <= own.kW * kSameSize;
      const bool is_word = other.kW == own.kW && other.is_single && own.is_single;
      return is_another_day && is_like && !is_word && !is_slip(other);
    });
  }

 private:
  struct Large {
    const MonthSlots* month;
    int day;
    double kW;
    bool is_single;  ///< Neither neighbour lies above the limit.
  };

  [[nodiscard]] bool is_above(const MonthSlots& month, std::size_t slot) const {
    return slot < month.measured_kW.size() && sign_ * month.measured_kW[slot] > limit_kW_;
  }

  [[nodiscard]] Large large_of(const MonthSlots& month, std::size_t slot) const {
    const bool is_single = !is_above(month, slot + 1) && (slot == 0 || !is_above(month, slot - 1));
    return {&month, month.grid->day(static_cast<int>(slot)), sign_ * month.measured_kW[slot],
            is_single};
  }

  void gather(const MonthSlots& month) {
    const std::vector<int>& begins = month.grid->day_begins();
    for (std::size_t day = 0; day + 1 < begins.size(); ++day) {
      int reported = 0;
      int above = 0;
      for (int slot = begins[day]; slot < begins[day + 1]; ++slot) {
        const auto i = static_cast<std::size_t>(slot);
        if (month.validity[i] != Validity::ok || month.measured_kW[i] == 0.0) continue;
        ++reported;
        // Loads just below the limit speak for those just above it.
        if (kSameSize * sign_ * month.measured_kW[i] > limit_kW_) {
          large_.push_back(large_of(month, i));
        }
        if (is_above(month, i)) ++above;
      }
      if (above > 0 && above > kSlipOfDay * reported)
        slips_.emplace_back(&month, static_cast<int>(day));
    }
  }

  [[nodiscard]] bool is_slip(const Large& one) const {
    return std::find(slips_.begin(), slips_.end(), std::pair{one.month, one.day}) != slips_.end();
  }

  const MonthSlots& month_;
  double limit_kW_;
  double sign_;
  std::vector<Large> large_;
  std::vector<std::pair<const MonthSlots*, int>> slips_;
};

/// @return the largest reading times `sign` that is believed above the limit; 0: none is.
double check_unrated(MonthSlots& month, const ValidationContext& context, double limit_kW,
                     double sign) {
  const LargeLoads loads{month, context, limit_kW, sign};
  double largest_kW = 0.0;
  std::vector<std::size_t> refused;
  for (std::size_t i = 0; i < month.measured_kW.size(); ++i) {
    const double value_kW = sign * month.measured_kW[i];
    if (month.validity[i] != Validity::ok || !(value_kW > limit_kW)) continue;
    if (loads.believes(i)) {
      largest_kW = std::max(largest_kW, value_kW);
    } else {
      refused.push_back(i);
    }
  }
  for (const std::size_t slot : refused) condemn(month, slot, Reason::range);
  return largest_kW;
}

bool is_negative(const MonthSlots& month, std::size_t slot) {
  return reported_kW(month, slot) < 0.0;
}

/// Slots of `month` within `reach` slots of a negative one, also across the month's ends. Empty
/// when there is none.
std::vector<bool> beside_negatives(const MonthSlots& month, const ValidationContext& context,
                                   std::ptrdiff_t reach, bool some_inside) {
  const auto n = static_cast<std::ptrdiff_t>(month.measured_kW.size());
  std::vector<bool> beside;
  const auto mark = [&](std::ptrdiff_t centre) {
    if (beside.empty()) beside.assign(static_cast<std::size_t>(n), false);
    const std::ptrdiff_t last = std::min(n - 1, centre + reach);
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, centre - reach); i <= last; ++i) {
      beside[static_cast<std::size_t>(i)] = true;
    }
  };
  for (std::ptrdiff_t i = 0; some_inside && i < n; ++i) {
    if (is_negative(month, static_cast<std::size_t>(i))) mark(i);
  }
  for (std::ptrdiff_t i = 1; i <= reach; ++i) {
    const auto size = [](const MonthSlots& m) {
      return static_cast<std::ptrdiff_t>(m.measured_kW.size());
    };
    const MonthSlots* before = context.before;
    if (before != nullptr && i <= size(*before) &&
        is_negative(*before, static_cast<std::size_t>(size(*before) - i))) {
      mark(-i);
    }
    const MonthSlots* after = context.after;
    if (after != nullptr && i <= size(*after) &&
        is_negative(*after, static_cast<std::size_t>(i - 1))) {
      mark(n - 1 + i);
    }
  }
  return beside;
}

void check_corrections(MonthSlots& month, const ValidationContext& context,
                       const ValidationOptions& options, bool negative_inside) {
  const std::vector<bool> beside = beside_negatives(
      month, context, options.correction_window / month.grid->interval(), negative_inside);
  if (beside.empty()) return;
  double largest_elsewhere_kW = -1.0;
  for (std::size_t i = 0; i < beside.size(); ++i) {
    if (!beside[i] && month.validity[i] == Validity::ok) {
      largest_elsewhere_kW = std::max(largest_elsewhere_kW, month.measured_kW[i]);
    }
  }
  if (largest_elsewhere_kW < 0.0) return;  // nothing to compare with
  for (std::size_t i = 0; i < beside.size(); ++i) {
    if (beside[i] && month.validity[i] == Validity::ok &&
        month.measured_kW[i] > largest_elsewhere_kW) {
      condemn(month, i, Reason::range);
    }
  }
}

/// The slots with the highest valid readings of a day.
struct DayTop {
  std::size_t highest = 0;
  double first_kW = -1.0;
  double second_kW = -1.0;
  double third_kW = -1.0;
};

DayTop top_of_day(const MonthSlots& month, std::size_t begin, std::size_t end) {
  DayTop top;
  for (std::size_t i = begin; i < end; ++i) {
    const double value_kW = month.measured_kW[i];
    if (month.validity[i] != Validity::ok || !(value_kW > top.third_kW)) continue;
    if (value_kW > top.first_kW) {
      top.third_kW = top.second_kW;
      top.second_kW = top.first_kW;
      top.first_kW = value_kW;
      top.highest = i;
    } else if (value_kW > top.second_kW) {
      top.third_kW = top.second_kW;
      top.second_kW = value_kW;
    } else {
      top.third_kW = value_kW;
    }
  }
  return top;
}

/// Whether three readings of the day are so high that none can be a spike.
bool has_third_reading_above(const MonthSlots& month, std::size_t begin, std::size_t end,
                             double level_kW) {
  int above = 0;
  for (std::size_t i = begin; i < end; ++i) {
    if (month.measured_kW[i] >= level_kW && month.validity[i] == Validity::ok && ++above == 3) {
      return true;
    }
  }
  return false;
}

/// The step of the readings: a coarse register shows 0, 1, 2 … times it. Tiny for fine readings.
double step_of_readings_kW(const MonthSlots& month) {
  std::vector<double> values;
  for (std::size_t i = 0; i < month.measured_kW.size(); ++i) {
    if (month.validity[i] == Validity::ok) values.push_back(month.measured_kW[i]);
  }
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const double rounding_kW = 1e-6 * std::max(values.back(), -values.front());
  double step_kW = kAbsent;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double rise_kW = values[i] - values[i - 1];
    if (rise_kW > rounding_kW && !(rise_kW >= step_kW)) step_kW = rise_kW;
  }
  return std::isnan(step_kW) ? 0.0 : step_kW;
}

/// Finds single readings far above the rest of their day that nothing confirms.
class SpikeCheck {
 public:
  SpikeCheck(MonthSlots& month, const Meter& meter, const ValidationContext& context,
             const ValidationOptions& options)
      : month_{month}, meter_{meter}, context_{context}, options_{options} {}

  void run(double largest_kW) {
    const double ordinary_kW = largest_kW / (1.0 + options_.spike_rise);
    const std::vector<int>& begins = month_.grid->day_begins();
    for (std::size_t day = 0; day + 1 < begins.size(); ++day) {
      const auto begin = static_cast<std::size_t>(begins[day]);
      const auto end = static_cast<std::size_t>(begins[day + 1]);
      if (has_third_reading_above(month_, begin, end, ordinary_kW)) continue;
      // Each pass removes one spike, so two in one day are both found.
      for (;;) {
        const DayTop top = top_of_day(month_, begin, end);
        if (top.third_kW <= 0.0) break;  // a load that ran twice a day has no third to compare with
        if ((top.first_kW - top.third_kW) / top.third_kW <= options_.spike_rise) break;
        if (!is_far_from_its_time_of_day(top.highest) || is_confirmed(top.highest)) break;
        condemn(month_, top.highest, Reason::spike);
      }
    }
  }

 private:
  bool is_far_from_its_time_of_day(std::size_t slot) {
    const int time_of_day = month_.grid->time_of_day(static_cast<int>(slot));
    std::vector<double> values;
    for (std::size_t i = 0; i < month_.measured_kW.size(); ++i) {
      if (i != slot && month_.validity[i] == Validity::ok &&
          month_.grid->time_of_day(static_cast<int>(i)) == time_of_day) {
        values.push_back(month_.measured_kW[i]);
      }
    }
    if (values.size() < kSpikeDaysMin) return false;
    const double centre_kW = median_of(values);
    for (double& value : values) value = std::abs(value - centre_kW);
    const double scale_kW = std::max(
        {kNormalMad * median_of(values), kSpikeScaleFloor * median_magnitude(month_), step_kW()});
    return std::abs(month_.measured_kW[slot] - centre_kW) > options_.spike_scales * scale_kW;
  }

  bool is_confirmed(std::size_t slot) {
    if (meter_.is_counted && register_goes_on(slot)) return true;
    const int others = readings_like(slot);
    // A load that mostly rests has no usual time of day, so one other run shows its power.
    return others >= kFiringsConfirming || (others > 0 && mostly_rests());
  }

  /// A register that counted a spike continues from there; one that was misread falls back.
  [[nodiscard]] bool register_goes_on(std::size_t slot) const {
    const auto goes_on = [](const MonthSlots& month, std::size_t i) {
      return !has(month.reasons[i], Reason::reset) && !has(month.reasons[i], Reason::jump);
    };
    if (slot + 1 < month_.reasons.size()) return goes_on(month_, slot + 1);
    return context_.after == nullptr || goes_on(*context_.after, 0);
  }

  /// Readings of the same size on the days around, at any time of day, also across
  /// the month's ends.
  [[nodiscard]] int readings_like(std::size_t slot) const {
    const double value_kW = month_.measured_kW[slot];
    const auto reach =
        static_cast<std::ptrdiff_t>(options_.spike_days_around) * month_.grid->times_of_day();
    const auto centre = static_cast<std::ptrdiff_t>(slot);
    const auto size = std::ssize(month_.measured_kW);
    const auto count = [&](const MonthSlots* in, std::ptrdiff_t begin, std::ptrdiff_t end) {
      if (in == nullptr) return 0;
      int like = 0;
      for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, begin);
           i < std::min(end, std::ssize(in->measured_kW)); ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (in->validity[k] != Validity::ok || (in == &month_ && i == centre)) continue;
        const double other_kW = in->measured_kW[k];
        if (other_kW >= value_kW / kSameSize && other_kW <= value_kW * kSameSize) ++like;
      }
      return like;
    };
    const std::ptrdiff_t before = context_.before ? std::ssize(context_.before->measured_kW) : 0;
    return count(&month_, centre - reach, centre + reach + 1) +
           count(context_.before, before + centre - reach, before) +
           count(context_.after, 0, centre + reach + 1 - size);
  }

  [[nodiscard]] bool mostly_rests() {
    if (!mostly_rests_) {
      std::vector<double> values;
      for (std::size_t i = 0; i < month_.measured_kW.size(); ++i) {
        if (month_.validity[i] == Validity::ok) values.push_back(month_.measured_kW[i]);
      }
      mostly_rests_ = median_of(values) <= kFewSteps * step_kW();
    }
    return *mostly_rests_;
  }

  double step_kW() {
    if (!step_kW_) step_kW_ = step_of_readings_kW(month_);
    return *step_kW_;
  }

  MonthSlots& month_;
  const Meter& meter_;
  const ValidationContext& context_;
  const ValidationOptions& options_;
  std::optional<double> step_kW_;
  std::optional<bool> mostly_rests_;
};

/// Reported slots equal to `value_kW` next to the month: back from its start or on from its end.
int run_outside(const MonthSlots* neighbour, double value_kW, bool from_its_end) {
  if (neighbour == nullptr) return 0;
  const std::size_t n = neighbour->measured_kW.size();
  int run = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const double other_kW = reported_kW(*neighbour, from_its_end ? n - 1 - k : k);
    if (std::isnan(other_kW)) continue;
    if (other_kW != value_kW) break;
    ++run;
  }
  return run;
}

/// A run of equal reports within the month: slots [begin, end), `count` of them reported.
struct Run {
  std::size_t begin;
  std::size_t end;
  double value_kW;
  int count;
};

/// Checks runs of equal readings; a run of one needs only a comparison.
class RunCheck {
 public:
  RunCheck(MonthSlots& month, const Meter& meter, const ValidationContext& context,
           const ValidationOptions& options)
      : month_{month}, context_{context}, zero_run_max_{meter.zero_run_max} {
    const seconds interval = month.grid->interval();
    stuck_max_ = meter.stuck_max.value_or(options.stuck_intervals * interval);
  }

  void run() {
    Run run{0, 0, kAbsent, 0};
    for (std::size_t i = 0; i < month_.measured_kW.size(); ++i) {
      const double value_kW = reported_kW(month_, i);
      if (std::isnan(value_kW)) continue;
      if (value_kW == run.value_kW) {
        ++run.count;
      } else {
        if (first_ || run.count > 1 || run.value_kW == 0.0) finish(run, false);
        run = {i, i, value_kW, 1};
      }
      run.end = i + 1;
    }
    finish(run, true);
    for (const Run& stuck : stuck_) {
      if (!comes_back(stuck.value_kW)) condemn_run(stuck, Reason::stuck);
    }
  }

 private:
  /// A meter that froze stands at another value each time. What comes back day by day is a load
  /// that takes just so much, such as a car that is charged.
  [[nodiscard]] bool comes_back(double value_kW) const {
    std::ptrdiff_t runs = std::ranges::count(stuck_, value_kW, &Run::value_kW);
    for (const MonthSlots* neighbour : {context_.before, context_.after}) {
      if (runs >= kComesBack) break;
      if (neighbour != nullptr) runs += long_runs(*neighbour, value_kW);
    }
    return runs >= kComesBack;
  }

  [[nodiscard]] std::ptrdiff_t long_runs(const MonthSlots& month, double value_kW) const {
    std::ptrdiff_t runs = 0;
    int length = 0;
    for (std::size_t i = 0; i < month.measured_kW.size(); ++i) {
      const double other_kW = reported_kW(month, i);
      if (std::isnan(other_kW)) continue;
      length = other_kW == value_kW ? length + 1 : 0;
      if (length > 0 && length == stuck_max_ / month.grid->interval()) ++runs;
    }
    return runs;
  }

  void condemn_run(const Run& run, Reason reason) {
    for (std::size_t i = run.begin; i < run.end; ++i) {
      if (!std::isnan(reported_kW(month_, i))) condemn(month_, i, reason);
    }
  }

  void finish(Run run, bool last) {
    if (run.count == 0) return;
    if (first_) run.count += run_outside(context_.before, run.value_kW, true);
    if (last) run.count += run_outside(context_.after, run.value_kW, false);
    first_ = false;
    const seconds length = run.count * month_.grid->interval();
    const bool zero = run.value_kW == 0.0;
    const bool doubtful = zero ? zero_run_max_ && length > *zero_run_max_
                               : stuck_max_ > seconds{0} && length >= stuck_max_;
    if (!doubtful) return;
    if (zero) {
      condemn_run(run, Reason::zero_run);
    } else {
      stuck_.push_back(run);
    }
  }

  static constexpr std::ptrdiff_t kComesBack = 3;

  MonthSlots& month_;
  const ValidationContext& context_;
  std::optional<seconds> zero_run_max_;
  seconds stuck_max_;
  std::vector<Run> stuck_;  ///< Too long; decided once all are known.
  bool first_ = true;
};

}  // namespace

Reason doubt_of(double mean_kW, const Meter& meter, const ValidationOptions& options) {
  if (mean_kW < 0.0 && !meter.negative_is_valid) return Reason::negative;
  const bool is_beyond =
      meter.rated_kW && std::abs(mean_kW) > options.range_factor * *meter.rated_kW;
  return is_beyond ? Reason::range : Reason::none;
}

void validate(MonthSlots& month, const Meter& meter, const ValidationContext& context,
              const ValidationOptions& options) {
  const bool both_ways = meter.negative_is_valid;
  const Extremes extremes = extremes_of(month);
  const double limit_kW = range_limit_kW(month, extremes.magnitude_kW(), meter, context, options);
  double lower_kW = both_ways ? -limit_kW : 0.0;
  double largest_kW = limit_kW;
  if (!meter.rated_kW && extremes.highest_kW > limit_kW) {
    largest_kW = std::max(limit_kW, check_unrated(month, context, limit_kW, 1.0));
  }
  if (!meter.rated_kW && both_ways && extremes.lowest_kW < lower_kW) {
    lower_kW = -std::max(limit_kW, check_unrated(month, context, limit_kW, -1.0));
  }
  if (extremes.highest_kW > largest_kW || extremes.lowest_kW < lower_kW) {
    check_range(month, lower_kW, largest_kW, both_ways ? Reason::range : Reason::negative);
  }
  if (!both_ways) check_corrections(month, context, options, extremes.lowest_kW < 0.0);
  SpikeCheck{month, meter, context, options}.run(std::min(extremes.highest_kW, largest_kW));
  // A register that stands still has counted nothing, and one that counts evenly has a steady load
  // or coarse steps: it says so by counting, unlike a power that nobody measures any more.
  if (!meter.is_counted) RunCheck{month, meter, context, options}.run();
}

}  // namespace recald::metering
