#include "core/metering/months/gap_fill.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

namespace recald::metering {
namespace {

using std::chrono::seconds;

/// Count, mean and sum of squared deviations; two of them can be merged without their readings.
struct Moments {
  double n = 0.0;
  double mean = 0.0;
  double squares = 0.0;

  void merge(const Moments& other) {  // Chan, Golub, LeVeque
    if (other.n == 0.0) return;
    const double total = n + other.n;
    const double step = other.mean - mean;
    squares += other.squares + step * step * n * other.n / total;
    mean += step * other.n / total;
    n = total;
  }
  [[nodiscard]] double variance() const { return n < 2.0 ? 0.0 : squares / (n - 1.0); }
};

/// Readings that are averaged together, and the number of slots filled with that average.
struct Pool {
  Moments readings;
  double variance_kW2 = 0.0;
  double filled = 0.0;
  bool known = false;
};

struct Gap {
  int begin;
  int end;
};

/// The computation for one month; the arrays are indexed by day type and time of day.
class MonthFiller {
 public:
  MonthFiller(MonthSlots& month, const FillOptions& options)
      : month_{month},
        options_{options},
        times_{month.grid->times_of_day()},
        types_{options.daytype ? 2 : 1} {
    find_day_types();
    by_time_.resize(static_cast<std::size_t>(types_ * times_));
    learn_times_of_day();
    for (const Moments& moments : by_time_) whole_month_.merge(moments);
    pools_.resize(static_cast<std::size_t>((types_ + 2) * times_ + 1));
  }

  FillResult run() {
    if (whole_month_.n == 0.0) return {};
    for (const Gap& gap : gaps()) fill(gap);
    FillResult result;
    result.filled = filled_;
    const double hours = month_.grid->interval_h();
    for (const Pool& pool : pools_) {
      if (pool.filled == 0.0) continue;
      result.variance_kWh2 +=
          pool.variance_kW2 * pool.filled * pool.filled / pool.readings.n * hours * hours;
    }
    result.variance_kWh2 += gap_variance_kWh2_ + block_variance_kWh2();
    return result;
  }

 private:
  [[nodiscard]] double measured_kW(int slot) const {
    return month_.measured_kW[static_cast<std::size_t>(slot)];
  }
  [[nodiscard]] int time_of(int slot) const { return month_.grid->time_of_day(slot); }
  [[nodiscard]] int day_type(int slot) const {
    return types_ == 1 ? 0 : day_types_[static_cast<std::size_t>(month_.grid->day(slot))];
  }
  Moments& cell(int type, int time) {
    return by_time_[static_cast<std::size_t>(type * times_ + time)];
  }

  /// One pass over deviations from the first reading of each time of day, which is close enough to
  /// their mean to lose no digits.
  void learn_times_of_day() {
    struct Sums {
      double n = 0.0;
      double origin = 0.0;
      double sum = 0.0;
      double squares = 0.0;
    };
    std::vector<Sums> sums(by_time_.size());
    for (int slot = 0; slot < month_.slots(); ++slot) {
      if (!month_.is_ok(slot)) continue;
      Sums& s = sums[static_cast<std::size_t>(day_type(slot) * times_ + time_of(slot))];
      if (s.n == 0.0) s.origin = measured_kW(slot);
      const double deviation_kW = measured_kW(slot) - s.origin;
      s.n += 1.0;
      s.sum += deviation_kW;
      s.squares += deviation_kW * deviation_kW;
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const Sums& s = sums[i];
      if (s.n == 0.0) continue;
      by_time_[i] = {s.n, s.origin + s.sum / s.n, std::max(0.0, s.squares - s.sum * s.sum / s.n)};
    }
  }

  void find_day_types() {
    for (int d = 1; d <= month_.grid->days(); ++d) {
      const Day day = month_.grid->month() / d;
      const auto weekday = std::chrono::weekday{std::chrono::sys_days{day}};
      const bool weekend = weekday == std::chrono::Saturday || weekday == std::chrono::Sunday;
      const bool holiday = std::find(options_.holidays.begin(), options_.holidays.end(), day) !=
                           options_.holidays.end();
      day_types_.push_back(weekend || holiday ? 1 : 0);
    }
  }

  [[nodiscard]] std::vector<Gap> gaps() const {
    std::vector<Gap> found;
    for (int slot = 0; slot < month_.slots(); ++slot) {
      if (month_.has_energy(slot)) continue;
      if (found.empty() || found.back().end != slot) found.push_back({slot, slot});
      found.back().end = slot + 1;
    }
    return found;
  }

  void fill(const Gap& gap) {
    const seconds length = (gap.end - gap.begin) * month_.grid->interval();
    const bool good_neighbours = gap.begin > 0 && gap.end < month_.slots() &&
                                 month_.is_ok(gap.begin - 1) && month_.is_ok(gap.end);
    if (options_.rule == FillRule::linear_short && length <= options_.line_max && good_neighbours) {
      fill_by_line(gap);
      return;
    }
    const bool as_days = length > options_.by_slots_gap_max;
    double spread_kWh = 0.0;
    for (int slot = gap.begin; slot < gap.end; ++slot) {
      FillMethod method = FillMethod::none;
      Pool& pool = pool_for(slot, method);
      if (!as_days) {
        pool.filled += 1.0;
        spread_kWh += std::sqrt(pool.variance_kW2) * month_.grid->interval_h();
      }
      set(slot, pool.readings.mean, method);
    }
    gap_variance_kWh2_ += spread_kWh * spread_kWh;
    if (as_days) days_missing_ += std::chrono::duration<double, std::ratio<86'400>>(length).count();
  }

  void fill_by_line(const Gap& gap) {
    const double from_kW = measured_kW(gap.begin - 1);
    const double to_kW = measured_kW(gap.end);
    const double steps = gap.end - gap.begin + 1;
    double spread_kWh = 0.0;
    for (int slot = gap.begin; slot < gap.end; ++slot) {
      FillMethod method = FillMethod::none;
      spread_kWh += std::sqrt(pool_for(slot, method).variance_kW2) * month_.grid->interval_h();
      set(slot, from_kW + (to_kW - from_kW) * (slot - gap.begin + 1) / steps, FillMethod::line);
    }
    gap_variance_kWh2_ += spread_kWh * spread_kWh;
  }

  void set(int slot, double value_kW, FillMethod method) {
    const auto i = static_cast<std::size_t>(slot);
    month_.used_kW[i] = value_kW;
    month_.method[i] = method;
    if (month_.validity[i] == Validity::missing) month_.validity[i] = Validity::filled;
    ++filled_;
  }

  /// The narrowest pool with enough readings: like days, all days, times around, the month.
  Pool& pool_for(int slot, FillMethod& method) {
    const int type = day_type(slot);
    const int time = time_of(slot);
    if (cell(type, time).n >= options_.days_min) {
      method = types_ == 1 ? FillMethod::same_time : FillMethod::same_time_like_days;
      return pool(type * times_ + time, [&] { return cell(type, time); });
    }
    const Moments all_days = at_time(time);
    if (types_ > 1 && all_days.n >= options_.days_min) {
      method = FillMethod::same_time;
      return pool(types_ * times_ + time, [&] { return all_days; });
    }
    Moments around = at_time((time + times_ - 1) % times_);
    around.merge(all_days);
    around.merge(at_time((time + 1) % times_));
    if (around.n >= 1.0) {
      method = FillMethod::neighbouring_times;
      return pool((types_ + 1) * times_ + time, [&] { return around; });
    }
    method = FillMethod::month_mean;
    return pool((types_ + 2) * times_, [&] { return whole_month_; });
  }

  Moments at_time(int time) {
    Moments all;
    for (int type = 0; type < types_; ++type) all.merge(cell(type, time));
    return all;
  }

  template <class Readings>
  Pool& pool(int index, Readings readings) {
    Pool& pool = pools_[static_cast<std::size_t>(index)];
    if (!pool.known) {
      pool.known = true;
      pool.readings = readings();
      pool.variance_kW2 = pool.readings.variance();
      // One or two readings say little about their spread, so use the month's, which is wider.
      if (pool.readings.n < options_.days_min) {
        pool.variance_kW2 = std::max(pool.variance_kW2, whole_month_.variance());
      }
    }
    return pool;
  }

  /// For the slots in long gaps, from the means of complete days.
  [[nodiscard]] double block_variance_kWh2() const {
    if (days_missing_ == 0.0) return 0.0;
    Moments complete_days;
    const std::vector<int>& begins = month_.grid->day_begins();
    for (std::size_t day = 0; day + 1 < begins.size(); ++day) {
      if (begins[day] == begins[day + 1]) continue;
      double sum_kW = 0.0;
      bool complete = true;
      for (int slot = begins[day]; slot < begins[day + 1]; ++slot) {
        complete = complete && month_.is_ok(slot);
        sum_kW += measured_kW(slot);
      }
      if (complete) complete_days.merge({1.0, sum_kW / (begins[day + 1] - begins[day]), 0.0});
    }
    double variance_kW2 = complete_days.variance();
    double days_known = complete_days.n;
    if (complete_days.n < options_.days_min) {
      // Without complete days to compare, assume that a day varies as much as a single slot.
      variance_kW2 = whole_month_.variance();
      days_known = std::max(1.0, whole_month_.n / times_);
    }
    constexpr double day_h = 24.0;
    return variance_kW2 * (days_missing_ + days_missing_ * days_missing_ / days_known) * day_h *
           day_h;
  }

  MonthSlots& month_;
  const FillOptions& options_;
  int times_;
  int types_;
  std::vector<int> day_types_;
  std::vector<Moments> by_time_;
  Moments whole_month_;
  std::vector<Pool> pools_;
  int filled_ = 0;
  double days_missing_ = 0.0;
  double gap_variance_kWh2_ = 0.0;
};

}  // namespace

FillResult fill_gaps(MonthSlots& month, const FillOptions& options) {
  bool whole = true;
  for (int slot = 0; slot < month.slots(); ++slot) {
    const auto i = static_cast<std::size_t>(slot);
    if (month.has_energy(slot)) {
      month.used_kW[i] = month.measured_kW[i];
    } else {
      whole = false;
    }
  }
  if (whole) return {};
  return MonthFiller{month, options}.run();
}

}  // namespace recald::metering
